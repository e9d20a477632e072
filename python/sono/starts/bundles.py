"""Torus knots and links as bundles: strands packed side by side in a thick rope, which is twisted and closed.

The strands of `torus` lie on a torus, which is hollow; those of a bundle fill it, at places of the triangular
lattice. Both are one type. On the torus the strands cross a disc in places on a circle, which turns by q/p
while they go round once. Where the packing looks the same after q/p of a turn, none of its places being the
centre, the disc of a bundle turns by so much, and places may be shifted to a circle together with all that
they are turned to. Else it makes a whole number of turns, while strands take the steps that are left, from
place to place along a simple closed curve through all of them; a motion of the disc makes that the circle.

>>> len(bundle(4, 6, 1)), len(bundle(5, -7, 2))
(2, 1)
"""

import math

import numpy as np

from sono.curve import Components, Floats
from sono.starts.drawing import check_size, mirror
from sono.starts.torus import check_type

MOST_STRANDS = 300
"""Strands of a bundle; the curve through their places takes seconds."""

ROOM = 3.0
"""From the bundle to the axis of the ring that it is closed to, in diameters of a strand."""

_CENTRES = [((0, 0), 1), ((1 / 2, math.sqrt(1 / 12)), 3), ((1 / 2, 0), 2)]
"""Centres of packings: a place, a triangle, an edge of the lattice, and how often each looks the same in a
turn; of a place that is not counted, as its own strand would be a component without a partner."""


def bundle(p: int, q: int, variant: int) -> Components:
    """Return the torus knot or link T(p,q) as a bundle, in units of about one rope radius.

    There are gcd(p, q) components, of as many vertices each. Bundles of odd `variant`, from 1, have as many
    strands as the smaller of |p| and |q|, those of even ones as the larger: the rope goes round that often.
    The variants 1 and 2 are packed round a strand, 3 and 4 round a triangle of strands, 5 and 6 round a pair,
    further ones round random centres. pq > 0 is right-handed, pq < 0 its mirror image. Raises ValueError
    where p or q is zero, or for more than `MOST_STRANDS` strands.
    """
    check_type(p, q)
    strands, twist = sorted((abs(p), abs(q)), reverse=variant % 2 == 0)
    if strands > MOST_STRANDS:
        raise ValueError(
            f"T({p},{q}) as a bundle has {strands:,} strands; {MOST_STRANDS} are the most, give variant 0"
        )
    random = np.random.default_rng(variant)
    kind = (variant - 1) // 2
    centre, symmetry = _CENTRES[kind] if kind < len(_CENTRES) else (random.random(2), 1)
    components = math.gcd(p, q)
    fold = strands // components
    if symmetry % fold == 0:
        curve = _wound(_places(components, centre, fold), strands, twist, 0)
    else:
        steps = twist - round(twist / strands) * strands
        curve = _wound(_closed(_places(strands, centre, 1), random), strands, twist, steps)
    return curve if p * q > 0 else mirror(curve)


def _places(n: int, centre: object, fold: int) -> Floats:
    """Return the n lattice points (n, 2) next to a centre, which becomes the origin, in 1/fold of a turn."""
    reach = 2 * math.ceil(math.sqrt(n * fold)) + 2
    one, two = np.mgrid[-reach : reach + 1, -reach : reach + 1].reshape(2, -1)
    points = np.column_stack([one + two / 2, two * math.sqrt(3 / 4)]) - np.asarray(centre)
    angles = (np.arctan2(points[:, 1], points[:, 0]) + 1e-6) % (2 * np.pi)
    points, angles = points[angles < 2 * np.pi / fold], angles[angles < 2 * np.pi / fold]
    order = np.lexsort((angles, np.linalg.norm(points, axis=1).round(6)))
    nearest: Floats = points[order[:n]]
    return nearest


def _closed(places: Floats, random: np.random.Generator) -> Floats:
    """Order places (n, 2) so that the polygon through them, counter-clockwise, does not meet itself.

    While two edges are longer than those that would join their first and their last ends, these take their
    place. Edges that cross are, so none is left that does; small shifts keep places off the edges of others.
    Through two places goes a square.
    """
    if len(places) == 2:
        middle, half = places.mean(axis=0), (places[1] - places[0]) / 2
        side = np.array([half[1], -half[0]])
        return np.array([middle - half, middle + side, middle + half, middle - side])
    tour = places + random.normal(scale=0.01, size=places.shape)
    tour = tour[np.argsort(np.arctan2(*(tour - tour.mean(axis=0)).T))]
    while True:
        apart = np.linalg.norm(tour[:, None] - tour, axis=2)
        edges = np.diag(np.roll(apart, -1, axis=1))
        gains = edges[:, None] + edges - apart - np.roll(apart, (-1, -1), axis=(0, 1))
        np.fill_diagonal(gains, 0)
        first, last = sorted(np.unravel_index(gains.argmax(), gains.shape))
        if gains[first, last] < 1e-9:
            break
        tour[first + 1 : last + 1] = tour[first + 1 : last + 1][::-1].copy()
    x, y = tour.T
    return tour if (x * np.roll(y, -1) - y * np.roll(x, -1)).sum() > 0 else tour[::-1]


def _wound(corners: Floats, strands: int, twist: int, steps: int) -> Components:
    """Return strands that go round together, while they are turned and take steps from corner to corner.

    The `corners` (m, 2) are all places, or all those from which the others are got by turns. Where there are
    more of them than strands, each step leads past some.
    """
    components = math.gcd(strands, twist)
    turns = (twist - steps) / strands
    bundle = np.linalg.norm(corners, axis=1).max()
    ring = max(bundle + ROOM, bundle * turns)  # strands climb at 45 degrees at most
    rounds = strands // components
    n = rounds * (math.ceil(4 * np.pi * math.hypot(ring + bundle, turns * bundle)) + 2 * abs(steps))
    check_size(components * n, f"T({strands},{twist}) as a bundle")
    time = np.arange(n) * rounds / n
    around, turned = 2 * np.pi * time, 2 * np.pi * turns * time
    pace = max(len(corners) // strands, 1)
    curve = []
    for first in range(components):
        x, y = _along(corners, pace * (first + steps * time))
        rho = ring + np.cos(turned) * x - np.sin(turned) * y
        # Turning clockwise as seen looking forward along the strand: a right-handed screw.
        z = -np.sin(turned) * x - np.cos(turned) * y
        curve.append(2 * np.column_stack([rho * np.cos(around), rho * np.sin(around), z]))
    return curve


def _along(corners: Floats, place: Floats) -> Floats:
    """Return points (2, n) of a closed polygon, which has corner k at place k."""
    corner = np.floor(place).astype(int)
    begin, end = (corners[(corner + more) % len(corners)].T for more in (0, 1))
    points: Floats = begin + (end - begin) * (place - corner)
    return points
