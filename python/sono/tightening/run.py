"""From any closed curve to tight ones: the plan of a run, and the loop that runs each of its rungs.

A `Run` first finds a shape: SONO collapses the curve and anneals it on so few beads that they rearrange
freely, and the polish makes the result exact; several such trials compete. From the best shape the run climbs
to each n asked for, refining the inscribed knot to twice the vertices and polishing it. With the method
"sono" there is one trial, and SONO does all the rest too. Rust does the work in slices of a tenth of a
second; between slices, and while one takes longer, a caller may show progress or stop.
"""

import json
import math
import sys
import time
from collections.abc import Callable, Sequence
from contextlib import suppress
from dataclasses import dataclass, field, fields, replace
from functools import partial
from operator import index
from typing import Any, Literal, Self, TypeVar, cast, get_args

import numpy as np
from numpy.typing import ArrayLike, NDArray

from sono import _core
from sono._core import Collapse, CurveError, Measures, PanicError, Polish, PolishStatus, Status, Tightener
from sono.invariants.identify import Curve, Fingerprint, TooEntangledError, fingerprint
from sono.jobs.checkpoints import packed, unpacked
from sono.patience import patiently, within

Method = Literal["both", "sono", "polish"]
Stage = Literal["collapse", "anneal", "reanneal", "settle", "trial", "climb", "polish"]
Rung = tuple[Stage, int]
Engine = Collapse | Tightener | Polish
Seen = tuple[Status | PolishStatus, Curve]
Done = TypeVar("Done")

SLICE = 0.1
"""Seconds between two looks at the run."""

COARSE = 0.7
"""Edges of a shape as it is found are at most so long, and at least half of it, where n allows; in radii."""

FINE = 0.5
"""Edges of a rope that SONO refines to the next n are at most so long; in radii."""

TRIALS = 8
"""Trials of a run, unless the first few agree."""

AGREEING = 4
LONG = 150
"""A run whose first trials, so many, end in the same shape makes no more; nor does one of a rope so long, in
radii: its trials take seconds, each ends in another shape, and a search goes further."""

SAME_SHAPE = 1e-5
"""Relative difference in L_a up to which two shapes count as the same."""

UNEQUAL = 1e-3
"""Dispersion above which a shape is second to one of equal edges, as its length does not compare: forces may
balance without tension in some edge of a coarse rope, which is shorter then."""

OFFSETS = 3
OFFSETS_TO = 1000
"""Offsets along the rope from which the last n is refined, up to this n: beads settle in other grooves each
time, which matters less the finer they are. Above it the others are tried where one did not get tight."""

MOST = 500_000
"""The largest n; the polish then takes 1 GB or more."""

COMPARED = 60_000
MOMENT = 0.3
"""The type of a stopped rope is compared if it has so few vertices, in so many seconds."""

FINER = 4
"""A state in which a run was stopped has at most so many times the vertices that were asked for."""

HOPELESS = 1.3
"""A run whose first trial needs so many times the vertices asked for makes no other: what trials from one
curve need differs by a few percent as a rule, and by a sixth at most as far as is known."""

HOT = 0.5
"""Violation tolerated at the start of every other trial's anneal; it crosses higher barriers."""


class Stopped(Exception):  # noqa: N818 - no error, a request that was followed
    """The run was stopped before its end; what it has is in `Run.best`."""


class KnotTypeError(ValueError):
    """A rope came out as another knot than the curve that was given, and is not delivered: a bug."""


class _TimeIsUp(Stopped):
    """The time limit of `tighten` was reached."""


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
    """Raise `ValueError` for an unknown setting or a value that is of no use."""
    defaults = default_settings()
    for name, value in settings.items():
        if name not in defaults:
            raise ValueError(f"unknown setting {name!r}; the settings are: {', '.join(defaults)}")
        most = None if isinstance(defaults[name], float) else 2**64 - 1 if name == "seed" else 2**32 - 1
        if not _is_number(value, most):
            kind = "a finite number" if most is None else f"a whole number from 0 to {most}"
            raise ValueError(f"setting {name} = {value!r} is not {kind}")
    # The core checks the ranges when a stage begins, which on a triangle costs nothing.
    Tightener([np.eye(3)], "settle", 60, json.dumps(settings))


def _is_number(value: object, most: int | None) -> bool:
    """Tell whether this is a finite number, or a whole one up to `most`."""
    if most is None:
        return isinstance(value, int | float) and abs(value) <= sys.float_info.max
    return isinstance(value, int) and not isinstance(value, bool) and 0 <= value <= most


def measure(vertices: ArrayLike | Sequence[ArrayLike]) -> Measures:
    """Measure a curve at the scale it has: an (n, 3) array, or one such array for each component of a link.

    Raises `CurveError` for one that is no embedded closed curve. Definitions: Baranska, Pieranski, Rawdon,
    "Ropelength of tight polygonal knots", section 2; for unequal edges L_c stays an upper bound.
    """
    return _core.measure(as_curve(vertices))


def forces(vertices: ArrayLike | Sequence[ArrayLike]) -> "Forces":
    """Find the forces that come nearest to balance on a curve, scaled to R_s = 1.

    Beads at most 2.0001 apart may press against each other, those whose radius is within 0.1 % of R may
    withstand bending, and edges within 1 % of the longest may be in tension: a bead rope's edges are equal.
    Raises `CurveError` for a curve that is not embedded.
    """
    return Forces(*_core.balance(as_curve(vertices)))


def tighten(
    vertices: ArrayLike | Sequence[ArrayLike],
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
    run = Run(as_curve(vertices), [index(n)], settings, method, index(trials))
    end = math.inf if time_limit is None else time.monotonic() + time_limit

    def watch_time(progress: Progress) -> None:
        watch(progress)
        if time.monotonic() > end:
            raise _TimeIsUp

    try:
        return run.tighten(watch_time)
    except _TimeIsUp:
        return run.best()


@dataclass(frozen=True, eq=False)
class Forces:
    """The forces in a rope of n beads and radius 1, in units of its mean tension.

    `tension` (n,) is that of the edge after each bead, `couple` (n,) that with which each bead withstands
    bending beyond the radius. The beads `contacts` (m, 2), counted through all components, press against
    each other with the forces `pressing` (m,). `residual` is the largest coordinate of a force that is left
    over on a bead.
    """

    tension: NDArray[np.float64]
    couple: NDArray[np.float64]
    contacts: NDArray[np.int64]
    pressing: NDArray[np.float64]
    residual: float


@dataclass(frozen=True, eq=False)
class Tight:
    """A tightened curve.

    `curve` holds one (n_i, 3) array for each component, scaled to R_s = 1; `measures` is what it measures.
    `converged` tells whether the last engine reached its end: the polish a residual below 1e-8 at mu = 1e-11,
    SONO the dispersion and overlaps that the settings ask for. `shapes` has the L_a of each trial's shape,
    all at the same coarse n, and `failed` says why other trials came to nothing. `loosened` tells that the
    curve, as it was given, held only a thin rope, and was first loosened by isotopic moves. `sweeps`,
    `factorisations` and `seconds` count from the start of the run.

    Where the polish came last, `residual` is the largest force left over, tension being 1, and `forces` are
    those in the rope (fitted to the vertices if it has not converged); `mu` is the product of each
    constraint's multiplier and slack, and `excess`, the sum of these products, tells by how much a converged
    rope is longer than the local minimum. Otherwise these are None. No forces are fitted to a rope that was
    stopped.
    """

    curve: Curve
    measures: Measures
    converged: bool
    shapes: list[float]
    failed: list[str]
    loosened: bool
    sweeps: int
    factorisations: int
    seconds: float
    residual: float | None = None
    mu: float | None = None
    excess: float | None = None
    forces: Forces | None = None


@dataclass(frozen=True)
class Progress:
    """Where a run stands: the rung it is on (`stage`, `n`), the n it climbs to, and the core's status.

    `status` is None as long as the rung is only just beginning. `trial` counts the trials, this one included,
    from 1.
    """

    stage: Stage
    n: int
    target: int
    trial: int
    status: Status | PolishStatus | None


@dataclass
class Run:
    """A tightening that can be stopped at any time, and saved and resumed at any slice.

    `curve` is any embedded closed curve at any scale; `targets` are the numbers of vertices still wanted, all
    components together, in increasing order. Raises `ValueError` for a wrong target, method or setting.
    """

    curve: Curve
    targets: list[int]
    settings: dict[str, Any]
    method: Method = "both"
    trials: int = TRIALS
    type: Fingerprint | None = None
    start: Curve = field(default_factory=list)
    loosened: bool = False
    rungs: list[Rung] = field(default_factory=list)
    shape: Curve | None = None
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
        measures = _core.measure(self.curve)
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
            self.seen = _as_seen(self.worker)
        status, curve = (self.rival and _as_seen(self.rival)) or self.seen or (None, self.curve)
        if self.method == "both" and self.shape and self.rungs[0][0] not in ("climb", "polish"):
            curve = self.shape  # In the middle of another trial the best shape so far is better.
        elif not self._has_type(curve):
            curve = self.curve
        curve, measures = _unit(_coarser(curve, self.targets[0]))
        return replace(self._tight(status, curve, measures), converged=False)

    def _has_type(self, curve: Curve) -> bool:
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
            run.worker = _ENGINES[engine].restore(worker)
        return run

    def _climb(self, look: Callable[[], None]) -> None:
        """Run the first rung to its end."""
        if self.worker is None:
            self.seen = None
            self.worker = self._busily(partial(self._engine, *self.rungs[0]), look)
            self.seen = _as_seen(self.worker)
            look()  # here too, since many a rung takes less than a slice
        while True:
            start = time.perf_counter()
            status, curve = self._busily(partial(_advanced, self.worker), look)
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
        better, worse = sorted((self.worker, self.rival), key=_rank)
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
            settings |= _anneal_of(trial, default_settings() | self.settings)
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
        status, curve = _as_seen(self.worker)
        tight = self._tight(status, curve, status.best)
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
            self.curve, self.rungs = cast("Curve", self.shape), self._climb_to_target()
        else:
            self.curve, self.rungs = self.start, [("collapse", 0)]

    def _trials_done(self) -> int:
        return len(self.shapes) + len(self.failed)

    def _trial(self, length: float) -> list[Rung]:
        """Plan the rest of a trial for a rope of this length."""
        # Edges of other lengths find other shapes; multiples of the golden ratio spread them evenly.
        trial = self._trials_done()
        least, most = (0.92, 1.1) if _is_hot(trial) else (0.6, 0.9)
        edge = least + (most - least) * ((0.5 + trial // 2 * (math.sqrt(5) - 1) / 2) % 1)
        n = _coarsest(self.targets[0], length)
        return [("anneal", min(n, max(int(length / edge), 3 * len(self.curve)))), ("trial", n)]

    def _compare(self, measures: Measures) -> None:
        """Keep the shape of a trial if it is the best."""
        if self.shape is None or _rank_of_shape(measures) < _rank_of_shape(_core.measure(self.shape)):
            self.shape = self.curve
        self.shapes.append(measures.l_a or measures.l_p)

    def _enough(self) -> bool:
        """Tell whether another trial is not worth it."""
        if self._trials_done() >= self.trials:
            return True
        agree = self.shapes and max(self.shapes) < (1 + SAME_SHAPE) * min(self.shapes)
        long = self.shapes and min(self.shapes) > LONG
        return bool(agree or long) and len(self.shapes) >= AGREEING

    def _tight(self, status: Status | PolishStatus | None, curve: Curve, measures: Measures) -> Tight:
        tight = Tight(
            curve,
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
        status, curve = _as_seen(worker)
        tight = self._tight(status, curve, status.best)
        if not isinstance(worker, Polish):
            return tight
        if not tight.converged:
            # The best state is not the last, to which the multipliers belong.
            fitted = patiently(partial(forces, curve), look)
            return replace(tight, residual=fitted.residual, forces=fitted)
        found = worker.status()
        own = Forces(*worker.forces())
        return replace(tight, residual=found.residual, excess=found.excess, forces=own)

    def _anneal(self) -> list[Rung]:
        """Plan SONO's rungs from the collapsed rope to the next target."""
        assert self.shape is not None
        self.curve = self.shape
        n = self.targets[0]
        coarsest = _coarsest(n, _core.measure(self.shape).l_p)
        finer = _doubled(coarsest, n)
        anneals: list[Rung] = [("anneal", coarsest), *(("reanneal", n) for n in finer[:1])]
        return anneals + [("settle", level) for level in finer or [coarsest]]

    def _climb_to_target(self) -> list[Rung]:
        """Plan the rungs from a tight rope to the next target."""
        between, last = _CLIMB[self.method]
        *levels, n = _doubled(sum(map(len, self.curve)), self.targets[0]) or self.targets[:1]
        return [*((between, level) for level in levels), (last, n)]


_FAILURES = (CurveError, PanicError, KnotTypeError)
"""What ends a trial, and not always the run."""

_ENGINES: dict[str, type[Engine]] = {engine.__name__: engine for engine in (Collapse, Tightener, Polish)}

_CLIMB: dict[Method, tuple[Stage, Stage]] = {
    "both": ("climb", "polish"),
    "polish": ("climb", "polish"),
    "sono": ("settle", "settle"),
}


def _as_seen(worker: Engine) -> Seen:
    return worker.status(), worker.best()


def _advanced(worker: Engine) -> Seen:
    return worker.advance(SLICE), worker.best()


def _unit(curve: Curve) -> tuple[Curve, Measures]:
    """Return a curve scaled to R_s = 1, and what it measures."""
    measures = _core.measure(curve)
    if abs(measures.r_s - 1) < 1e-9:
        return curve, measures
    curve = [component / measures.r_s for component in curve]
    return curve, _core.measure(curve)


def _coarser(curve: Curve, n: int) -> Curve:
    """Return a rope, with fewer vertices where it has far more than n; the knot stays the same."""
    if sum(map(len, curve)) <= FINER * n:
        return curve
    needed = max(n, math.ceil(_core.measure(curve).l_p / FINE))
    if needed <= FINER * n:
        coarse = _core.refine(curve, needed)
        if fingerprint(coarse) == fingerprint(curve):
            return coarse
    return _core.simplify(curve)


def _rank(polish: Polish) -> tuple[bool, float]:
    """Order tight ropes before others, then the shorter before the longer."""
    status = polish.status()
    return status.outcome != "tight", status.best.l_p


def _rank_of_shape(measures: Measures) -> tuple[bool, bool, float]:
    """Order shapes of equal edges before others, those with an L_c before others, then by length."""
    return measures.dispersion > UNEQUAL, measures.l_a is None, measures.l_a or measures.l_p


def _is_hot(trial: int) -> bool:
    return trial % 2 == 1


def _anneal_of(trial: int, settings: dict[str, Any]) -> dict[str, Any]:
    """Return the anneal of a trial: a short one, as it has to find a shape only, and every other one hot."""
    sweeps = max(settings["anneal_sweeps"] // 10, 1)
    tolerance = HOT if _is_hot(trial) else settings["anneal_tolerance"]
    return {"anneal_sweeps": sweeps, "anneal_tolerance": tolerance}


def _coarsest(n: int, length: float) -> int:
    """Halve n as long as the edges of a rope of this length stay short enough."""
    while 2 * length / n < COARSE:
        n //= 2
    return n


def _doubled(have: int, n: int) -> list[int]:
    """Return the levels above `have` that lead to n by doubling."""
    levels: list[int] = []
    while n > have:
        levels.insert(0, n)
        n //= 2
    return levels
