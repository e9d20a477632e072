"""Knot invariants of polygons: what tells whether two curves have the same knot type.

A curve is one (n_i, 3) array a component. `fingerprint` is what a search checks each trial with; `homfly` is
sharper and needs the extra sono[identify]. The single invariants take a projection:
`alexander(diagram(curve), -1)`.
"""

import cmath
import math
import sys
from dataclasses import dataclass
from typing import TypeAlias

import numpy as np
from numpy.typing import NDArray

from sono import _core

Floats: TypeAlias = NDArray[np.float64]
Ints: TypeAlias = NDArray[np.int64]
Curve: TypeAlias = list[Floats]
Fingerprint: TypeAlias = tuple[tuple[int, ...], tuple[int, ...], tuple[int, ...]]

ORDERS = (2, 3, 5)
"""Orders of the roots of unity at which a fingerprint has signatures and Alexander polynomials."""

PRIME, GENERATOR = 2_147_482_951, 6
"""The modulus of `_core.determinant`, and a generator of its multiplicative group."""

MOST_CROSSINGS = 1000
"""Crossings up to which a projection is taken; signatures of more would take seconds."""


@dataclass(frozen=True)
class Crossings:
    """The crossings of a projection.

    `over` and `under` (m,) are places on the curve, counted in edges from the first vertex of the first
    component; `sign` (m,) is +1 where the crossing is right-handed; component c owns the places bounds[c] to
    bounds[c + 1].
    """

    over: Floats
    under: Floats
    sign: Ints
    bounds: Ints

    def component(self, place: Floats) -> Ints:
        """Return the component that each place belongs to."""
        return np.searchsorted(self.bounds, place, side="right") - 1


def fingerprint(curve: Curve) -> Fingerprint:
    """Return the linking numbers of all pairs, signatures, and Alexander polynomials modulo a prime.

    The signatures are those at exp(2 pi i/k), k = 2, 3, 5. The polynomial, at a root t of unity of the same
    orders modulo `PRIME`, is known up to a factor of plus or minus a power of t, which the power 2 k removes.
    Curves of one type, with their components in one order, have equal fingerprints, however thin they are.
    Few passages of strands leave it as it was, but 66 of the 249 knots to 10 crossings share theirs with
    others; see `homfly`. Raises `TooEntangledError`, and `CurveError` for a curve that crosses itself.
    """
    found = diagram(curve)
    linking = linking_matrix(found)[np.triu_indices(len(curve), 1)].tolist()
    signatures = tuple(signature(found, cmath.exp(2j * math.pi / k)) for k in ORDERS)
    return tuple(linking), signatures, tuple(alexander_modulo(found, k) for k in ORDERS)


def homfly(curve: Curve) -> str:
    """Return the HOMFLY polynomial in Regina's variables alpha and z. Raises ImportError without regina."""
    import regina

    found = diagram(curve)
    link = regina.Link.fromPD(planar_diagram(found))
    link.insertLink(regina.Link(len(curve) - link.countComponents()))  # circles without crossings
    return str(link.homflyAZ())


def planar_diagram(found: Crossings) -> list[tuple[int, int, int, int]]:
    """Return the PD code: for each crossing its four edges, counter-clockwise from the incoming lower one.

    Edges are numbered from 1 along the components, in order. A component without crossings leaves no trace.
    """
    place = np.concatenate([found.under, found.over])
    order = np.argsort(place)
    leaving = np.argsort(order)
    entering = _entered(found, place[order])[leaving]
    (under_in, over_in), (under_out, over_out) = np.split(entering + 1, 2), np.split(leaving + 1, 2)
    right = found.sign > 0
    second, fourth = np.where(right, over_out, over_in), np.where(right, over_in, over_out)
    codes = np.stack([under_in, second, under_out, fourth], axis=1).tolist()
    return [(a, b, c, d) for a, b, c, d in codes]


class TooEntangledError(ValueError):
    """A curve whose projection has so many crossings that its invariants would take ages."""


def diagram(curve: Curve) -> Crossings:
    """Return a projection of `curve`, simplified by exact isotopies. Raises `TooEntangledError`."""
    simple = _core.simplify(curve)
    # Turning the axes is exact.
    turned = ([np.roll(component, turn, axis=1) for component in simple] for turn in range(3))
    found = min((_seen(curve, MOST_CROSSINGS) for curve in turned), key=lambda found: len(found.sign))
    if len(found.sign) > MOST_CROSSINGS:
        raise TooEntangledError(f"the curve has over {MOST_CROSSINGS} crossings: its type cannot be told")
    return found


def linking_matrix(found: Crossings) -> Ints:
    """Return the (k, k) linking numbers of the k components, with a diagonal of zeros."""
    count = len(found.bounds) - 1
    twice = np.zeros((count, count), np.int64)
    np.add.at(twice, (found.component(found.over), found.component(found.under)), found.sign)
    twice += twice.T
    np.fill_diagonal(twice, 0)
    assert (twice % 2 == 0).all(), "two closed curves cross an even number of times"
    return twice // 2


def alexander(found: Crossings, t: complex) -> float:
    """Return |Delta(t)| for |t| = 1: the Alexander polynomial, for links the one of a single variable.

    At t = -1 it is the determinant of the knot; it is 0 for split links.
    """
    fox = _fox(found)
    if fox is None:
        return 0.0
    count, rows, columns, values = fox
    matrix = np.zeros((count, count), complex)
    np.add.at(matrix, (rows, columns), values @ [1, t])
    return float(abs(np.linalg.det(matrix)))


def alexander_modulo(found: Crossings, k: int) -> int:
    """Return Delta(t)^2k for a root t of unity of order k modulo `PRIME`."""
    fox = _fox(found)
    if fox is None:
        return 0
    count, rows, columns, values = fox
    t = pow(GENERATOR, (PRIME - 1) // k, PRIME)
    entries = zip(rows.tolist(), columns.tolist(), (values @ [1, t] % PRIME).tolist(), strict=True)
    return pow(_core.determinant(count, list(entries)), 2 * k, PRIME)


def _fox(found: Crossings) -> tuple[int, Ints, Ints, Ints] | None:
    """Return a minor of the Fox matrix of the Wirtinger presentation, if it is not 0: its size and entries.

    An entry has a row, a column and a value a + b t, as (a, b). Source: R. Crowell and R. Fox, Introduction
    to Knot Theory, 1963.
    """
    unders = np.sort(found.under)
    first = np.searchsorted(unders, found.bounds)
    # Each component is cut where it passes under; one that never does is a single arc.
    arcs = np.maximum(np.diff(first), 1)
    if arcs.sum() > max(1, len(unders)):
        return None

    def arc(place: Floats, passed: int) -> Ints:
        component = found.component(place)
        rank = np.searchsorted(unders, place) - first[component] + passed
        numbered: Ints = np.cumsum(arcs)[component] - arcs[component] + rank % arcs[component]
        return numbered

    rows = np.tile(np.arange(len(unders)), 3)
    columns = np.concatenate([arc(found.over, 0), arc(found.under, 0), arc(found.under, 1)])
    # 1 - t, t and -1 at a right-handed crossing, t - 1, 1 and -t at a left-handed one.
    sign, right = found.sign, found.sign > 0
    ones = np.concatenate([sign, np.where(right, 0, 1), np.where(right, -1, 0)])
    ts = np.concatenate([-sign, np.where(right, 1, 0), np.where(right, 0, -1)])
    kept = (rows > 0) & (columns > 0)
    values = np.column_stack([ones, ts])[kept]
    return max(len(unders) - 1, 0), rows[kept] - 1, columns[kept] - 1, values


def signature(found: Crossings, t: complex) -> int:
    """Return the Levine-Tristram signature for |t| = 1; at -1 it is -2 for the right-handed trefoil.

    A mirror changes its sign. It comes from the faces of the projection: R. Kashaev, arXiv:1801.04632, proved
    by J. Liu, arXiv:2311.01923.
    """
    faces = _faces(found)
    x, y = math.sqrt((1 + t.real) / 2), t.real
    corner = np.array([[y, x, 1, x], [x, 1, x, 1], [1, x, y, x], [x, 1, x, 1]])
    form = np.zeros(2 * [faces.max(initial=-1) + 1])
    np.add.at(form, (faces[:, None], faces[None]), corner[:, :, None] * found.sign)
    values = np.linalg.eigvalsh(form)
    return int(np.sign(values[abs(values) > 1e-9]).sum() - found.sign.sum()) // 2


def _faces(found: Crossings) -> Ints:
    """Return the faces (4, m), numbered from 0, round each crossing, first that between the incoming strands.

    Pieces of a split projection keep their faces apart.
    """
    place = np.concatenate([found.under, found.over])
    order = np.argsort(place)
    rank = np.argsort(order)
    entering = _entered(found, place[order])
    under_out, over_out = np.split(rank, 2)
    under_in, over_in = entering[under_out], entering[over_out]
    # An edge has two sides. A corner joins the sides of two; what is joined all the way round is a face.
    left = np.where(found.sign > 0, 0, 1)
    right = 1 - left
    one = 2 * np.stack([under_in, under_in, under_out, under_out]) + np.stack([left, right, right, left])
    two = 2 * np.stack([over_in, over_out, over_out, over_in]) + np.stack([right, right, left, left])
    face = np.arange(2 * len(place))
    while (face[one] != face[two]).any():
        low = np.minimum(face[one], face[two])
        np.minimum.at(face, one, low)
        np.minimum.at(face, two, low)
    return np.unique(face[one], return_inverse=True)[1].reshape(one.shape)


def _entered(found: Crossings, places: Floats) -> Ints:
    """Return, for each of the sorted places, the edge that enters it: an edge has the rank it leaves."""
    component = found.component(places)
    first, last = (np.searchsorted(component, component, side) for side in ("left", "right"))
    entering = np.arange(len(places)) - 1
    return np.where(entering < first, last - 1, entering)


def crossings(curve: Curve, direction: Floats | None = None) -> Crossings:
    """Return the crossings seen along the z axis, or from where `direction` (3,) points to.

    No two vertices may be seen in one place.
    """
    if direction is None:
        return _seen(curve)
    up = direction / np.linalg.norm(direction)
    across = np.cross(up, [1.0, 2.0, 3.0])
    across /= np.linalg.norm(across)
    turn = np.column_stack([across, np.cross(up, across), up])
    return _seen([component @ turn for component in curve])


def _seen(curve: Curve, most: int = sys.maxsize) -> Crossings:
    over, under, right = _core.crossings(curve, most)
    return Crossings(over, under, np.where(right, 1, -1), _bounds(curve))


def simplify(curve: Curve) -> Curve:
    """Remove every vertex whose triangle with its two neighbours no other edge meets (the KMT reduction).

    Each removal is an isotopy, decided exactly, so that strands may be as close as rounding lets them be;
    in the result they may all but touch. Raises `CurveError` for a curve that crosses itself. Source:
    K. Koniaris and M. Muthukumar, Phys. Rev. Lett. 66 (1991) 2211.
    """
    return _core.simplify(curve)


def _bounds(curve: Curve) -> Ints:
    return np.cumsum([0] + [len(component) for component in curve])
