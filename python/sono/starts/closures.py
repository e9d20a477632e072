"""Closed curves from a description: torus knots, braid words, arc presentations, chains of rings.

Every curve here is drawn for a rope of radius about 1, so its length is close to its ropelength, and is
sampled finely enough (turning angles below about 20 degrees, or straight pieces of 0.6 radii) that
the polygon has the knot type of the smooth curve.

>>> len(torus(2, 3)), len(torus(2, 4)), len(braid([1, -2, 1, -2])), len(chain(3))
(1, 2, 1, 3)
"""

import math
from collections.abc import Sequence
from typing import TypeAlias

import numpy as np
from numpy.typing import NDArray

Curve: TypeAlias = list[NDArray[np.float64]]
"""One (n_i, 3) array a component: the vertices of a closed polygon, the first not repeated at the end."""

Strokes: TypeAlias = list[tuple[int, int]]
"""An arc presentation, column by column: the two rows where the column's vertical stroke ends, from 0. Each
row ends two strokes too, and a horizontal stroke joins them, which passes over all vertical ones."""


MOST_VERTICES = 500_000
"""Vertices of a curve that is drawn."""

COMMUTE = 0.5
"""How often a random move of an arc presentation exchanges two columns that may be exchanged."""


def torus(p: int, q: int, n: int | None = None) -> Curve:
    """Return the torus knot or link T(p,q), which winds p times the long way round and q times the short way.

    The minor radius of the torus is 1. There are g = gcd(p, q) components of n vertices each; by default n
    gives turning angles of 15 to 20 degrees and is a multiple of q/g, so that the polygon has the (q/g)-fold
    symmetry of the curve. pq > 0 is right-handed, pq < 0 its mirror image. Raises ValueError where p or q is
    zero, n is less than 3, or there would be over `MOST_VERTICES`.
    """
    if p == 0 or q == 0:
        raise ValueError(f"T({p},{q}) is no torus knot: p and q must not be zero")
    components = math.gcd(p, q)
    long, short = abs(p) // components, abs(q) // components
    n = short * max(3, round(14 * (long + short) / short)) if n is None else n
    if n < 3:
        raise ValueError(f"a closed polygon needs at least 3 vertices, not {n}")
    _check_size(components * n, f"T({p},{q})")
    # q/p: the strands climb at 45 degrees, as in the tightest rope of two strands. 1: room in the hole.
    major = 1 + short / long
    time = 2 * np.pi * np.arange(n) / n
    curve = []
    for k in range(components):
        around = long * time
        through = short * time + 2 * np.pi * k / abs(p)
        rho = major + np.cos(through)
        # Turning clockwise as seen looking forward along the strand: a right-handed screw.
        z = -math.copysign(1, p * q) * np.sin(through)
        curve.append(np.column_stack([rho * np.cos(around), rho * np.sin(around), z]))
    return curve


def braid(word: Sequence[int]) -> Curve:
    """Return the closure of the braid `word` of generators +-1, +-2, ...; a positive one is right-handed.

    The strands run round the z axis at radii 2 apart. In a crossing two neighbours make half a turn about the
    point between them, so they stay 2 apart; crossings that share no strand share a sector where their order
    allows. There are max |generator| + 1 strands, and a strand without crossings is a circle. Raises
    ValueError for a generator 0, or where there would be over `MOST_VERTICES`.
    """
    if 0 in word:
        raise ValueError("a braid generator must not be 0: they count from +-1")
    strands = max(map(abs, word), default=0) + 1
    # At least 36 vertices on each strand, and 12 for each crossing on two of them.
    _check_size(max(36 * strands, 24 * len(word)), f"a braid of {strands} strands, {len(word)} crossings")
    target, lift = _sectors(word, strands)
    sectors = len(target)
    _check_size(12 * sectors * strands, f"a braid of {strands} strands, {len(word)} crossings")
    # A sector 4 long at the innermost strand keeps the half turns from pinching below radius 1.
    inner = max(2.0, 4 * sectors / (2 * np.pi))
    samples = max(12, math.ceil(36 / sectors))
    time = np.arange(samples) / samples
    half_turn = np.pi * time**2 * (3 - 2 * time)

    def piece(sector: int, position: int) -> NDArray[np.float64]:
        end = target[sector, position]
        rho = inner + (position + end) + (position - end) * np.cos(half_turn)
        angle = 2 * np.pi * (sector + time) / sectors
        return np.column_stack(
            [rho * np.cos(angle), rho * np.sin(angle), lift[sector, position] * np.sin(half_turn)]
        )

    curve = []
    unseen = set(range(strands))
    while unseen:
        first = position = min(unseen)
        pieces: list[NDArray[np.float64]] = []
        while not pieces or position != first:
            unseen.remove(position)
            for sector in range(sectors):
                pieces.append(piece(sector, position))
                position = int(target[sector, position])
        curve.append(np.vstack(pieces))
    return curve


def _sectors(word: Sequence[int], strands: int) -> tuple[NDArray[np.int_], NDArray[np.float64]]:
    """Pack the crossings into as few sectors as their order allows.

    Returns two (sectors, strands) arrays: where each position goes in each sector, and +1, -1 or 0 for a
    strand that passes over, under or straight on.
    """
    free = [0] * strands
    target, lift = [np.arange(strands)], [np.zeros(strands)]
    for generator in word:
        left = abs(generator) - 1
        sector = max(free[left], free[left + 1])
        free[left] = free[left + 1] = sector + 1
        if sector == len(target):
            target.append(np.arange(strands))
            lift.append(np.zeros(strands))
        target[sector][[left, left + 1]] = left + 1, left
        lift[sector][[left, left + 1]] = np.sign(generator), -np.sign(generator)
    return np.array(target), np.array(lift)


def chain(rings: int) -> Curve:
    """Return a simple chain of round rings: 1 is the unknot, 2 the Hopf link, 3 the sum of two Hopf links.

    The rings have radius 3. Each is the one before it, moved on by 4 and turned by 90 degrees: every gap is
    then 2, and neighbours have linking number +1. Raises ValueError for less than one ring, or where there
    would be over `MOST_VERTICES`.
    """
    _check_size(48 * rings, f"a chain of {rings} rings")
    if rings < 1:
        raise ValueError(f"a chain has at least one ring, not {rings}")
    time = 2 * np.pi * np.arange(48) / 48
    along, across = 3 * np.cos(time), 3 * np.sin(time)
    turns = np.pi / 2 * np.arange(rings)
    return [
        np.column_stack([along + 4 * k, across * math.cos(turn), -across * math.sin(turn)])
        for k, turn in enumerate(turns)
    ]


def _check_size(vertices: int, what: str) -> None:
    """Refuse what would take more memory and time than anyone has, before any is taken."""
    if vertices > MOST_VERTICES:
        raise ValueError(f"{what} would take over {MOST_VERTICES:,} vertices; give a smaller one")


def grid(strokes: Strokes) -> Curve:
    """Return the knot or link of an arc presentation, drawn on two sheets 2 apart.

    Rows and columns are 2 apart too, so that a rope of radius 1 fits. Raises ValueError where a row does not
    end two strokes.
    """
    columns = {row: [c for c, ends in enumerate(strokes) if row in ends] for row in range(len(strokes))}
    if any(low == high for low, high in strokes) or any(len(ends) != 2 for ends in columns.values()):
        raise ValueError("in an arc presentation each row and each column has two ends of strokes")
    curve = []
    unseen = set(range(len(strokes)))
    while unseen:
        column = min(unseen)
        row = strokes[column][0]
        corners: list[tuple[int, int, int]] = []
        while column in unseen:
            unseen.remove(column)
            corners.append((column, row, 0))
            row = sum(strokes[column]) - row
            corners += [(column, row, 0), (column, row, 1)]
            column = sum(columns[row]) - column
            corners.append((column, row, 1))
        curve.append(divided(2 * np.array(corners, float), 0.6))
    return curve


def divided(corners: NDArray[np.float64], longest: float) -> NDArray[np.float64]:
    """Divide the edges of a polygon until none is longer than `longest`."""
    pieces = [
        np.linspace(begin, end, math.ceil(np.linalg.norm(end - begin) / longest), endpoint=False)
        for begin, end in zip(corners, np.roll(corners, -1, axis=0), strict=True)
    ]
    return np.vstack(pieces)


def shuffled(strokes: Strokes, seed: int, more: int = 0) -> Strokes:
    """Return another arc presentation of the same type, with so many columns `more`, after many random moves.

    A corner may become a step of another row and column. Rows and columns may be moved round cyclically, and
    neighbouring ones change places where their strokes are apart or one lies within the other (P. Cromwell,
    "Embedding knots and links in an open book I", Topology Appl. 64 (1995) 37). The same seed gives the same
    presentation.
    """
    random = np.random.default_rng(seed)
    for _ in range(more):
        strokes = _stepped(strokes, *map(int, random.integers([len(strokes), 2, 2, 2])))
    for _ in range(2 * len(strokes) * (1 + more)):
        turn = int(random.integers(len(strokes)))
        strokes = strokes[turn:] + strokes[:turn]
        if _may_swap(strokes[0], strokes[1]) and random.random() < COMMUTE:
            strokes[0], strokes[1] = strokes[1], strokes[0]
        # The same presentation with rows for columns; from the other side of the sheets, the same knot.
        strokes = _transposed(strokes)
    return strokes


def _stepped(strokes: Strokes, column: int, end: int, above: int, right: int) -> Strokes:
    """Return the presentation with a step in place of the corner at one end of a column.

    The column ends in a new row above the corner's or below it, and a new column to the right or left leads
    from there to the old one.
    """
    new = strokes[column][end] + above
    rows = [tuple(row + (row >= new) for row in ends) for ends in strokes]
    corner, other = rows[column][end], rows[column][1 - end]
    rows[column] = min(new, other), max(new, other)
    rows.insert(column + right, (min(new, corner), max(new, corner)))
    return [(low, high) for low, high in rows]


def _may_swap(one: tuple[int, int], other: tuple[int, int]) -> bool:
    """Tell whether the rows of two strokes do not interleave, and are four."""
    ends = sorted([(row, 0) for row in one] + [(row, 1) for row in other])
    rows, owners = zip(*ends, strict=True)
    return len(set(rows)) == 4 and owners not in ((0, 1, 0, 1), (1, 0, 1, 0))


def _transposed(strokes: Strokes) -> Strokes:
    """Return the columns of each row, in the order of rows."""
    columns = [[c for c, ends in enumerate(strokes) if row in ends] for row in range(len(strokes))]
    return [(low, high) for low, high in columns]


def mirror(curve: Curve) -> Curve:
    """Return the mirror image of `curve` in the plane z = 0."""
    return [component * (1, 1, -1) for component in curve]
