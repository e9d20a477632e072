"""Curves that are well formed and yet hardly meant: an open chain, and one wrapped into a periodic box."""

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]

FAR = 4.0
LONGEST = 1.5
"""The edge that closes an open chain is longer than so many mean edges, and times the longest other edge."""

RING = 1.25
"""The edge between the ends of a ring is at most so many times as long as the longest other one, or `LONGEST`
times as long as the median one."""

STEPS = 2.5
"""Jumps through a periodic box are at least so many times as long as the longest other edge; so a polygon
whose edges are about equal has none."""

LEAST = 10
"""Other edges that there must be, since a knot of a few sticks may have any proportions."""


@np.errstate(over="ignore", invalid="ignore")  # the core refuses what is that large
def closing_edge(vertices: Floats) -> float:
    """Give the closing edge of a component (n, 3) that looks like an open chain, in mean edges, else 0."""
    edges = np.linalg.norm(np.roll(vertices, -1, axis=0) - vertices, axis=1)
    closing, others = edges[-1], edges[:-1]
    far = float(closing / edges.mean())
    return far if far > FAR and closing > LONGEST * others.max() else 0.0


@np.errstate(over="ignore", invalid="ignore")
def ends_apart(vertices: Floats) -> bool:
    """Tell whether the ends of a component (n, 3) are farther apart than neighbours are.

    The edge that closes a ring is one of its bonds, and these vary.
    """
    edges = np.linalg.norm(np.roll(vertices, -1, axis=0) - vertices, axis=1)
    return bool(edges[-1] > RING * edges[:-1].max() and edges[-1] > LONGEST * np.median(edges))


@np.errstate(over="ignore", invalid="ignore")
def gaps(vertices: Floats) -> NDArray[np.int64]:
    """Give the edges within a chain (n, 3) after which another may begin: few, and far longer than others."""
    edges = np.linalg.norm(np.diff(vertices, axis=0), axis=1)
    if len(edges) < LEAST:
        return np.zeros(0, np.int64)
    far = edges > FAR * np.median(edges)
    apart = far.any() and LEAST * far.sum() <= len(edges) and edges[far].min() > STEPS * edges[~far].max()
    return np.flatnonzero(far) if apart else np.zeros(0, np.int64)


@np.errstate(over="ignore", invalid="ignore")
def jumps(components: Sequence[Floats]) -> tuple[NDArray[np.int64], dict[str, float]]:
    """Give the edges, counted through all components, that jump through a periodic box, and its size by axis.

    Such a jump is a step that left the box on one side and came in on the other: along some axes it is nearly
    as long as all the curve is wide, there are jumps both ways, and without them the steps are short. The
    edges that close components may be anything, since the chains may be open.
    """
    steps = np.vstack([np.roll(vertices, -1, axis=0) - vertices for vertices in components])
    inner = np.ones(len(steps), bool)
    inner[np.cumsum([len(vertices) for vertices in components]) - 1] = False
    box = np.ptp(np.vstack(components), axis=0)
    through = np.zeros(steps.shape, bool)
    for axis, (along, size) in enumerate(zip(steps.T, box, strict=True)):
        far = abs(along) > size / 2
        short = LONGEST * abs(along[inner & ~far]).max(initial=0)
        within = far & (size - abs(along) <= short)
        both_ways = (along[within] > 0).any() and (along[within] < 0).any()
        if both_ways and (within | ~far | ~inner).all():
            through[:, axis] = within
    jumping = through.any(axis=1)
    others = inner & ~jumping
    if not jumping.any() or others.sum() < LEAST:
        return np.zeros(0, np.int64), {}
    longest = np.linalg.norm(steps[others], axis=1).max()
    unwrapped = np.where(through, box - abs(steps), steps)[jumping]
    short_again = np.linalg.norm(unwrapped, axis=1).max() <= LONGEST * longest
    stand_out = np.linalg.norm(steps[jumping], axis=1).min() >= STEPS * longest
    sizes = {"xyz"[axis]: float(box[axis]) for axis in np.flatnonzero(through.any(axis=0))}
    return (np.flatnonzero(jumping), sizes) if short_again and stand_out else (np.zeros(0, np.int64), {})
