"""A small drawing of a rope: paths of SVG in which the strand that is nearer to the eye lies over the others.

The rope is cut into short pieces. Each lies one layer above all that it covers, and what follows each other
along the rope in one layer is one line. So a drawing has as many layers as strands lie on each other, some
four in a tight knot, and takes about 1 kB.
"""

from collections.abc import Iterator
from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from sono.curve import Components, Curve, CurveLike, Floats, measure
from sono.figures.turning import principal

SIZE = 128
"""The width and height of the drawing's grid, whose points are whole numbers."""

THINNEST = 1 / 40
"""The radius of the rope in shares of the drawing, at least."""

EDGE = 1.5
"""How far a line's dark edge goes beyond it, in points of the grid."""

PIECE = 0.4
"""The length of a piece in radii."""

MOST = 500
"""Pieces at most; those of longer ropes are longer."""

BEND = 2.5
"""Radii along the rope within which it does not lie on itself."""

UNDER = 4
"""Pieces that a line goes on under what lies over it."""

COVERS = 1.9
"""Radii within which the axes of strands are seen that lie on each other, not side by side."""


@dataclass(frozen=True)
class Drawing:
    """Lines of a `width`, by layers, the lowest first: of each component in it the number and the path.

    A layer has first all its lines on dark edges, which are EDGE wider on either side and end where the lines
    do, then all its lines in the colours of their components, with round ends.
    """

    width: float
    layers: list[list[tuple[int, str]]]


@dataclass(frozen=True)
class _Pieces:
    """Where pieces begin: (m, 3) in the grid, x, y down and z to the eye; how far along which component."""

    points: Floats
    along: Floats
    lengths: Floats
    component: NDArray[np.int64]


def drawing(rope: CurveLike) -> Drawing:
    """Return a drawing of a rope, of any scale, that shows its widest side.

    Raises `CurveError` for a curve that is not embedded.

    >>> import sono
    >>> hopf = drawing(sono.start("Hopf", known=True))
    >>> len(hopf.layers) > 1, {component for layer in hopf.layers for component, _ in layer}
    (True, {0, 1})
    """
    curve = Curve(rope)
    r_s = measure(curve).r_s
    pieces, radius = _seen([component / r_s for component in curve])
    layer = _layers(pieces, radius)
    numbers = range(int(layer.max()) + 1)
    return Drawing(round(2 * radius - EDGE, 1), [list(_lines(pieces, layer, number)) for number in numbers])


def _seen(rope: Components) -> tuple[_Pieces, float]:
    """Return the pieces of a rope of radius 1, and the radius that they are drawn with, in the grid."""
    every = np.concatenate(rope)
    frame = principal(every)
    box = np.array([(every @ frame.T).min(axis=0), (every @ frame.T).max(axis=0)])
    wide = float(np.ptp(box, axis=0)[:2].max())
    radius = max(1.0, THINNEST * wide)
    scale = (SIZE - 2 * EDGE) / (wide + 2 * radius)
    length = sum(float(_edges(component).sum()) for component in rope)
    cut = [_cut((part - box.mean(axis=0) @ frame) @ frame.T, max(PIECE, length / MOST)) for part in rope]
    points = np.concatenate([points for points, _, _ in cut]) * scale * [1, -1, 1] + [SIZE / 2, SIZE / 2, 0]
    along, lengths = (np.concatenate([part[k] for part in cut]) * scale for k in (1, 2))
    component = np.repeat(np.arange(len(cut)), [len(points) for points, _, _ in cut])
    return _Pieces(points, along, lengths, component), radius * scale


def _cut(component: Floats, piece: float) -> tuple[Floats, Floats, Floats]:
    """Return points evenly along a component, how far along each is, and the component's length, for each."""
    along = np.concatenate([[0.0], np.cumsum(_edges(component))])
    at = np.linspace(0, along[-1], max(8, round(along[-1] / piece)), endpoint=False)
    closed = np.vstack([component, component[:1]])
    points = np.column_stack([np.interp(at, along, closed[:, k]) for k in range(3)])
    return points, at, np.full(len(at), along[-1])


def _edges(component: Floats) -> Floats:
    return np.asarray(np.linalg.norm(np.roll(component, -1, axis=0) - component, axis=1))


def _layers(pieces: _Pieces, radius: float) -> NDArray[np.int64]:
    """Return the layer (m,) of each piece: one above the layers of all that it covers."""
    middle = (pieces.points + _next(pieces)) / 2
    layer = np.zeros(len(middle), np.int64)
    below = np.zeros(len(middle), bool)
    for k in np.argsort(middle[:, 2]):
        near = np.hypot(*(middle[:, :2] - middle[k, :2]).T) < COVERS * radius
        apart = abs(pieces.along - pieces.along[k])
        apart = np.minimum(apart, pieces.lengths - apart)
        others = (pieces.component != pieces.component[k]) | (apart > BEND * radius)
        layer[k] = (layer[near & others & below] + 1).max(initial=0)
        below[k] = True
    return layer


def _next(pieces: _Pieces) -> Floats:
    """Return where each piece ends."""
    parts = np.split(pieces.points, np.flatnonzero(np.diff(pieces.component)) + 1)
    return np.concatenate([np.roll(part, -1, axis=0) for part in parts])


def _lines(pieces: _Pieces, layer: NDArray[np.int64], number: int) -> Iterator[tuple[int, str]]:
    """Give each component that has pieces of a layer, and the path of these."""
    for c in range(pieces.component[-1] + 1):
        mine = pieces.component == c
        points, there = np.rint(pieces.points[mine, :2]).astype(int), layer[mine] == number
        if there.any():
            runs = list(_runs(_under(there, layer[mine] > number)))
            yield c, "".join(_path(points[run % len(points)]) for run in runs) or _path(points) + "z"


def _under(there: NDArray[np.bool_], higher: NDArray[np.bool_]) -> NDArray[np.bool_]:
    """Go on a little under what is higher, so that no dark edge ends in sight."""
    for _ in range(UNDER):
        there = there | (higher & (np.roll(there, 1) | np.roll(there, -1)))
    return there


def _runs(there: NDArray[np.bool_]) -> Iterator[NDArray[np.int64]]:
    """Give the points of each run of pieces that are `there`, if not all are."""
    begins = np.flatnonzero(there & ~np.roll(there, 1))
    ends = np.flatnonzero(~there & np.roll(there, 1))
    for begin in begins:
        later = ends[ends > begin]
        yield np.arange(begin, (later[0] if len(later) else ends[0] + len(there)) + 1)


def _path(points: NDArray[np.int64]) -> str:
    """Return a line through points, each relative to the one before it."""
    steps = [(x, y) for x, y in (b - a for a, b in pairwise(points)) if x or y] or [(0, 0)]
    return f"M{points[0][0]} {points[0][1]}l" + " ".join(f"{x} {y}" for x, y in steps).replace(" -", "-")
