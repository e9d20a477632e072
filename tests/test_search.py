"""The search: what a trial gives, which minima are told apart, and that it matters not who does the work."""

import json
import threading
import time
from collections import deque
from collections.abc import Callable
from dataclasses import replace
from typing import Any

import numpy as np
import polygons
import pytest

from sono import _core, measure, starts
from sono._core import CurveError, PanicError
from sono.curve import Components, Curve, packed
from sono.invariants import Fingerprint, TooEntangledError, fingerprint
from sono.jobs.workers import Threads
from sono.searching import minima, search, trials
from sono.searching.minima import Shape, radii_of_gyration
from sono.searching.search import Search
from sono.searching.trials import Source, attempt, finish, refine, reseat
from sono.tightening import Stopped, engines, plan, trial


def source(knot: str) -> Source:
    return Source.of(starts.start(knot), knot)


def here(function: Callable[..., Any], *args: Any, rank: int | None = None) -> Callable[[], Any]:
    """Do a function at once."""
    result = function(*args)
    return lambda: result


def late(function: Callable[..., Any], *args: Any, rank: int | None = None) -> Callable[[], Any]:
    """Do a function when its result is wanted."""
    return lambda: function(*args)


def run(knot: str, trials: int, found: Search | None = None, submit: Any = here) -> Search:
    found = found or Search()
    for _ in found.run(source(knot), trials, submit):
        pass
    return found


def test_a_trial_ends_in_a_short_rope_of_the_type() -> None:
    shape = attempt(source("4_1"), 3)
    assert shape.curve is not None
    assert fingerprint(shape.curve) == fingerprint(starts.start("4_1"))
    assert shape.length == measure(shape.curve).l_a
    assert 42 < shape.length < 42.5
    np.testing.assert_array_equal(shape.radii, radii_of_gyration(shape.curve))


def test_a_trial_follows_its_variant() -> None:
    one, again, other = (attempt(source("4_1"), variant) for variant in (1, 1, 2))
    assert one.length == again.length != other.length


def test_a_trial_that_changes_the_type_is_found_out() -> None:
    trefoil = source("3_1")
    wrong = replace(trefoil, type=fingerprint(starts.start("4_1")))
    assert attempt(wrong, 0).changed
    assert attempt(wrong, 0).curve is None
    counted = Search()
    for _ in counted.run(wrong, 2, here):
        pass
    assert (counted.trials, counted.changed, counted.failed, counted.minima) == (2, 2, 0, [])


def test_a_start_that_cannot_be_tightened_is_counted() -> None:
    flat = [np.array([[0.0, 0, 0], [1, 0, 0], [2, 0, 0], [1, 0, 0.0]])]
    counted = Search()
    hopeless = Source(None, flat, fingerprint(starts.start("unknot")))
    for _ in counted.run(hopeless, 1, here):
        pass
    assert (counted.trials, counted.changed, counted.failed) == (1, 0, 1)


@pytest.mark.parametrize("stage", ["start", "collapse", "anneal", "polish"])
def test_a_trial_that_fails_is_a_failed_trial(monkeypatch: pytest.MonkeyPatch, stage: str) -> None:
    begun = 0

    def failing(make: Callable[..., Any]) -> Callable[..., Any]:
        def begin(*arguments: Any) -> Any:
            nonlocal begun
            begun += 1
            if begun == 2:
                raise PanicError("index out of bounds")
            return make(*arguments)

        return begin

    if stage == "start":
        monkeypatch.setattr(Source, "start", failing(Source.start))
    else:
        engine = {"collapse": "Collapse", "anneal": "Tightener", "polish": "Polish"}[stage]
        monkeypatch.setattr(trial, engine, failing(getattr(_core, engine)))
    found = run("3_1", 3)
    assert (found.trials, found.failed, found.changed) == (3, 1, 0)
    assert found.minima[0].converged


def test_what_cannot_be_refined_or_finished_leaves_the_rest(monkeypatch: pytest.MonkeyPatch) -> None:
    shape = attempt(source("3_1"), 0)
    minimum = refine(shape)
    assert minimum

    def refuse(*_: object) -> None:
        raise CurveError("too coarse")

    monkeypatch.setattr(trials, "Polish", refuse)
    monkeypatch.setattr(plan, "Polish", refuse)
    assert refine(shape) is None
    assert finish(minimum, 300) is None
    assert reseat(minimum) is minimum


def test_refined_and_finished_ropes_are_tight() -> None:
    minimum = refine(attempt(source("3_1"), 0))
    assert minimum
    assert minimum.converged
    assert (minimum.residual or 0) <= 1e-8
    assert minimum.length == pytest.approx(32.7429, abs=1e-3)
    assert measure(minimum.curve).dl == pytest.approx(trials.FINE_EDGE, rel=0.01)
    fine = finish(minimum, 480)
    assert fine
    assert fine.converged
    assert (fine.variant, measure(fine.curve).n) == (minimum.variant, 480)
    # README; the beads may lie in another groove
    assert fine.length == pytest.approx((4 * 32.739828 + 32.755154) / 5, abs=3e-5)


def test_beads_seated_anew_make_ropes_shorter() -> None:
    refined = [refine(attempt(source("8_19"), variant)) for variant in (1, 2, 3)]
    before = [minimum for minimum in refined if minimum]
    after = [reseat(minimum) for minimum in before]
    assert len(after) == 3
    for one, two in zip(before, after, strict=True):
        assert two.converged
        assert measure(two.curve).n == measure(one.curve).n
        assert (1 - 1e-3) * one.length < two.length <= one.length
        assert (two.variant, two.hits, two.met) == (one.variant, one.hits, one.met)
    # Most of them lie in a groove, some 2e-3 above the best.
    assert min(two.length - one.length for one, two in zip(before, after, strict=True)) < -1e-4


@pytest.mark.slow
def test_the_shortest_known_rope_is_found() -> None:
    found = run("6_1", 16)
    best = found.minima[0]
    assert best.length < 56.7058  # ACPR 2011; single greedy runs end 1.5 % above
    assert best.converged
    assert [minimum.length for minimum in found.minima] == sorted(minimum.length for minimum in found.minima)
    assert found.trials == 16
    met = sum(minimum.hits for minimum in found.minima) + sum(shape.hits for shape in found.shapes)
    assert (met + found.failed, found.changed) == (16, 0)


def test_the_workers_do_not_matter() -> None:
    one, other = run("3_1", 12), run("3_1", 12, submit=late)
    assert one.state() == other.state()


@pytest.mark.slow
def test_a_saved_search_goes_on_as_if_it_had_never_stopped() -> None:
    whole = Search()
    trials = 3 * search.ROUND
    for _ in whole.run(source("3_1"), trials, here):
        pass
    half = Search()
    pauses = half.run(source("3_1"), trials, here)
    for many in range(search.ROUND, trials, search.ROUND):
        next(pauses)
        assert half.trials == many
        again = Search.restore(json.loads(json.dumps(half.state())))
        assert run("3_1", trials, again).state() == whole.state()


def test_seeds_begin_elsewhere() -> None:
    found = run("3_1", 2, Search(seed=3))
    assert {minimum.variant for minimum in found.minima} <= {3_000_000, -3_000_001}


def test_shapes_are_told_apart_by_their_radii() -> None:
    found = Search()
    curve = starts.start("3_1")
    for variant, (length, radii) in enumerate([(9.0, (1, 1, 1)), (8.0, (1, 1, 1.001)), (7.0, (1, 1, 2))]):
        found._take(Shape(variant, length, np.array(radii, float), curve))
    assert [(shape.variant, shape.hits) for shape in found.shapes] == [(2, 1), (1, 2)]


@pytest.mark.slow
@pytest.mark.parametrize("knot", ["3_1", "5_2", "T(2,4)"])
def test_a_curve_is_searched_by_its_scrambles(knot: str) -> None:
    curve = starts.start(knot)
    unnamed = Source.of(curve)
    assert unnamed.start(0) is unnamed.curve
    start = unnamed.start(1)
    assert len(start[0]) != len(curve[0])
    assert fingerprint(start) == unnamed.type
    assert attempt(unnamed, 1).curve
    assert Source.of(curve, "chain3").name is None
    assert Source.of(curve, "T(2,4)").name == "T(2,4)"
    assert Source.of(curve, "m7_4").name == "m7_4"


def test_ropes_of_another_type_are_dropped(monkeypatch: pytest.MonkeyPatch) -> None:
    right = refine(attempt(source("3_1"), 0))
    assert right
    wrong = replace(right, curve=Curve([component * [1, 1, -1] for component in right.curve]))
    monkeypatch.setattr(search, "refine", lambda *_: wrong)
    found = run("3_1", 2)
    assert (found.minima, found.changed) == ([], 1)
    monkeypatch.setattr(search, "refine", lambda *_: right)
    monkeypatch.setattr(search, "reseat", lambda *_: wrong)
    found = run("3_1", 2)
    assert [minimum.length for minimum in found.minima] == [right.length]
    assert found.changed == 1


def test_a_shorter_shape_is_another() -> None:
    known = refine(attempt(source("3_1"), 0))
    assert known
    found = Search(minima=[known])
    for length in (known.length * 1.001, known.length * 0.99):
        found._take(Shape(1, length, known.met[0], known.curve))
    assert [len(found.shapes), found.minima[0].hits] == [1, known.hits + 1]


@pytest.mark.parametrize(("anyway", "refined"), [(0, [1]), (1, [1]), (2, [1, 2])])
def test_what_cannot_be_the_shortest_is_not_refined(anyway: int, refined: list[int]) -> None:
    curve = Curve(starts.start("3_1"))
    known = minima.Minimum(0, 30, True, 0, curve, [])
    shapes = [Shape(i, 30 * (1 + i * search.BLUR / 1.5), np.full(3, float(i)), curve) for i in (1, 2)]
    found, begun = Search(minima=[known], shapes=shapes), list[int]()

    def submit(function: Callable[..., Any], *args: Any, rank: int | None = None) -> Callable[[], Any]:
        begun.append(args[0].variant)
        return late(function, *args)

    found._refine(2, submit, deque(), anyway)
    assert begun == refined


def test_what_stops_a_polish_is_not_swallowed() -> None:
    known = refine(attempt(source("3_1"), 0))
    assert known

    def stop() -> None:
        raise Stopped("enough")

    with pytest.raises(Stopped, match="enough"):
        finish(known, 2000, stop)


def test_what_watches_can_stop_a_trial(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(engines, "SLICE", 1e-4)

    def stop() -> None:
        raise RuntimeError("enough")

    with pytest.raises(RuntimeError, match="enough"):
        attempt(source("8_18"), 0, stop)


def test_a_search_anneals_as_it_should(monkeypatch: pytest.MonkeyPatch) -> None:
    anneals: list[dict[str, float]] = []

    def spy(*arguments: Any) -> _core.Tightener:
        anneals.append(json.loads(arguments[3]))
        return _core.Tightener(*arguments)

    monkeypatch.setattr(trial, "Tightener", spy)
    found = run("3_1", 12)
    assert [anneal.pop("seed") for anneal in anneals] == [i // 2 + i % 2 for i in range(12)]
    # Variants 2, -2 and -6.
    assert [anneals.count(trials.GENTLE_ANNEAL), anneals.count(trials.WARM_ANNEAL)] == [9, 3]
    assert (found.trials, found.failed, found.changed) == (12, 0, 0)
    assert found.minima[0].converged
    assert found.minima[0].length == pytest.approx(32.743, abs=5e-3)


@pytest.mark.parametrize("wrong", [0.7, 0.94, 1.05, 1.4])
def test_refined_shapes_have_one_edge_length(wrong: float) -> None:
    shape = attempt(source("3_1"), 0)
    minimum = refine(replace(shape, length=wrong * shape.length))
    assert minimum
    assert measure(minimum.curve).dl == pytest.approx(trials.FINE_EDGE, rel=minima.SAME_EDGES)


def test_edges_of_few_beads() -> None:
    for length in (6.2, 12.57, 32.74, 400):
        for dl in (0.5, 0.3, 0.2, 0.05, 0.005):
            assert minima.has_edges(round(length / dl), length, dl)
            assert not minima.has_edges(round(1.3 * length / dl) + 2, length, dl)


class Made:
    """Trials and refined shapes that cost nothing: many minima, each met by shapes of several lengths."""

    def __init__(self, monkeypatch: pytest.MonkeyPatch, seconds: float = 0) -> None:
        self.seconds, self.active, self.most = seconds, 0, 0
        self.lock = threading.Lock()
        self.curve = Curve(starts.start("3_1"))
        trefoil = source("3_1").type
        for module in (search, trials):
            monkeypatch.setattr(module, "fingerprint", lambda _: trefoil)
        monkeypatch.setattr(search, "attempt", self.attempt)
        monkeypatch.setattr(search, "refine", self.refine)
        monkeypatch.setattr(search, "reseat", lambda minimum, watch=None: minimum)

    def work(self, seconds: float) -> None:
        with self.lock:
            self.active += 1
            self.most = max(self.most, self.active)
        time.sleep(seconds)
        with self.lock:
            self.active -= 1

    def attempt(self, source: Source, variant: int, watch: trials.Watch = trials.unwatched) -> Shape:
        self.work(self.seconds)
        draw = np.random.default_rng(abs(variant) + (variant < 0) * 10**7)
        which = draw.geometric(0.02)  # thousands of minima, the shorter the more often met
        radii = np.array([1, 2, 3]) * 1.02 ** float(which)
        return Shape(variant, 30 * 1.001**which * draw.uniform(1, 1.003), radii, self.curve)

    def refine(self, shape: Shape, watch: trials.Watch = trials.unwatched) -> minima.Minimum:
        self.work(10 * self.seconds)
        length, curve = (
            round(shape.length, 1),
            Curve([shape.radii[0] * component for component in self.curve]),
        )
        return minima.Minimum(shape.variant, length, True, 0, curve, [shape.radii])


def test_a_long_search_stays_small(monkeypatch: pytest.MonkeyPatch) -> None:
    Made(monkeypatch)
    found = Search()
    for _ in found.run(source("3_1"), 5_000, here):
        assert len(found.minima) <= search.KEPT
        assert len(found.shapes) <= search.KEPT
        assert len(found.refining) <= search.REFINED * search.LAG
        assert all(len(minimum.met) <= minima.MET for minimum in found.minima)
    assert found.trials == 5_000
    assert len(json.dumps(found.state())) < 1_000_000
    assert [m.length for m in found.minima] == sorted(m.length for m in found.minima)
    assert found.minima[0].hits > 10


def test_every_trial_counts_once(monkeypatch: pytest.MonkeyPatch) -> None:
    """Shapes of one minimum scatter, and the shortest so far is ever another of them."""
    made = Made(monkeypatch)

    def attempt(source: Source, variant: int, watch: trials.Watch = trials.unwatched) -> Shape:
        draw = np.random.default_rng(abs(variant) + (variant < 0) * 10**7)
        radii = np.array([1, 2, 3]) * draw.uniform(1, 1 + 2 * minima.SAME_RADII)
        return Shape(variant, 30 * draw.uniform(1, 1.003), radii, made.curve)

    def refine(shape: Shape, watch: trials.Watch = trials.unwatched) -> minima.Minimum:
        return minima.Minimum(shape.variant, 30, True, 0, made.curve, [shape.radii])

    monkeypatch.setattr(search, "attempt", attempt)
    monkeypatch.setattr(search, "refine", refine)
    for seed in range(20):
        found = run("3_1", 64, Search(seed=seed))
        assert [minimum.hits for minimum in found.minima] == [64 - sum(s.hits for s in found.shapes)]


def test_64_workers_are_busy_and_change_nothing(monkeypatch: pytest.MonkeyPatch) -> None:
    made = Made(monkeypatch, seconds=0.01)
    one, other = Search(), Search()
    with Threads(64) as workers:

        def submit(function: Callable[..., Any], *args: Any, rank: int | None = None) -> Callable[[], Any]:
            watch = trials.unwatched
            return workers.submit(function, *args, watch=watch, rank=-1 if rank is None else rank)

        start = time.monotonic()
        for _ in one.run(source("3_1"), 3200, submit, 64):
            pass
        took = time.monotonic() - start
    assert made.most == 64
    # 3,200 trials of 10 ms and some shapes of 100 ms: 1.5 s for 64 workers, 80 s for rounds of 4 trials.
    assert took < 15
    made.seconds = 0
    for _ in other.run(source("3_1"), 3200, here):
        pass
    assert one.state() == other.state()


def test_urgent_work_comes_first() -> None:
    order: list[int] = []
    begun, free = threading.Event(), threading.Event()

    def hold(watch: trials.Watch) -> None:
        begun.set()
        free.wait(60)

    with Threads(1) as workers:
        first = workers.submit(hold, watch=trials.unwatched)
        begun.wait(60)
        ranks = [5, 3, -1, 4, -1]
        waits = [
            workers.submit(lambda rank, _: order.append(rank), rank, watch=trials.unwatched, rank=rank)
            for rank in ranks
        ]
        free.set()
        first()
        for wait in waits:
            wait()
    assert order == sorted(ranks)


def test_trials_that_are_cut_leave_what_was_found() -> None:
    """The limit comes in the middle of a round; the shapes found are refined, and nothing else is begun."""
    begun: list[str] = []

    def submit(function: Callable[..., Any], *args: Any, rank: int | None = None) -> Callable[[], Any]:
        def call() -> Any:
            begun.append(function.__name__)
            if rank is not None and rank >= 3:
                raise search.OutOfTime
            return function(*args)

        return call

    found = Search()
    for _ in found.run(source("3_1"), 10**6, submit):
        pass
    assert found.trials == 3
    assert begun[:4] == 4 * ["attempt"]
    assert set(begun[4:]) == {"refine", "reseat"}
    assert found.minima[0].converged


def test_a_limit_while_shapes_are_refined_keeps_the_minima() -> None:
    refined = 0

    def submit(function: Callable[..., Any], *args: Any, rank: int | None = None) -> Callable[[], Any]:
        def call() -> Any:
            nonlocal refined
            refined += function is trials.refine
            if refined > 1:
                raise search.OutOfTime
            return function(*args)

        return call

    found = Search()
    for _ in found.run(source("3_1"), 16, submit):
        pass
    assert [minimum.converged for minimum in found.minima] == [True]


def test_restored_minima_are_measured_again() -> None:
    found = run("3_1", 2)
    state = found.state()
    assert Search.restore(state).state() == state
    curve = [component.copy() for component in found.minima[0].curve]
    curve[0][7] += 0.3
    state["minima"][0] |= {"curve": packed(curve), "length": 20.0}
    again = Search.restore(state)
    damaged = next(minimum for minimum in again.minima if minimum.variant == found.minima[0].variant)
    assert not damaged.converged
    assert damaged.length == pytest.approx(measure(curve).l_a or measure(curve).l_p)
    assert damaged.length > 33
    for key, value in {"minima": 3, "shapes": [{}], "refining": [[1]], "more": 1}.items():
        with pytest.raises((TypeError, ValueError, LookupError)):
            Search.restore(found.state() | {key: value})


def test_a_minimum_found_twice_is_one(monkeypatch: pytest.MonkeyPatch) -> None:
    curve = Made(monkeypatch).curve
    thrice = [minima.Minimum(k, 30 + 1e-3 * k, True, 0, curve, [], hits=k) for k in (2, 1, 3)]
    other = minima.Minimum(4, 30.1, True, 0, curve, [], hits=4)
    stuck = minima.Minimum(5, 29, False, None, curve, [], hits=5)
    found = minima.merged([thrice[0], stuck, other, *thrice[1:]])
    assert [(minimum.variant, minimum.hits) for minimum in found] == [(1, 6), (4, 4), (5, 5)]


def test_a_tangle_is_told_once_it_is_collapsed(monkeypatch: pytest.MonkeyPatch) -> None:
    tangle, told = [polygons.entangled(30, 3)], []

    def entangled_at_first(curve: Components) -> Fingerprint:
        told.append(curve)
        if len(told) == 1:
            raise TooEntangledError
        return fingerprint(curve)

    monkeypatch.setattr(trials, "fingerprint", entangled_at_first)
    assert Source.of(tangle).type == fingerprint(tangle)
    assert told[1] is not tangle
