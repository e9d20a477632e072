"""Projections: the crossings of a curve as it is seen from somewhere, after exact isotopies."""

import sys
from dataclasses import dataclass
from typing import TypeAlias

import numpy as np
from numpy.typing import NDArray

from sono import _core
from sono.curve import Components, Floats

Ints: TypeAlias = NDArray[np.int64]

MOST_CROSSINGS = 1000
"""Crossings up to which a projection is taken; signatures of more would take seconds."""


class TooEntangledError(ValueError):
    """A curve whose projection has so many crossings that its invariants would take ages."""


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


def diagram(curve: Components) -> Crossings:
    """Return a projection of `curve`, simplified by exact isotopies. Raises `TooEntangledError`."""
    simple = _core.simplify(curve)
    # Turning the axes is exact.
    turned = ([np.roll(component, turn, axis=1) for component in simple] for turn in range(3))
    found = min((_seen(curve, MOST_CROSSINGS) for curve in turned), key=lambda found: len(found.sign))
    if len(found.sign) > MOST_CROSSINGS:
        raise TooEntangledError(f"the curve has over {MOST_CROSSINGS} crossings: its type cannot be told")
    return found


def crossings(curve: Components, direction: Floats | None = None, most: int = sys.maxsize) -> Crossings:
    """Return the crossings seen along the z axis, or from where `direction` (3,) points to.

    No two vertices may be seen in one place. Of more than `most` crossings, only some are found.
    """
    if direction is None:
        return _seen(curve, most)
    up = direction / np.linalg.norm(direction)
    across = np.cross(up, [1.0, 2.0, 3.0])
    across /= np.linalg.norm(across)
    turn = np.column_stack([across, np.cross(up, across), up])
    return _seen([component @ turn for component in curve], most)


def simplify(curve: Components) -> Components:
    """Remove every vertex whose triangle with its two neighbours no other edge meets (the KMT reduction).

    Each removal is an isotopy, decided exactly, so that strands may be as close as rounding lets them be;
    in the result they may all but touch. Raises `CurveError` for a curve that crosses itself. Source:
    K. Koniaris and M. Muthukumar, Phys. Rev. Lett. 66 (1991) 2211.
    """
    return _core.simplify(curve)


def linking_matrix(found: Crossings) -> Ints:
    """Return the (k, k) linking numbers of the k components, with a diagonal of zeros."""
    count = len(found.bounds) - 1
    twice = np.zeros((count, count), np.int64)
    np.add.at(twice, (found.component(found.over), found.component(found.under)), found.sign)
    twice += twice.T
    np.fill_diagonal(twice, 0)
    assert (twice % 2 == 0).all(), "two closed curves cross an even number of times"
    return twice // 2


def linking_numbers(found: Crossings) -> tuple[int, ...]:
    """Return the linking numbers of all pairs of components."""
    matrix = linking_matrix(found)
    return tuple(matrix[np.triu_indices(len(matrix), 1)].tolist())


def planar_diagram(found: Crossings) -> list[tuple[int, int, int, int]]:
    """Return the PD code: for each crossing its four edges, counter-clockwise from the incoming lower one.

    Edges are numbered from 1 along the components, in order. A component without crossings leaves no trace.
    """
    place = np.concatenate([found.under, found.over])
    order = np.argsort(place)
    leaving = np.argsort(order)
    entering = entered(found, place[order])[leaving]
    (under_in, over_in), (under_out, over_out) = np.split(entering + 1, 2), np.split(leaving + 1, 2)
    right = found.sign > 0
    second, fourth = np.where(right, over_out, over_in), np.where(right, over_in, over_out)
    codes = np.stack([under_in, second, under_out, fourth], axis=1).tolist()
    return [(a, b, c, d) for a, b, c, d in codes]


def entered(found: Crossings, places: Floats) -> Ints:
    """Return, for each of the sorted places, the edge that enters it: an edge has the rank it leaves."""
    component = found.component(places)
    first, last = (np.searchsorted(component, component, side) for side in ("left", "right"))
    entering = np.arange(len(places)) - 1
    return np.where(entering < first, last - 1, entering)


def _seen(curve: Components, most: int) -> Crossings:
    over, under, right = _core.crossings(curve, most)
    return Crossings(over, under, np.where(right, 1, -1), _bounds(curve))


def _bounds(curve: Components) -> Ints:
    return np.cumsum([0] + [len(component) for component in curve])
