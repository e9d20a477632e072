"""Alexander polynomials from a projection, at a complex number or modulo a prime."""

import numpy as np

from sono import _core
from sono.curve import Floats
from sono.invariants.crossings import Crossings, Ints

PRIME, GENERATOR = 2_147_482_951, 6
"""The modulus of `_core.determinant`, and a generator of its multiplicative group."""


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
