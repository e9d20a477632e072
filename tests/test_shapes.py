"""The ropes that the package carries: they are the knots of their names, and what tightening begins with."""

from pathlib import Path

import numpy as np
import pytest
from conftest import Sono, a_tenth

import sono as api
from sono import measure, starts
from sono.invariants import fingerprint
from sono.starts import archive, knotinfo, shapes
from sono.tightening.run import Run

ROPES = {
    knot: archive.unpacked(data)
    for knot, data in archive.read(shapes.FOLDER.joinpath("knots.zip").read_bytes()).items()
}


def test_a_rope_comes_back_as_it_was_but_for_rounding() -> None:
    ropes = {"3_1": starts.known("3_1") or [], "5^2_1": starts.start("5^2_1"), "far": [1e4 * np.eye(3)]}
    packed = {name: archive.packed(rope) for name, rope in ropes.items()}
    for name, data in archive.read(archive.written(packed)).items():
        for one, other in zip(archive.unpacked(data), ropes[name], strict=True):
            assert one == pytest.approx(other, abs=0.6 / archive.PARTS)
            assert archive.packed(archive.unpacked(data)) == data
    assert sum(map(len, packed.values())) < 10 * sum(len(c) for rope in ropes.values() for c in rope)


def test_a_place_is_that_of_the_knot_whatever_it_is_called() -> None:
    for family, knot, spellings in (
        ("knots", "8_20", ["8.20", "K8n1", "8:1:20", "8_20"]),
        ("knots", "11n_34", ["K11n34", "11N_34", "11n34"]),
        ("links", "L5a1", ["Whitehead", "5^2_1", "L5a1{1}", "L5a1"]),
        ("links", "L2a1", ["Hopf", "2^2_1"]),
        ("torus", "T(3,4)", ["T(4,3)", "T(-3,-4)", "T( 3 , 4 )", "t[3,4]"]),
        ("composites", "3_1#m3_1", ["square", "m3_1#3_1", "3_1 # mirror image of 3_1"]),
        ("composites", "3_1#4_1", ["4_1#3_1", "m4_1#3_1"]),
        ("composites", "3_1#3_1#m3_1", ["3_1#(m3_1#3_1)"]),
    ):
        assert {shapes.place(name) for name in spellings} == {shapes.Place(family, knot)}
    for family, knot, spellings in (
        ("knots", "8_20", ["m8_20", "m8.20"]),
        ("torus", "T(3,4)", ["T(-3,4)", "mT(4,3)"]),
        ("composites", "3_1#4_1", ["m3_1#4_1", "m(3_1#4_1)"]),
        ("composites", "3_1#3_1#m3_1", ["m3_1#m3_1#3_1"]),
    ):
        assert {shapes.place(name) for name in spellings} == {shapes.Place(family, knot, mirrored=True)}


@pytest.mark.parametrize("knot", a_tenth(ROPES))
def test_ropes_are_tight_and_of_the_knots_of_their_names(knot: str) -> None:
    rope = ROPES[knot]
    assert fingerprint(rope) == fingerprint(starts.start(knot))
    measures = measure(rope)
    assert measures.r_s == pytest.approx(1, abs=1e-6)
    assert measures.dispersion < 1e-6


def test_names_in_other_spellings_are_compared() -> None:
    published = api.compare(starts.known("8_20") or [], "8_20").published
    assert published
    assert [api.compare(starts.known("8_20") or [], name).published for name in ("K8n1", "m8.20")] == 2 * [
        published
    ]


def test_mirror_images_and_names_in_any_case() -> None:
    shape, mirrored = starts.known("8_20"), starts.known(" M8_20 ")
    assert shape
    assert mirrored
    assert np.array_equal(mirrored[0], shape[0] * [1, 1, -1])
    for spelling in ("8.20", "K8n1", "8:1:20"):
        again = starts.known(spelling)
        assert again
        assert np.array_equal(again[0], shape[0])
    assert starts.known("8_22") is starts.known("m") is starts.known("T(2,103)") is None


@pytest.mark.slow
@pytest.mark.parametrize("knot", ["3_1", "6_2", "8_18", "9_40", "10_161"])
def test_a_shape_leads_to_the_rope_of_the_atlas(knot: str) -> None:
    rope = ROPES[knot]
    n = sum(map(len, rope))
    tight = api.tighten(knot, n)
    assert (tight.converged, tight.known, tight.shapes) == (True, True, [])
    assert (tight.measures.l_a or 0) < (measure(rope).l_a or 0) + 1e-6
    assert fingerprint(tight.curve) == fingerprint(starts.start(knot))


def test_long_edges_are_tried_anew_and_short_ones_begin_with_the_shape() -> None:
    known = starts.known("3_1")
    run = Run(starts.start("3_1"), [40, 80, 160], {}, trials=1, known=known)
    coarse = run.tighten()
    assert (coarse.known, len(coarse.shapes)) == (False, 1)
    run.next_target()
    fine = Run.restore(run.state()).tighten()
    assert (fine.known, fine.converged, fine.shapes) == (True, True, [])
    assert run.tighten().curve == fine.curve


def test_a_shape_that_is_another_knot_is_not_used() -> None:
    tight = Run(starts.start("3_1"), [80], {}, trials=1, known=starts.known("m3_1")).tighten()
    assert (tight.known, tight.converged) == (False, True)
    assert fingerprint(tight.curve) == fingerprint(starts.start("3_1"))


def test_the_command_says_what_it_began_with(sono: Sono) -> None:
    known = sono("tighten", "4_1", "-n", "120", "-o", "k.txt")
    assert known.exit_code == 0
    assert "begun with the atlas's rope; --start drawn begins with a loose one" in known.stderr
    drawn = sono("tighten", "4_1", "-n", "120", "--start", "drawn", "--trials", "2", "-o", "d.txt")
    assert "2 trials" in drawn.stderr
    assert "atlas" not in drawn.stderr
    again = sono("tighten", "4_1", "-n", "120", "-o", "k.txt", "--resume")
    assert (again.exit_code, again.stdout) == (0, known.stdout)
    other = sono("tighten", "4_1", "-n", "120", "-o", "k.txt", "--resume", "--start", "drawn")
    assert (other.exit_code, "is of another curve" in other.stderr) == (1, True)
    sono_alone = sono("tighten", "4_1", "-n", "120", "--method", "sono", "-o", "s.txt")
    assert "atlas" not in sono_alone.stderr


def test_the_shape_is_written(sono: Sono) -> None:
    result = sono("start", "m8_18", "--known")
    assert result.stdout.startswith("# m8_18, the rope of the atlas\n")
    assert api.start("m8_18", known=True) == api.Curve(starts.known("m8_18") or [])
    assert result.stdout.count("\n") == 1 + len(api.start("m8_18", known=True)[0])
    for wrong in (("T(2,103)",), ("8_18", "--variant", "1"), ("--braid", "1 1 1"), ("8_99",)):
        refused = sono("start", *wrong, "--known")
        assert refused.exit_code == 2
    assert "the atlas has no rope of 'T(2,103)'" in sono("start", "T(2,103)", "--known").stderr
    with pytest.raises(ValueError, match="the atlas has one rope"):
        api.start("8_18", 3, known=True)


def test_a_knot_of_a_table_that_is_not_installed_begins_with_its_rope(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def missing(name: str) -> None:
        raise ImportError(name)

    monkeypatch.setattr(knotinfo, "knot_row", missing)
    monkeypatch.setattr(shapes, "FOLDER", tmp_path)
    with pytest.raises(ValueError, match=r"pip install 'sono\[knotinfo\]'"):
        starts.drawn("11a_1")
    (tmp_path / "knots.zip").write_bytes(archive.written({"11a_1": archive.packed(ROPES["3_1"])}))
    assert [c.tolist() for c in starts.drawn("K11a1")] == [c.tolist() for c in ROPES["3_1"]]


def test_a_place_has_the_name_that_published_values_go_by() -> None:
    names = [
        "8.20",
        "Whitehead",
        "Hopf",
        "m5_1#3_1",
        "5_1#m3_1",
        "square",
        "m4_1#3_1",
        "3_1#m3_1#m3_1",
        "T(24,-19)",
    ]
    assert [shapes.place(name).knot for name in names] == [starts.canonical(name) for name in names]


@pytest.mark.parametrize(
    ("name", "knot"),
    [
        ("P(-2,3,7)", "12n_242"),
        ("P(2,-3,-7)", "m12n_242"),
        ("m P(-2,3,7)", "m12n_242"),
        ("pretzel(3,3,3)", "m9_35"),
        ("7/3", "5_2"),
        ("7/-3", "m5_2"),
        ("C(3,1,2)", "6_2"),
        ("dt:4 6 8 2", "4_1"),
        ("mdt:4 6 2", "m3_1"),
        ("-1 -1 -1", "m3_1"),
        ("(1 -2)^4", "8_18"),
        ("Turk's head 3x5", "10_123"),
        ("1 1 1 -2 -2 -2", "3_1#m3_1"),
        ("1 2 1 2 1 2 1 2 1 2 1 2 1 2", "T(3,7)"),
    ],
)
def test_what_is_drawn_from_a_diagram_has_the_rope_of_its_type(name: str, knot: str) -> None:
    rope = starts.known(name)
    assert rope is not None
    assert np.array_equal(rope[0], np.asarray((starts.known(knot) or [])[0]))
    assert api.verify(rope, starts.start(name)).verdict == "same"


@pytest.mark.parametrize("name", ["gauss:1 -2 | 2 -1", "-1 -1", "4/1", "-4/1", "4/-3", "8/3", "P(2,2,2)"])
def test_the_rope_of_a_link_runs_as_its_diagram_does(name: str) -> None:
    rope = starts.known(name)
    assert rope is not None
    assert api.verify(rope, starts.start(name)).verdict == "same"


@pytest.mark.parametrize(
    "name", ["P(-2,3,9)", "P(5,7,9)", "3 1", "1 -1", "chain4", "pd:[]", "(1 2)^0", "foo"]
)
def test_what_the_atlas_has_not_by_any_name(name: str) -> None:
    assert starts.known(name) is None


@pytest.mark.parametrize(
    ("name", "meant"),
    [("3 1", "did you mean '3_1'?"), ("8 20", "mean '8_20'?"), ("1 1 3 3", "give every generator up to the")],
)
def test_a_braid_that_falls_into_pieces_is_doubted(name: str, meant: str, sono: Sono) -> None:
    doubt = starts.doubt(name)
    assert doubt is not None
    assert meant in doubt
    assert f"sono: {doubt}\n" == sono("start", name, "-o", "k.txt").stderr
    for whole in ("1 -2 1 -2", "1 1", "-2 1", "3_1", "gauss:1 -2 | 2 -1", "3 1 2"):
        assert starts.doubt(whole) is None
