"""A sharper bound: the length of the inscribed curve over its own thickness, which is more than R_c.

The thickness is guessed from points of the curve, a little low, and proven in whole numbers by
`check_thickness`, which takes nothing from here but the guess. docs/explanation/theorem.md has the
theorem, (T5) to (T7).
"""

import os
from dataclasses import dataclass
from decimal import ROUND_CEILING, ROUND_FLOOR, Context, Decimal
from fractions import Fraction
from typing import Any

import numpy as np
from numpy.typing import NDArray

from sono import check_thickness
from sono.calls import Rope, rope_of
from sono.certificates import DIGITS, certify, document_of
from sono.curve import Components, polygon
from sono.records import Record

SHARES = (0.98, 0.95, 0.9, 0.8, 0.6, 0.3)
"""Of what the guess is above R_c, tried one after the other."""

POINTS = 9
"""Points of an arc that are looked at."""


@dataclass(frozen=True, eq=False, repr=False)
class Thickness(Record):
    """Proves that the type of a polygon has a ropelength of at most `l_k`.

    In the unit of the vertices, the inscribed curve is at least `tau` thick and at most `length` long; `r` is
    an R that has the conditions (T1) to (T3). All are decimals. `polygon` is the SHA-256 of the vertices as
    little-endian doubles.

    >>> import sono
    >>> tight = sono.tighten("3_1", 60)
    >>> sharp = sono.sharpen(tight)
    >>> 32.743 < sharp.l_k < 32.93, sono.certify(tight).l_c > 33.5
    (True, True)
    """

    r: Decimal
    tau: Decimal
    length: Decimal
    l_k: Decimal
    polygon: str

    def document(self, file: str | os.PathLike[str]) -> dict[str, Any]:
        """Return what proves it of a file of these vertices, as JSON has it.

        Raises `OSError` for a file that cannot be read, `ValueError` for one that does not hold these
        vertices in plain rows of x y z.
        """
        return document_of(file, self.polygon, ("sono thickness", 1), self.to_dict())

    def rounded(self, digits: int = 14) -> str:
        """Return the bound with fewer digits, rounded up."""
        return f"{Context(digits, ROUND_CEILING).plus(self.l_k):f}"


def sharpen(vertices: Rope, /) -> Thickness:
    """Prove a bound on the ropelength of a curve's type that is sharper than that of `certify`.

    Of what edges add to L_c, a fourth is left as a rule. It takes a second for hundreds of vertices. A name
    stands for the atlas's rope of the knot. Raises `CurveError` as `certify` does, `ValueError` where no
    bound is proven that is sharper. Source: docs/explanation/theorem.md.

    >>> import sono
    >>> 25.1327 < sono.sharpen("Hopf").l_k < 25.134 < sono.certify("Hopf").l_c
    True
    """
    components = rope_of(vertices)
    certificate = certify(components)
    up, down = Context(DIGITS, ROUND_CEILING), Context(DIGITS, ROUND_FLOOR)
    r_c = float(certificate.r_c)
    min_rad = float(certificate.min_rad)
    guess = min(min_rad, guessed(components, float(certificate.r), min_rad))
    for share in SHARES if guess > r_c else ():
        tau = down.create_decimal(r_c + share * (guess - r_c))
        found = {"r": certificate.r, "tau": tau, "length": certificate.length}
        found["l_k"] = up.divide(certificate.length, tau)
        try:
            check_thickness.prove(
                {key: Fraction(value) for key, value in found.items()},
                [list(map(tuple, component.tolist())) for component in components],
            )
        except check_thickness.RefusedError:
            continue
        return Thickness(**found, polygon=polygon(components))
    raise ValueError(
        "no sharper bound is proven: K_P is hardly thicker than R_c, or its edges are too unequal"
    )


def guessed(components: Components, r: float, min_rad: float) -> float:
    """Return about half the least distance of points of K_P that are far from each other along it."""
    arcs = [_arcs(component) for component in components]
    vertices, points = np.concatenate(list(components)), np.concatenate(arcs)
    component = np.repeat(np.arange(len(arcs)), list(map(len, arcs)))
    edges = [np.linalg.norm(np.roll(c, -1, axis=0) - c, axis=1) for c in components]
    longest = max(float(edge.max()) for edge in edges)
    least = 2 * r
    along = np.concatenate([np.cumsum(edge) for edge in edges])
    around = np.array([edge.sum() for edge in edges])[component]
    for i, vertex in enumerate(vertices):
        apart = abs(along - along[i])
        far = (component != component[i]) | (np.minimum(apart, around - apart) > np.pi * min_rad - longest)
        near = far & (np.linalg.norm(vertices - vertex, axis=1) < least + 2 * longest)
        if near.any():
            ways = points[near][:, :, None] - points[i]
            least = min(least, float(np.linalg.norm(ways, axis=-1).min()))
    return least / 2


def _arcs(v: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return points (n, POINTS, 3) of the arcs of a component."""
    before, after = np.roll(v, 1, axis=0) - v, np.roll(v, -1, axis=0) - v
    sizes = [np.linalg.norm(way, axis=1) for way in (before, after)]
    tangent = np.minimum(*sizes) / 2
    start, end = (way * (tangent / size)[:, None] for way, size in zip((before, after), sizes, strict=True))
    # (1 - x)^2 p + 2 w x (1 - x) v + x^2 q over its sum of weights, w the cosine of half the angle.
    weight = np.linalg.norm(end - start, axis=1) / (2 * tangent)
    x = np.linspace(0, 1, POINTS)[None, :, None]
    whole = (1 - x) ** 2 + 2 * weight[:, None, None] * x * (1 - x) + x**2
    arcs: NDArray[np.float64] = v[:, None] + ((1 - x) ** 2 * start[:, None] + x**2 * end[:, None]) / whole
    return arcs
