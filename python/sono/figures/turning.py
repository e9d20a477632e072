"""How a curve is turned before it is looked at: its widest side to the eye, and several curves alike."""

from collections.abc import Sequence

import numpy as np

from sono.curve import Components, Floats

SAMPLES = 240
"""Points of each component by which curves are laid on each other."""


def turned(curves: Sequence[Components]) -> list[Floats]:
    """Return a rotation (3, 3) for each curve, whose rows are the directions right, up and to the eye.

    The first curve shows its widest side. Each other one is laid on the one before it as well as can be, if
    they have equally many components, and else is turned like the first.

    >>> kite = np.array([[2.0, 0, 0], [0, 1, 0], [-1, 0, 0], [0, -1, 0.5]])
    >>> turned_over = kite[[2, 1, 0, 3]][:, [1, 2, 0]]
    >>> first, second = turned([[kite], [turned_over]])
    >>> np.allclose(kite @ first.T, turned_over[[2, 1, 0, 3]] @ second.T, atol=0.05)
    True
    """
    frames: list[Floats] = []
    points: list[Floats] = []
    for curve in curves:
        here = _sampled(curve)
        alike = frames and here.shape == points[-1].shape
        frames.append(frames[-1] @ _laid(here, points[-1]) if alike else principal(here))
        points.append(here)
    return frames


def principal(points: Floats) -> Floats:
    """Return the rotation (3, 3) that turns the widest side of points (m, k, 3) to the eye."""
    flat = points.reshape(-1, 3)
    axes: Floats = np.linalg.svd(flat - flat.mean(axis=0), full_matrices=False)[2]
    axes[2] = np.cross(axes[0], axes[1])
    return axes


def _sampled(curve: Components) -> Floats:
    """Return SAMPLES points (m, SAMPLES, 3), evenly along each of m components, round their mean."""
    parts = []
    for component in curve:
        closed = np.vstack([component, component[:1]])
        along = np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(closed, axis=0), axis=1))])
        at = np.linspace(0, along[-1], SAMPLES, endpoint=False)
        parts.append(np.column_stack([np.interp(at, along, closed[:, k]) for k in range(3)]))
    points = np.array(parts)
    return np.asarray(points - points.mean(axis=(0, 1)))


def _laid(points: Floats, on: Floats) -> Floats:
    """Return the rotation that lays a curve on another, wherever each begins and whichever way it runs.

    Source: W. Kabsch, Acta Cryst. A 32, 922 (1976), for each of the beginnings.
    """
    starts = [np.roll(way, shift, axis=1) for way in (points, points[:, ::-1]) for shift in range(SAMPLES)]
    products = np.einsum("smki,mkj->sij", np.array(starts), on)
    u, s, vt = np.linalg.svd(products)
    sign = np.sign(np.linalg.det(u @ vt))
    best = int(np.argmax(s[:, 0] + s[:, 1] + sign * s[:, 2]))
    rotation: Floats = (u[best] * [1, 1, sign[best]] @ vt[best]).T
    return rotation
