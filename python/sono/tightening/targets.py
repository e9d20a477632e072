"""What a rope is to have: a number of vertices, or edges of a length."""

from collections.abc import Sequence
from typing import get_args

from sono.curve import Components
from sono.tightening.settings import LEAST_DL, MOST, MOST_DL, Method

Target = int | float
"""What a rope is to have: so many vertices, an int, or edges of this length in radii, a float."""

COARSE = 0.7
"""Edges of a shape as it is found are at most so long, and at least half of it, where n allows; in radii."""


def aimed(target: Target, length: float) -> int:
    """Return the number of vertices that a rope of this length has then."""
    return target if isinstance(target, int) else max(round(length / target), 3)


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


def coarse_first(targets: Sequence[Target]) -> list[Target]:
    """Put targets in order, each of them once."""
    return sorted(set(targets), key=lambda target: target if isinstance(target, int) else -target)


def check(curve: Components, targets: Sequence[Target], method: str, trials: int) -> None:
    """Refuse what no run could do, before anything is computed."""
    least = 3 * len(curve)
    for target in targets:
        if not isinstance(target, int):
            if not LEAST_DL <= target <= MOST_DL:
                raise ValueError(f"dl = {target} is no edge length from {LEAST_DL:g} to {MOST_DL:g} radii")
        elif target > MOST:
            raise ValueError(f"n = {target} is too large; {MOST:,} vertices are the most")
        elif target < least:
            raise ValueError(
                f"n = {target} is too small; 3 vertices for each component make {least} at least"
            )
    if method not in get_args(Method):
        raise ValueError(f"unknown method {method!r}; the methods are: {', '.join(get_args(Method))}")
    if trials < 1:
        raise ValueError(f"trials = {trials} is too small; 1 is the least")
