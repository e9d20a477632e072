"""The library: what `measure` and `tighten` take and give, and runs that stop, save and go on."""

import json
import math
from collections.abc import Callable
from itertools import count
from typing import Any, get_args

import numpy as np
import pytest
from polygons import entangled

import sono
from sono import starts, tighten
from sono._core import PanicError
from sono.curve import Components, as_components
from sono.invariants import identify as invariants
from sono.tightening import KnotTypeError, Method, Progress, Run, Stopped
from sono.tightening import run as pipeline
from sono.tightening.plan import Stage
from sono.tightening.settings import check_settings, default_settings

QUICK = {"anneal_sweeps": 500, "settle_sweeps": 100, "tolerance": 1e-2}

HEXAGON = [[math.cos(i * math.pi / 3), math.sin(i * math.pi / 3), 0.0] for i in range(6)]


@pytest.mark.parametrize(
    "vertices",
    [HEXAGON, [HEXAGON], np.array(HEXAGON), [np.array(HEXAGON)], np.array([HEXAGON])],
    ids=["list", "lists", "array", "arrays", "stacked"],
)
def test_measure_takes_anything_like_arrays(vertices: Any) -> None:
    measures = sono.measure(vertices)
    assert (measures.n, measures.components) == (6, 1)
    assert measures.l_p == pytest.approx(6 / math.sqrt(0.75), abs=1e-12)


def test_any_kind_of_array(tmp_path_factory: pytest.TempPathFactory) -> None:
    exact = np.array([[0, 0, 0], [2, 0, 0], [2, 2, 1], [0, 2, 0]])
    expected = sono.measure(exact.astype(np.float64)).length
    padded = np.zeros((8, 6))
    padded[::2, ::2] = exact
    for array in (exact, exact.astype(np.float32), np.asfortranarray(exact), padded[::2, ::2]):
        assert sono.measure(array).length == expected


def test_components_of_different_lengths() -> None:
    curve = as_components([np.array(HEXAGON), 9 * np.array(HEXAGON[::2])])
    assert [component.shape for component in curve] == [(6, 3), (3, 3)]
    assert sono.measure(curve).components == 2


@pytest.mark.parametrize(
    "vertices", [[], [1.0, 2.0], [[0, 0], [1, 0], [0, 1]], [HEXAGON, [[0, 1]]], "knot", 3]
)
def test_what_is_no_curve(vertices: Any) -> None:
    with pytest.raises((ValueError, TypeError)):
        as_components(vertices)


def test_the_callers_arrays_stay_as_they_are() -> None:
    curve = sono.start("3_1")
    before = [component.copy() for component in curve]
    sono.tighten(curve, 40, settings=QUICK)
    assert all(map(np.array_equal, curve, before))


@pytest.mark.parametrize(
    ("third", "message"),
    [([math.nan, 0, 0], "vertex 2 of component 0 is not finite"), ([1, 0, 0], "coincide")],
)
def test_curve_errors_say_where(third: list[float], message: str) -> None:
    with pytest.raises(sono.CurveError, match=message):
        sono.measure(np.array([[0, 0, 0], [1, 0, 0], third, [0, 1, 0]]))


def test_tighten_gives_arrays_and_what_they_measure() -> None:
    tight = sono.tighten(sono.start("Hopf"), n=60, settings=QUICK)
    assert [component.dtype for component in tight.curve] == [np.dtype(float)] * 2
    assert sum(map(len, tight.curve)) == tight.measures.n == 60
    assert tight.converged
    measures = sono.measure(tight.curve)
    assert (measures.l_p, measures.l_c) == (tight.measures.l_p, tight.measures.l_c)
    assert measures.r_s == pytest.approx(1, abs=1e-12)
    assert tight.sweeps > 0
    assert tight.seconds > 0


@pytest.mark.parametrize("factor", [1e-9, 1e-3, 1e6])
def test_any_scale_and_place(factor: float) -> None:
    curve = [factor * (component + 10) for component in sono.start("3_1")]
    assert 32.4 < sono.tighten(curve, 60, settings=QUICK).measures.l_p < 33


def test_numbers_from_numpy() -> None:
    with_ints = sono.tighten(sono.start("3_1"), 40, seed=3, settings=QUICK)
    with_numpy = sono.tighten(sono.start("3_1"), np.int64(40), seed=np.uint8(3), settings=QUICK)  # type: ignore[arg-type]
    assert np.array_equal(with_ints.curve, with_numpy.curve)
    with pytest.raises(ValueError, match=r"n = 40\.5 is no whole number"):
        sono.tighten(sono.start("3_1"), 40.5)  # type: ignore[arg-type]


def test_the_seed_may_be_among_the_settings() -> None:
    curve = sono.start("3_1")
    as_argument = sono.tighten(curve, 40, seed=5, settings=QUICK)
    as_setting = sono.tighten(curve, 40, settings=QUICK | {"seed": 5})
    assert np.array_equal(as_argument.curve, as_setting.curve)
    assert not np.array_equal(as_argument.curve, sono.tighten(curve, 40, settings=QUICK).curve)
    with pytest.raises(ValueError, match="the seed is given twice"):
        sono.tighten(curve, 40, seed=5, settings={"seed": 5})


@pytest.mark.parametrize("limit", [math.nan, -1, -math.inf])
def test_a_time_limit_that_is_none(limit: float) -> None:
    with pytest.raises(ValueError, match="is no number of seconds"):
        sono.tighten(sono.start("3_1"), 60, time_limit=limit)


@pytest.mark.parametrize(
    ("n", "settings", "message"),
    [
        (2, {}, "n = 2 is too small; 3 vertices for each component make 3"),
        (40, {"speed": 1}, "unknown setting 'speed'; the settings are: c_1, "),
        (40, {"c_1": 0.7}, "c_1 = 0.7 is out of range"),
        (40, {"c_1": math.nan}, "c_1 = nan is not a finite number"),
        (40, {"c_1": "0.5"}, "c_1 = '0.5' is not a finite number"),
        (40, {"c_1": 10**400}, "is not a finite number"),
        (40, {"anneal_sweeps": -1}, "anneal_sweeps = -1 is not a whole number from 0 to 4294967295"),
        (40, {"anneal_sweeps": 1e3}, "anneal_sweeps = 1000.0 is not a whole number"),
        (40, {"anneal_sweeps": True}, "anneal_sweeps = True is not a whole number"),
    ],
)
def test_wrong_values(n: int, settings: dict[str, Any], message: str) -> None:
    with pytest.raises(ValueError, match=message):
        sono.tighten(sono.start("3_1"), n, settings=settings)


def test_default_settings_are_right() -> None:
    check_settings(default_settings())


def test_too_few_vertices_for_the_knot() -> None:
    with pytest.raises(sono.CurveError, match="12 vertices are too few"):
        sono.tighten(sono.start("3_1"), 12, settings=QUICK)


def test_time_limit_gives_the_best_so_far() -> None:
    tight = sono.tighten(sono.start("3_1"), 50_000, time_limit=1e-9)
    assert not tight.converged
    assert tight.measures.n < 50_000
    assert tight.measures.l_p > 32


@pytest.mark.usefixtures("slices")
def test_keyboard_interrupt_passes_through() -> None:
    def interrupt(progress: Progress) -> None:
        raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        sono.tighten(sono.start("3_1"), 40, watch=interrupt)


@pytest.mark.usefixtures("slices")
@pytest.mark.parametrize(
    ("method", "stages"),
    [
        ("both", ["collapse", "anneal", "trial", "climb", "polish"]),
        ("sono", ["collapse", "anneal", "reanneal", "settle"]),
        ("polish", ["climb", "polish"]),
    ],
)
def test_progress_climbs_to_the_target(method: Method, stages: list[str]) -> None:
    seen: list[Progress] = []
    sono.tighten(sono.start("3_1"), 160, method=method, trials=1, settings=QUICK, watch=seen.append)
    assert {progress.target for progress in seen} == {160}
    assert {progress.trial for progress in seen} <= {1, 2}
    met = [progress.stage for progress in seen]
    assert met == sorted(met, key=stages.index)
    assert [progress.n for progress in seen if progress.stage == stages[-1]][-1] == 160
    assert all(0 <= progress.status.progress <= 1 for progress in seen if progress.status)


@pytest.mark.usefixtures("slices")
def test_a_run_saved_at_each_slice_gives_the_same() -> None:
    stops = 0

    def stop(progress: Progress) -> None:
        nonlocal stops
        stops += 1
        raise Stopped

    whole = Run(sono.start("3_1"), [40, 60, 130], QUICK)
    parts = Run(sono.start("3_1"), [40, 60, 130], QUICK)
    while whole.targets:
        expected = whole.tighten()
        tight = None
        while tight is None:
            try:
                tight = parts.tighten(stop)
            except Stopped:
                parts = Run.restore(json.loads(json.dumps(parts.state())))
        assert (tight.sweeps, tight.converged) == (expected.sweeps, expected.converged)
        assert all(map(np.array_equal, tight.curve, expected.curve))
        whole.next_target()
        parts.next_target()
    assert stops > 10


def test_a_reached_target_is_reached_again_at_once() -> None:
    run = Run(sono.start("3_1"), [60, 40, 60], QUICK)
    assert run.targets == [40, 60]
    first = run.tighten()
    again = Run.restore(json.loads(json.dumps(run.state()))).tighten()
    assert np.array_equal(first.curve, again.curve)
    assert (first.sweeps, first.converged) == (again.sweeps, again.converged)


def test_a_target_out_of_reach_can_be_left() -> None:
    run = Run(sono.start("3_1"), [12, 60], QUICK)
    with pytest.raises(sono.CurveError):
        run.tighten()
    run.next_target()
    direct = sono.tighten(sono.start("3_1"), 60, settings=QUICK)
    assert np.array_equal(run.tighten().curve, direct.curve)


def refuse(monkeypatch: pytest.MonkeyPatch, error: Exception, when: Callable[[int, str, int], bool]) -> None:
    """Let those stages fail of which `when` says so, given their number from 1, their name and n."""
    begin, begun = Run._engine, 0

    def engine(self: Run, stage: Stage, n: int) -> Any:
        nonlocal begun
        begun += 1
        if when(begun, stage, n):
            raise error
        return begin(self, stage, n)

    monkeypatch.setattr(Run, "_engine", engine)


@pytest.mark.parametrize("stage", ["collapse", "anneal", "trial"])
@pytest.mark.parametrize("error", [sono.CurveError("too thin"), PanicError("index out of bounds")])
def test_a_trial_that_fails_is_one_less(
    monkeypatch: pytest.MonkeyPatch, error: Exception, stage: str
) -> None:
    refuse(monkeypatch, error, lambda number, what, n: number > 3 and what == stage)
    tight = sono.tighten(sono.start("3_1"), 60, trials=3, settings=QUICK)
    assert tight.converged
    assert tight.failed == 2 * [str(error)]
    assert tight.shapes == [pytest.approx(tight.measures.l_a, rel=1e-6)]


def test_later_targets_outlive_a_failure(monkeypatch: pytest.MonkeyPatch) -> None:
    run = Run(sono.start("Hopf"), [20, 60], {"seed": 1})
    assert run.tighten().converged
    run.next_target()
    assert run.tighten().converged
    refuse(monkeypatch, sono.CurveError("too coarse"), lambda _, stage, n: (stage, n) == ("polish", 130))
    run = Run(sono.start("3_1"), [60, 130, 140], QUICK)
    shapes = run.tighten().shapes
    run.next_target()
    with pytest.raises(sono.CurveError, match="too coarse"):
        run.tighten()
    run.next_target()
    tight = run.tighten()
    assert (tight.converged, tight.measures.n, tight.shapes) == (True, 140, shapes)


def test_a_later_offset_that_fails_leaves_the_first(monkeypatch: pytest.MonkeyPatch) -> None:
    one = sono.tighten(sono.start("3_1"), 130, trials=1, settings=QUICK)
    polishes = 0

    def third(number: int, stage: str, n: int) -> bool:
        nonlocal polishes
        polishes += stage == "polish"
        return polishes > 1

    refuse(monkeypatch, sono.CurveError("too coarse"), third)
    other = sono.tighten(sono.start("3_1"), 130, trials=1, settings=QUICK)
    assert other.converged
    assert other.measures.l_p == pytest.approx(one.measures.l_p, rel=1e-3)


def test_where_no_trial_succeeds_the_error_is_told() -> None:
    with pytest.raises(sono.CurveError, match="12 vertices are too few") as caught:
        sono.tighten(sono.start("3_1"), 12, settings=QUICK)
    assert 12 < (caught.value.needed or 0) < 40
    crossing = np.array([[0, 0, 0], [2, 2, 0], [2, 0, 0], [0, 2, 0]])
    with pytest.raises(sono.CurveError, match="crosses itself") as caught:
        sono.tighten(crossing, 60)
    assert caught.value.needed is None


def other_knots(monkeypatch: pytest.MonkeyPatch, changed: set[int]) -> None:
    """Let the ropes that come in these places seem to be of another type."""
    place = count()

    def seen(curve: Components) -> invariants.Fingerprint:
        found = invariants.fingerprint(curve)
        return ((7,), *found[1:]) if next(place) in changed else found

    monkeypatch.setattr(pipeline, "fingerprint", seen)


def test_a_trial_that_changes_the_type_is_dropped(monkeypatch: pytest.MonkeyPatch) -> None:
    other_knots(monkeypatch, {2})  # after the curve itself and the first collapse: the first anneal
    tight = tighten(starts.start("3_1"), 60, trials=3)
    assert tight.converged
    assert len(tight.shapes) == 2
    (why,) = tight.failed
    assert "came out as another knot" in why


@pytest.mark.parametrize("method", get_args(Method))
def test_another_knot_is_never_delivered(monkeypatch: pytest.MonkeyPatch, method: Method) -> None:
    other_knots(monkeypatch, set(range(1, 1000)))
    with pytest.raises(KnotTypeError, match="came out as another knot"):
        tighten(starts.start("3_1"), 60, method=method, settings={"anneal_sweeps": 1000})


def test_a_knot_lost_at_the_last_polish_is_not_delivered(monkeypatch: pytest.MonkeyPatch) -> None:
    run = Run(starts.start("3_1"), [60], {}, trials=1)
    other_knots(monkeypatch, {4})  # the curve, collapse, anneal, trial, polish
    with pytest.raises(KnotTypeError, match="the polish at n = 60"):
        run.tighten()


def test_a_thin_curve_is_loosened_once_for_all_trials() -> None:
    polygon = entangled(16, 3)
    run = Run([polygon], [120], {}, trials=3)
    stages = []
    tight = run.tighten(lambda progress: stages.append((progress.trial, progress.status)))
    assert tight.loosened
    assert len(tight.shapes) == 3
    loosening = {trial for trial, status in stages if getattr(status, "stage", None) == "loosen"}
    assert loosening == {1}


@pytest.mark.parametrize("method", ["both", "sono"])
@pytest.mark.parametrize("n", [15, 21])
def test_a_trefoil_on_as_few_beads_as_in_the_papers_figures(n: int, method: Method) -> None:
    tight = tighten(starts.start("3_1"), n, method=method)
    assert tight.converged
    assert invariants.fingerprint(tight.curve) == invariants.fingerprint(starts.start("3_1"))
    # Neighbours touch; edges so long leave no bound.
    assert tight.measures.l_p < 31
    assert tight.measures.dl < 2
    assert tight.measures.l_c is None


def test_the_least_n_is_told_and_will_do() -> None:
    with pytest.raises(sono.CurveError, match="strands would fit between beads; ask for at least") as caught:
        tighten(starts.start("3_1"), 9)
    needed = caught.value.needed or 0
    assert 10 < needed < 17
    assert tighten(starts.start("3_1"), needed).converged


@pytest.mark.parametrize("knot", ["3_1", "4_1"])
def test_ropes_of_the_coarsest_edges_are_tight_one_after_another(knot: str) -> None:
    """What holds a rope on few beads is nothing to begin the next few with."""
    least = {"3_1": 14, "4_1": 21}[knot]
    run = Run(starts.start(knot), list(range(least, least + 6)), {}, trials=4)
    while run.targets:
        tight = run.tighten()
        assert tight.converged, run.targets[0]
        assert tight.measures.dispersion < 1e-6
        run.next_target()


def test_a_rope_too_entangled_to_compare_is_kept_by_its_moves(monkeypatch: pytest.MonkeyPatch) -> None:
    def too_entangled(_: object) -> None:
        raise sono.TooEntangledError("over 1000 crossings")

    monkeypatch.setattr("sono.tightening.run.fingerprint", too_entangled)
    assert tighten(starts.start("3_1"), 60, trials=1).converged
