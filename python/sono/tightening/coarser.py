"""Ropes to be delivered: of radius 1, and not much finer than was asked for."""

import math

from sono import _core
from sono.curve import Components, Measures, measure
from sono.invariants import fingerprint

FINER = 4
"""A state in which a run was stopped has at most so many times the vertices that were asked for."""

EDGE = 0.5
"""Edges of a rope of fewer vertices are at most so long, in radii."""


def unit(curve: Components) -> tuple[Components, Measures]:
    """Return a curve scaled to R_s = 1, and what it measures."""
    measures = measure(curve)
    if abs(measures.r_s - 1) < 1e-9:
        return curve, measures
    curve = [component / measures.r_s for component in curve]
    return curve, measure(curve)


def coarser(curve: Components, n: int) -> Components:
    """Return a rope, with fewer vertices where it has far more than n; the knot stays the same."""
    if sum(map(len, curve)) <= FINER * n:
        return curve
    needed = max(n, math.ceil(measure(curve).l_p / EDGE))
    if needed <= FINER * n:
        coarse = _core.refine(curve, needed)
        if fingerprint(coarse) == fingerprint(curve):
            return coarse
    return _core.simplify(curve)
