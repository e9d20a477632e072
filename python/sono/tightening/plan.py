"""Which rungs lead to a tight rope, and what each is begun with.

A trial collapses the curve, anneals it on few beads and polishes it there: its rungs are "collapse", "anneal"
and "trial". From the best shape "climb" rungs, each with twice the vertices of the one before, lead to the
last, a "polish". With the method "sono" there is one trial, and "settle" rungs in place of the polished ones.
"""

from typing import Any, Literal

from sono.curve import Measures
from sono.tightening.settings import Method

Stage = Literal["collapse", "anneal", "reanneal", "settle", "trial", "climb", "polish"]

Rung = tuple[Stage, int]

COARSE = 0.7
"""Edges of a shape as it is found are at most so long, and at least half of it, where n allows; in radii."""

FINE = 0.5
"""Edges of a rope that SONO refines to the next n are at most so long; in radii."""

AGREEING = 4
LONG = 150
"""A run whose first trials, so many, end in the same shape makes no more; nor does one of a rope so long, in
radii: its trials take seconds, each ends in another shape, and a search goes further."""

SAME_SHAPE = 1e-5
"""Relative difference in L_a up to which two shapes count as the same."""

UNEQUAL = 1e-3
"""Dispersion above which a shape is second to one of equal edges, as its length does not compare: forces may
balance without tension in some edge of a coarse rope, which is shorter then."""

HOPELESS = 1.3
"""A run whose first trial needs so many times the vertices asked for makes no other: what trials from one
curve need differs by a few percent as a rule, and by a sixth at most as far as is known."""

HOT = 0.5
"""Violation tolerated at the start of every other trial's anneal; it crosses higher barriers."""

CLIMB: dict[Method, tuple[Stage, Stage]] = {
    "both": ("climb", "polish"),
    "polish": ("climb", "polish"),
    "sono": ("settle", "settle"),
}


def rank_of_shape(measures: Measures) -> tuple[bool, bool, float]:
    """Order shapes of equal edges before others, those with an L_c before others, then by length."""
    return measures.dispersion > UNEQUAL, measures.l_a is None, measures.l_a or measures.l_p


def is_hot(trial: int) -> bool:
    """Tell whether a trial is to have a hot anneal."""
    return trial % 2 == 1


def anneal_of(trial: int, settings: dict[str, Any]) -> dict[str, Any]:
    """Return the anneal of a trial: a short one, as it has to find a shape only, and every other one hot."""
    sweeps = max(settings["anneal_sweeps"] // 10, 1)
    tolerance = HOT if is_hot(trial) else settings["anneal_tolerance"]
    return {"anneal_sweeps": sweeps, "anneal_tolerance": tolerance}


def coarsest(n: int, length: float) -> int:
    """Halve n as long as the edges of a rope of this length stay short enough."""
    while 2 * length / n < COARSE:
        n //= 2
    return n


def doubled(have: int, n: int) -> list[int]:
    """Return the levels above `have` that lead to n by doubling."""
    levels: list[int] = []
    while n > have:
        levels.insert(0, n)
        n //= 2
    return levels
