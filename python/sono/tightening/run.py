"""The loop that runs each rung of a plan, which can be watched, stopped, saved and resumed at any slice.

A `Run` first finds a shape: SONO collapses the curve and anneals it on so few beads that they rearrange
freely, and the polish makes the result exact; several such trials compete. From the best shape the run climbs
to each n asked for, refining the inscribed knot to twice the vertices and polishing it. With the method
"sono" there is one trial, and SONO does all the rest too. Rust does the work in slices of a tenth of a
second; between slices, and while one takes longer, a caller may show progress or stop.
"""

import json
import math
import time
from collections.abc import Callable
from contextlib import suppress
from dataclasses import dataclass, field, fields, replace
from functools import partial
from typing import Any, Self, TypeVar, cast, get_args

from sono import _core
from sono._core import Collapse, CurveError, PanicError, Polish, PolishStatus, Status, Tightener
from sono.curve import Components, Curve, Measures, forces, forces_of, measure, packed, unpacked
from sono.invariants import Fingerprint, TooEntangledError, fingerprint
from sono.patience import patiently, within
from sono.tightening.engines import ENGINES, Engine, Seen, advanced, as_seen, rank
from sono.tightening.plan import (
    AGREEING,
    CLIMB,
    COARSE,
    FINE,
    HOPELESS,
    LONG,
    SAME_SHAPE,
    Rung,
    Stage,
    anneal_of,
    coarsest,
    doubled,
    is_hot,
    rank_of_shape,
)
from sono.tightening.results import KnotTypeError, Progress, Tight
from sono.tightening.settings import MOST, TRIALS, Method, check_settings, default_settings

Done = TypeVar("Done")

OFFSETS = 3


OFFSETS_TO = 1000
"""Offsets along the rope from which the last n is refined, up to this n: beads settle in other grooves each
time, which matters less the finer they are. Above it the others are tried where one did not get tight."""

COMPARED = 60_000
MOMENT = 0.3
"""The type of a stopped rope is compared if it has so few vertices, in so many seconds."""

FINER = 4
"""A state in which a run was stopped has at most so many times the vertices that were asked for."""


@dataclass
class Run:
    """A tightening that can be stopped at any time, and saved and resumed at any slice.

    `curve` is any embedded closed curve at any scale; `targets` are the numbers of vertices still wanted, all
    components together, in increasing order. Raises `ValueError` for a wrong target, method or setting.
    """

    curve: Components
    targets: list[int]
    settings: dict[str, Any]
    method: Method = "both"
    trials: int = TRIALS
    type: Fingerprint | None = None
    start: Components = field(default_factory=list)
    loosened: bool = False
    rungs: list[Rung] = field(default_factory=list)
    shape: Components | None = None
    shapes: list[float] = field(default_factory=list)
    failed: list[str] = field(default_factory=list)
    worker: Engine | None = None
    offset: int = 0
    rival: Polish | None = None
    sweeps: int = 0
    factorisations: int = 0
    seconds: float = 0.0

    def __post_init__(self) -> None:
        """Refuse what no run could do, before anything is computed."""
        self.targets = sorted(set(self.targets))
        self.busy = False
        self.seen: Seen | None = None
        if self.targets and self.targets[-1] > MOST:
            raise ValueError(f"n = {self.targets[-1]} is too large; {MOST:,} vertices are the most")
        least = 3 * len(self.curve)
        if self.targets and self.targets[0] < least:
            raise ValueError(
                f"n = {self.targets[0]} is too small; 3 vertices for each component make {least} at least"
            )
        if self.method not in get_args(Method):
            raise ValueError(
                f"unknown method {self.method!r}; the methods are: {', '.join(get_args(Method))}"
            )
        if self.trials < 1:
            raise ValueError(f"trials = {self.trials} is too small; 1 is the least")
        check_settings(self.settings)
        self.start = self.start or self.curve
        if self.targets and not self.rungs:
            self.rungs = self._climb_to_target() if self.method == "polish" else [("collapse", 0)]

    def tighten(self, watch: Callable[[Progress], None] = lambda _: None) -> Tight:
        """Tighten at the first target; `watch` is called five times a second or more and may raise `Stopped`.

        Called once more it gives the same again. A trial that fails is only one trial less. Raises
        `CurveError` for a curve that cannot be tightened, or not with so few vertices, and `KnotTypeError`.
        """
        look = partial(self._look, watch)
        if self.type is None:
            with suppress(TooEntangledError):  # the collapsed rope is less so, as a rule
                self.type = patiently(partial(fingerprint, self.curve), look)
        while True:
            try:
                self._climb(look)
                self._check_type(look)
            except _FAILURES as error:
                self._fail(error)
                continue
            if self._is_last():
                return self._ended(self._better(), look)
            if self.rungs == [("polish", self.targets[0])]:
                self.rival, self.worker = cast("Polish", self._better()), None
                self.offset += 1
            else:
                self._leave()

    def next_target(self) -> None:
        """Turn from the first target, reached or out of reach, to the next."""
        reached = self.worker is not None
        self.offset, self.rival = 0, None
        self._leave()
        self.targets.pop(0)
        if not self.targets:
            return
        measures = measure(self.curve)
        edge = measures.l_p / (measures.n * measures.r_s)
        if self.method == "sono" and self.shape:
            fine = reached and edge < FINE
            self.rungs = self._climb_to_target() if fine else self._anneal()
        elif self.method == "polish" or (reached and edge < COARSE):
            self.rungs = self._climb_to_target()
        elif self.shape and not reached:  # it could not be refined to that n
            self.curve, self.rungs = self.shape, self._climb_to_target()
        else:  # what suits so few beads may not suit more of them
            self.curve, self.rungs = self.start, [("collapse", 0)]
            self.shape, self.shapes, self.failed = None, [], []

    def best(self) -> Tight:
        """Return the best state as `tighten` was stopped, as unconverged as it is, without forces.

        Where the worker is busy still, this is how it was last seen; before any was, the curve as given.
        """
        if self.worker and not self.busy:
            self.seen = as_seen(self.worker)
        status, curve = (self.rival and as_seen(self.rival)) or self.seen or (None, self.curve)
        if self.method == "both" and self.shape and self.rungs[0][0] not in ("climb", "polish"):
            curve = self.shape  # In the middle of another trial the best shape so far is better.
        elif not self._has_type(curve):
            curve = self.curve
        curve, measures = _unit(_coarser(curve, self.targets[0]))
        return replace(self._tight(status, curve, measures), converged=False)

    def _has_type(self, curve: Components) -> bool:
        """Tell whether a curve has the type of the one that was given, as far as a moment suffices."""
        if self.type is None or sum(map(len, curve)) > COMPARED:
            return True
        try:
            return within(MOMENT, partial(fingerprint, curve)) in (self.type, None)
        except TooEntangledError:
            return True

    @property
    def at_rest(self) -> bool:
        """Whether nobody is at work on the run, so that its `state` can be taken."""
        return self.worker is None or not self.busy

    def state(self) -> dict[str, Any]:
        """Return all that is needed to go on later, for JSON; `Run.restore` is its inverse."""
        curves = {name: packed(getattr(self, name)) for name in ("curve", "start", "shape")}
        engines = {
            "worker": self.worker and [type(self.worker).__name__, self.worker.state()],
            "rival": self.rival and self.rival.state(),
        }
        return {own.name: getattr(self, own.name) for own in fields(self)} | curves | engines

    @classmethod
    def restore(cls, state: dict[str, Any]) -> Self:
        """Return the run that gave this state; it goes on as if it had never stopped.

        Raises an error of any kind for what is no state.
        """
        curves = {name: unpacked(state[name]) for name in ("curve", "start", "shape")}
        rungs = [(stage, n) for stage, n in state["rungs"]]
        rival = state["rival"] and Polish.restore(state["rival"])
        type = state["type"] and tuple(map(tuple, state["type"]))
        run = cls(**state | curves | {"type": type, "rungs": rungs, "worker": None, "rival": rival})
        if state["worker"]:
            engine, worker = state["worker"]
            run.worker = ENGINES[engine].restore(worker)
        return run

    def _climb(self, look: Callable[[], None]) -> None:
        """Run the first rung to its end."""
        if self.worker is None:
            self.seen = None
            self.worker = self._busily(partial(self._engine, *self.rungs[0]), look)
            self.seen = as_seen(self.worker)
            look()  # here too, since many a rung takes less than a slice
        while True:
            start = time.perf_counter()
            status, curve = self._busily(partial(advanced, self.worker), look)
            self.seconds += time.perf_counter() - start
            if status.outcome != "running":
                return
            self.seen = status, curve
            look()

    def _busily(self, call: Callable[[], Done], look: Callable[[], None]) -> Done:
        """Have the worker do what may take long."""

        def work() -> Done:
            try:
                return call()
            finally:
                self.busy = False

        self.busy = True
        return patiently(work, look)

    def _look(self, watch: Callable[[Progress], None]) -> None:
        """Show where the run stands."""
        stage, n = self.rungs[0]
        status = self.seen and self.seen[0]
        n = n or (status.best.n if status else sum(map(len, self.curve)))
        watch(Progress(stage, n, self.targets[0], self._trials_done() + 1, status))

    def _check_type(self, look: Callable[[], None]) -> None:
        """Compare what a rung has ended in with the curve that was given."""
        assert self.worker is not None
        found = patiently(partial(fingerprint, self.worker.best()), look)
        self.type = self.type or found
        if found != self.type:
            stage, n = self.rungs[0]
            raise KnotTypeError(f"the {stage} at n = {n} came out as another knot; please report this curve")

    def _is_last(self) -> bool:
        """Tell whether nothing but the worker is between here and the first target."""
        n = self.targets[0]
        if self.rungs != [("polish", n)]:
            return self.rungs == [("settle", n)]
        assert self.worker is not None
        stuck = self.worker.status().outcome != "tight"
        several = (n <= OFFSETS_TO or stuck) and sum(map(len, self.curve)) != n
        return self.offset + 1 >= (OFFSETS if several else 1)

    def _better(self) -> Engine:
        """Return the better of the worker, which is done, and its rival; the other one's work is added up."""
        assert self.worker is not None
        if not (self.rival and isinstance(self.worker, Polish)):
            return self.worker
        better, worse = sorted((self.worker, self.rival), key=rank)
        self.factorisations += worse.status().factorisations
        self.worker, self.rival = better, None
        return better

    def _engine(self, stage: Stage, n: int) -> Engine:
        """Begin a rung."""
        trial = self._trials_done()
        seed = (self.settings.get("seed", 0) + trial + self.offset) % 2**64
        if stage == "trial" or stage == "climb" or stage == "polish":
            return Polish(self.curve, n, stage == "climb", seed)
        settings = self.settings | {"seed": seed}
        if self.method == "both":
            settings |= anneal_of(trial, default_settings() | self.settings)
        if stage == "collapse":
            return Collapse(self.curve, self.loosened, json.dumps(settings))
        try:
            return Tightener(self.curve, stage, n, json.dumps(settings))
        except CurveError:
            if self.method != "both" or stage != "anneal" or n == self.rungs[1][1]:
                raise
            # So few beads are too coarse for some component; those of the shape may do.
            return Tightener(self.curve, stage, self.rungs[1][1], json.dumps(settings))

    def _leave(self) -> None:
        """Take over what the first rung has reached, and plan the next ones if there are none."""
        if self.worker is None:
            return
        status, curve = as_seen(self.worker)
        tight = self._tight(status, curve, Measures.of(status.best))
        self.curve, self.sweeps, self.factorisations = tight.curve, tight.sweeps, tight.factorisations
        if isinstance(self.worker, Collapse) and (loosened := self.worker.loosened()):
            self.start, self.loosened = loosened, True  # once for all trials
        self.worker = None
        stage, _ = self.rungs.pop(0)
        if stage == "collapse":
            if self.method == "sono":
                self.shape = self.curve
                self.rungs = self._anneal()
            else:
                self.rungs = self._trial(tight.measures.l_p)
        elif stage == "trial":
            self._compare(tight.measures)
            self._next_trial()

    def _fail(self, error: CurveError | PanicError | KnotTypeError) -> None:
        """Do without the trial, or the offset, that failed; raise its error where there is nothing else."""
        self.worker = None
        stage, _ = self.rungs[0]
        if self.rival:
            self.worker, self.rival, self.offset = self.rival, None, OFFSETS
            return
        few = self.targets[0]
        needed = error.needed or math.inf if isinstance(error, CurveError) else 0
        hopeless = not self.shapes and needed > HOPELESS * few
        if self.method != "both" or stage in ("climb", "polish") or hopeless:
            raise error
        self.failed.append(str(error))
        if not self.shapes and len(self.failed) >= min(AGREEING, self.trials):
            raise error
        self._next_trial()

    def _next_trial(self) -> None:
        """Plan another trial, or, where there were enough, the climb from the best shape."""
        if self._enough():
            self.curve, self.rungs = cast("Components", self.shape), self._climb_to_target()
        else:
            self.curve, self.rungs = self.start, [("collapse", 0)]

    def _trials_done(self) -> int:
        return len(self.shapes) + len(self.failed)

    def _trial(self, length: float) -> list[Rung]:
        """Plan the rest of a trial for a rope of this length."""
        # Edges of other lengths find other shapes; multiples of the golden ratio spread them evenly.
        trial = self._trials_done()
        least, most = (0.92, 1.1) if is_hot(trial) else (0.6, 0.9)
        edge = least + (most - least) * ((0.5 + trial // 2 * (math.sqrt(5) - 1) / 2) % 1)
        n = coarsest(self.targets[0], length)
        return [("anneal", min(n, max(int(length / edge), 3 * len(self.curve)))), ("trial", n)]

    def _compare(self, measures: Measures) -> None:
        """Keep the shape of a trial if it is the best."""
        if self.shape is None or rank_of_shape(measures) < rank_of_shape(measure(self.shape)):
            self.shape = self.curve
        self.shapes.append(measures.l_a or measures.l_p)

    def _enough(self) -> bool:
        """Tell whether another trial is not worth it."""
        if self._trials_done() >= self.trials:
            return True
        agree = self.shapes and max(self.shapes) < (1 + SAME_SHAPE) * min(self.shapes)
        long = self.shapes and min(self.shapes) > LONG
        return bool(agree or long) and len(self.shapes) >= AGREEING

    def _tight(self, status: Status | PolishStatus | None, curve: Components, measures: Measures) -> Tight:
        tight = Tight(
            Curve(curve),
            measures,
            status is not None and status.outcome == "tight",
            list(self.shapes),
            list(self.failed),
            self.loosened,
            self.sweeps,
            self.factorisations,
            self.seconds,
        )
        if isinstance(status, Status):
            return replace(tight, sweeps=self.sweeps + status.sweeps)
        if isinstance(status, PolishStatus):
            return replace(tight, factorisations=self.factorisations + status.factorisations, mu=status.mu)
        return tight

    def _ended(self, worker: Engine, look: Callable[[], None]) -> Tight:
        """Return what the last rung has ended in, with the forces in it."""
        status, curve = as_seen(worker)
        tight = self._tight(status, curve, Measures.of(status.best))
        if not isinstance(worker, Polish):
            return tight
        if not tight.converged:
            # The best state is not the last, to which the multipliers belong.
            fitted = patiently(partial(forces, curve), look)
            return replace(tight, residual=fitted.residual, forces=fitted)
        found = worker.status()
        own = forces_of(worker.forces(), tight.curve.components)
        return replace(tight, residual=found.residual, excess=found.excess, forces=own)

    def _anneal(self) -> list[Rung]:
        """Plan SONO's rungs from the collapsed rope to the next target."""
        assert self.shape is not None
        self.curve = self.shape
        n = self.targets[0]
        few = coarsest(n, measure(self.shape).l_p)
        finer = doubled(few, n)
        anneals: list[Rung] = [("anneal", few), *(("reanneal", n) for n in finer[:1])]
        return anneals + [("settle", level) for level in finer or [few]]

    def _climb_to_target(self) -> list[Rung]:
        """Plan the rungs from a tight rope to the next target."""
        between, last = CLIMB[self.method]
        *levels, n = doubled(sum(map(len, self.curve)), self.targets[0]) or self.targets[:1]
        return [*((between, level) for level in levels), (last, n)]


_FAILURES = (CurveError, PanicError, KnotTypeError)
"""What ends a trial, and not always the run."""


def _unit(curve: Components) -> tuple[Components, Measures]:
    """Return a curve scaled to R_s = 1, and what it measures."""
    measures = measure(curve)
    if abs(measures.r_s - 1) < 1e-9:
        return curve, measures
    curve = [component / measures.r_s for component in curve]
    return curve, measure(curve)


def _coarser(curve: Components, n: int) -> Components:
    """Return a rope, with fewer vertices where it has far more than n; the knot stays the same."""
    if sum(map(len, curve)) <= FINER * n:
        return curve
    needed = max(n, math.ceil(measure(curve).l_p / FINE))
    if needed <= FINER * n:
        coarse = _core.refine(curve, needed)
        if fingerprint(coarse) == fingerprint(curve):
            return coarse
    return _core.simplify(curve)
