"""Drawings made even: triangles of a plane graph get more alike in area, and none turns over.

>>> square = np.array([[0.0, 0], [1, 0], [1, 1], [0, 1], [0.9, 0.2]])
>>> fan = np.array([[0, 1, 4], [1, 2, 4], [2, 3, 4], [3, 0, 4]])
>>> evened(square, fan, np.arange(4), 50)[4].round(6).tolist()
[0.5, 0.5]
"""

import numpy as np
from numpy.typing import NDArray

from sono.curve import Floats

LEAST_STEP = 1e-6
"""The share of a step at which it ends."""


def areas(points: Floats, triangles: NDArray[np.int_]) -> Floats:
    """Return twice the areas (k,) of triangles (k, 3) of points (n, 2), those of clockwise ones negative."""
    one, two, three = points[triangles.T]
    (a, b), (c, d) = (two - one).T, (three - one).T
    doubled: Floats = a * d - b * c
    return doubled


def evened(points: Floats, triangles: NDArray[np.int_], fixed: NDArray[np.int_], steps: int) -> Floats:
    """Return the points (n, 2) after so many steps that make the product of all areas larger.

    All triangles have to be counter-clockwise, and stay so. In each step every point but the fixed ones goes
    towards where it would make the product of its own triangles largest, by Newton's method.
    """
    best, share = np.log(areas(points, triangles)).sum(), 0.5
    for _ in range(steps):
        moves = _moves(points, triangles)
        moves[fixed] = 0
        while True:
            moved = points + share * moves
            doubled = areas(moved, triangles)
            if doubled.min() > 0 and np.log(doubled).sum() > best:
                break
            share /= 2
            if share < LEAST_STEP:
                return points
        points, best, share = moved, np.log(doubled).sum(), min(1.5 * share, 1)
    return points


def _moves(points: Floats, triangles: NDArray[np.int_]) -> Floats:
    """Return Newton's steps (n, 2) for the logarithms of the areas round each point."""
    slopes, curvatures = np.zeros((len(points), 2)), np.zeros((len(points), 2, 2))
    doubled = areas(points, triangles)
    for corner in range(3):
        at, two, three = np.roll(triangles, -corner, axis=1).T
        across = points[three] - points[two]
        slope = np.column_stack([-across[:, 1], across[:, 0]]) / doubled[:, None]
        np.add.at(slopes, at, slope)
        np.add.at(curvatures, at, slope[:, :, None] * slope[:, None, :])
    # A point of one triangle alone has no largest product; it is kept from running away.
    kept = 1e-9 * np.trace(curvatures, axis1=1, axis2=2)[:, None, None] * np.eye(2)
    moves: Floats = np.linalg.solve(curvatures + kept, slopes[:, :, None])[:, :, 0]
    return moves
