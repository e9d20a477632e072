"""How finely a smooth curve is sampled: so that the polygon is surely of its type."""

from collections.abc import Callable, Iterable, Sequence

import numpy as np
from numpy.typing import NDArray

from sono._core import CurveError
from sono.curve import measure

Floats = NDArray[np.float64]

SURE = 4
"""The curve is nowhere farther from the polygon than the polygon's rope radius over this."""

STEEP = np.pi / 6
"""The largest angle between an edge and the arc that it stands for."""

Drawing = tuple[list[Floats], float, float]
"""The polygons, how far the curve may be from them, and the largest angle between the two."""


@np.errstate(all="ignore")  # what is not finite is not near
def sampled(draw: Callable[[int], Drawing], finer: Iterable[int]) -> list[Floats]:
    """Draw polygons, each (n, 3), ever finer until they are near enough to the curve: a step of `finer` each.

    Then the arcs can be straightened inside of the polygon's rope, and the types are one. Raises `ValueError`
    when no step is fine enough.
    """
    for step in finer:
        curves, far, angle = draw(step)
        if np.isfinite(far) and angle <= STEEP and SURE * far <= _radius(curves):
            return curves
    raise ValueError("the curve meets itself, or nearly, so that no polygon is surely of its type")


def _radius(curves: Sequence[Floats]) -> float:
    try:
        return measure(curves).r_s
    except CurveError:  # it meets itself
        return 0.0
