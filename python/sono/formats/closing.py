"""Open chains, closed as the user asks: by an edge between the ends, or by way of a sphere round the chain.

What is added has edges about as long as those of the chain, so that no giant edge sets the scale of a rope.
"""

import math
from itertools import pairwise
from typing import Literal, TypeAlias, get_args

import numpy as np
from numpy.typing import NDArray

Floats: TypeAlias = NDArray[np.float64]

Close: TypeAlias = Literal["direct", "sphere"]
"""How open chains are closed."""

Ends: TypeAlias = Close | Literal["open"]
"""What is done with open chains: they may be left open, for what is known of them without a closure."""

WAYS: tuple[str, ...] = get_args(Close)

ROOM = 1.25
"""The sphere's radius, over the largest distance of a vertex from the centre of mass."""

FINEST = 1 / 8
"""Edges of an arc are at most so many radii of its sphere long, and thus outside of the chain."""

SAME_WAY = 1e-6
"""Sine of an angle between the ways out up to which they are one."""


@np.errstate(over="ignore", invalid="ignore")
def closing(vertices: Floats, close: Close) -> Floats:
    """Give the vertices (m, 3) to be added after those of an open chain (n, 3), n at least 2, to close it.

    "direct" goes straight from the last vertex to the first. "sphere" has both ends go straight on, away from
    the centre of mass, to a sphere round the chain, and joins them by the shorter arc there; where both leave
    it the same way, out and back again is the straight way too.
    """
    origin = vertices[0]
    size = float(abs(vertices - origin).max())
    if not math.isfinite(size):  # the core refuses what is that large
        return np.zeros((0, 3))
    chain = (vertices - origin) / size
    edge = float(np.linalg.norm(np.diff(chain, axis=0), axis=1).mean())
    way = _along(_corners(chain) if close == "sphere" else chain[[-1, 0]], edge)
    added: Floats = origin + size * way
    return added


def _corners(chain: Floats) -> Floats:
    """Give the corners of the way from the last vertex by the sphere to the first, both included."""
    centre = chain.mean(axis=0)
    radius = ROOM * float(np.linalg.norm(chain - centre, axis=1).max())
    out, back = _outward(chain[-1], chain[-2], centre), _outward(chain[0], chain[1], centre)
    normal = np.cross(out, back)
    sine, cosine = float(np.linalg.norm(normal)), float(out @ back)
    if sine < SAME_WAY and cosine > 0:
        return chain[[-1, 0]]
    if sine < SAME_WAY:  # on opposite sides any arc will do
        normal = np.cross(out, np.eye(3)[abs(out).argmin()])
    across = np.cross(normal / np.linalg.norm(normal), out)
    angle = math.atan2(sine, cosine)
    turns = np.linspace(0, angle, math.ceil(angle / FINEST) + 1)[:, None]
    arc = centre + radius * (np.cos(turns) * out + np.sin(turns) * across)
    return np.vstack([chain[-1], arc[:-1], centre + radius * back, chain[0]])


def _outward(end: Floats, before: Floats, centre: Floats) -> Floats:
    """Give the direction in which an end leaves the centre of mass, or its edge if it is that centre."""
    way = end - centre
    if np.linalg.norm(way) <= SAME_WAY * np.linalg.norm(end - before):
        way = end - before
    unit: Floats = way / np.linalg.norm(way)
    return unit


def _along(corners: Floats, edge: float) -> Floats:
    """Give the vertices between the first and the last corner of a way, in steps of about one edge."""
    points = []
    for start, end in pairwise(corners):
        pieces = max(1, round(float(np.linalg.norm(end - start)) / edge))
        points.append(start + np.arange(pieces)[:, None] / pieces * (end - start))
    return np.vstack(points)[1:]
