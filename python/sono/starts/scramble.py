"""Isotopic entangling: a curve of the same type that looks nothing like the one it came from."""

import math
from collections.abc import Callable, Sequence
from typing import TypeAlias

import numpy as np
from numpy.typing import NDArray

from sono import _core
from sono.curve import Components

Map: TypeAlias = Callable[[NDArray[np.float64]], NDArray[np.float64]]
"""A map of space, which takes points (m, 3) to points (m, 3)."""

MOST = 5_000
"""Vertices of a curve that is scrambled, whose distances are all compared: 1 GB."""

LOOSENINGS = 4
"""How often a curve is looked at, each time looser, before it is taken as thin as it is."""


def scramble(
    curve: Components, seed: int, swirls: int = 40, watch: Callable[[], None] = lambda: None
) -> Components:
    """Return `curve` entangled by random swirls of space, in the same unit and with more vertices.

    A swirl turns every sphere about a centre by an angle that fades with its radius; let the angle grow from
    zero, and it is an isotopy of all space, so the image has the knot type of the curve. The polygon has the
    type of the image because its edges are halved until they are shorter than half a rope radius, and a swirl
    after which the curve would not hold a rope of that radius, 600 radii long at most, or half as long again
    as it was, is left out. A curve without room for that is loosened first. The same seed gives the same
    curve. `watch` is called before each swirl; what it raises passes through. Raises ValueError for a curve
    that touches itself, or too thin a rope, or more than `MOST` vertices.
    """
    if (n := sum(map(len, curve))) > MOST:
        raise ValueError(f"{n:,} vertices are too many to scramble; {MOST:,} are the most")
    random = np.random.default_rng(seed)
    curve, radius = _rope(curve)
    longest = max(600 * radius, 1.5 * _length(curve))
    for _ in range(swirls):
        watch()
        swirl = _swirl(random, np.vstack(curve))
        moved = [_image(component, swirl, radius / 2) for component in curve]
        if _length(moved) <= longest and _holds_rope(moved, radius):
            curve = moved
    return curve


def _rope(curve: Components) -> tuple[Components, float]:
    """Return `curve` finely sampled, and the radius of a rope in it that leaves room to move.

    One that is drawn too thin is loosened first, by isotopic moves.
    """
    loose = curve
    for _ in range(LOOSENINGS):
        if found := _held(loose, (100, 200, 400)):
            return found
        loose = _loosened(loose)
    if found := _held(curve, (800, 1600)):
        return found
    raise ValueError("the curve comes closer to itself than 1/400 of its length, and cannot be loosened")


def _held(curve: Components, slenderness: Sequence[int]) -> tuple[Components, float] | None:
    """Return `curve` and the radius, likewise, of the first slenderness at which there is room to move."""
    length = _length(curve)
    for radius in (length / times for times in slenderness):
        fine = [_image(component, np.copy, radius / 2) for component in curve]
        if _holds_rope(fine, 2 * radius):
            return fine, radius
    return None


def _loosened(curve: Components) -> Components:
    """Return the curve with more room round it; sampled more finely, so that no corner stays sharp."""
    length = _length(curve)
    try:
        return _core.loosen([_image(component, np.copy, length / 100) for component in curve])
    except _core.CurveError as error:
        raise ValueError(f"the curve touches itself, or is too entangled to scramble: {error}") from error


def _swirl(random: np.random.Generator, points: NDArray[np.float64]) -> Map:
    """Draw a swirl that takes hold of a part of the (n, 3) points."""
    size = math.sqrt(points.var(axis=0).sum())
    centre = points[random.integers(len(points))] + random.normal(scale=0.3 * size, size=3)
    axis = random.normal(size=3)
    axis /= np.linalg.norm(axis)
    most, width = random.uniform(-2 * np.pi, 2 * np.pi), size * random.uniform(0.5, 1.5)

    def swirl(points: NDArray[np.float64]) -> NDArray[np.float64]:
        arm = points - centre
        angle = most * np.exp(-(arm**2).sum(axis=1, keepdims=True) / width**2)
        along = np.outer(arm @ axis, axis)
        turned = (arm - along) * np.cos(angle) + np.cross(axis, arm) * np.sin(angle)
        moved: NDArray[np.float64] = centre + along + turned
        return moved

    return swirl


def _image(component: NDArray[np.float64], move: Map, longest: float) -> NDArray[np.float64]:
    """Return the (m, 3) image of a polygon, with edges halved until those of the image are short enough."""
    while True:
        image = move(component)
        cut = np.flatnonzero(np.linalg.norm(_edges(image), axis=1) > longest)
        if not len(cut):
            return image
        middle = component[cut] + _edges(component)[cut] / 2
        component = np.insert(component, cut + 1, middle, axis=0)


def _holds_rope(curve: Components, radius: float) -> bool:
    """Tell whether all vertices are 2 radii apart, or else 2/pi of the way between them along the curve.

    A bend of the radius of the rope meets this up to its half circle, the ends of which are 2 radii apart.
    """
    points = np.vstack(curve)
    points = points - points.mean(axis=0)
    norm = (points**2).sum(axis=1)
    distance2 = norm[:, None] + norm - 2 * points @ points.T
    least = np.full_like(distance2, 2 * radius)
    begin = 0
    for component in curve:
        lengths = np.linalg.norm(_edges(component), axis=1)
        place = np.cumsum(lengths) - lengths
        arc = abs(place[:, None] - place)
        arc = np.minimum(arc, lengths.sum() - arc)
        own = slice(begin, begin + len(place))
        least[own, own] = np.minimum(2 / np.pi * arc, 2 * radius)
        begin += len(place)
    rounding = 1e-9 * radius**2
    return bool((distance2 + rounding >= least**2).all())


def _edges(component: NDArray[np.float64]) -> NDArray[np.float64]:
    return np.roll(component, -1, axis=0) - component


def _length(curve: Components) -> float:
    return float(sum(np.linalg.norm(_edges(component), axis=1).sum() for component in curve))
