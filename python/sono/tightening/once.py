"""One curve, one n, one call."""

import math
import time
from collections.abc import Callable
from operator import index
from typing import Any

from sono.curve import CurveLike, as_components
from sono.tightening.results import Progress, Stopped, Tight
from sono.tightening.run import Run
from sono.tightening.settings import TRIALS, Method


class _TimeIsUp(Stopped):
    """The time limit of `tighten` was reached."""


def tighten(
    vertices: CurveLike,
    n: int = 480,
    *,
    method: Method = "both",
    trials: int = TRIALS,
    seed: int | None = None,
    time_limit: float | None = None,
    settings: dict[str, Any] | None = None,
    watch: "Callable[[Progress], None]" = lambda _: None,
) -> "Tight":
    """Tighten a curve of any scale to a rope of `n` vertices, all components together.

    With the method "both" SONO finds shapes in up to `trials` trials and the polish makes the best one exact;
    "sono" and "polish" do without the other. After `time_limit` seconds the best state so far is returned,
    with `converged` False. `settings` replaces some of `default_settings()`, which are SONO's; the seed may
    be given there instead. `watch` is called about ten times a second; what it raises ends the run and passes
    through. Raises `CurveError` for a curve that cannot be tightened (with so few vertices), `ValueError` for
    a wrong n, method or setting. A rope of another knot type than the curve is never returned:
    `KnotTypeError`.
    """
    settings = settings or {}
    if seed is not None:
        if "seed" in settings:
            raise ValueError("the seed is given twice, as an argument and in the settings")
        settings = settings | {"seed": index(seed)}
    if time_limit is not None and not time_limit >= 0:
        raise ValueError(f"time_limit = {time_limit} is no number of seconds")
    run = Run(as_components(vertices), [index(n)], settings, method, index(trials))
    end = math.inf if time_limit is None else time.monotonic() + time_limit

    def watch_time(progress: Progress) -> None:
        watch(progress)
        if time.monotonic() > end:
            raise _TimeIsUp

    try:
        return run.tighten(watch_time)
    except _TimeIsUp:
        return run.best()
