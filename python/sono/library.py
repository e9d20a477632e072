"""Starting conformations: loose knots and links that a tightening run begins with.

Every curve here is drawn for a rope of radius about 1, so its length is close to its ropelength, and is
sampled finely enough (turning angles below about 20 degrees) that the polygon has the knot type of the smooth
curve.

>>> len(torus(2, 3)), len(torus(2, 4)), len(braid([1, -2, 1, -2])), len(start("chain3"))
(1, 2, 1, 3)
"""

import difflib
import math
import re
from collections.abc import Callable, Sequence
from typing import TypeAlias

import numpy as np
from numpy.typing import NDArray

Curve: TypeAlias = list[NDArray[np.float64]]
"""One (n_i, 3) array a component: the vertices of a closed polygon, the first not repeated at the end."""

Map: TypeAlias = Callable[[NDArray[np.float64]], NDArray[np.float64]]
"""A map of space, which takes points (m, 3) to points (m, 3)."""

# Torus knots by their type, the others by a braid word as KnotInfo lists it (https://knotinfo.math.indiana.edu,
# "Braid Notation"). KnotInfo's table and ours may differ by a mirror image: here a positive generator is a
# right-handed crossing, so 3_1 is the right-handed trefoil.
_TABLE = {
    "unknot": "chain1",
    "0_1": "chain1",
    "3_1": "T(2,3)",
    "4_1": "1 -2 1 -2",
    "5_1": "T(2,5)",
    "7_1": "T(2,7)",
    "8_19": "T(3,4)",
    "9_1": "T(2,9)",
    "Hopf": "chain2",
    "2^2_1": "chain2",
    "L2a1": "chain2",
    "chain3": "chain3",
}

NAMES = tuple(_TABLE)
"""The names `start` knows, besides torus types such as "T(2,5)" and braid words such as "1 -2 1 -2"."""

_TORUS = re.compile(r"t\s*\(\s*(-?\d+)\s*,\s*(-?\d+)\s*\)", re.IGNORECASE)
_CHAIN = re.compile(r"chain\s*(\d+)", re.IGNORECASE)
_BRAID = re.compile(r"-?\d+([\s,]+-?\d+)+")


def start(name: str) -> Curve:
    """Return the starting conformation called `name`, in units of about one rope radius.

    `name` is one of `NAMES`, a torus type "T(p,q)", a chain of rings "chain3", or a braid word "1 -2 1 -2" of
    two generators or more; letter case and surrounding space do not matter. Raises ValueError, with the
    nearest known name, for anything else.
    """
    known = {known.casefold(): spec for known, spec in _TABLE.items()}
    spec = known.get(name.strip().casefold(), name.strip())
    if match := _TORUS.fullmatch(spec):
        return torus(int(match[1]), int(match[2]))
    if match := _CHAIN.fullmatch(spec):
        return chain(int(match[1]))
    if _BRAID.fullmatch(spec):
        return braid([int(generator) for generator in re.findall(r"-?\d+", spec)])
    near = difflib.get_close_matches(spec, NAMES, n=1)
    hint = f"did you mean {near[0]!r}? " if near else ""
    raise ValueError(f"unknown knot {name!r}: {hint}Known are {', '.join(NAMES)}, T(p,q) and braid words")


def torus(p: int, q: int, n: int | None = None) -> Curve:
    """Return the torus knot or link T(p,q), which winds p times the long way round and q times the short way.

    The minor radius of the torus is 1. There are g = gcd(p, q) components of n vertices each; by default n
    gives turning angles of 15 to 20 degrees and is a multiple of q/g, so that the polygon has the (q/g)-fold
    symmetry of the curve. pq > 0 is right-handed, pq < 0 its mirror image. Raises ValueError where p or q is
    zero, or n is less than 3.
    """
    if p == 0 or q == 0:
        raise ValueError(f"T({p},{q}) is no torus knot: p and q must not be zero")
    components = math.gcd(p, q)
    long, short = abs(p) // components, abs(q) // components
    n = short * max(3, round(14 * (long + short) / short)) if n is None else n
    if n < 3:
        raise ValueError(f"a closed polygon needs at least 3 vertices, not {n}")
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
    ValueError for a generator 0.
    """
    if 0 in word:
        raise ValueError("a braid generator must not be 0: they count from +-1")
    strands = max(map(abs, word), default=0) + 1
    target, lift = _sectors(word, strands)
    sectors = len(target)
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
    then 2, and neighbours have linking number +1. Raises ValueError for less than one ring.
    """
    if rings < 1:
        raise ValueError(f"a chain has at least one ring, not {rings}")
    time = 2 * np.pi * np.arange(48) / 48
    along, across = 3 * np.cos(time), 3 * np.sin(time)
    turns = np.pi / 2 * np.arange(rings)
    return [
        np.column_stack([along + 4 * k, across * math.cos(turn), -across * math.sin(turn)])
        for k, turn in enumerate(turns)
    ]


def mirror(curve: Curve) -> Curve:
    """Return the mirror image of `curve` in the plane z = 0."""
    return [component * (1, 1, -1) for component in curve]


def scramble(curve: Curve, seed: int, swirls: int = 40) -> Curve:
    """Return `curve` entangled by random swirls of space, in the same unit and with more vertices.

    A swirl turns every sphere about a centre by an angle that fades with its radius; let the angle grow from
    zero, and it is an isotopy of all space, so the image has the knot type of the curve. The polygon has the
    type of the image because its edges are halved until they are shorter than half a rope radius, and a swirl
    after which the curve would not hold a rope of that radius, 600 radii long at most, is left out. The same
    seed gives the same curve. Raises ValueError for a curve that touches itself, or too thin a rope.
    """
    random = np.random.default_rng(seed)
    curve, radius = _rope(curve)
    for _ in range(swirls):
        swirl = _swirl(random, np.vstack(curve))
        moved = [_image(component, swirl, radius / 2) for component in curve]
        if _length(moved) <= 600 * radius and _holds_rope(moved, radius):
            curve = moved
    return curve


def _rope(curve: Curve) -> tuple[Curve, float]:
    """Return `curve` finely sampled, and the radius of a rope in it that leaves room to move."""
    length = _length(curve)
    for slenderness in (100, 200, 400):
        radius = length / slenderness
        fine = [_image(component, np.copy, radius / 2) for component in curve]
        if _holds_rope(fine, 2 * radius):
            return fine, radius
    raise ValueError("the curve touches itself, or comes closer to itself than 1/100 of its length")


def _swirl(random: np.random.Generator, points: NDArray[np.float64]) -> Map:
    """Draw a swirl that takes hold of a part of the (n, 3) points."""
    size = math.sqrt(points.var(axis=0).sum())
    centre = points[random.integers(len(points))] + random.normal(scale=0.3 * size, size=3)
    axis = random.normal(size=3)
    axis /= np.linalg.norm(axis)
    most, width = random.uniform(-2 * np.pi, 2 * np.pi), size * random.uniform(0.5, 1.5)

    def swirl(points: NDArray[np.float64]) -> NDArray[np.float64]:
        arm = points - centre
        angle = most * np.exp(-(arm**2).sum(axis=1, keepdims=True) / width**2)
        along = np.outer(arm @ axis, axis)
        turned = (arm - along) * np.cos(angle) + np.cross(axis, arm) * np.sin(angle)
        moved: NDArray[np.float64] = centre + along + turned
        return moved

    return swirl


def _image(component: NDArray[np.float64], move: Map, longest: float) -> NDArray[np.float64]:
    """Return the (m, 3) image of a polygon, with edges halved until those of the image are short enough."""
    while True:
        image = move(component)
        cut = np.flatnonzero(np.linalg.norm(_edges(image), axis=1) > longest)
        if not len(cut):
            return image
        middle = component[cut] + _edges(component)[cut] / 2
        component = np.insert(component, cut + 1, middle, axis=0)


def _holds_rope(curve: Curve, radius: float) -> bool:
    """Tell whether all vertices are 2 radii apart, or else 2/pi of the way between them along the curve.

    A bend of the radius of the rope meets this up to its half circle, the ends of which are 2 radii apart.
    """
    points = np.vstack(curve)
    points = points - points.mean(axis=0)
    norm = (points**2).sum(axis=1)
    distance2 = norm[:, None] + norm - 2 * points @ points.T
    least = np.full_like(distance2, 2 * radius)
    begin = 0
    for component in curve:
        lengths = np.linalg.norm(_edges(component), axis=1)
        place = np.cumsum(lengths) - lengths
        arc = abs(place[:, None] - place)
        arc = np.minimum(arc, lengths.sum() - arc)
        own = slice(begin, begin + len(place))
        least[own, own] = np.minimum(2 / np.pi * arc, 2 * radius)
        begin += len(place)
    rounding = 1e-9 * radius**2
    return bool((distance2 + rounding >= least**2).all())


def _edges(component: NDArray[np.float64]) -> NDArray[np.float64]:
    return np.roll(component, -1, axis=0) - component


def _length(curve: Curve) -> float:
    return float(sum(np.linalg.norm(_edges(component), axis=1).sum() for component in curve))
