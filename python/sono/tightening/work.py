"""What the engines did, stage by stage: the moves that were shown to let no strand pass, and those undone."""

from collections.abc import Iterable
from dataclasses import dataclass, field
from typing import Any, Self

from sono._core import Collapse
from sono.curve import Components
from sono.records import Record
from sono.tightening.engines import Engine, Status, status_of


@dataclass(frozen=True, repr=False, eq=False)
class Work(Record):
    """What was done in a stage, on `n` vertices; where it belongs to a trial, in this `trial`, from 1.

    `moves` of all beads, each of many `sweeps` of SONO or of one of the polish's `steps`, were shown to let
    no strand pass; `undone` are those that were not, and `lost` the sweeps which that cost. The theorem asks
    that beads which count stay further apart than the longest edge is long, over sqrt 2: `margin` is the
    least ratio of the two that was met, and above 1. Loosening, by moves that are exact, `moved` vertices one
    by one and `removed` others.

    >>> import sono
    >>> [(work.stage, work.undone, work.margin > 1) for work in sono.tighten("3_1", 240).path]
    [('polish', 0, True)]
    """

    stage: str
    n: int
    trial: int | None = None
    sweeps: int = 0
    lost: int = 0
    steps: int = 0
    factorisations: int = 0
    moves: int = 0
    undone: int = 0
    margin: float | None = None
    moved: int = 0
    removed: int = 0

    @classmethod
    def of(cls, status: Status, stage: str, trial: int | None = None) -> Self:
        """Take the counts over from where an engine stands."""
        counts = {key: getattr(status, key) for key in (*_COUNTS, "margin")}
        return cls(stage, status.best.n, trial, steps=status.iterations, **counts)


_COUNTS = ("sweeps", "lost", "factorisations", "moves", "undone")


def total(works: Iterable[Work]) -> dict[str, Any]:
    """Add up what was done, with the least margin."""
    listed = list(works)
    margins = [work.margin for work in listed if work.margin is not None]
    summed = (*_COUNTS, "steps", "moved", "removed")
    sums: dict[str, Any] = {key: sum(getattr(work, key) for work in listed) for key in summed}
    return sums | {"margin": min(margins, default=None)}


@dataclass
class Log:
    """All that was done for a plan, and after which of these stages its curve, shape and start came to be.

    `after` has for each stage the place of the one that it went on from. There None is the curve that was
    given, or a shape that is known.
    """

    works: list[Work] = field(default_factory=list)
    after: list[int | None] = field(default_factory=list)
    curve: int | None = None
    shape: int | None = None
    start: int | None = None

    def add(self, engine: Engine, stage: str, trial: int | None = None) -> Components:
        """Add what an engine did; return its rope, from which the plan goes on."""
        if isinstance(engine, Collapse) and (counts := engine.loosening()):
            loosened = sum(map(len, engine.loosened() or []))
            self._append(Work("loosen", loosened, trial, **counts))
            self.curve = self.start = len(self.works) - 1
        self.add_aside(status_of(engine), stage, trial)
        self.curve = len(self.works) - 1
        return engine.best()

    def add_aside(self, status: Status, stage: str, trial: int | None = None) -> None:
        """Add what an engine did whose rope is not used."""
        self._append(Work.of(status, stage, trial))

    def _append(self, work: Work) -> None:
        self.works.append(work)
        self.after.append(self.curve)

    def path(self, end: int | None) -> list[Work]:
        """Return the stages that led one after the other to this one, which is the last."""
        found = []
        while end is not None:
            found.append(self.works[end])
            end = self.after[end]
        return found[::-1]

    def state(self) -> dict[str, Any]:
        """Return it for JSON; `restore` is its inverse."""
        return vars(self) | {"works": [work.to_dict() for work in self.works]}

    @classmethod
    def restore(cls, state: dict[str, Any]) -> Self:
        """Return the log that gave this state. Raises an error of any kind for what is none."""
        return cls(**state | {"works": [Work(**work) for work in state["works"]]})
