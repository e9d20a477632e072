"""One curve, one n or one edge length, one call."""

import math
import time
from collections.abc import Callable

from sono.curve import CurveLike, as_components
from sono.tightening.results import Progress, Stopped, Tight
from sono.tightening.run import Run
from sono.tightening.settings import TRIALS, Changes, Method, Settings, whole

DEFAULT_N = 480


class _Enough(Stopped):
    """The time limit was reached, or who watches has seen enough."""


def unseen(progress: Progress) -> None:
    """Watch nothing."""


def tighten(
    vertices: CurveLike,
    n: int | None = None,
    *,
    dl: float | None = None,
    method: Method = "both",
    trials: int = TRIALS,
    seed: int | None = None,
    time_limit: float | None = None,
    settings: Settings | Changes | None = None,
    watch: Callable[[Progress], object] = unseen,
) -> Tight:
    """Tighten a curve of any scale to a rope of n vertices, or of edges dl; see `sono.tighten`."""
    settings = settings.changes() if isinstance(settings, Settings) else dict(settings or {})
    if seed is not None:
        if "seed" in settings:
            raise ValueError("the seed is given twice, as an argument and in the settings")
        settings = settings | {"seed": whole("seed", seed)}
    if time_limit is not None and not time_limit >= 0:
        raise ValueError(f"time_limit = {time_limit} is no number of seconds")
    if n is not None and dl is not None:
        raise ValueError("give the number n of vertices or the length dl of edges, not both")
    target = float(dl) if dl is not None else DEFAULT_N if n is None else whole("n", n)
    run = Run(as_components(vertices), [target], settings, method, whole("trials", trials))
    end = math.inf if time_limit is None else time.monotonic() + time_limit

    def look(progress: Progress) -> None:
        if watch(progress) is True or time.monotonic() > end:
            raise _Enough

    try:
        return run.tighten(look)
    except _Enough:
        return run.best()
