"""From any closed curve to tight ones: the ladder of n, and the loop that runs each of its rungs.

A `Run` collapses the curve, then climbs for each n asked for: anneal at a coarse n, where beads rearrange
most freely, refine the inscribed knot to twice the vertices and anneal a little more, then settle, refine and
settle again until n is reached. Rust does the work in slices of a tenth of a second; between slices a caller
may show progress, save or stop.
"""

import json
import math
import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from operator import index
from typing import Any, Literal, Self, cast

import numpy as np
from numpy.typing import ArrayLike, NDArray

from sono import _core
from sono._core import Measures, Status, Tightener

Curve = list[NDArray[np.float64]]
Stage = Literal["collapse", "anneal", "reanneal", "settle"]

SLICE = 0.1
"""Seconds between two looks at the run."""

COARSE = 0.7
"""Edges of a rope that is annealed are at most so long, and at least half of it, where n allows; in radii."""

FINE = 0.5
"""Edges of a tight rope that is refined to the next n are at most so long; in radii."""


class Stopped(Exception):  # noqa: N818 - no error, a request that was followed
    """The run was stopped before its end; what it has is in `Run.best`."""


def as_curve(vertices: ArrayLike | Sequence[ArrayLike]) -> Curve:
    """Return the components, (n_i, 3) each, of an (n, 3) array or a sequence of such. Raises `ValueError`."""
    try:
        whole = [np.array(vertices, dtype=np.float64)]
    except ValueError:  # components of unequal length
        whole = []
    if not whole or whole[0].ndim == 3:
        whole = [np.array(component, dtype=np.float64) for component in cast("Sequence[ArrayLike]", vertices)]
    for component in whole:
        if component.ndim != 2 or component.shape[1] != 3:
            raise ValueError(f"vertices must have the shape (n, 3), not {component.shape}")
    return whole


def default_settings() -> dict[str, Any]:
    """Return SONO's settings by name: see `rust/settings.rs` or the README for what they mean."""
    return cast("dict[str, Any]", json.loads(_core.default_settings()))


def check_settings(settings: dict[str, Any]) -> None:
    """Raise `ValueError` for an unknown setting or a value out of its range."""
    unknown = settings.keys() - default_settings().keys()
    if unknown:
        known = ", ".join(default_settings())
        raise ValueError(f"unknown setting {min(unknown)!r}; the settings are: {known}")
    # The core checks the values when a stage begins, which on a triangle costs nothing.
    Tightener([np.eye(3)], "settle", 60, json.dumps(settings, allow_nan=False))


def measure(vertices: ArrayLike | Sequence[ArrayLike]) -> Measures:
    """Measure a curve at the scale it has: an (n, 3) array, or one such array for each component of a link.

    Raises `CurveError` for one that is no embedded closed curve. Definitions: Baranska, Pieranski, Rawdon,
    "Ropelength of tight polygonal knots", section 2; for unequal edges L_c stays an upper bound.
    """
    return _core.measure(as_curve(vertices))


def tighten(
    vertices: ArrayLike | Sequence[ArrayLike],
    n: int = 480,
    *,
    seed: int = 0,
    time_limit: float | None = None,
    settings: dict[str, Any] | None = None,
    watch: "Callable[[Progress], None]" = lambda _: None,
) -> "Tight":
    """Tighten a curve of any scale with SONO to a rope of `n` vertices, all components together.

    After `time_limit` seconds the best state so far is returned, with `converged` False. `settings` replaces
    some of `default_settings()`. `watch` is called about ten times a second; KeyboardInterrupt passes through
    it. Raises `CurveError` for a curve that cannot be tightened, `ValueError` for a wrong n or setting.
    """
    run = Run(as_curve(vertices), [index(n)], {**(settings or {}), "seed": index(seed)})
    end = math.inf if time_limit is None else time.monotonic() + time_limit

    def watch_time(progress: Progress) -> None:
        watch(progress)
        if time.monotonic() > end:
            raise Stopped

    try:
        return run.tighten(watch_time)
    except Stopped:
        return run.best()


@dataclass(frozen=True)
class Tight:
    """A tightened curve.

    `curve` holds one (n_i, 3) array for each component, scaled to R_s = 1; `measures` is what it measures.
    `converged` tells whether dispersion and overlaps reached the tolerance that the settings ask for.
    `sweeps` and `seconds` count from the start of the run.
    """

    curve: Curve
    measures: Measures
    converged: bool
    sweeps: int
    seconds: float


@dataclass(frozen=True)
class Progress:
    """Where a run stands: the rung it is on (`stage`, `n`), the n it climbs to, and the core's status."""

    stage: Stage
    n: int
    target: int
    status: Status


@dataclass
class Run:
    """A tightening that can be stopped, saved and resumed at any slice.

    `curve` is any embedded closed curve at any scale; `targets` are the numbers of vertices still wanted, all
    components together, in increasing order. Raises `ValueError` for a wrong target or setting.
    """

    curve: Curve
    targets: list[int]
    settings: dict[str, Any]
    rungs: list[tuple[Stage, int]] = field(default_factory=lambda: [("collapse", 0)])
    loose: Curve | None = None
    tightener: Tightener | None = None
    sweeps: int = 0
    seconds: float = 0.0

    def __post_init__(self) -> None:
        """Refuse what no run could do, before anything is computed."""
        self.targets = sorted(set(self.targets))
        least = 3 * len(self.curve)
        if self.targets and self.targets[0] < least:
            raise ValueError(
                f"n = {self.targets[0]} is too small; 3 vertices for each component make {least} at least"
            )
        check_settings(self.settings)

    def tighten(self, watch: Callable[[Progress], None] = lambda _: None) -> Tight:
        """Tighten at the first target; `watch` is called between slices and may raise `Stopped`.

        Called once more it gives the same again. Raises `CurveError` for a curve that cannot be tightened,
        or not with so few vertices.
        """
        while True:
            outcome = self._climb(watch)
            if self.rungs == [("settle", self.targets[0])]:
                return self._tight(outcome == "tight")
            self._leave()

    def next_target(self) -> None:
        """Turn from the first target, reached or out of reach, to the next."""
        self._leave()
        self.targets.pop(0)
        if self.targets:
            self.rungs = self._ladder()

    def best(self) -> Tight:
        """Return the best state of the rung on which `tighten` was stopped, as unconverged as it is."""
        return self._tight(False)

    def state(self) -> dict[str, Any]:
        """Return all that is needed to go on later, for JSON; `Run.restore` is its inverse."""
        return {
            **vars(self),
            "curve": [component.tolist() for component in self.curve],
            "loose": self.loose and [component.tolist() for component in self.loose],
            "tightener": self.tightener and self.tightener.state(),
        }

    @classmethod
    def restore(cls, state: dict[str, Any]) -> Self:
        """Return the run that gave this state; it goes on as if it had never stopped."""
        return cls(
            **state
            | {
                "curve": as_curve(state["curve"]),
                "loose": state["loose"] and as_curve(state["loose"]),
                "tightener": state["tightener"] and Tightener.restore(state["tightener"]),
                "rungs": [(stage, n) for stage, n in state["rungs"]],
            }
        )

    def _climb(self, watch: Callable[[Progress], None]) -> str:
        """Run the first rung to its end; return the outcome."""
        stage, n = self.rungs[0]
        if self.tightener is None:
            self.tightener = Tightener(self.curve, stage, n, json.dumps(self.settings))
        while True:
            start = time.perf_counter()
            status = self.tightener.advance(SLICE)
            self.seconds += time.perf_counter() - start
            if status.outcome != "running":
                return status.outcome
            watch(Progress(stage, n or status.best.n, self.targets[0], status))

    def _leave(self) -> None:
        """Take over what the first rung has reached, and plan the next ones if there are none."""
        if self.tightener is None:
            return
        tight = self.best()
        self.curve, self.sweeps = tight.curve, tight.sweeps
        self.tightener = None
        stage, _ = self.rungs.pop(0)
        if stage == "collapse":
            self.loose = self.curve
            self.rungs = self._ladder()

    def _tight(self, converged: bool) -> Tight:
        assert self.tightener is not None
        status = self.tightener.status()
        sweeps = self.sweeps + status.sweeps
        return Tight(self.tightener.best(), status.best, converged, sweeps, self.seconds)

    def _ladder(self) -> list[tuple[Stage, int]]:
        """Plan the rungs from here to the next target, halving n as long as the rope stays fine enough."""
        assert self.loose is not None
        length = _core.measure(self.loose).l_p
        n = self.targets[0]
        have = sum(map(len, self.curve))
        climbing = self.curve is not self.loose and length / have < FINE
        levels = [n]
        while levels[0] // 2 > have if climbing else 2 * length / levels[0] < COARSE:
            levels.insert(0, levels[0] // 2)
        if climbing:
            return [("settle", level) for level in levels]
        self.curve = self.loose
        coarsest, *finer = levels
        anneals: list[tuple[Stage, int]] = [("anneal", coarsest), *(("reanneal", n) for n in finer[:1])]
        return anneals + [("settle", level) for level in finer or [coarsest]]
