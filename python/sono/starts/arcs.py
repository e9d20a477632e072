"""Arc presentations: knots of vertical strokes on one sheet and horizontal ones on another.

>>> trefoil = [(0, 2), (1, 3), (2, 4), (0, 3), (1, 4)]
>>> len(grid(trefoil)), len(shuffled(trefoil, seed=1, more=2))
(1, 7)
"""

from typing import TypeAlias

import numpy as np

from sono.curve import Components
from sono.starts.drawing import divided

Strokes: TypeAlias = list[tuple[int, int]]
"""An arc presentation, column by column: the two rows where the column's vertical stroke ends, from 0. Each
row ends two strokes too, and a horizontal stroke joins them, which passes over all vertical ones."""

COMMUTE = 0.5
"""How often a random move of an arc presentation exchanges two columns that may be exchanged."""


def grid(strokes: Strokes) -> Components:
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
