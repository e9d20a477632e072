"""The search: what a trial gives, which minima are told apart, and that it matters not who does the work."""

import json
from collections.abc import Callable
from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from sono import _core, library, measure, pipeline, search
from sono._core import CurveError, PanicError
from sono.invariants import fingerprint
from sono.pipeline import Stopped
from sono.search import Search, Shape, Source, attempt, finish, radii_of_gyration, refine, reseat


@pytest.fixture(autouse=True)
def quick(monkeypatch: pytest.MonkeyPatch) -> None:
    """Short anneals are enough for knots of few crossings."""
    monkeypatch.setattr(search, "GENTLE", 1)


def source(knot: str) -> Source:
    return Source.of(library.start(knot), knot)


def here(function: Callable[..., Any], *args: Any) -> Callable[[], Any]:
    """Do a function at once."""
    result = function(*args)
    return lambda: result


def late(function: Callable[..., Any], *args: Any) -> Callable[[], Any]:
    """Do a function when its result is wanted."""
    return lambda: function(*args)


def run(knot: str, trials: int, found: Search | None = None, submit: Any = here) -> Search:
    found = found or Search()
    for _ in found.run(source(knot), found.rounds(trials), submit):
        pass
    return found


def test_a_trial_ends_in_a_short_rope_of_the_type() -> None:
    shape = attempt(source("4_1"), 3)
    assert shape.curve is not None
    assert fingerprint(shape.curve) == fingerprint(library.start("4_1"))
    assert shape.length == measure(shape.curve).l_a
    assert 42 < shape.length < 42.5
    np.testing.assert_array_equal(shape.radii, radii_of_gyration(shape.curve))


def test_a_trial_follows_its_variant() -> None:
    one, again, other = (attempt(source("4_1"), variant) for variant in (1, 1, 2))
    assert one.length == again.length != other.length


def test_a_trial_that_changes_the_type_is_found_out() -> None:
    trefoil = source("3_1")
    wrong = replace(trefoil, type=fingerprint(library.start("4_1")))
    assert attempt(wrong, 0).changed
    assert attempt(wrong, 0).curve is None
    counted = Search()
    for _ in counted.run(wrong, counted.rounds(2), here):
        pass
    assert (counted.trials, counted.changed, counted.failed, counted.minima) == (2, 2, 0, [])


def test_a_start_that_cannot_be_tightened_is_counted() -> None:
    flat = [np.array([[0.0, 0, 0], [1, 0, 0], [2, 0, 0], [1, 0, 0.0]])]
    counted = Search()
    hopeless = Source(None, flat, fingerprint(library.start("unknot")))
    for _ in counted.run(hopeless, counted.rounds(1), here):
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
        monkeypatch.setattr(search, engine, failing(getattr(_core, engine)))
    found = run("3_1", 3)
    assert (found.trials, found.failed, found.changed) == (3, 1, 0)
    assert found.minima[0].tight


def test_what_cannot_be_refined_or_finished_leaves_the_rest(monkeypatch: pytest.MonkeyPatch) -> None:
    shape = attempt(source("3_1"), 0)
    minimum = refine(shape)
    assert minimum

    def refuse(*_: object) -> None:
        raise CurveError("too coarse")

    monkeypatch.setattr(search, "Polish", refuse)
    monkeypatch.setattr(pipeline, "Polish", refuse)
    assert refine(shape) is None
    assert finish(minimum, 300) is None
    assert reseat(minimum) is minimum


def test_refined_and_finished_ropes_are_tight() -> None:
    minimum = refine(attempt(source("3_1"), 0))
    assert minimum
    assert minimum.tight
    assert minimum.residual <= 1e-8
    assert minimum.length == pytest.approx(32.7429, abs=1e-3)
    assert measure(minimum.curve).dl == pytest.approx(search.FINE_EDGE, rel=0.01)
    fine = finish(minimum, 480)
    assert fine
    assert fine.tight
    assert (fine.variant, measure(fine.curve).n) == (minimum.variant, 480)
    assert fine.length == pytest.approx((4 * 32.739828 + 32.755154) / 5, abs=2e-6)  # README


def test_beads_seated_anew_make_ropes_shorter() -> None:
    refined = [refine(attempt(source("8_19"), variant)) for variant in (1, 2, 3)]
    before = [minimum for minimum in refined if minimum]
    after = [reseat(minimum) for minimum in before]
    assert len(after) == 3
    for one, two in zip(before, after, strict=True):
        assert two.tight
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
    assert best.tight
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
    for _ in whole.run(source("3_1"), whole.rounds(24), here):
        pass
    half = Search()
    pauses = half.run(source("3_1"), half.rounds(24), here)
    next(pauses)
    assert half.trials == 8
    half = Search.restore(json.loads(json.dumps(half.state())))
    assert run("3_1", 24, half).state() == whole.state()


def test_seeds_begin_elsewhere() -> None:
    found = run("3_1", 2, Search(seed=3))
    assert {minimum.variant for minimum in found.minima} <= {3_000_000, -3_000_001}


def test_shapes_are_told_apart_by_their_radii() -> None:
    found = Search()
    curve = library.start("3_1")
    for variant, (length, radii) in enumerate([(9.0, (1, 1, 1)), (8.0, (1, 1, 1.001)), (7.0, (1, 1, 2))]):
        found._take(Shape(variant, length, np.array(radii, float), curve))
    assert [(shape.variant, shape.hits) for shape in found.shapes] == [(2, 1), (1, 2)]


@pytest.mark.slow
@pytest.mark.parametrize("knot", ["3_1", "7_4", "T(2,4)"])
def test_a_curve_is_searched_by_its_scrambles(knot: str) -> None:
    curve = library.start(knot)
    unnamed = Source.of(curve)
    assert unnamed.start(0, search.unwatched) is curve
    start = unnamed.start(1, search.unwatched)
    assert len(start[0]) != len(curve[0])
    assert fingerprint(start) == unnamed.type
    assert attempt(unnamed, 1).curve
    assert Source.of(curve, "T(2,4)").name is None
    assert Source.of(curve, "m7_4").name == "m7_4"


def test_ropes_of_another_type_are_dropped(monkeypatch: pytest.MonkeyPatch) -> None:
    right = refine(attempt(source("3_1"), 0))
    assert right
    wrong = replace(right, curve=[component * [1, 1, -1] for component in right.curve])
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


def test_what_stops_a_polish_is_not_swallowed() -> None:
    known = refine(attempt(source("3_1"), 0))
    assert known

    def stop() -> None:
        raise Stopped("enough")

    with pytest.raises(Stopped, match="enough"):
        finish(known, 2000, stop)


def test_what_watches_can_stop_a_trial(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(search, "SLICE", 1e-4)

    def stop() -> None:
        raise RuntimeError("enough")

    with pytest.raises(RuntimeError, match="enough"):
        attempt(source("8_18"), 0, stop)
