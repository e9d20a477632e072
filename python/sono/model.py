"""The paper's toroidal model: how L_p, L_c and the truth measure a bead rope wound round another one.

Beads of radius R = 1 a distance dl apart wind round a straight rope of the same kind, partly in its grooves
and partly on its hills. Their mean distance from its axis, over the hill of half-angle phi = arcsin(dl/4), is

    r = mean of 2 cos phi = dl / (2 arcsin(dl/4)).

An edge is seen from the axis at the angle alpha, sin(alpha/2) = (dl/2)/r = arcsin(dl/4), and its midpoint
lies at h = sqrt(r^2 - dl^2/4). The inscribed arc joins two midpoints; its radius dl/(2 tan(alpha/2)) is that
h, and its rope has radius R_c = sqrt(1 - dl^2/4). For one edge, in units of the radius of the rope,

    dL_p = dl,    dL_c = alpha h / R_c,    dL = 2 alpha,    a = (dL_c - dL) / (dL - dL_p),

dL being an arc of the circle of radius 2 that the axis of a smooth rope follows, and a the weight for which
(a dL_p + dL_c)/(a + 1) = dL exactly. As a -> 4 for dl -> 0, the weighted ropelength is L_a = (4 L_p + L_c)/5.

Derived again from this geometry, every formula of the paper's section holds, among them dL_p < dL < dL_c,
a = 4 + 353 dl^2/480 + O(dl^4) and a(1) = 4.940, "close to 5". Two things to know when using them. As printed,
a is a quotient of differences of order dl^3 between terms of order dl, which leaves no digit of a double at
dl = 1e-7. And 4 is the limit of a, not its average: a(1.5) = 7.30, and a grows without bound as dl -> 2,
where R_c vanishes.

>>> import sono
>>> float(round(sono.model.weight(1.0), 3))
4.94

Source: J. Baranska, P. Pieranski, E. J. Rawdon, "Ropelength of tight polygonal knots", section "The problem
of finding the right ropelength, an analytic approach".
"""

from typing import TypeVar

import numpy as np
from numpy.typing import NDArray

Lengths = TypeVar("Lengths", float, NDArray[np.float64])
"""An edge length dl, or an array of them of any shape; R = 1."""


def raw(dl: Lengths) -> Lengths:
    """Give dL_p, the raw polygonal length of an edge. Raises `ValueError` unless 0 < dl < 2."""
    return _checked(dl)


def inscribed(dl: Lengths) -> Lengths:
    """Give dL_c, the inscribed length of an edge over R_c. Raises `ValueError` unless 0 < dl < 2."""
    dl = _checked(dl)
    return true(dl) * _midpoint_distance(dl) / (2 * _r_c(dl))


def true(dl: Lengths) -> Lengths:
    """Give dL, the length of smooth rope that an edge stands for. Raises `ValueError` unless 0 < dl < 2."""
    alpha: Lengths = 2 * np.arcsin(np.arcsin(_checked(dl) / 4))
    return 2 * alpha


def average(dl: Lengths) -> Lengths:
    """Give dL_a = (4 dL_p + dL_c)/5, which is dL but for O(dl^5). Raises `ValueError` unless 0 < dl < 2."""
    return (4 * raw(dl) + inscribed(dl)) / 5


def weight(dl: Lengths) -> Lengths:
    """Give a, the weight of dL_p for which the average is exact. Raises `ValueError` unless 0 < dl < 2.

    The powers of dl that cancel are divided out by hand: with x = dl/4, u = arcsin x = p x, arcsin u = q u,

        dL_c - dL = 2 q u (h - 2 R_c)/R_c,    h^2 - 4 R_c^2 = x^2 gap,    dL - dL_p = 4 x^3 lack,

    so that no digits are lost at any dl: the relative error stays below 2e-15.
    """
    x = _checked(dl) / 4
    excess_x = _arcsin_excess(x)
    p = 1 + x**2 * excess_x
    u = p * x
    excess_u = _arcsin_excess(u)
    q = 1 + u**2 * excess_u
    gap = 12 - 4 * excess_x * (1 + p) / p**2
    lack = excess_x + p**3 * excess_u
    r_c = _r_c(dl)
    return p * q * gap / (2 * r_c * (_midpoint_distance(dl) + 2 * r_c) * lack)


def weight_series(dl: Lengths) -> Lengths:
    """Give the paper's expansion of a, 4 + 353 dl^2/480. Raises `ValueError` unless 0 < dl < 2."""
    return 4 + 353 * _checked(dl) ** 2 / 480


def _checked(dl: Lengths) -> Lengths:
    if not np.all((dl > 0) & (dl < 2)):
        raise ValueError("the edge length dl must lie between 0 and 2, in units of the radius of the rope")
    return dl


def _midpoint_distance(dl: Lengths) -> Lengths:
    """h, from the mean distance r."""
    r = dl / (2 * np.arcsin(dl / 4))
    h: Lengths = np.sqrt((r - dl / 2) * (r + dl / 2))
    return h


def _r_c(dl: Lengths) -> Lengths:
    """R_c, factored to keep its digits near dl = 2."""
    r_c: Lengths = np.sqrt((2 - dl) * (2 + dl)) / 2
    return r_c


def _arcsin_excess(x: Lengths) -> Lengths:
    """(arcsin x - x)/x^3 by its power series; 30 terms are exact to a double up to x = arcsin(1/2)."""
    total = 0 * x
    for k in range(30, 0, -1):
        total = (1 + x**2 * total) * ((2 * k - 1) ** 2 / (2 * k * (2 * k + 1)))
    return total
