"""What a tightening gives: the rope, and before that where it stands or why it stopped."""

from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any, Self

from sono.curve import Components, Curve, Forces, Measures, measure
from sono.records import Drawn, Record
from sono.tightening.engines import Status
from sono.tightening.plan import Plan, Stage
from sono.tightening.work import Work, total

if TYPE_CHECKING:
    from sono.figures.view import View


class Stopped(Exception):  # noqa: N818 - no error, a request that was followed
    """The run was stopped before its end; what it has is in `Run.best`."""


class KnotTypeError(ValueError):
    """A rope came out as another knot than the curve that was given, and is not delivered: a bug."""


@dataclass(frozen=True, eq=False, repr=False)
class Tight(Record, Drawn):
    """A tightened curve.

    `curve` is scaled to R_s = 1; `measures` is what it measures. `converged` tells whether the last engine
    reached its end: the polish a residual below 1e-8 at mu = 1e-11, SONO the dispersion and overlaps that the
    settings ask for, as they may ask for another mu. `shapes` has the L_a of each trial's shape, all at the
    same coarse n, and `failed` says why other trials came to nothing. `loosened` tells that the curve, as it
    was given, held only a thin rope, and was first loosened by isotopic moves. `known` tells that the rope
    was polished from a shape that was known, without trials. `sweeps`, `factorisations` and `seconds` count
    from the start of the run.

    `path` are the stages that led to the rope, one after the other, from the curve that was given or the
    shape that was known; `total` adds up all that were made, those of other trials too. They say which moves
    were shown to let no strand pass: see `Work`.

    Where the polish came last, `residual` is the largest force left over, tension being 1, and `forces` are
    those in the rope (fitted to the vertices if it has not converged); `mu` is the product of each
    constraint's multiplier and slack, and `excess`, the sum of these products, tells by how much at most a
    converged rope is longer than the local minimum. Otherwise these are None. No forces are fitted to a rope
    that was stopped.

    >>> import sono
    >>> tight = sono.tighten("4_1", 105)
    >>> tight.converged, tight.residual < 1e-8, len(tight.forces.tension), tight.to_dict()["n"]
    (True, True, 105, 105)
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
    known: bool = False
    path: tuple[Work, ...] = ()
    total: dict[str, Any] = field(default_factory=dict)

    @classmethod
    def of(cls, plan: Plan, seconds: float, status: Status | None, curve: Components) -> Self:
        """Make the result of a rope of a plan, or of what an engine that has this `status` is at."""
        log = plan.log
        now = [Work.of(status, plan.rung[0])] if status else []
        end = log.shape if curve is plan.shape else log.curve
        last = [] if curve is plan.shape or curve is plan.curve else now
        sums = total([*log.works, *now])
        return cls(
            curve=Curve(curve),
            measures=measure(curve),
            converged=status is not None and status.outcome == "tight",
            shapes=list(plan.shapes),
            failed=list(plan.failed),
            loosened=plan.loosened,
            known=plan.from_known,
            sweeps=sums["sweeps"],
            factorisations=sums["factorisations"],
            seconds=seconds,
            mu=status.mu if status else None,
            path=(*log.path(end), *last),
            total=sums,
        )

    def to_dict(self) -> dict[str, Any]:
        """Return plain values: what the rope measures first, among the other fields."""
        values = super().to_dict()
        return self.measures.to_dict() | {key: values[key] for key in values if key != "measures"}

    def view(self) -> "View":
        """Show the rope in the round, in a notebook, or on a page to be saved; see `sono.view`."""
        from sono.figures.view import shown  # here, as few need it

        return shown([("", self.curve)])


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
    status: Status | None
