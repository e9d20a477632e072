"""The public calls and their records: what goes in, what comes out, and that it can be passed on."""

import copy
import json
import pickle
import re
from collections.abc import Callable
from concurrent.futures import ProcessPoolExecutor
from multiprocessing import get_context
from pathlib import Path
from typing import Any, cast

import numpy as np
import pytest

import sono
from sono import Curve, Progress, Tight
from sono.records import Record

SQUARE = np.array([[1.0, 1, 0], [-1, 1, 0], [-1, -1, 0], [1, -1, 0]])


@pytest.fixture(scope="module")
def tight() -> Tight:
    return sono.tighten("Hopf", 60, seed=1)


def records(tight: Tight) -> list[Record]:
    assert tight.forces
    minimum = sono.search("3_1", trials=1)[0]
    return [tight.curve, tight.measures, tight.forces, tight, minimum, sono.compare(tight, "3_1")]


def test_records_are_equal_by_value_and_can_be_passed_on(tight: Tight) -> None:
    for record in records(tight):
        for again in (pickle.loads(pickle.dumps(record)), copy.copy(record), copy.deepcopy(record)):
            assert again == record
            assert type(again) is type(record)
        assert json.loads(json.dumps(record.to_dict())) == record.to_dict()
        assert repr(record).startswith(type(record).__name__)
        html = record._repr_html_()
        assert html.startswith("<table><caption>")
        assert "array(" not in html
        assert record != 3
    with pytest.raises(AttributeError):
        tight.converged = False  # type: ignore[misc]


def test_records_differ_where_a_bit_does(tight: Tight) -> None:
    moved = [component.copy() for component in tight.curve]
    moved[1][7, 2] = np.nextafter(moved[1][7, 2], 1)
    assert Curve(moved) != tight.curve
    assert Curve(moved[:1]) != tight.curve


def test_rows_for_data_frames_are_flat(tight: Tight) -> None:
    row = tight.to_dict()
    assert (row["l_p"], row["n"], row["converged"]) == (tight.measures.l_p, 60, True)
    minimum = sono.search("3_1", trials=1)[0]
    assert minimum.to_dict()["l_a"] == minimum.measures.l_a


def test_a_curve_is_like_the_list_of_its_components() -> None:
    link = Curve([SQUARE, SQUARE[:3] + 5])
    assert (len(link), link.n, [len(component) for component in link]) == (2, 7, [4, 3])
    assert repr(link) == "Curve(4 + 3 vertices)"
    np.testing.assert_array_equal(link[1], SQUARE[:3] + 5)
    with pytest.raises(ValueError, match="read-only"):
        link[0][0, 0] = 2
    for wrong in (np.zeros((4, 2)), [np.zeros(4)], 5.0):
        with pytest.raises(ValueError, match=r"vertices must have the shape \(n, 3\)"):
            Curve(wrong)
    with pytest.raises(ValueError, match="component 1 has 2 vertices; a closed curve has 3 at least"):
        Curve([SQUARE, SQUARE[:2]])
    with pytest.raises(ValueError, match="vertex 2 of component 0 is not finite"):
        Curve(SQUARE * [[1], [1], [np.nan], [1]])


@pytest.mark.parametrize("make", [np.array, lambda c: [c], Curve, lambda c: c.tolist()])
def test_curves_go_in_as_arrays_lists_and_curves(make: Callable[[Any], Any]) -> None:
    assert sono.measure(make(SQUARE)).l_p == pytest.approx(8)


def test_names_go_in_too(tmp_path: Path) -> None:
    for call in (sono.measure, sono.descriptors, sono.forces):
        assert call("3_1") == call(sono.start("3_1", known=True))
    sono.write(tmp_path / "hopf.vect", "Hopf")
    assert sono.read(tmp_path / "hopf.vect") == sono.start("Hopf")
    assert "8_18" in sono.names()
    with pytest.raises(ValueError, match="there is only '3_1'"):
        sono.start("3_11")


def test_contacts_are_told_by_component_and_bead(tight: Tight) -> None:
    forces = tight.forces
    assert forces
    first = np.cumsum([0, *map(len, tight.curve)])
    places = forces.places
    assert places.shape == (len(forces.contacts), 2, 2)
    assert set(places[:, :, 0].ravel().tolist()) == {0, 1}
    np.testing.assert_array_equal(first[places[..., 0]] + places[..., 1], forces.contacts)
    beads = [[tight.curve[c][i] for c, i in pair] for pair in places[forces.pressing > 1e-3]]
    assert beads
    assert np.allclose([np.linalg.norm(one - other) for one, other in beads], 2, atol=1e-6)


@pytest.mark.parametrize("dl", [0.7, 0.31, 0.1])
def test_ropes_have_the_edges_that_were_asked_for(dl: float) -> None:
    tight = sono.tighten("3_1", dl=dl, trials=1)
    assert tight.converged
    assert tight.measures.n == round(tight.measures.l_p / dl)


def test_n_and_dl_exclude_each_other() -> None:
    with pytest.raises(ValueError, match="not both"):
        sono.tighten("3_1", 60, dl=0.1)
    for dl in (0.0, 1.5, float("nan")):
        with pytest.raises(ValueError, match="no edge length"):
            sono.tighten("3_1", dl=dl)


@pytest.mark.parametrize("dl", [None, 0.2])
def test_who_watches_stops_and_keeps_the_best(dl: float | None) -> None:
    seen: list[Progress] = []

    def watch(progress: Progress) -> bool:
        seen.append(progress)
        return progress.trial == 2

    tight = sono.tighten("3_1", dl=dl, known=False, watch=watch)
    assert not tight.converged
    assert len(tight.shapes) == 1
    assert tight.measures.r_s == pytest.approx(1)
    assert [progress.trial for progress in seen].count(2) == 1

    def stop(progress: Progress) -> None:
        raise sono.Stopped("enough")

    with pytest.raises(sono.Stopped, match="enough"):
        sono.tighten("3_1", dl=dl, watch=stop)


def test_minima_are_the_same_whatever_the_number_of_jobs() -> None:
    one, other = (sono.search("4_1", trials=3, jobs=jobs, minima=2) for jobs in (1, 3))
    assert one == other
    assert [minimum.length for minimum in one] == sorted(minimum.length for minimum in one)
    fine = sono.search("4_1", trials=1, dl=0.3)[0]
    assert fine.measures.dl == pytest.approx(0.3, rel=0.01)


def test_comparisons_say_what_they_compare_with() -> None:
    found = sono.compare(sono.tighten("3_1", 240), "m3_1")
    assert found.published == pytest.approx(32.7436, abs=1e-3)
    assert found.source
    assert found.l_a_difference == pytest.approx((found.l_a or 0) - (found.published or 0))
    assert found.kind == "bound"
    assert sono.compare("Hopf", "T(7,3)").published is None


def test_results_cross_processes() -> None:
    with ProcessPoolExecutor(1, mp_context=get_context("spawn")) as pool:
        assert pool.submit(sono.tighten, "3_1", 40, trials=1).result().converged


def test_what_there_is_can_be_listed() -> None:
    for name in dir(sono):
        assert getattr(sono, name) is not None
        assert name.startswith("__") or getattr(sono, name).__doc__
    with pytest.raises(AttributeError, match="no attribute 'nonsense'"):
        _ = sono.nonsense


@pytest.mark.parametrize(
    ("call", "why"),
    [
        (lambda: sono.refine("3_1", 10**9), "n = 1000000000 is no whole number from 3 to 500000"),
        (lambda: sono.refine("3_1", -1), "n = -1 is no whole number from 3 to 500000"),
        (lambda: sono.tighten("3_1", cast(Any, 60.5)), "n = 60.5 is no whole number"),
        (lambda: sono.tighten("3_1", True), "n = True is no whole number"),
        (lambda: sono.tighten("3_1", 60, trials=cast(Any, "x")), "trials = 'x' is no whole number"),
        (lambda: sono.tighten("3_1", 60, seed=cast(Any, "x")), "seed = 'x' is no whole number"),
        (lambda: sono.tighten("nofile.txt", 60), "sono.read reads a file"),
        (lambda: sono.search("3_1", trials=0), "trials = 0 is no whole number of 1 at least"),
        (lambda: sono.search("3_1", jobs=0), "jobs = 0 is no whole number from 1 to 256"),
        (lambda: sono.search("3_1", minima=0), "minima = 0 is no whole number of 1 at least"),
        (lambda: sono.search("3_1", seed=-1), "seed = -1 is no whole number"),
        (lambda: sono.search("3_1", dl=float("nan")), "dl = nan is no edge length"),
        (lambda: sono.start(cast(Any, 31)), "31 is no name of a knot"),
        (lambda: sono.start("3_1", cast(Any, 1.5)), "variant = 1.5 is no whole number"),
        (lambda: sono.compare("3_1", "nosuch"), "'nosuch' is no name of a knot"),
        (lambda: sono.compare("3_1", cast(Any, SQUARE)), "is no name of a knot"),
        (lambda: sono.write("x.txt", SQUARE * np.nan), "vertex 0 of component 0 is not finite"),
    ],
)
def test_wrong_arguments_are_named(call: Callable[[], Any], why: str) -> None:
    with pytest.raises(ValueError, match=re.escape(why)):
        call()


def test_what_a_call_gave_goes_in_like_a_curve(tight: Tight) -> None:
    minimum = sono.search("3_1", trials=1)[0]
    assert Curve(cast(Any, tight)) == tight.curve
    assert sono.measure(minimum) == minimum.measures
    assert minimum.to_dict()["length"] == minimum.measures.length
    assert sono.refine(tight, 100).n == 100
    assert tight.forces
    with pytest.raises(ValueError, match="read-only"):
        tight.forces.tension[0] = 1
