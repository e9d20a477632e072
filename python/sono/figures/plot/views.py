"""Where a rope is looked at from."""

import numpy as np

from sono.curve import Components, Floats

ROUND = 1.15
"""A rope is round, and turned so that what is farthest from its axis is at the top, if its two largest
radii of gyration are in no larger ratio; else it lies along its longest axis."""


def seen(components: Components) -> list[Floats]:
    """Return a curve as it is looked at: as flat as it can be, x to the right, y upward, z to the eye.

    Its centre is at the origin, and x, y, z are its principal axes, from the longest to the shortest. The
    third moments tell their ends apart, so that a curve is seen from the same side however it lies. It is
    turned, never mirrored.
    """
    points = np.vstack(components)
    centre = points.mean(axis=0)
    arms = points - centre
    squares, axes = np.linalg.eigh(arms.T @ arms)
    skew = ((arms @ axes) ** 3).sum(axis=0)
    to_eye, _, along = (axes * np.where(skew < 0, -1, 1)).T
    turn = np.array([along, np.cross(to_eye, along), to_eye])
    if squares[2] < ROUND**2 * squares[1]:
        turn = _farthest_up(arms @ turn.T) @ turn
    return [(component - centre) @ turn.T for component in components]


def _farthest_up(arms: Floats) -> Floats:
    """Return the turn round the z axis after which the point farthest from it is at the top."""
    far = np.hypot(arms[:, 0], arms[:, 1])
    x, y = arms[np.argmax(far), :2] / far.max()
    return np.array([[y, -x, 0], [x, y, 0], [0, 0, 1]])
