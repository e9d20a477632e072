"""Diagrams as Gauss codes: simplified, taken apart into prime links, and their HOMFLY polynomials.

>>> from sono.curve import Curve
>>> trefoil = ([[-1, 2, -3, 1, -2, 3]], [True, True, True])
>>> homfly_polynomial(trefoil)
{(-4, 0): -1, (-2, 0): 2, (-2, 2): 1}
"""

from itertools import pairwise
from typing import TypeAlias

import numpy as np

from sono import _core
from sono.invariants.crossings import Crossings

Gauss: TypeAlias = tuple[list[list[int]], list[bool]]
"""A diagram: for each component the crossings that it passes, from 1, negative where it does so below, and
for each crossing whether it is right-handed."""

Polynomial: TypeAlias = dict[tuple[int, int], int]
"""Coefficients by the powers of alpha and z."""

MOST_DIAGRAMS = 20_000
"""Diagrams that are looked at for a HOMFLY polynomial; those of up to 20 crossings need some thousands."""


def gauss_code(found: Crossings) -> Gauss:
    """Return the Gauss code of a projection."""
    numbers = np.arange(1, len(found.sign) + 1)
    place = np.concatenate([found.over, found.under])
    order = np.argsort(place)
    passages = np.concatenate([numbers, -numbers])[order]
    cuts = np.searchsorted(place[order], found.bounds)
    return [passages[a:b].tolist() for a, b in pairwise(cuts)], (found.sign > 0).tolist()


def as_crossings(gauss: Gauss) -> Crossings:
    """Return a diagram as a projection, of which only the order of places says anything."""
    passages, right = gauss
    over, under = np.zeros(len(right)), np.zeros(len(right))
    for place, passage in enumerate(passage for component in passages for passage in component):
        (over if passage > 0 else under)[abs(passage) - 1] = place
    bounds = np.cumsum([0, *map(len, passages)])
    return Crossings(over, under, np.where(right, 1, -1), bounds)


def shortened(gauss: Gauss) -> Gauss:
    """Return the diagram after strands above all others, or below, have been laid as short as they get."""
    return _core.shortened(gauss)


def homfly_polynomial(gauss: Gauss) -> Polynomial | None:
    """Return the HOMFLY polynomial, None where that would take too long.

    alpha P(right-handed) - P(left-handed)/alpha = z P(smoothed), and P = 1 for the unknot.
    """
    terms = _core.homfly(gauss, MOST_DIAGRAMS)
    return None if terms is None else {(alpha, z): value for alpha, z, value in terms}


def times(one: Polynomial, other: Polynomial) -> Polynomial:
    """Return the product of two polynomials."""
    product: Polynomial = {}
    for (alpha, z), value in one.items():
        for (more_alpha, more_z), factor in other.items():
            power = alpha + more_alpha, z + more_z
            product[power] = product.get(power, 0) + value * factor
    return {power: value for power, value in product.items() if value}


def written(polynomial: Polynomial) -> str:
    """Write a polynomial as Regina does, with x for alpha and y for z: "2 x^-2 - x^-4"."""
    text = ""
    for (alpha, z), value in sorted(polynomial.items(), reverse=True):
        powers = [_power("x", alpha), _power("y", z)]
        factor = "" if abs(value) == 1 and (alpha or z) else str(abs(value))
        term = " ".join(filter(None, [factor, *powers]))
        text += (" - " if value < 0 else " + ") + term if text else "-" * (value < 0) + term
    return text or "0"


def _power(variable: str, exponent: int) -> str:
    return variable if exponent == 1 else f"{variable}^{exponent}" if exponent else ""


def alexander_polynomial(polynomial: Polynomial) -> str:
    """Write the Alexander polynomial in t, of a single variable, by the HOMFLY polynomial.

    Its lowest power is 0, and its highest coefficient above 0.
    """
    # The Conway polynomial is that at alpha = 1, and there z = t^1/2 - t^-1/2.
    conway: dict[int, int] = {}
    for (_, z), value in polynomial.items():
        conway[z] = conway.get(z, 0) + value
    conway = {z: value for z, value in conway.items() if value}
    top = max(conway, default=0)
    delta = np.poly1d([0])
    for z, value in conway.items():
        # t^(top/2) times value (t - 1)^z t^(-z/2): such powers of t as are whole.
        delta += value * np.poly1d([1, -1]) ** z * np.poly1d([1, 0]) ** ((top - z) // 2)
    coefficients = [int(c) for c in delta.coeffs]
    sign = -1 if coefficients[0] < 0 else 1
    terms = {(len(coefficients) - 1 - k, 0): sign * c for k, c in enumerate(coefficients) if c}
    return written(terms).replace("x", "t")
