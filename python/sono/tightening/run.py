"""The loop that works through a plan, which can be watched, stopped, saved and resumed at any slice.

Rust does the work in slices of a tenth of a second; between slices, and while one takes longer, a caller may
show progress or stop.
"""

import time
from collections.abc import Callable, Sequence
from contextlib import suppress
from dataclasses import replace
from functools import partial
from typing import Any, Self, TypeVar, cast

from sono._core import Collapse, CurveError, PanicError, Polish
from sono.curve import Components, Curve, forces, forces_of
from sono.invariants import Fingerprint, TooEntangledError, fingerprint
from sono.patience import patiently, within
from sono.tightening.coarser import coarser, unit
from sono.tightening.engines import Engine, Seen, advanced, as_seen, rank, restored, saved, status_of
from sono.tightening.plan import GROOVED, Plan
from sono.tightening.results import KnotTypeError, Progress, Tight
from sono.tightening.settings import TRIALS, Method, check_settings
from sono.tightening.targets import Target, check, coarse_first

Done = TypeVar("Done")

OFFSETS = 3
OFFSETS_TO = 1000
"""Offsets along the rope from which the last n is refined, up to this n, where edges are `GROOVED`: beads
settle in other grooves each time. Else the others are tried where one did not get tight."""

COMPARED = 60_000
MOMENT = 0.3
"""The type of a stopped rope is compared if it has so few vertices, in so many seconds."""

FAILURES = (CurveError, PanicError, KnotTypeError)
"""What ends a trial, and not always the run."""


class Run:
    """A tightening that can be stopped at any time, and saved and resumed at any slice.

    `plan` tells what comes next; `engine` is at work on it, and `rival` is the better one of those that have
    refined to the same n from another offset.
    """

    def __init__(
        self,
        curve: Components,
        targets: Sequence[Target],
        settings: dict[str, Any],
        method: Method = "both",
        trials: int = TRIALS,
        known: Components | None = None,
    ) -> None:
        """Plan to tighten any embedded closed curve, at any scale, to each target, coarse ones first.

        An int n counts the vertices of all components together, a float is an edge length in radii. A rope of
        radius 1 and the same type that is `known` takes the place of trials where it suits. Raises
        `ValueError` for a wrong target, method or setting.
        """
        check(curve, targets, method, trials)
        check_settings(settings)
        self.plan = Plan(coarse_first(targets), settings, method, trials, curve, known=known)
        self.type: Fingerprint | None = None
        self.engine: Engine | None = None
        self.rival: Polish | None = None
        self.offset = 0
        self.seconds = 0.0
        self.busy = False
        self.seen: Seen | None = None

    @property
    def targets(self) -> list[Target]:
        """The numbers of vertices, or edge lengths, that are still wanted."""
        return self.plan.targets

    @property
    def shape(self) -> Components | None:
        """The best shape that trials have found."""
        return self.plan.shape

    def tighten(self, watch: Callable[[Progress], None] = lambda _: None) -> Tight:
        """Tighten at the first target; `watch` is called five times a second or more and may raise `Stopped`.

        Called once more it gives the same again. A trial that fails is only one trial less. Raises
        `CurveError` for a curve that cannot be tightened, or not with so few vertices, and `KnotTypeError`.
        """
        look = partial(self._look, watch)
        if self.type is None:
            with suppress(TooEntangledError):  # the collapsed rope is less so, as a rule
                self.type = patiently(partial(fingerprint, self.plan.start), look)
        while True:
            try:
                self._work(look)
                self._check_type(look)
            except FAILURES as error:
                self._fail(error)
                continue
            if not self.plan.is_last:
                self._leave()
            elif not self._is_over():
                self.rival, self.engine = cast("Polish", self._better()), None
                self.offset += 1
            elif self.plan.climb_again(better := self._better()):
                self.engine, self.offset = None, 0
            else:
                return self._ended(better, look)

    def next_target(self) -> None:
        """Turn from the first target, reached or out of reach, to the next."""
        reached = self.engine is not None
        self.offset, self.rival = 0, None
        self._leave()
        self.plan.next_target(reached)

    def best(self) -> Tight:
        """Return the best state as `tighten` was stopped, as unconverged as it is, without forces.

        Where the engine is busy still, this is how it was last seen; before any was, the curve as given.
        """
        plan = self.plan
        if self.engine and not self.busy:
            self.seen = as_seen(self.engine)
        status, curve = (self.rival and as_seen(self.rival)) or self.seen or (None, plan.curve)
        if plan.shape and plan.finds_shapes:
            curve = plan.shape  # In the middle of another trial the best shape so far is better.
        elif not self._has_type(curve):
            curve = plan.curve
        tight = Tight.of(plan, self.seconds, status, curve)
        curve, measures = unit(coarser(curve, plan.n))
        return replace(tight, curve=Curve(curve), measures=measures, converged=False)

    @property
    def at_rest(self) -> bool:
        """Whether nobody is at work on the run, so that its `state` can be taken."""
        return self.engine is None or not self.busy

    def state(self) -> dict[str, Any]:
        """Return all that is needed to go on later, for JSON; `Run.restore` is its inverse."""
        return {
            "plan": self.plan.state(),
            "type": self.type,
            "engine": saved(self.engine),
            "rival": saved(self.rival),
            "offset": self.offset,
            "seconds": self.seconds,
        }

    @classmethod
    def restore(cls, state: dict[str, Any]) -> Self:
        """Return the run that gave this state; it goes on as if it had never stopped.

        Raises an error of any kind for what is no state.
        """
        if set(state) != _STATE:
            raise ValueError("other parts than those of a run")
        plan = Plan.restore(state["plan"])
        run = cls(plan.curve, plan.targets, plan.settings, plan.method, plan.trials)
        run.plan = plan
        run.type = state["type"] and tuple(map(tuple, state["type"]))
        run.engine, run.rival = restored(state["engine"]), cast("Polish | None", restored(state["rival"]))
        run.offset, run.seconds = state["offset"], float(state["seconds"])
        return run

    def _engine(self, stage: str, n: int) -> Engine:
        """Begin a rung: that of the plan, which has this stage and n."""
        return self.plan.begin(self.offset)

    def _work(self, look: Callable[[], None]) -> None:
        """Run the rung to its end."""
        if self.engine is None:
            self.seen = None
            self.engine = self._busily(partial(self._engine, *self.plan.rung), look)
            self.seen = as_seen(self.engine)
            look()  # here too, since many a rung takes less than a slice
        while True:
            start = time.perf_counter()
            status, curve = self._busily(partial(advanced, self.engine), look)
            self.seconds += time.perf_counter() - start
            if status.outcome != "running":
                return
            self.seen = status, curve
            look()

    def _busily(self, call: Callable[[], Done], look: Callable[[], None]) -> Done:
        """Have the engine do what may take long."""

        def work() -> Done:
            try:
                return call()
            finally:
                self.busy = False

        self.busy = True
        return patiently(work, look)

    def _look(self, watch: Callable[[Progress], None]) -> None:
        """Show where the run stands."""
        plan = self.plan
        stage, n = plan.rung
        status = self.seen and self.seen[0]
        n = n or (status.best.n if status else sum(map(len, plan.curve)))
        watch(Progress(stage, n, plan.n, plan.tried + 1, status))

    def _check_type(self, look: Callable[[], None]) -> None:
        """Compare what a rung has ended in with the curve that was given, if it is not too entangled.

        Then it is of that type all the same, as each of its moves was shown to be an isotopy.
        """
        assert self.engine is not None
        try:
            found = patiently(partial(fingerprint, self.engine.best()), look)
        except TooEntangledError:
            return
        self.type = self.type or found
        if found != self.type:
            stage, n = self.plan.rung
            raise KnotTypeError(f"the {stage} at n = {n} came out as another knot; please report this curve")

    def _has_type(self, curve: Components) -> bool:
        """Tell whether a curve has the type of the one that was given, as far as a moment suffices."""
        if self.type is None or sum(map(len, curve)) > COMPARED:
            return True
        try:
            return within(MOMENT, partial(fingerprint, curve)) in (self.type, None)
        except TooEntangledError:
            return True

    def _is_over(self) -> bool:
        """Tell whether the last rung has been tried from enough offsets along the rope."""
        if not isinstance(self.engine, Polish):
            return True
        status, n = status_of(self.engine), self.plan.n
        grooved = n <= OFFSETS_TO and status.best.dl > GROOVED
        several = (grooved or status.outcome != "tight") and sum(map(len, self.plan.curve)) != n
        return self.offset + 1 >= (OFFSETS if several else 1)

    def _better(self) -> Engine:
        """Return the better of the engine, which is done, and its rival; the other one's work is added up."""
        assert self.engine is not None
        if not (self.rival and isinstance(self.engine, Polish)):
            return self.engine
        better, worse = sorted((self.engine, self.rival), key=rank)
        self.plan.log.add_aside(status_of(worse), self.plan.rung[0])
        self.engine, self.rival = better, None
        return better

    def _leave(self) -> None:
        """Take over what the rung has reached."""
        if self.engine is None:
            return
        if isinstance(self.engine, Collapse) and (loosened := self.engine.loosened()):
            self.plan.take_loosened(loosened)  # once for all trials
        self.plan.take(self.engine)
        self.engine = None

    def _fail(self, error: CurveError | PanicError | KnotTypeError) -> None:
        """Do without the trial, or the offset, that failed; raise its error where there is nothing else."""
        if self.engine and isinstance(error, KnotTypeError):
            self.plan.log.add_aside(status_of(self.engine), self.plan.rung[0])
        self.engine = None
        if self.rival:
            self.engine, self.rival, self.offset = self.rival, None, OFFSETS
            return
        needed = error.needed or float("inf") if isinstance(error, CurveError) else 0
        self.plan.fail(error, needed)

    def _ended(self, engine: Engine, look: Callable[[], None]) -> Tight:
        """Return what the last rung has ended in, with the forces in it."""
        status, curve = as_seen(engine)
        tight = Tight.of(self.plan, self.seconds, status, curve)
        if not isinstance(engine, Polish):
            return tight
        if not tight.converged:
            # The best state is not the last, to which the multipliers belong.
            fitted = patiently(partial(forces, curve), look)
            return replace(tight, residual=fitted.residual, forces=fitted)
        own = forces_of(engine.forces(), curve)
        return replace(tight, residual=status.residual, excess=status.excess, forces=own)


_STATE = {"plan", "type", "engine", "rival", "offset", "seconds"}
