"""The shapes that the package carries: they are the atlas's knots, and lead to the atlas's ropes."""

from pathlib import Path

import numpy as np
import pytest
from conftest import Sono

import sono as api
from sono import formats, measure, starts
from sono.invariants import fingerprint
from sono.jobs.atlas import Atlas
from sono.jobs.shapes import refresh
from sono.starts import shapes
from sono.tightening.run import Run

KNOTS = Path(__file__).parent.parent / "knots"
LENGTHS = shapes.lengths()


def test_there_is_one_of_each_knot_in_the_atlas() -> None:
    rows = Atlas(KNOTS).rows()
    assert {knot: row["l_a"] for knot, row in rows.items()} == LENGTHS
    assert shapes.FILE.stat().st_size < 2000 * len(rows)  # type: ignore[attr-defined]


@pytest.mark.parametrize("knot", LENGTHS)
def test_shapes_are_the_knots_of_their_names(knot: str) -> None:
    shape = starts.known(knot)
    assert shape
    assert fingerprint(shape) == fingerprint(starts.start(knot))
    measures = measure(shape)
    assert measures.l_p / measures.r_s == pytest.approx(LENGTHS[knot], rel=0.01)
    assert measures.r_s == pytest.approx(1, abs=0.01)
    assert measures.dl == pytest.approx(shapes.EDGE, rel=0.01)


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
    assert starts.known("8_22") is starts.known("m") is starts.known("T(2,59)") is None


@pytest.mark.slow
@pytest.mark.parametrize("knot", ["3_1", "6_2", "8_18", "9_40", "10_161"])
def test_a_shape_leads_to_the_rope_of_the_atlas(knot: str) -> None:
    rope = formats.read(KNOTS / "tight" / f"{knot}.txt").components
    n = sum(map(len, rope))
    tight = api.tighten(knot, n)
    assert (tight.converged, tight.known, tight.shapes) == (True, True, [])
    assert (tight.measures.l_a or 0) < (measure(rope).l_a or 0) + 1e-3
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
    assert "begun with the atlas's shape; --start drawn begins with a loose one" in known.stderr
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
    assert result.stdout.startswith("# m8_18, the shape of the atlas\n")
    assert api.start("m8_18", known=True) == api.Curve(starts.known("m8_18") or [])
    assert result.stdout.count("\n") == 1 + len(api.start("m8_18", known=True)[0])
    for wrong in (("T(2,59)",), ("8_18", "--variant", "1"), ("--braid", "1 1 1"), ("8_99",)):
        refused = sono("start", *wrong, "--known")
        assert refused.exit_code == 2
    assert "the atlas has no shape of 'T(2,59)'" in sono("start", "T(2,59)", "--known").stderr
    with pytest.raises(ValueError, match="the atlas has one shape"):
        api.start("8_18", 3, known=True)


def test_what_is_shorter_takes_its_place(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    hopf = api.tighten("Hopf", 126)
    (tmp_path / "tight").mkdir()
    formats.write(tmp_path / "tight" / "Hopf.txt", hopf.curve)
    (tmp_path / "atlas.tsv").write_text(f"knot\tl_a\nHopf\t{hopf.measures.l_a}\n")
    own = tmp_path / "shapes.npz"
    own.write_bytes(shapes.packed({"3_1": shapes.Shape(shapes.shape("3_1"), LENGTHS["3_1"])}))
    monkeypatch.setattr(shapes, "FILE", own)
    shapes.lengths.cache_clear()
    assert refresh(Atlas(tmp_path)) == ["Hopf"]
    assert refresh(Atlas(tmp_path)) == []
    assert list(shapes.lengths()) == ["3_1", "Hopf"]
    found = starts.known("hopf")
    assert found
    assert len(found) == 2
    assert fingerprint(found) == fingerprint(starts.start("Hopf"))
    monkeypatch.undo()
    shapes.lengths.cache_clear()
