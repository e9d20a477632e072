"""How a rope lies on a printer's bed: in the least box there is, found from coarse turns to fine ones."""

import numpy as np

from sono.curve import Components, Floats
from sono.figures.turning import principal

POINTS = 400
"""Of a curve, about so many tell how wide it is."""

TURNS = 400
"""Turns that are tried at once, round axes of any direction."""

ANGLES = (3, 3, 1, 0.3, 0.3, 0.1, 0.1, 0.03, 0.01, 0.003)
"""By how much they turn what was best, in radians, about."""


def flat(curve: Components, radius: float) -> list[Floats]:
    """Turn a curve so that its tube lies flat: the longest edge of its box is along x, the shortest along z.

    >>> turned = flat([np.array([[0.0, 3, 5], [0, -3, 5], [0, -3, -5], [0, 3, -5]])], radius=1)
    >>> np.ptp(turned[0], axis=0).round(1).tolist()
    [10.0, 6.0, 0.0]
    """
    points = np.vstack(curve)
    turn = _least(points[:: len(points) // POINTS + 1], radius)
    return [component @ turn.T for component in curve]


def _least(points: Floats, radius: float) -> Floats:
    """Return the rotation (3, 3) after which the box of a tube round these points is least."""
    best = principal(points)
    random = np.random.default_rng(1)
    for angle in ANGLES:
        turns = _turns(angle * random.normal(size=(TURNS, 3))) @ best
        turns = np.concatenate([best[None], turns])
        best = turns[np.argmin(np.prod(_edges(points, turns) + 2 * radius, axis=1))]
    axes: Floats = best[np.argsort(-_edges(points, best[None])[0])]
    axes[2] *= np.sign(np.linalg.det(axes))
    return axes


def _edges(points: Floats, turns: Floats) -> Floats:
    """Return the edges (k, 3) of the boxes of points (n, 3) after turns (k, 3, 3)."""
    along = turns @ points.T
    edges: Floats = along.max(axis=2) - along.min(axis=2)
    return edges


def _turns(vectors: Floats) -> Floats:
    """Return rotations (k, 3, 3) about vectors (k, 3) by their lengths. Source: O. Rodrigues, 1840."""
    angles = np.linalg.norm(vectors, axis=1)[:, None, None]
    x, y, z = (vectors / angles[:, 0]).T
    zero = 0 * x
    cross = np.moveaxis(np.array([[zero, -z, y], [z, zero, -x], [-y, x, zero]]), 2, 0)
    turns: Floats = np.eye(3) + np.sin(angles) * cross + (1 - np.cos(angles)) * (cross @ cross)
    return turns
