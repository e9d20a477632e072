"""One curve, one target, one call."""

import time
from collections.abc import Callable
from typing import Any

from sono.curve import Components
from sono.tightening.results import Progress, Stopped, Tight
from sono.tightening.run import Run
from sono.tightening.settings import Changes, Settings, whole


class _Enough(Stopped):
    """The time limit was reached, or who watches has seen enough."""


def polished(curve: Components, n: int, watch: Callable[[], None]) -> Tight:
    """Polish a rope on n vertices; `watch` is called about ten times a second, and may raise."""
    return Run(curve, [n], {}, "polish").tighten(lambda _: watch())


def best_of(run: Run, seconds: float, watch: Callable[[Progress], object]) -> Tight:
    """Tighten at a run's first target, or return the best when time is up or `watch` returns True."""
    end = time.monotonic() + seconds

    def look(progress: Progress) -> None:
        if watch(progress) is True or time.monotonic() > end:
            raise _Enough

    try:
        return run.tighten(look)
    except _Enough:
        return run.best()


def changed(settings: Settings | Changes | None, seed: int | None) -> dict[str, Any]:
    """Return the settings that are not what they are by default, the seed among them. Raises `ValueError`."""
    changes = settings.changes() if isinstance(settings, Settings) else dict(settings or {})
    if seed is None:
        return changes
    if "seed" in changes:
        raise ValueError("the seed is given twice, as an argument and in the settings")
    return changes | {"seed": whole("seed", seed)}
