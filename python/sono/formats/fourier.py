"""Curves given as Fourier series: X(t) = sum over j of A_j cos(jt) + B_j sin(jt)."""

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from sono.formats.sampling import Drawing, sampled

Floats = NDArray[np.float64]

Series = tuple[Floats, Floats]
"""The coefficients A and B, each (m, 3), of the harmonics 0 to m - 1."""

POINTS = [512 << doublings for doublings in range(7)]
"""How many points of a component are tried, one after the other."""


def polygons(series: Sequence[Series]) -> list[Floats]:
    """Give a polygon for every component, (n, 3), all together of the type that the curves have.

    Raises `ValueError` if the curve meets itself, or nearly.
    """
    bends = [_bend(*one) for one in series]

    def draw(n: int) -> Drawing:
        # Along an edge dt, X' changes by bend dt at most, and X comes an eighth of bend dt dt from the edge.
        curves, dt = [_points(*one, n) for one in series], 2 * np.pi / n
        speeds = [np.linalg.norm(np.roll(x, -1, axis=0) - x, axis=1).min() / dt for x in curves]
        turns = [bend * dt / speed for bend, speed in zip(bends, speeds, strict=True)]
        return curves, max(bends) * dt**2 / 8, np.arcsin(max(turns))

    return sampled(draw, POINTS)


@np.errstate(all="ignore")
def _bend(a: Floats, b: Floats) -> float:
    """Give a bound on the second derivative of the curve."""
    j = np.arange(len(a))
    return float((j**2 * np.sqrt((a**2 + b**2).sum(axis=1))).sum())


def _points(a: Floats, b: Floats, n: int) -> Floats:
    waves = np.zeros((n, 3), complex)
    np.add.at(waves, np.arange(len(a)) % n, a - 1j * b)  # at n points, the harmonics j and j - n are one
    return np.asarray(n * np.fft.ifft(waves, axis=0).real)
