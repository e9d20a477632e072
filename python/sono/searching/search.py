"""The search for the shortest tight rope of a knot: many trials from different starts.

The tight shape that a rope ends in depends on how it begins, and the shortest one is found by few starts in a
hundred. A trial collapses a start, anneals it with SONO on few beads and polishes it there, in half a second
for 8 crossings; what decides is the variety of the starts, so each trial takes another variant of
`library.start`. At so few beads the grooves between them blur lengths by a few tenths of a percent, so the
most promising shapes are refined to finer edges, where minima are told apart by length and radii of gyration.

Trials are pure functions of a source and the number of its variant, so they may run in threads or on other
machines, and a search gives the same minima whatever the number of workers.
"""

import json
import math
from collections import deque
from collections.abc import Callable, Iterable, Iterator
from contextlib import suppress
from dataclasses import dataclass, field, replace
from typing import Any, Protocol, Self, TypeAlias, TypeVar

import numpy as np
from numpy.typing import NDArray

from sono._core import Collapse, Measures, PanicError, Polish, Tightener
from sono.invariants.identify import Curve, Fingerprint, TooEntangledError, fingerprint
from sono.jobs.checkpoints import packed, unpacked
from sono.starts import names as library
from sono.starts.scramble import scramble
from sono.tightening.run import HOT, SLICE, Stopped, measure, tighten

TRIAL_EDGE = 0.45
"""Edge length of the shapes that trials end in, in radii."""

FINE_EDGE = 0.2
"""Edge length at which minima are compared."""

POLISHES = 3
"""Attempts to polish a shape on edges of that length, as its own length changes meanwhile."""

HOT_ANNEAL = {"anneal_sweeps": 100_000, "anneal_tolerance": HOT}
GENTLE_ANNEAL = {"anneal_sweeps": 5_000, "anneal_tolerance": 0.1}
GENTLE = 2 / 3
"""The anneals of trials, and the share of the gentle ones. A hot anneal crosses barriers and leads many
starts to the same few shapes; a gentle one, of fewer sweeps, keeps rarer shapes that are near the start."""

ANNEAL_EDGES = (0.8, 1.2)
"""Edges of the anneal, of other lengths each time: the coarser, the higher the barriers that it crosses."""

OFFSETS = 2
"""Offsets along the rope from which a shape is refined; the shortest result counts."""

MOST_BEADS = 10_000
"""Beads of a collapsed rope up to which a trial goes on. A thin start may jam at once; the rest is hours."""

ROUND = 8
REFINED = 2
"""After each round of so many trials so many of its shapes are refined."""

LAG = 32
"""Rounds that may pass at most until a refined shape is waited for."""

AHEAD = 32
"""Trials for each worker that are begun ahead of the round they belong to, so that none has to wait."""

FINALISTS = 4
"""Shapes that are refined after the last round."""

RESEATED = 2
"""Minima whose beads are seated anew at the end."""

KEPT = 24
"""Unrefined shapes that are remembered, and minima."""

MET = 16
"""Coarse shapes of a minimum that are remembered."""

SAME_RADII = 0.007
"""Relative difference of the radii of gyration up to which ropes of one edge length count as one shape."""

SAME_LENGTH = 2e-4
"""Relative difference in L_a up to which two refined ropes of the same shape count as one minimum."""

SHORTER_SHAPE = 5e-3
"""A shape shorter than a minimum by more than this share is another, even if their radii are alike."""

SAME_EDGES = 0.02
"""Relative difference of edge lengths up to which the grooves of two ropes are alike."""

INTACT = 1e-6
"""Dispersion, and deviation of R_s from 1, up to which a restored minimum counts as tight."""

SEED_STRIDE = 10**6
"""Variants of one seed; those of the next begin after them."""

FAILURES = (ValueError, PanicError)
"""What ends a trial, or the refining of a shape, and nothing else: a `CurveError`, a curve that no scramble
can be made of, a bug in the core."""

Radii: TypeAlias = NDArray[np.float64]
Worker = TypeVar("Worker", Collapse, Tightener, Polish)
Result = TypeVar("Result")

Watch: TypeAlias = Callable[[], None]
"""Called about ten times a second; whatever it raises stops the work."""


Waiting: TypeAlias = "Callable[[], Minimum | None]"
"""Waits for a minimum."""


class OutOfTime(Stopped):
    """The trials of a search, or the rest of it, are to end; what it has counts."""


class Submit(Protocol):
    """Has a function done elsewhere, perhaps on another machine; what it returns waits for the result.

    Trials have a `rank`, the least of which comes first; None is for what waits for no trial.
    """

    def __call__(
        self, function: Callable[..., Result], /, *args: Any, rank: int | None = None
    ) -> Callable[[], Result]:
        """Begin it."""


def unwatched() -> None:
    """Let the work go on."""


@dataclass(frozen=True, eq=False)
class Source:
    """A knot to search: its `type`, a `curve` of it, and its `name` if the library has variants of that."""

    name: str | None
    curve: Curve
    type: Fingerprint

    @classmethod
    def of(cls, curve: Curve, name: str | None = None, watch: Watch = unwatched) -> Self:
        """Return the source of a curve, which is what the library draws if there is a name.

        A nameless curve is collapsed first, as a long and thin one cannot be scrambled. Raises `ValueError`.
        """
        if name and library.has_variants(name):
            return cls(name, curve, fingerprint(curve))
        type = None
        with suppress(TooEntangledError):  # the collapsed rope is less so, as a rule
            type = fingerprint(curve)
        collapsed = _done(Collapse(curve, False, "{}"), watch).best()
        return cls(None, collapsed, type or fingerprint(collapsed))

    def start(self, variant: int, watch: Watch = unwatched) -> Curve:
        """Return a starting conformation; variant 0 is the curve itself."""
        if not variant:
            return self.curve
        return library.start(self.name, variant) if self.name else scramble(self.curve, variant, watch=watch)


@dataclass(frozen=True, eq=False)
class Shape:
    """What a trial ended in: a coarse rope, its L_a and its radii of gyration (3,).

    `curve` is None where the trial came to nothing, and `changed` tells that this was for the knot's type.
    `hits` counts the trials that ended so.
    """

    variant: int
    length: float = float("inf")
    radii: Radii = field(default_factory=lambda: np.full(3, np.inf))
    curve: Curve | None = None
    changed: bool = False
    hits: int = 1


@dataclass(frozen=True, eq=False)
class Minimum:
    """A refined rope, the variant that led there, and the number of trials that did.

    `tight` tells whether the polish reached its end, `residual` is the largest force left over, if that is
    known, and `met` has the radii of gyration of the coarse shapes that were refined to it.
    """

    variant: int
    length: float
    tight: bool
    residual: float | None
    curve: Curve
    met: list[Radii]
    hits: int = 0


def attempt(source: Source, variant: int, watch: Watch = unwatched) -> Shape:
    """Make one trial. A start that cannot be drawn or collapsed gives a shape without a curve."""
    try:
        collapsed = _done(Collapse(source.start(variant, watch), False, "{}"), watch)
        edge = _spread(*ANNEAL_EDGES, variant)
        n = max(int(collapsed.status().best.l_p / edge), 3 * len(collapsed.best()))
        if n > MOST_BEADS:
            return Shape(variant)
        anneal = GENTLE_ANNEAL if _spread(0, 1, variant, math.sqrt(2)) < GENTLE else HOT_ANNEAL
        settings = json.dumps(anneal | {"seed": abs(variant)})
        annealed = _done(Tightener(collapsed.best(), "anneal", n, settings), watch)
        n = round(annealed.status().best.l_p / TRIAL_EDGE)
        polished = _done(Polish(annealed.best(), n, True, abs(variant)), watch)
    except FAILURES:
        return Shape(variant)
    curve = polished.best()
    if fingerprint(curve) != source.type:
        return Shape(variant, changed=True)
    return Shape(variant, _length(polished.status().best), radii_of_gyration(curve), curve)


def refine(shape: Shape, watch: Watch = unwatched) -> Minimum | None:
    """Polish a shape to the end on edges of `FINE_EDGE`. Returns None for one that cannot be refined."""
    curve, length = shape.curve, shape.length
    for _ in range(POLISHES):
        n = round(length / FINE_EDGE)
        polish = curve and _polished(curve, n, watch)
        if not polish:
            return None
        curve, length = polish.best(), _length(polish.status().best)
        if has_edges(n, length, FINE_EDGE):
            return _replaced(Minimum(shape.variant, 0, False, 0, [], [shape.radii]), polish)
    return None


def finish(minimum: Minimum, n: int, watch: Watch = unwatched) -> Minimum | None:
    """Polish a minimum on n vertices, doubling the vertices on the way there; None if that fails."""
    try:
        tight = tighten(minimum.curve, n, method="polish", watch=lambda _: watch())
    except FAILURES:
        return None
    assert tight.residual is not None
    return replace(
        minimum,
        length=_length(tight.measures),
        tight=tight.converged,
        residual=tight.residual,
        curve=tight.curve,
    )


def reseat(minimum: Minimum, watch: Watch = unwatched) -> Minimum:
    """Polish a minimum on twice the vertices and then on its own number again; the shorter one counts.

    Beads lie in grooves between those that they touch; among more beads these are shallow, and a rope may
    leave one that held it up, by a thousandth of its length at most.
    """
    n = sum(map(len, minimum.curve))
    try:
        fine = _done(Polish(minimum.curve, 2 * n, False, 0), watch)
    except FAILURES:
        return minimum
    polish = _polished(fine.best(), n, watch)
    return min(minimum, _replaced(minimum, polish), key=rank) if polish else minimum


def rank(minimum: Minimum) -> tuple[bool, float]:
    """Order tight ropes before others, then the shorter before the longer."""
    return not minimum.tight, minimum.length


def same_edges(one: float, other: float) -> bool:
    """Tell whether edges are so equally long that ropes are compared by their L_a alone."""
    return abs(one - other) <= SAME_EDGES * other


def has_edges(n: int, length: float, dl: float) -> bool:
    """Tell whether a rope of n vertices and this length has edges of dl, as far as n is a whole number."""
    return abs(n * dl - length) <= max(SAME_EDGES * length, dl)


def radii_of_gyration(curve: Curve) -> Radii:
    """Return the three principal radii of gyration (3,) of all vertices, in increasing order."""
    arms = np.vstack(curve)
    arms = arms - arms.mean(axis=0)
    radii: Radii = np.sqrt(np.linalg.eigvalsh(arms.T @ arms / len(arms)).clip(0))
    return radii


@dataclass
class Search:
    """A search under way, which can be saved after any round and go on later.

    `trials` counts the variants tried so far, of which `failed` could not be tightened. `changed` counts the
    ropes that ended in another knot type, in trials or later; none should. `shapes` are the shortest ones
    that are not refined and `minima` those that are, `kept` at most, both shortest first. `refining` has the
    shapes under way, and how many trials there will be when they are waited for.
    """

    seed: int = 0
    kept: int = KEPT
    trials: int = 0
    changed: int = 0
    failed: int = 0
    shapes: list[Shape] = field(default_factory=list)
    minima: list[Minimum] = field(default_factory=list)
    refining: list[tuple[int, Shape]] = field(default_factory=list)

    def run(self, source: Source, trials: int, submit: Submit, workers: int = 1) -> Iterator[None]:
        """Make trials until there are so many, pausing after each round; then refine the best shapes left.

        The best minima are seated anew at the end. `submit` has functions of this module done elsewhere, by
        so many `workers`, on whose number nothing depends. If one raises `OutOfTime` trials are over.
        """
        waiting = deque(submit(refine, shape) for _, shape in self.refining)
        with suppress(OutOfTime):
            yield from self._try(source, trials, submit, AHEAD * workers, waiting)
        with suppress(OutOfTime):
            yield from self._end(source, submit, waiting)

    def confirmed(self, minimum: Minimum | None, source: Source) -> Minimum | None:
        """Return a minimum, if there is one, of the knot's type; count it if it is of another."""
        if not minimum or fingerprint(minimum.curve) == source.type:
            return minimum
        self.changed += 1
        return None

    def state(self) -> dict[str, Any]:
        """Return all that is needed to go on later, for JSON; `Search.restore` is its inverse."""
        return json.loads(json.dumps(vars(self), default=_plain))  # type: ignore[no-any-return]

    @classmethod
    def restore(cls, state: dict[str, Any]) -> Self:
        """Return the search that gave this state, its minima measured again. Raises an error for others."""
        shapes = list(map(_shape, state["shapes"]))
        minima = sorted(map(_minimum, state["minima"]), key=rank)
        refining = [(int(due), _shape(shape)) for due, shape in state["refining"]]
        return cls(**state | {"shapes": shapes, "minima": minima, "refining": refining})

    def _try(
        self, source: Source, trials: int, submit: Submit, ahead: int, waiting: deque[Waiting]
    ) -> Iterator[None]:
        """Make the trials, taking them and the refined shapes in an order that nobody's speed changes."""
        first = begun = self.trials
        trying: deque[Callable[[], Shape]] = deque()
        while self.trials < trials:
            while begun < min(trials, self.trials + max(ahead, 2 * ROUND)):
                variant = self._variant(source, begun)
                trying.append(submit(attempt, source, variant, rank=begun - first))
                begun += 1
            for _ in range(min(ROUND, trials - self.trials)):
                self._take(trying.popleft()())
            self._keep(waiting, sum(due <= self.trials for due, _ in self.refining), source)
            self._refine(REFINED, submit, waiting)
            yield

    def _end(self, source: Source, submit: Submit, waiting: deque[Waiting]) -> Iterator[None]:
        """Refine the best shapes that are left, and seat the best minima anew."""
        self._keep(waiting, len(waiting), source)
        self._refine(FINALISTS, submit, waiting)
        self._keep(waiting, len(waiting), source)
        yield
        before = self.minima[:RESEATED]
        reseating = [submit(reseat, minimum) for minimum in before]
        for minimum, seated in zip(before, reseating, strict=True):
            if again := self.confirmed(seated(), source):
                self._merge(again, [other for other in self.minima if other is not minimum])
        yield

    def _variant(self, source: Source, trial: int) -> int:
        """Return the variant of a trial: 0, -1, 1, -2, 2, ... of knots with both kinds, else 0, 1, 2, ..."""
        first = self.seed * SEED_STRIDE
        if not source.name:
            return first + trial
        return -(first + trial // 2 + 1) if trial % 2 else first + trial // 2

    def _refine(self, most: int, submit: Submit, waiting: deque[Waiting]) -> None:
        """Begin to refine the shortest shapes; they stay in the list until they are done.

        At first they are waited for after the next round, later after so many trials as there were by half:
        many workers make many trials while one refines a shape.
        """
        due = self.trials + ROUND * min(max(self.trials // (2 * ROUND), 1), LAG)
        under_way = [shape.radii for _, shape in self.refining]
        fresh = [s for s in self.shapes if not any(_alike(s.radii, radii) for radii in under_way)]
        for shape in fresh[:most]:
            self.refining.append((due, shape))
            waiting.append(submit(refine, shape))

    def _take(self, shape: Shape) -> None:
        """Count a trial, and remember its shape if it is new and may lead to a minimum that is kept."""
        self.trials += 1
        self.changed += shape.changed
        self.failed += shape.curve is None and not shape.changed
        if shape.curve is None:
            return
        for i, minimum in enumerate(self.minima):
            another = shape.length < (1 - SHORTER_SHAPE) * minimum.length
            if not another and any(_alike(shape.radii, radii) for radii in minimum.met):
                self.minima[i] = replace(minimum, hits=minimum.hits + 1)
                return
        if len(self.minima) == self.kept:
            longest = max(minimum.length for minimum in self.minima)
            if shape.length > (1 + SHORTER_SHAPE) * longest:
                return
        for i, other in enumerate(self.shapes):
            if _alike(shape.radii, other.radii):
                shorter = min(shape, other, key=lambda shape: shape.length)
                # It goes by the first one's radii while it is refined; those of others may be further off.
                self.shapes[i] = replace(shorter, radii=other.radii, hits=other.hits + 1)
                break
        else:
            self.shapes.append(shape)
        self.shapes = sorted(self.shapes, key=lambda shape: shape.length)[:KEPT]

    def _keep(self, waiting: deque[Waiting], count: int, source: Source) -> None:
        """Wait for the first refined shapes; take each for a new minimum, or for one that is known."""
        for _ in range(count):
            found = waiting[0]()
            waiting.popleft()
            _, shape = self.refining.pop(0)
            # Other trials may have met the shape while it was refined.
            same = [other for other in self.shapes if _alike(other.radii, shape.radii)]
            self.shapes = [other for other in self.shapes if other not in same]
            if found := self.confirmed(found, source):
                hits = sum(shape.hits for shape in same or [shape])
                self._merge(replace(found, hits=hits), self.minima)

    def _merge(self, found: Minimum, minima: list[Minimum]) -> None:
        """Keep the best of these and another."""
        # A new list, as other threads look at the first.
        self.minima = merged([*minima, found])[: self.kept]


def merged(minima: Iterable[Minimum]) -> list[Minimum]:
    """Return minima with those made one that are the same, the shortest first."""
    apart: list[Minimum] = []
    for found in minima:
        radii = radii_of_gyration(found.curve)
        for i, known in enumerate(apart):
            near = abs(known.length - found.length) < SAME_LENGTH * found.length
            if near and _alike(radii_of_gyration(known.curve), radii):
                shorter, met = min(known, found, key=rank), (known.met + found.met)[-MET:]
                apart[i] = replace(shorter, met=met, hits=known.hits + found.hits)
                break
        else:
            apart.append(found)
    return sorted(apart, key=rank)


def _done(worker: Worker, watch: Watch) -> Worker:
    """Let an engine run to its end."""
    while worker.advance(SLICE).outcome == "running":
        watch()
    return worker


def _spread(least: float, most: float, number: int, step: float = (math.sqrt(5) - 1) / 2) -> float:
    """Spread numbers evenly over a range by multiples of an irrational step, by default the golden ratio."""
    return least + (most - least) * ((0.5 + number * step) % 1)


def _polished(curve: Curve, n: int, watch: Watch) -> Polish | None:
    """Polish a rope on n vertices from a few offsets along it, and return the shortest, if there is any."""
    found = []
    for offset in range(OFFSETS):
        with suppress(*FAILURES):
            found.append(_done(Polish(curve, n, False, offset), watch))
    return min(found, key=lambda polish: (not _is_tight(polish), _length(polish.status().best)), default=None)


def _replaced(minimum: Minimum, polish: Polish) -> Minimum:
    """Return the minimum with what the polish made of its rope."""
    status = polish.status()
    return replace(
        minimum,
        length=_length(status.best),
        tight=_is_tight(polish),
        residual=status.residual,
        curve=polish.best(),
    )


def _is_tight(polish: Polish) -> bool:
    return polish.status().outcome == "tight"


def _length(measures: Measures) -> float:
    return measures.l_a or measures.l_p


def _alike(one: Radii, other: Radii) -> bool:
    # A flat curve has a radius of 0.
    return bool((abs(one - other) <= SAME_RADII * np.maximum(other, other.max() / 10)).all())


def _plain(value: Any) -> Any:
    """Make radii, shapes and minima fit for JSON."""
    return value.tolist() if isinstance(value, np.ndarray) else vars(value) | {"curve": packed(value.curve)}


def _shape(state: dict[str, Any]) -> Shape:
    return Shape(**state | {"radii": np.array(state["radii"], float), "curve": unpacked(state["curve"])})


def _minimum(state: dict[str, Any]) -> Minimum:
    curve = unpacked(state["curve"]) or []
    measures = measure(curve)
    intact = max(abs(measures.r_s - 1), measures.dispersion) <= INTACT
    own = {"curve": curve, "length": _length(measures), "tight": bool(state["tight"]) and intact}
    return Minimum(**state | own | {"met": [np.array(radii, float) for radii in state["met"]]})
