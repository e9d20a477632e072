"""The shape of chains that are not closed, by the descriptors of closed curves that need no closure.

May import nothing of sono.
"""

import math
from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]


def edges(chain: Floats, closed: bool) -> tuple[Floats, Floats]:
    """Return where the edges of a chain (n, 3) start and end: n of them if it is `closed`, else n - 1."""
    ends = np.roll(chain, -1, axis=0)
    return (chain, ends) if closed else (chain[:-1], ends[:-1])


def length(chains: Sequence[Floats], closed: Sequence[bool]) -> float:
    """Return the length of all edges of chains."""
    pairs = (edges(chain, ring) for chain, ring in zip(chains, closed, strict=True))
    return float(sum(np.linalg.norm(end - start, axis=1).sum() for start, end in pairs))


def writhe(chains: Sequence[Floats], closed: Sequence[bool]) -> tuple[float, float, float]:
    """Return the mean over all directions of the signs of crossings that are seen, and of their number.

    The signs are of crossings of chains with themselves, and with each other; the number is of all. Each pair
    of edges is seen to cross in a share of all directions that is known: K. Klenin, J. Langowski, Biopolymers
    54 (2000) 307, method 1a. Edges that touch count nothing.
    """
    pairs = [edges(chain, ring) for chain, ring in zip(chains, closed, strict=True)]
    start, end = (np.concatenate(places) for places in zip(*pairs, strict=True))
    of = np.repeat(np.arange(len(pairs)), [len(places) for places, _ in pairs])
    own = between = crossings = 0.0
    for i in range(len(start) - 1):
        seen = _seen(start[i], end[i], start[i + 1 :], end[i + 1 :])
        own += float(seen[of[i + 1 :] == of[i]].sum())
        between += float(seen[of[i + 1 :] != of[i]].sum())
        crossings += float(abs(seen).sum())
    return own, between, crossings


@np.errstate(divide="ignore", invalid="ignore")
def _seen(start: Floats, end: Floats, starts: Floats, ends: Floats) -> Floats:
    """Return the shares (m,) of directions in which an edge crosses others (m, 3), signed as it does."""
    corners = [starts - start, ends - start, ends - end, starts - end]
    normals = [np.cross(one, other) for one, other in zip(corners, [*corners[1:], corners[0]], strict=True)]
    units = [normal / np.linalg.norm(normal, axis=1)[:, None] for normal in normals]
    around = zip(units, [*units[1:], units[0]], strict=True)
    angle = sum(np.arcsin(np.sum(one * other, axis=1).clip(-1, 1)) for one, other in around)
    sign = np.sign(np.sum(np.cross(ends - starts, end - start) * corners[0], axis=1))
    shares: Floats = np.nan_to_num(angle * sign) / math.tau
    return shares


def corners(chain: Floats, closed: bool) -> tuple[Floats, Floats]:
    """Return the edges before and after each vertex (m, 3) at which a chain turns: all of a ring's."""
    start, end = edges(chain, closed)
    steps = end - start
    return (np.roll(steps, 1, axis=0), steps) if closed else (steps[:-1], steps[1:])
