"""Curves given as Fourier series: X(t) = sum over j of A_j cos(jt) + B_j sin(jt)."""

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from sono._core import CurveError
from sono.curve import measure

Floats = NDArray[np.float64]

Series = tuple[Floats, Floats]
"""The coefficients A and B, each (m, 3), of the harmonics 0 to m - 1."""

LEAST, MOST = 512, 1 << 15
"""Vertices of a component."""

SURE = 4
"""The curve is nowhere farther from the polygon than the polygon's rope radius over this."""


@np.errstate(all="ignore")  # what is not finite is refused
def sampled(series: Sequence[Series]) -> list[Floats]:
    """Give a polygon for every component, (n, 3), all together of the type that the curves have.

    The number of vertices is doubled until no edge is farther from its arc than a quarter of the radius of
    the polygon's rope, nor turned away from it by more than a third of a right angle: then the arcs can be
    straightened inside of the rope. Raises `ValueError` if that takes too many vertices, or numbers are not
    finite.
    """
    bends = [_bend(*one) for one in series]
    n = LEAST
    while n <= MOST and np.isfinite(bends).all():
        curves = [_points(*one, n) for one in series]
        step = 2 * np.pi / n
        slack = [bend * step**2 for bend in bends]
        edges = [np.linalg.norm(np.roll(x, -1, axis=0) - x, axis=1).min() for x in curves]
        straight = all(2 * far < edge for far, edge in zip(slack, edges, strict=True))
        if straight and SURE * max(slack) / 8 <= _radius(curves):
            return curves
        n *= 2
    raise ValueError("the curve meets itself, or nearly, so that no polygon is surely of its type")


def _bend(a: Floats, b: Floats) -> float:
    """Give a bound on the second derivative; an edge is an eighth of it, times dt squared, from its arc."""
    j = np.arange(len(a))
    return float((j**2 * np.sqrt((a**2 + b**2).sum(axis=1))).sum())


def _points(a: Floats, b: Floats, n: int) -> Floats:
    waves = np.zeros((n, 3), complex)
    np.add.at(waves, np.arange(len(a)) % n, a - 1j * b)  # at n points, the harmonics j and j - n are one
    return np.asarray(n * np.fft.ifft(waves, axis=0).real)


def _radius(curves: Sequence[Floats]) -> float:
    try:
        return measure(curves).r_s
    except CurveError:  # it meets itself
        return 0.0
