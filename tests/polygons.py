"""Polygons as people have them: random ones, meanders, knotted arcs in long loops; seeded."""

from typing import Any

import numpy as np
from numpy.typing import NDArray

from sono import starts

Vertices = NDArray[np.float64]


def gaussian(n: int, seed: int) -> Vertices:
    """A closed walk of n Gaussian steps."""
    steps = np.random.default_rng(seed).normal(size=(n, 3))
    return np.cumsum(steps - steps.mean(axis=0), axis=0)


def equilateral(n: int, seed: int) -> Vertices:
    """A closed walk of n steps that are 1 long to rounding."""
    steps = np.random.default_rng(seed).normal(size=(n, 3))
    for _ in range(2000):
        steps -= steps.mean(axis=0)
        steps /= np.linalg.norm(steps, axis=1)[:, None]
    return np.cumsum(steps, axis=0)


def entangled(n: int, seed: int) -> Vertices:
    """n Gaussian vertices: nearly every edge crosses a third of the others."""
    return np.random.default_rng(seed).normal(size=(n, 3))


def meander(steps: int, seed: int) -> Vertices:
    """The way round a random tree in the square lattice, in a plane."""
    random = np.random.default_rng(seed)
    cells, filled = [(0, 0)], {(0, 0)}
    while len(cells) < steps // 4:
        x, y = cells[random.integers(len(cells))]
        dx, dy = ((1, 0), (-1, 0), (0, 1), (0, -1))[random.integers(4)]
        if (x + 2 * dx, y + 2 * dy) not in filled:
            cells.append((x + 2 * dx, y + 2 * dy))
            filled |= {(x + dx, y + dy), cells[-1]}
    onward: dict[Any, Any] = {}
    for x, y in filled:
        sides = {
            (x, y - 1): ((x, y), (x + 1, y)),
            (x + 1, y): ((x + 1, y), (x + 1, y + 1)),
            (x, y + 1): ((x + 1, y + 1), (x, y + 1)),
            (x - 1, y): ((x, y + 1), (x, y)),
        }
        onward |= dict(side for beyond, side in sides.items() if beyond not in filled)
    return np.array([(x, y, 0) for x, y in _walk(onward)], float)


def lattice(steps: int, seed: int) -> Vertices:
    """An unknot in the cubic lattice, grown by pushing random edges aside."""
    random = np.random.default_rng(seed)
    onward: dict[Any, Any] = {
        (0, 0, 0): (1, 0, 0),
        (1, 0, 0): (1, 1, 0),
        (1, 1, 0): (0, 1, 0),
        (0, 1, 0): (0, 0, 0),
    }
    points = list(onward)
    while len(points) < steps:
        a = points[random.integers(len(points))]
        b = onward[a]
        axis, way = int(random.integers(3)), int(random.choice([-1, 1]))
        p, q = (tuple(x + way * (k == axis) for k, x in enumerate(end)) for end in (a, b))
        if a[axis] == b[axis] and p not in onward and q not in onward:
            onward |= {a: p, p: q, q: b}
            points += [p, q]
    return np.array(_walk(onward), float)


def knotted_arc(name: str, size: float, seed: int) -> Vertices:
    """A loop 1 across, on few vertices, with a knot so large in it."""
    random = np.random.default_rng(seed)
    knot = starts.start(name)[0]
    knot = knot - knot.mean(axis=0)
    knot *= size / np.ptp(knot, axis=0).max()
    outermost = np.linalg.norm(knot, axis=1).argmax()
    x = knot[outermost] / np.linalg.norm(knot[outermost])
    y = np.cross(random.normal(size=3), x)
    y /= np.linalg.norm(y)
    knot = np.roll(knot, -outermost, axis=0)[1:] @ np.column_stack([x, y, np.cross(x, y)])
    t = np.linspace(0, 2 * np.pi, random.integers(10, 60), endpoint=False)[1:]
    loop = np.column_stack([1 - np.cos(t), np.sin(t), 0.1 * np.sin(2 * t) * (1 - np.cos(t))]) / 2
    # It leaves the knot on the side on which that ends.
    loop *= [1, -1 if knot[-1, 1] < knot[0, 1] else 1, 1]
    turn, _ = np.linalg.qr(random.normal(size=(3, 3)))
    whole: Vertices = np.vstack([knot, loop + np.array([0.7 * size, 0, 0])]) @ (turn * np.linalg.det(turn))
    return whole


def _walk(onward: dict[Any, Any]) -> list[Any]:
    walk = [next(iter(onward))]
    while (point := onward[walk[-1]]) != walk[0]:
        walk.append(point)
    return walk
