"""One curve, one n or one edge length, one call."""

import math
import time
from collections.abc import Callable
from functools import partial
from operator import index
from typing import Any

from sono._core import Collapse
from sono.curve import Components, CurveLike, as_components, measure
from sono.patience import patiently
from sono.tightening.engines import advanced
from sono.tightening.results import Progress, Stopped, Tight
from sono.tightening.run import Run
from sono.tightening.settings import TRIALS, Method
from sono.tightening.trial import COARSE

DEFAULT_N = 480

CLIMBS = 3
"""Attempts to come to edges of a given length, as the rope's own length changes a little meanwhile."""


class _Enough(Stopped):
    """The time limit was reached, or who watches has seen enough."""


def tighten(
    vertices: CurveLike,
    n: int | None = None,
    *,
    dl: float | None = None,
    method: Method = "both",
    trials: int = TRIALS,
    seed: int | None = None,
    time_limit: float | None = None,
    settings: dict[str, Any] | None = None,
    watch: Callable[[Progress], object] = lambda _: None,
) -> Tight:
    """Tighten a curve of any scale to a rope of n vertices, or of edges dl; see `sono.tighten`."""
    settings = settings or {}
    if seed is not None:
        if "seed" in settings:
            raise ValueError("the seed is given twice, as an argument and in the settings")
        settings = settings | {"seed": index(seed)}
    if time_limit is not None and not time_limit >= 0:
        raise ValueError(f"time_limit = {time_limit} is no number of seconds")
    if n is not None and dl is not None:
        raise ValueError("give the number n of vertices or the length dl of edges, not both")
    if dl is not None and not 0 < dl <= 1:
        raise ValueError(f"dl = {dl} is no edge length; it is in radii of the rope, above 0 and at most 1")
    curve = as_components(vertices)
    end = math.inf if time_limit is None else time.monotonic() + time_limit
    run = Run(curve, [DEFAULT_N if n is None else index(n)], settings, method, index(trials))

    def look(progress: Progress) -> None:
        if watch(progress) is True or time.monotonic() > end:
            raise _Enough

    try:
        if dl is None:
            return run.tighten(look)
        run = Run(curve, [_few(curve, dl, method, end)], settings, method, index(trials))
        tight = run.tighten(look)
        for _ in range(CLIMBS):
            wanted = round(tight.measures.l_p / dl)
            if wanted == tight.measures.n:
                break
            run.targets.append(wanted)
            run.next_target()
            tight = run.tighten(look)
        return tight
    except _Enough:
        return run.best()


def _few(curve: Components, dl: float, method: Method, end: float) -> int:
    """Return a number of vertices to begin with, by the length of the rope as it is collapsed."""

    def look() -> None:
        if time.monotonic() > end:
            raise _Enough

    length, edge = measure(curve).l_p, dl
    if method != "polish":
        collapse = Collapse(curve, False, "{}")
        while (seen := patiently(partial(advanced, collapse), look)[0]).outcome == "running":
            pass
        length, edge = seen.best.l_p, max(dl, COARSE)
    return max(round(length / edge), 3 * len(curve))
