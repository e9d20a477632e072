"""What the shape of a curve is told by, besides its ropelength: descriptors. On the ground floor, by `curve`.

May import nothing of sono but the core, `curve`, `strands`, and what results have in common.
"""

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from sono import _core, strands
from sono.curve import Components, CurveLike, Floats, Measures, as_components, measure
from sono.records import Record

TOUCHING = 1 + 5e-5
"""Of 2 R_s: up to this distance vertices are in contact, as they are for `sono.forces`."""

STRAIGHT = 1e-6
"""Angle by which a curve must turn for its plane to mean anything."""

BLOCK = 1 << 22
"""Pairs of vertices that are looked at in one go."""


@dataclass(frozen=True, eq=False, repr=False)
class Descriptors(Record):
    """What tells the shape of a curve: lengths in the unit of its vertices, angles in radians.

    Of the crossings that are seen, in the mean over all directions, `writhe` is the sum of signs, +1 for a
    right-handed one, and `acn`, the average crossing number, the number; both are exact for the polygon, and
    not those of the smooth knot: the tight trefoil of 120, 240, 480, 960 vertices has acn 4.2874, 4.2842,
    4.2833, 4.2828. For a link that is of all crossings; `self_writhe` is of those of components with
    themselves, and the rest of the writhe twice the sum of the linking numbers.

    `radius_of_gyration` is the root of the mean squared distance from the centre of mass, the curve being a
    wire of even weight, and `gyration` are the eigenvalues of its gyration tensor, the largest first, whose
    sum is its square. `diameter` is the largest distance of two vertices. `total_curvature` is the sum of all
    turning angles, `total_torsion` that of the angles, pi/2 at most, between the planes of each vertex with
    its neighbours and of the next one, where the curve is not straight. `max_curvature` is 1/MinRad.
    `contacts` are the pairs of vertices that are 2 R_s apart, within 0.005 %, along no arc of their component
    shorter than pi MinRad less its longest edge.

    Of an open chain all this is of its own edges and of the vertices between them, and `contacts` is None.

    Sources: K. Klenin, J. Langowski, Biopolymers 54 (2000) 307 for the writhe of polygons; J. Milnor, Ann. of
    Math. 52 (1950) 248 for total curvature.

    >>> import sono
    >>> found = sono.descriptors([[1, 1, 0], [-1, 1, 0], [-1, -1, 0], [1, -1, 0]])
    >>> found.writhe, round(found.total_curvature / math.pi, 9), round(found.diameter**2, 9)
    (0.0, 2.0, 8.0)
    """

    writhe: float
    self_writhe: float
    acn: float
    radius_of_gyration: float
    gyration: tuple[float, float, float]
    diameter: float
    total_curvature: float
    total_torsion: float
    max_curvature: float
    contacts: int | None


def descriptors(vertices: CurveLike, closed: bool | Sequence[bool] = True) -> Descriptors:
    """Describe the shape of a curve, in a time that grows with n^2: see `sono.descriptors`.

    Its components may be open chains, all or some: `closed` says which are not.
    """
    curve = as_components(vertices)
    rings = [closed] * len(curve) if isinstance(closed, bool) else list(closed)
    if all(rings):
        measures = measure(curve)
        return _described(curve, rings, _core.writhe(curve), _pairs(curve, measures))
    for c, chain in enumerate(curve):
        steps = np.diff(chain, axis=0)
        if len(chain) < 2 or not np.isfinite(chain).all() or not steps.any(axis=1).all():
            raise ValueError(f"chain {c} needs two vertices, finite ones, and no two equal neighbours")
    return _described(curve, rings, strands.writhe(curve, rings), (_diameter(curve), None))


def _described(
    curve: Components,
    rings: Sequence[bool],
    crossed: tuple[float, float, float],
    pairs: tuple[float, int | None],
) -> Descriptors:
    own, between, crossings = crossed
    diameter, contacts = pairs
    chains = list(zip(curve, rings, strict=True))
    gyration = _gyration(chains)
    return Descriptors(
        writhe=own + between,
        self_writhe=own,
        acn=crossings,
        radius_of_gyration=math.sqrt(sum(gyration)),
        gyration=gyration,
        diameter=diameter,
        total_curvature=sum(float(_turned(*_corners(*chain)).sum()) for chain in chains),
        total_torsion=sum(_torsion(*chain) for chain in chains),
        max_curvature=max(float(_bends(*strands.corners(*chain)).max(initial=0)) for chain in chains),
        contacts=contacts,
    )


def curvature(component: Floats) -> Floats:
    """Return the curvatures (n,) at the vertices, 1/Rad: 2 tan(theta/2) over the shorter edge at a corner."""
    return _bends(*strands.corners(component, True))


def _bends(before: Floats, after: Floats) -> Floats:
    tangent = np.linalg.norm(np.cross(before, after), axis=1)
    one, other = np.linalg.norm(before, axis=1), np.linalg.norm(after, axis=1)
    # tan(theta/2) = sin theta / (1 + cos theta)
    half = tangent / (one * other + (before * after).sum(axis=1))
    curvatures: Floats = 2 * half / np.minimum(one, other)
    return curvatures


def _gyration(chains: Sequence[tuple[Floats, bool]]) -> tuple[float, float, float]:
    """Return the eigenvalues of the second moments of a wire about its centre."""
    start, end = map(np.concatenate, zip(*(strands.edges(*chain) for chain in chains), strict=True))
    weight = np.linalg.norm(end - start, axis=1)
    weight /= weight.sum()
    centre = weight @ (start + end) / 2
    middle, half = (start + end) / 2 - centre, (end - start) / 2
    moments = (weight[:, None] * middle).T @ middle + (weight[:, None] * half).T @ half / 3
    x, y, z = np.linalg.eigvalsh(moments)[::-1].clip(min=0).tolist()
    return x, y, z


def _corners(chain: Floats, closed: bool) -> tuple[Floats, Floats]:
    """Return the unit vectors of the edges before and after each vertex at which a chain turns."""
    before, after = strands.corners(chain, closed)
    return before / np.linalg.norm(before, axis=1)[:, None], after / np.linalg.norm(after, axis=1)[:, None]


def _turned(before: Floats, after: Floats) -> Floats:
    """Return the angle by which a polygon turns at each vertex."""
    sines = np.linalg.norm(np.cross(before, after), axis=1)
    angles: Floats = np.arctan2(sines, np.sum(before * after, axis=1))
    return angles


def _torsion(chain: Floats, closed: bool) -> float:
    """Return the sum of the angles between planes that follow each other."""
    corners = _corners(chain, closed)
    planes = np.cross(*corners)[_turned(*corners) > STRAIGHT]
    planes, following = strands.edges(planes, closed)
    sines = np.linalg.norm(np.cross(planes, following), axis=1)
    return float(np.arctan2(sines, np.abs(np.sum(planes * following, axis=1))).sum())


def _pairs(curve: Components, measures: Measures) -> tuple[float, int]:
    """Return the largest distance of vertices, and how many pairs are in contact."""
    largest, contacts = 0.0, 0
    for rows, apart in _squares(curve):
        largest = max(largest, float(apart.max()))
        near = np.argwhere(apart <= (2 * measures.r_s * TOUCHING) ** 2)
        pairs = np.stack([rows[near[:, 0]], near[:, 1]], axis=1)
        contacts += int(_apart(curve, pairs[pairs[:, 0] < pairs[:, 1]]).sum())
    return math.sqrt(largest), contacts


def _diameter(curve: Components) -> float:
    """Return the largest distance of vertices."""
    return math.sqrt(max(float(apart.max()) for _, apart in _squares(curve)))


def _squares(curve: Components) -> Iterator[tuple[NDArray[np.int64], Floats]]:
    """Give for some vertices after the other their squared distances from all."""
    points = np.concatenate(curve)
    points = points - points.mean(axis=0)
    squares = np.sum(points**2, axis=1)
    for rows in np.array_split(np.arange(len(points)), len(points) ** 2 // BLOCK + 1):
        yield rows, squares[rows, None] + squares - 2 * points[rows] @ points.T


def _apart(curve: Components, pairs: NDArray[np.int64]) -> NDArray[np.bool_]:
    """Tell which pairs of vertices must keep their distance: the rule of SR, as the core has it."""
    places = list(_places(curve))
    of, at, around, least = (np.concatenate(column) for column in zip(*places, strict=True))
    one, other = pairs.T
    along = np.abs(at[one] - at[other])
    far = np.minimum(along, around[one] - along) >= least[one]
    apart: NDArray[np.bool_] = far | (of[one] != of[other])
    return apart


def _places(curve: Components) -> Iterator[tuple[Floats, Floats, Floats, Floats]]:
    """For the vertices of each component: its number, where they are along it, its length, and the rule."""
    for c, component in enumerate(curve):
        start, end = strands.edges(component, True)
        edges = np.linalg.norm(end - start, axis=1)
        least = math.pi * measure([component]).min_rad - edges.max()
        at = np.cumsum(edges) - edges
        same = np.ones(len(edges))
        yield c * same, at, edges.sum() * same, least * same
