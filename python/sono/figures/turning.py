"""How a curve is turned before it is looked at: its widest side to the eye, and several curves alike."""

from collections.abc import Sequence

import numpy as np

from sono.curve import Components, Floats

SAMPLES = 240
"""Points of each component by which curves are laid on each other."""

ROUND = 1.15
"""A rope is round, and turned so that what is farthest from its axis is at the top, if its two largest
radii of gyration are in no larger ratio; else it lies along its longest axis."""

EVEN = 1.05
"""Where all three radii of gyration are within such a ratio, no side is the widest: rings at right angles,
as the Borromean ones are, hide each other when seen along an axis, and are seen along the axes' diagonal."""

_DIAGONAL = np.array([[-1, 1, 0], [-1, -1, 2], [1, 1, 1]]) / np.sqrt([[2], [6], [3]])


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


def facing(curve: Components) -> list[Floats]:
    """Return a curve with its centre at the origin, x to the right, y upward, and z to the eye."""
    points = np.vstack(curve)
    frame = principal(points)
    return [(component - points.mean(axis=0)) @ frame.T for component in curve]


def principal(points: Floats) -> Floats:
    """Return the rotation (3, 3) that turns the widest side of points (..., 3) to the eye.

    It lays their longest principal axis to the right. The third moments tell the ends of axes apart, so that
    points are seen from the same side however they lie.
    """
    arms = points.reshape(-1, 3) - points.reshape(-1, 3).mean(axis=0)
    squares, axes = np.linalg.eigh(arms.T @ arms)
    skew = ((arms @ axes) ** 3).sum(axis=0)
    to_eye, _, along = (axes * np.where(skew < 0, -1, 1)).T
    turn = np.array([along, np.cross(to_eye, along), to_eye])
    if squares[2] < EVEN**2 * squares[0]:
        turn = _DIAGONAL @ turn
    if squares[2] < ROUND**2 * squares[1]:
        turn = _farthest_up(arms @ turn.T) @ turn
    return turn


def _farthest_up(arms: Floats) -> Floats:
    """Return the turn round the z axis after which the point farthest from it is at the top."""
    far = np.hypot(arms[:, 0], arms[:, 1])
    x, y = arms[np.argmax(far), :2] / far.max()
    return np.array([[y, -x, 0], [x, y, 0], [0, 0, 1]])


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
