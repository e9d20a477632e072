"""The search for the shortest tight rope of a knot: many trials from different starts.

The tight shape that a rope ends in depends on how it begins, and the shortest one is found by few starts in a
hundred. A trial collapses a start, anneals it with SONO on few beads and polishes it there, in a quarter of a
second for 8 crossings; what decides is the variety of the starts, so each trial takes another variant of
`starts.start`. The most promising shapes are refined to finer edges, where minima are told apart. A search
gives the same minima whatever the number of workers.
"""

import json
from collections import deque
from collections.abc import Callable, Iterator
from contextlib import suppress
from dataclasses import dataclass, field, replace
from typing import Any, Protocol, Self, TypeAlias, TypeVar

import numpy as np

from sono.curve import Curve, measure, packed, unpacked
from sono.invariants import fingerprint
from sono.searching.minima import (
    SHORTER_SHAPE,
    Minimum,
    Shape,
    alike,
    merged,
    rank,
)
from sono.searching.trials import Source, attempt, refine, reseat
from sono.tightening import Stopped

ROUND = 4

REFINED = 1
"""After each round of so many trials so many shapes are refined at most, those that may be the shortest."""

BLUR = 3e-3
"""Share of its length by which a shape gets shorter at most when it is refined."""

LAG = 32
"""Rounds that may pass at most until a refined shape is waited for."""

AHEAD = 32
"""Trials for each worker that are begun ahead of the round they belong to, so that none has to wait."""

FINALISTS = 4
"""Shapes that are refined after the last round at most: those that may be the shortest, and others as long as
there are fewer minima than that."""

RESEATED = 2
"""Minima whose beads are seated anew at the end, at most."""

GROOVE = 1e-3
"""Share of its length by which a minimum gets shorter at most when its beads are seated anew."""

KEPT = 24
"""Unrefined shapes that are remembered, and minima."""

INTACT = 1e-6
"""Dispersion, and deviation of R_s from 1, up to which a restored minimum counts as tight."""

SEED_STRIDE = 10**6
"""Variants of one seed; those of the next begin after them."""

Result = TypeVar("Result")

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
        self._refine(FINALISTS, submit, waiting, anyway=FINALISTS - len(self.minima))
        self._keep(waiting, len(waiting), source)
        yield
        before = [minimum for minimum in self.minima[:RESEATED] if self._may_win(minimum, GROOVE)]
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

    def _refine(self, most: int, submit: Submit, waiting: deque[Waiting], anyway: int = 0) -> None:
        """Begin to refine the shortest shapes that may win, and so many `anyway`.

        They stay in the list until they are done. At first they are waited for after the next round, later
        after so many trials as there were by half: many workers make many trials while one refines a shape.
        """
        due = self.trials + ROUND * min(max(self.trials // (2 * ROUND), 1), LAG)
        under_way = [shape.radii for _, shape in self.refining]
        fresh = [s for s in self.shapes if not any(alike(s.radii, radii) for radii in under_way)]
        for i, shape in enumerate(fresh[:most]):
            if i >= anyway and not self._may_win(shape, BLUR):
                break
            self.refining.append((due, shape))
            waiting.append(submit(refine, shape))

    def _may_win(self, rope: Shape | Minimum, share: float) -> bool:
        """Tell whether what gets shorter by this share may become no longer than the shortest minimum."""
        return not self.minima or (1 - share) * rope.length <= self.minima[0].length

    def _take(self, shape: Shape) -> None:
        """Count a trial, and remember its shape if it is new and may lead to a minimum that is kept."""
        self.trials += 1
        self.changed += shape.changed
        self.failed += shape.curve is None and not shape.changed
        if shape.curve is None:
            return
        for i, minimum in enumerate(self.minima):
            another = shape.length < (1 - SHORTER_SHAPE) * minimum.length
            if not another and any(alike(shape.radii, radii) for radii in minimum.met):
                self.minima[i] = replace(minimum, hits=minimum.hits + 1)
                return
        if len(self.minima) == self.kept:
            longest = max(minimum.length for minimum in self.minima)
            if shape.length > (1 + SHORTER_SHAPE) * longest:
                return
        for i, other in enumerate(self.shapes):
            if alike(shape.radii, other.radii):
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
            same = [other for other in self.shapes if alike(other.radii, shape.radii)]
            self.shapes = [other for other in self.shapes if other not in same]
            if found := self.confirmed(found, source):
                hits = sum(shape.hits for shape in same or [shape])
                self._merge(replace(found, hits=hits), self.minima)

    def _merge(self, found: Minimum, minima: list[Minimum]) -> None:
        """Keep the best of these and another."""
        # A new list, as other threads look at the first.
        self.minima = merged([*minima, found])[: self.kept]


def _plain(value: Any) -> Any:
    """Make radii, shapes and minima fit for JSON."""
    return value.tolist() if isinstance(value, np.ndarray) else vars(value) | {"curve": packed(value.curve)}


def _shape(state: dict[str, Any]) -> Shape:
    return Shape(**state | {"radii": np.array(state["radii"], float), "curve": unpacked(state["curve"])})


def _minimum(state: dict[str, Any]) -> Minimum:
    curve = Curve(unpacked(state["curve"]) or [])
    measures = measure(curve)
    intact = max(abs(measures.r_s - 1), measures.dispersion) <= INTACT
    own = {"curve": curve, "length": measures.l_a_or_l_p, "converged": bool(state["converged"]) and intact}
    return Minimum(**state | own | {"met": [np.array(radii, float) for radii in state["met"]]})
