"""Tubes round closed curves, as triangles.

A ring of vertices lies in the plane that halves the bend at each vertex of the line. From ring to ring its
first vertex is carried by the least rotation (R. L. Bishop, "There is more than one way to frame a curve",
Amer. Math. Monthly 82, 1975). What it has turned by when it is back, the holonomy, is spread evenly, so that
the last ring meets the first.

Each triangle lies between two such planes, inside the cylinder of the tube's radius round an edge. A tube is
therefore embedded where the planes of neighbours meet no nearer than its radius, and edges that are no
neighbours are two radii apart: where the radius is at most the line's R_c (see `sono.curve.Measures`).
"""

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from sono import _core
from sono.curve import CurveLike, Floats, as_components, measure

SHARE = 0.48
"""Of the tolerance, for the facets round the tube and for those along it; the rest is for tilted rings."""

LONGEST_EDGE = 0.5
"""Of the line, over the least radius of its bends."""


class Mesh(NamedTuple):
    """Triangles `faces` (m, 3) of `vertices` (k, 3), counterclockwise as seen from outside."""

    vertices: Floats
    faces: NDArray[np.int64]


def tube(line: Floats, radius: float, sides: int) -> Mesh:
    """Return the tube round a closed polygon (n, 3): n rings of so many vertices, `2 * n * sides` triangles.

    Vertex j of ring i is number `i * sides + j`. Nothing is checked: see the module for where it is embedded.

    >>> angles = np.linspace(0, math.tau, 40, endpoint=False)
    >>> ring = tube(np.stack([3 * np.cos(angles), 3 * np.sin(angles), 0 * angles], axis=1), 1, 12)
    >>> ring.vertices.shape, ring.faces.shape
    ((480, 3), (960, 3))
    """
    _, normals, binormals = frames(line)
    angles = np.linspace(0, math.tau, sides, endpoint=False)[:, None]
    ring = np.cos(angles) * normals[:, None] + np.sin(angles) * binormals[:, None]
    vertices = np.asarray(line)[:, None] + radius * ring
    return Mesh(vertices.reshape(-1, 3), _faces(len(line), sides))


def frames(line: Floats) -> tuple[Floats, Floats, Floats]:
    """Return unit tangents, normals and binormals (n, 3) of a closed polygon (n, 3), right-handed.

    A tangent halves the angle of two edges. The normals turn about the line evenly, by at most pi in all.
    """
    edges = _unit(np.roll(line, -1, axis=0) - line)
    tangents = _unit(edges + np.roll(edges, 1, axis=0))
    least = np.argmin(np.abs(tangents), axis=1)
    first = _unit(np.cross(tangents, np.eye(3)[least]))
    second = np.cross(tangents, first)
    turned = _turned(tangents, first, second)
    angles = np.cumsum(turned) - turned
    holonomy = math.remainder(turned.sum(), math.tau)
    angles = (angles - holonomy * np.arange(len(angles)) / len(angles))[:, None]
    normals = np.cos(angles) * first + np.sin(angles) * second
    return tangents, normals, np.cross(tangents, normals)


def _turned(tangents: Floats, first: Floats, second: Floats) -> Floats:
    """Return by what angle each frame, carried to the next tangent by the least rotation, is turned there."""
    onward = np.roll(tangents, -1, axis=0)
    lean = np.sum(onward * first, axis=1) / (1 + np.sum(onward * tangents, axis=1))
    carried = first - lean[:, None] * (tangents + onward)
    along = np.sum(carried * np.roll(first, -1, axis=0), axis=1)
    across = np.sum(carried * np.roll(second, -1, axis=0), axis=1)
    angles: Floats = np.arctan2(across, along)
    return angles


def _unit(vectors: Floats) -> Floats:
    units: Floats = vectors / np.linalg.norm(vectors, axis=1)[:, None]
    return units


def _faces(rings: int, sides: int) -> NDArray[np.int64]:
    """Return two triangles for each quadrangle between two rings."""
    here = np.arange(rings * sides).reshape(rings, sides)
    there = np.roll(here, -1, axis=0)
    beside, across = np.roll(here, -1, axis=1), np.roll(there, -1, axis=1)
    quadrangles = np.stack([here, beside, across, here, across, there], axis=-1)
    return quadrangles.reshape(-1, 3)


def tubes(curve: CurveLike, radius: float, tolerance: float) -> list[Mesh]:
    """Return tubes round the inscribed knot K_P of a curve, one for each component.

    No point of a facet is further than `tolerance`, in the unit of the curve, from the smooth tube. The curve
    must have an R_c, and the radius be at most that. Raises `CurveError` for a curve that is not embedded,
    `ValueError` for a radius or a tolerance that is not positive.

    >>> import sono
    >>> len(tubes(sono.start("Hopf", known=True), radius=0.9, tolerance=0.01))
    2
    """
    components = as_components(curve)
    line = _core.refine(components, vertices_within(components, radius, tolerance))
    return [tube(component, radius, sides_within(radius, tolerance)) for component in line]


def vertices_within(curve: CurveLike, radius: float, tolerance: float) -> int:
    """Return how many vertices the lines of `tubes` need in all for facets that are near enough."""
    measures = measure(curve)
    longest = spacing_within(radius, max(measures.min_rad, radius), tolerance)
    return max(math.ceil(measures.inscribed_length / longest), 12 * measures.components)


def sides_within(radius: float, tolerance: float) -> int:
    """Return how many vertices a ring has, 8 at least, so that chords are near enough to the circle."""
    _check(radius, tolerance)
    return max(8, math.ceil(math.pi / math.acos(1 - min(SHARE * tolerance / radius, 0.5))))


def spacing_within(radius: float, bend: float, tolerance: float) -> float:
    """Return how far rings may be apart on a line that bends by radii of at least `bend`.

    The outermost fibre of a tube on a bend of radius b bulges by (b + radius) h^2 / (8 b^2) over its chord.
    """
    _check(radius, tolerance)
    return min(bend * math.sqrt(8 * SHARE * tolerance / (bend + radius)), LONGEST_EDGE * bend)


def _check(radius: float, tolerance: float) -> None:
    if not (0 < radius < math.inf and 0 < tolerance < math.inf):
        raise ValueError(f"radius {radius} and tolerance {tolerance} must be positive numbers")
