"""Which rungs lead to tight ropes, and from what each begins.

First a shape is found: the stages of several trials are "collapse", "anneal" and "trial". From the best shape
"climb" rungs, each with twice the vertices of the one before, lead to the last, a "polish". With the method
"sono" one curve is collapsed, and rungs "anneal", "reanneal" and "settle" of SONO come in place of the
polished ones; with "polish" there is no shape to be found, nor where one is known.
"""

import json
from dataclasses import dataclass, field
from typing import Any, Literal, Self, TypeVar, cast

from sono._core import Polish, Tightener
from sono.curve import Components, Measures, measure, packed, unpacked
from sono.tightening.engines import Engine, status_of
from sono.tightening.settings import TRIALS, Method, of_polish, of_sono
from sono.tightening.targets import COARSE, Target, aimed, coarsest, doubled
from sono.tightening.trial import Recipe, Trial
from sono.tightening.work import Log

Stage = Literal["collapse", "anneal", "reanneal", "settle", "trial", "climb", "polish"]

Rung = tuple[Stage, int]

Error = TypeVar("Error", bound=Exception)

FINE = 0.5
"""Edges of a rope that SONO refines to the next n are at most so long; in radii."""

AGREEING = 4
LONG = 150
"""A run whose first trials, so many, end in the same shape makes no more; nor does one of a rope so long, in
radii: its trials take seconds, each ends in another shape, and a search goes further."""

SAME_SHAPE = 1e-5
"""Relative difference in L_a up to which two shapes count as the same."""

UNEQUAL = 1e-3
"""Dispersion above which a shape is second to one of equal edges, as its length does not compare: forces may
balance without tension in some edge of a coarse rope, which is shorter then."""

HOPELESS = 1.3
"""A run whose first trial needs so many times the vertices asked for makes no other: what trials from one
curve need differs by a few percent as a rule, and by a sixth at most as far as is known."""

KNOWN = 0.5
"""A rope whose edges are at most so long, in radii, is polished from a shape that is known; for one of longer
edges other shapes may be better."""

SHORT = 1.5
"""A first rung with so many times the vertices of a known shape, or less, is left out: it costs more than it
saves."""

GROOVED = 0.1
"""Beads with edges longer than this, in radii, lie in grooves between those that they touch, which may hold
the rope up by a ten-thousandth of its length; shorter ones by a hundred-thousandth at most."""

CLIMBS = 3
"""Climbs that are made once more for a target that is an edge length."""


@dataclass
class Plan:
    """What has been found so far, and what is to be done for the first of the `targets`.

    `curve` is what the next rung begins with, and `start` the curve of all trials, which may have been
    `loosened`. While a shape is looked for there is a `trial`, and `rungs` are empty. `shape` is the best of
    those found; `shapes` has the length of each, and `failed` says why other trials came to nothing. `climbs`
    counts those that were made once more for the sake of the edges. `known` is a shape of radius 1 to climb
    from instead, where edges are short enough for it, and `from_known` tells that the rope comes from there.
    The `log` has what was done.
    """

    targets: list[Target]
    settings: dict[str, Any]
    method: Method = "both"
    trials: int = TRIALS
    curve: Components = field(default_factory=list)
    start: Components = field(default_factory=list)
    loosened: bool = False
    trial: Trial | None = None
    rungs: list[Rung] = field(default_factory=list)
    shape: Components | None = None
    shapes: list[float] = field(default_factory=list)
    failed: list[str] = field(default_factory=list)
    climbs: int = 0
    known: Components | None = None
    from_known: bool = False
    log: Log = field(default_factory=Log)

    def __post_init__(self) -> None:
        """Begin with the first trial, or with the climb."""
        self.start = self.start or self.curve
        if self.targets and not (self.trial or self.rungs):
            if self._knows_enough():
                self._climb_from_known()
            elif self.method == "polish":
                self._climb()
            else:
                self._try_again()

    @property
    def rung(self) -> Rung:
        """The stage that comes next, and its number of vertices."""
        return (self.trial.stage, self.trial.n) if self.trial else self.rungs[0]

    @property
    def n(self) -> int:
        """The number of vertices that the first target asks for, as far as is known."""
        target = self.targets[0]
        if isinstance(target, int):
            return target
        return aimed(target, measure(self.shape or self.curve).l_p) if self.trial else self.rungs[-1][1]

    @property
    def finds_shapes(self) -> bool:
        """Whether shapes are still looked for."""
        return self.trial is not None

    @property
    def is_last(self) -> bool:
        """Whether the rung leads to the first target."""
        return not self.trial and len(self.rungs) == 1

    @property
    def tried(self) -> int:
        """The number of trials that are over."""
        return len(self.shapes) + len(self.failed)

    def seed(self, offset: int = 0) -> int:
        """Return the seed of this trial, or of this offset along the rope."""
        return int((self.settings.get("seed", 0) + self.tried + offset) % 2**64)

    def begin(self, offset: int) -> Engine:
        """Begin the rung. Raises `CurveError`."""
        if self.trial:
            return self.trial.begin()
        (stage, n), seed = self.rungs[0], self.seed(offset)
        if stage in ("climb", "polish"):
            return Polish(self.curve, n, stage == "climb", seed, of_polish(self.settings))
        settings = json.dumps(of_sono(self.settings) | {"seed": seed})
        return Tightener(self.curve, cast("Literal['anneal', 'reanneal', 'settle']", stage), n, settings)

    def take(self, engine: Engine) -> None:
        """Go on from what the rung has ended in."""
        self.curve = self.log.add(engine, self.rung[0], self.tried + 1 if self.trial else None)
        if not self.trial:
            self.rungs.pop(0)
        elif self.method == "sono":
            self.shape, self.trial, self.log.shape = self.curve, None, self.log.curve
            self._anneal()
        elif not self.trial.take(engine):
            self._compare(status_of(engine).best)
            self._next_trial()

    def state(self) -> dict[str, Any]:
        """Return all that is needed to go on later, for JSON; `Plan.restore` is its inverse."""
        curves = {name: packed(getattr(self, name)) for name in _CURVES}
        trial = self.trial and vars(self.trial) | {
            "recipe": vars(self.trial.recipe),
            "curve": packed(self.trial.curve),
        }
        return vars(self) | curves | {"trial": trial, "log": self.log.state()}

    @classmethod
    def restore(cls, state: dict[str, Any]) -> Self:
        """Return the plan that gave this state. Raises an error of any kind for what is no state."""
        curves = {name: unpacked(state[name]) for name in _CURVES}
        trial = state["trial"]
        if trial:
            curve = unpacked(trial["curve"])
            trial = Trial(**trial | {"recipe": Recipe(**trial["recipe"]), "curve": curve})
        rungs = [(stage, n) for stage, n in state["rungs"]]
        log = Log.restore(state["log"])
        return cls(**state | curves | {"trial": trial, "rungs": rungs, "log": log})

    def climb_again(self, engine: Engine) -> bool:
        """Plan another climb if edges, which follow the rope's own length, are not as long as asked for."""
        found = status_of(engine).best
        aim = aimed(self.targets[0], found.l_p)
        if self.climbs == CLIMBS or aim == found.n:
            return False
        self.curve, self.climbs = self.log.add(engine, self.rung[0]), self.climbs + 1
        self._climb()
        return True

    def take_loosened(self, curve: Components) -> None:
        """Begin all further trials with a curve that is loosened."""
        self.start, self.loosened = curve, True

    def fail(self, error: Error, needed: float) -> None:
        """Do without the trial that failed, and would have `needed` so many vertices; or raise its error."""
        if self.from_known:
            self.known, self.from_known = None, False
            self._try_again()
            return
        hopeless = not self.shapes and needed > HOPELESS * self.n
        if self.method != "both" or not self.trial or hopeless:
            raise error
        self.failed.append(str(error))
        if not self.shapes and len(self.failed) >= min(AGREEING, self.trials):
            raise error
        self._next_trial()

    def next_target(self, reached: bool) -> None:
        """Turn from the first target, reached or out of reach, to the next."""
        self.targets.pop(0)
        self.climbs = 0
        if not self.targets:
            return
        measures = measure(self.curve)
        edge = measures.l_p / (measures.n * measures.r_s)
        if self._knows_enough() and not (self.from_known and reached):
            self._climb_from_known()
        elif self.method == "sono" and self.shape:
            if reached and edge < FINE:
                self._climb()
            else:
                self._anneal()
        elif self.method == "polish" or (reached and edge < COARSE):
            self._climb()
        elif self.shape and not reached:  # it could not be refined to that n
            self.curve, self.log.curve = self.shape, self.log.shape
            self._climb()
        else:  # what suits so few beads may not suit more of them
            self.shape, self.shapes, self.failed = None, [], []
            self._try_again()

    def _knows_enough(self) -> bool:
        """Tell whether a shape is known that suits edges as short as those of the first target."""
        if self.known is None or self.method != "both":
            return False
        length = measure(self.known).l_p
        return length <= KNOWN * aimed(self.targets[0], length)

    def _climb_from_known(self) -> None:
        """Plan the climb from the shape that is known."""
        assert self.known is not None
        self.curve, self.from_known, self.log.curve = self.known, True, None
        self.shape, self.shapes, self.failed = None, [], []
        self._climb()
        if len(self.rungs) > 1 and self.rungs[0][1] < SHORT * sum(map(len, self.known)):
            self.rungs.pop(0)

    def _next_trial(self) -> None:
        """Plan another trial, or, where there were enough, the climb from the best shape."""
        if self._enough():
            self.curve, self.log.curve = cast("Components", self.shape), self.log.shape
            self._climb()
        else:
            self._try_again()

    def _try_again(self) -> None:
        """Plan another trial."""
        recipe = Recipe.numbered(self.tried, self.settings, self.targets[0], short=self.method == "both")
        self.curve, self.rungs, self.log.curve = self.start, [], self.log.start
        self.trial = Trial(recipe, self.start, self.loosened)

    def _compare(self, measures: Measures) -> None:
        """Keep the shape of a trial if it is the best."""
        if self.shape is None or _rank_of_shape(measures) < _rank_of_shape(measure(self.shape)):
            self.shape, self.log.shape = self.curve, self.log.curve
        self.shapes.append(measures.l_a_or_l_p)

    def _enough(self) -> bool:
        """Tell whether another trial is not worth it."""
        if self.tried >= self.trials:
            return True
        agree = self.shapes and max(self.shapes) < (1 + SAME_SHAPE) * min(self.shapes)
        long = self.shapes and min(self.shapes) > LONG
        return bool(agree or long) and len(self.shapes) >= AGREEING

    def _anneal(self) -> None:
        """Plan SONO's rungs from the collapsed rope to the first target."""
        assert self.shape is not None
        self.curve, self.log.curve = self.shape, self.log.shape
        length = measure(self.shape).l_p
        n = aimed(self.targets[0], length)
        few = coarsest(n, length)
        finer = doubled(few, n)
        self.rungs = [("anneal", few), *(("reanneal", level) for level in finer[:1])]
        self.rungs += [("settle", level) for level in finer or [few]]

    def _climb(self) -> None:
        """Plan the rungs from a tight rope to the first target."""
        between, last = cast("tuple[Stage, Stage]", _CLIMB[self.method])
        aim = aimed(self.targets[0], measure(self.curve).l_p)
        *levels, n = doubled(sum(map(len, self.curve)), aim) or [aim]
        self.trial, self.rungs = None, [*((between, level) for level in levels), (last, n)]


_CURVES = ("curve", "start", "shape", "known")

_CLIMB = {"both": ("climb", "polish"), "polish": ("climb", "polish"), "sono": ("settle", "settle")}


def _rank_of_shape(measures: Measures) -> tuple[bool, bool, float]:
    """Order shapes of equal edges before others, those with an L_c before others, then by length."""
    return measures.dispersion > UNEQUAL, measures.l_a is None, measures.l_a_or_l_p
