"""The core's engines: each works for a slice at a time, and has a status, a best state and one to save."""

from collections.abc import Callable
from dataclasses import dataclass, fields
from typing import Any, Literal, TypeVar

from sono._core import Collapse, Polish, Tightener
from sono.curve import Components, Measures
from sono.records import Record

Engine = Collapse | Tightener | Polish

AnyEngine = TypeVar("AnyEngine", bound=Engine)

SLICE = 0.1
"""Seconds between two looks at the run."""

_ENGINES: dict[str, type[Engine]] = {engine.__name__: engine for engine in (Collapse, Tightener, Polish)}


@dataclass(frozen=True, repr=False, eq=False)
class Status(Record):
    """Where an engine stands: its `outcome`, its `progress` from 0 to 1, and what its `best` state measures.

    SONO's engines name the `stage` they are at, which may be "loosen", and count `sweeps`, and those that
    were `lost`. The polish counts `iterations` and `factorisations`, and has the largest force that is left
    over, the `residual`, tension being 1, the barrier parameter `mu`, and the `excess` over the minimum.
    Both count `moves`, and those `undone`, with the least `margin`: see `Work`.
    """

    outcome: Literal["running", "tight", "stuck"]
    progress: float
    best: Measures
    stage: str | None = None
    sweeps: int = 0
    lost: int = 0
    iterations: int = 0
    factorisations: int = 0
    moves: int = 0
    undone: int = 0
    margin: float | None = None
    residual: float | None = None
    mu: float | None = None
    excess: float | None = None

    @classmethod
    def of(cls, found: Any) -> "Status":
        """Take over what the core says."""
        known = {field.name: found[field.name] for field in fields(cls) if field.name in found}
        return cls(**known | {"best": Measures(**found["best"])})


Seen = tuple[Status, Components]


def status_of(engine: Engine) -> Status:
    """Return where an engine stands."""
    return Status.of(engine.status())


def as_seen(engine: Engine) -> Seen:
    """Return where an engine stands, and its best state."""
    return status_of(engine), engine.best()


def advanced(engine: Engine) -> Seen:
    """Let an engine work for a slice; return where it stands then, and its best state."""
    return Status.of(engine.advance(SLICE)), engine.best()


def done(engine: AnyEngine, watch: Callable[[], None]) -> AnyEngine:
    """Let an engine run to its end; `watch` is called after each slice, and may raise."""
    while engine.advance(SLICE)["outcome"] == "running":
        watch()
    return engine


def saved(engine: Engine | None) -> list[str] | None:
    """Return an engine as texts; `restored` is the inverse."""
    return engine and [type(engine).__name__, engine.state()]


def restored(state: list[str] | None) -> Engine | None:
    """Return the engine that was saved so. Raises an error of any kind for what is no state."""
    return _ENGINES[state[0]].restore(state[1]) if state else None


def rank(polish: Polish) -> tuple[bool, float]:
    """Order tight ropes before others, then the shorter before the longer."""
    status = status_of(polish)
    return status.outcome != "tight", status.best.l_p
