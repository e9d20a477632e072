"""The core's engines: each works for a slice at a time, and has a status, a best state and one to save."""

from sono._core import Collapse, Polish, PolishStatus, Status, Tightener
from sono.curve import Components, Measures

Engine = Collapse | Tightener | Polish

Seen = tuple[Status | PolishStatus, Components]

SLICE = 0.1
"""Seconds between two looks at the run."""

_ENGINES: dict[str, type[Engine]] = {engine.__name__: engine for engine in (Collapse, Tightener, Polish)}


def as_seen(worker: Engine) -> Seen:
    """Return where an engine stands, and its best state."""
    return worker.status(), worker.best()


def advanced(worker: Engine) -> Seen:
    """Let an engine work for a slice; return where it stands then, and its best state."""
    return worker.advance(SLICE), worker.best()


def saved(engine: Engine | None) -> list[str] | None:
    """Return an engine as texts; `restored` is the inverse."""
    return engine and [type(engine).__name__, engine.state()]


def restored(state: list[str] | None) -> Engine | None:
    """Return the engine that was saved so. Raises an error of any kind for what is no state."""
    return _ENGINES[state[0]].restore(state[1]) if state else None


def measures_of(worker: Engine) -> Measures:
    """Return what an engine's best state measures."""
    return Measures.of(worker.status().best)


def rank(polish: Polish) -> tuple[bool, float]:
    """Order tight ropes before others, then the shorter before the longer."""
    status = polish.status()
    return status.outcome != "tight", status.best.l_p
