"""Torus knots and links beyond the table: their diagrams, and what is known of their types.

>>> name(3, 7), name(15, -2), is_tabled(2, 13), is_tabled(3, 4), is_tabled(2, 10)
('T(3,7)', 'mT(2,15)', True, True, False)
>>> determinant(3, 4), determinant(2, 6), signature(2, 3), signature(2, -4)
(3, 6, -2, 3)
"""

import math

import numpy as np

from sono.curve import Components, Floats, measure
from sono.invariants.braids import torus_type
from sono.invariants.crossings import TooEntangledError, crossings, diagram
from sono.invariants.diagrams import Gauss, gauss_code, shortened
from sono.naming.known import MOST_OF_KNOTS, MOST_OF_LINKS

MOST_SEEN = 10_000
"""Crossings of a view along its axis up to which a rope is looked at for a closed braid."""

ASIDE = 0.01 * np.array([0.31, 0.47, 0.83])
"""By how much a view is turned from the axis, along which symmetric ropes have vertices behind each other."""


ROUNDING = 1e-12
"""Thickness over the size of a curve, below which turning it might let strands pass."""


def name(p: int, q: int) -> str:
    """Return the name of a torus type; m is the mirror image."""
    least, most = sorted((abs(p), abs(q)))
    return f"{'m' * (p * q < 0)}T({least},{most})"


def is_tabled(p: int, q: int) -> bool:
    """Tell whether the table has a torus type, by its crossing number (K. Murasugi, 1991)."""
    p, q = abs(p), abs(q)
    return min(p * (q - 1), q * (p - 1)) <= (MOST_OF_KNOTS if math.gcd(p, q) == 1 else MOST_OF_LINKS)


def shown(curve: Components) -> Gauss:
    """Return the diagram of a curve, simplified by exact isotopies.

    Where that has too many crossings, a closed braid of a torus link is taken as it is seen along its axis.
    Raises `TooEntangledError` for another curve, and `CurveError` for one that crosses itself.
    """
    try:
        return shortened(gauss_code(diagram(curve)))
    except TooEntangledError:
        if measure(curve).r_s < ROUNDING * abs(np.vstack(curve)).max():
            raise
        seen = gauss_code(crossings(curve, _axis(curve), MOST_SEEN))
        if len(seen[1]) > MOST_SEEN:
            raise
        for gauss in (seen, shortened(seen)):
            if torus_type(gauss):
                return gauss
        raise


def _axis(curve: Components) -> Floats:
    """Return about the direction (3,) round which a curve goes, that of the area inside it."""
    area = sum(np.cross(component, np.roll(component, -1, axis=0)).sum(axis=0) for component in curve)
    axis: Floats = area / np.linalg.norm(area) + ASIDE
    return axis


def determinant(p: int, q: int) -> int:
    """Return the determinant of T(p,q).

    It is |f(-1)| for f(t) = (1 - t) (1 - t^(pq/g))^g / ((1 - t^p) (1 - t^q)) and g = gcd(p, q), the Alexander
    polynomial of a single variable; 1 - t^m is 2 there for an odd m, and about m (1 + t) for an even one.
    """
    p, q = abs(p), abs(q)
    components = math.gcd(p, q)
    above, below = components * [p * q // components], [p, q]
    even = [sum(m % 2 == 0 for m in factors) for factors in (above, below)]
    if even[0] > even[1]:
        return 0
    one, other = (math.prod(2 if m % 2 else m for m in factors) for factors in (above, below))
    return 2 * one // other


def signature(p: int, q: int) -> int:
    """Return the signature of T(p,q), by E. Brieskorn's count of i/p + j/q."""
    right = 1 if p * q > 0 else -1
    p, q = abs(p), abs(q)
    i, j = np.mgrid[1:p, 1:q]
    place = 2 * (i * q + j * p)
    inside = (place > p * q) & (place < 3 * p * q)
    outside = (place < p * q) | (place > 3 * p * q)
    return right * int(outside.sum() - inside.sum())
