"""Shapes and minima: told apart by length and radii of gyration, ranked, and counted.

At edges of 0.45 radii the grooves between beads blur lengths by a few tenths of a percent, so shapes of one
minimum are alike in their radii; minima themselves are told apart on finer edges.
"""

from collections.abc import Iterable
from dataclasses import dataclass, field, replace
from typing import Any, Self, TypeAlias

import numpy as np
from numpy.typing import NDArray

from sono.curve import Components, Curve, Measures, measure
from sono.records import Drawn, Record

Radii: TypeAlias = NDArray[np.float64]

SAME_RADII = 0.007
"""Relative difference of the radii of gyration up to which ropes of one edge length count as one shape."""

SAME_LENGTH = 2e-4
"""Relative difference in L_a up to which two refined ropes of the same shape count as one minimum."""

SHORTER_SHAPE = 5e-3
"""A shape shorter than a minimum by more than this share is another, even if their radii are alike."""

SAME_EDGES = 0.02
"""Relative difference of edge lengths up to which the grooves of two ropes are alike."""

MET = 16
"""Coarse shapes of a minimum that are remembered."""


@dataclass(frozen=True, eq=False)
class Shape:
    """What a trial ended in: a coarse rope, its L_a and its radii of gyration (3,).

    `curve` is None where the trial came to nothing, and `changed` tells that this was for the knot's type.
    `hits` counts the trials that ended so.
    """

    variant: int
    length: float = float("inf")
    radii: Radii = field(default_factory=lambda: np.full(3, np.inf))
    curve: Components | None = None
    changed: bool = False
    hits: int = 1


@dataclass(frozen=True, eq=False, repr=False)
class Minimum(Record, Drawn):
    """A refined rope, the variant that led there, and the number of trials that did.

    `length` is its L_a, `converged` tells whether the polish reached its end, `residual` is the largest force
    left over, if that is known, and `met` has the radii of gyration of the coarse shapes that were refined
    to it.

    >>> import sono
    >>> best = sono.search("3_1", trials=1)[0]
    >>> best.converged, best.hits, best.length == best.measures.l_a
    (True, 1, True)
    """

    variant: int
    length: float
    converged: bool
    residual: float | None
    curve: Curve
    met: list[Radii]
    hits: int = 0

    @classmethod
    def of(cls, shape: Shape) -> Self:
        """Return a shape as a minimum that has not been refined."""
        return cls(
            shape.variant,
            shape.length,
            converged=False,
            residual=None,
            curve=Curve(shape.curve or []),
            met=[shape.radii],
            hits=shape.hits,
        )

    @property
    def measures(self) -> Measures:
        """What the rope measures."""
        return measure(self.curve)

    def to_dict(self) -> dict[str, Any]:
        """Return plain values: the fields, and what the rope measures; `length` is that of the polygon."""
        return super().to_dict() | self.measures.to_dict()


def rank(minimum: Minimum) -> tuple[bool, float]:
    """Order tight ropes before others, then the shorter before the longer."""
    return not minimum.converged, minimum.length


def same_edges(one: float, other: float) -> bool:
    """Tell whether edges are so equally long that ropes are compared by their L_a alone."""
    return abs(one - other) <= SAME_EDGES * other


def has_edges(n: int, length: float, dl: float) -> bool:
    """Tell whether a rope of n vertices and this length has edges of dl, as far as n is a whole number."""
    return abs(n * dl - length) <= max(SAME_EDGES * length, dl)


def radii_of_gyration(curve: Components) -> Radii:
    """Return the three principal radii of gyration (3,) of all vertices, in increasing order."""
    arms = np.vstack(curve)
    arms = arms - arms.mean(axis=0)
    radii: Radii = np.sqrt(np.linalg.eigvalsh(arms.T @ arms / len(arms)).clip(0))
    return radii


def merged(minima: Iterable[Minimum]) -> list[Minimum]:
    """Return minima with those made one that are the same, the shortest first."""
    apart: list[Minimum] = []
    for found in minima:
        radii = radii_of_gyration(found.curve)
        for i, known in enumerate(apart):
            near = abs(known.length - found.length) < SAME_LENGTH * found.length
            if near and alike(radii_of_gyration(known.curve), radii):
                shorter, met = min(known, found, key=rank), (known.met + found.met)[-MET:]
                apart[i] = replace(shorter, met=met, hits=known.hits + found.hits)
                break
        else:
            apart.append(found)
    return sorted(apart, key=rank)


def alike(one: Radii, other: Radii) -> bool:
    """Tell whether radii of gyration are those of one shape."""
    # A flat curve has a radius of 0.
    return bool((abs(one - other) <= SAME_RADII * np.maximum(other, other.max() / 10)).all())
