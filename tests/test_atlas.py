"""The atlas: what it ships, that it never gets worse, and that it believes no name."""

import re
from pathlib import Path

import pytest
from conftest import Sono, a_tenth

from sono import certify, formats, measure, starts, tables
from sono import tighten as sono_tighten
from sono.jobs.atlas import Atlas, confirmed_type
from sono.searching import trials
from sono.starts import archive, shapes

SHIPPED = Atlas(Path(str(shapes.FOLDER)))
ROWS = SHIPPED.rows()


def tight(path: Path, knot: str, n: int) -> str:
    """Write a tight rope, as a search would."""
    shape = trials.attempt(trials.Source.of(starts.start(knot), knot), 0)
    assert shape.curve
    found = sono_tighten(shape.curve, n, method="polish")
    header = f"{knot}: tight, rope radius R_s = 1"
    formats.write(path, found.curve, [header, "searched: variant 0, seed 0, met in 1 of 1 trials, 1 s"])
    return str(path)


@pytest.mark.parametrize("knot", a_tenth(ROWS))
def test_rows_are_what_their_ropes_are(knot: str) -> None:
    row = SHIPPED.checked(knot)
    measures = measure(SHIPPED.rope(knot))
    for key in ("n", "dl", "l_p", "l_a"):
        assert row[key] == pytest.approx(getattr(measures, key), rel=1e-11)
    assert row["l_c"] == float(certify(SHIPPED.rope(knot)).l_c)
    assert abs(measures.r_s - 1) < 1e-6
    assert measures.dispersion < 1e-6
    assert row["type"] == ROWS[knot]["type"]
    assert float(row["l_c"] or 0) > float(row["l_c_fine"] or 0)


def test_a_family_is_as_long_as_its_archive() -> None:
    for family in SHIPPED.families.values():
        assert list(family.rows) == list(family.ropes)
        assert {shapes.place(knot).family for knot in family.rows} <= {family.name}
        assert all(shapes.place(knot).knot == knot for knot in family.rows)


def test_all_knots_to_ten_crossings_are_there_and_as_short_as_published() -> None:
    small = [ROWS[row["knot"]] for row in starts.table("knots")]
    assert sum(float(row["l_a_difference"] or 1) <= 0 for row in small) >= 248
    assert sum(float(row["l_c_difference"] or 1) <= 0 for row in small) >= 244


@pytest.mark.slow
@pytest.mark.parametrize("knot", ["3_1", "8_19"])
def test_the_finer_bound_is_what_the_rope_leads_to(knot: str) -> None:
    fine = sono_tighten(SHIPPED.rope(knot), int(ROWS[knot]["n_fine"] or 0), method="polish")
    # Beads may lie in another groove on another machine.
    assert fine.measures.l_c == pytest.approx(ROWS[knot]["l_c_fine"], rel=1e-4)


@pytest.mark.slow
def test_a_row_never_gets_worse(tmp_path: Path) -> None:
    atlas = Atlas(tmp_path)
    # 6_1 has two minima; the braid, variant 0, leads to the longer one.
    short, long = tmp_path / "short.txt", tmp_path / "long.txt"
    tight(long, "6_1", 288)
    shape = trials.attempt(trials.Source.of(starts.start("6_1"), "6_1"), 7)
    assert shape.curve
    formats.write(short, shape.curve)
    row = atlas.take("6_1", str(long))
    assert (row["variant"], row["seed"], row["published"]) == (0, 0, 56.7058)
    better = atlas.take("6_1", str(short))
    assert float(better["l_a"] or 0) < 56.7058 < float(row["l_a"] or 0)
    assert better["variant"] is None  # it did not say
    assert atlas.take("6_1", str(long)) == better == atlas.checked("6_1")
    assert tables.read(str(tmp_path / "knots.tsv")) == [better]


def test_ropes_are_brought_to_one_edge_length(tmp_path: Path) -> None:
    row = Atlas(tmp_path / "one").take("3_1", tight(tmp_path / "coarse.txt", "3_1", 60))
    assert abs(float(row["dl"] or 0) - 0.2) < 0.004
    assert row["l_a"] == pytest.approx(32.7429, abs=1e-3)  # 32.7192 at n = 60
    rope = Atlas(tmp_path / "one").rope("3_1")
    formats.write(tmp_path / "large.txt", [7 * component for component in rope])
    other = Atlas(tmp_path / "two")
    assert other.take("3_1", str(tmp_path / "large.txt"))["l_a"] == pytest.approx(row["l_a"], abs=1e-3)
    assert measure(other.rope("3_1")).r_s == pytest.approx(1, abs=1e-7)


def test_families_have_files_of_their_own(tmp_path: Path) -> None:
    atlas = Atlas(tmp_path)
    for name, family in (("Hopf", "links"), ("T(-3,2)", "torus"), ("3_1#m3_1", "composites")):
        knot = shapes.place(name).knot
        formats.write(tmp_path / "rope.txt", SHIPPED.rope(knot))
        row = atlas.take(knot, str(tmp_path / "rope.txt"))
        assert (row["knot"], row["type"]) == (knot, "proven")
        again = Atlas(tmp_path)
        assert list(again.families[family].rows) == [knot]
        assert again.checked(knot) == row


def test_another_knot_is_not_taken(tmp_path: Path) -> None:
    atlas = Atlas(tmp_path / "mine")
    trefoil = tight(tmp_path / "3_1.txt", "3_1", 120)
    for name in ("4_1", "m3_1"):
        with pytest.raises(ValueError, match=f"3_1.txt: is of another knot type than {name}; remove it"):
            atlas.take(name, trefoil)
    for name in ("L5a1", "3_1#3_1", "T(2,5)"):
        with pytest.raises(ValueError, match=f"is of another knot type than {re.escape(name)}"):
            atlas.take(name, trefoil)
    assert not (tmp_path / "mine").exists()
    assert confirmed_type("3_1", starts.start("3_1", 1), "3_1.txt") == "proven"


def test_the_command_updates_and_checks(folder: Path, sono: Sono) -> None:
    more = ("--folder", "mine", "--checkpoint", "kept")
    assert sono("atlas", "3_1", *more).exit_code == 2
    result = sono("atlas", "3_1", "10_999", "--update", "--trials", "1", *more)
    assert result.exit_code == 1
    assert "10_999: no such file, nor a knot" in result.stderr
    assert "3_1\t164\t32.74" in result.stdout
    assert "trials: 1, of which 0 changed their knot type; hours of search: 0.00" in result.stderr
    for names in (("3_1",), ("K3a1",), ("knots",), ()):
        assert sono("atlas", *names, *more).stdout == result.stdout
    again = sono("atlas", "3_1", "--update", "--trials", "1", *more)
    assert (again.exit_code, again.stdout) == (0, result.stdout)
    missing = sono("atlas", "3_1.typo.txt", *more)
    assert (missing.exit_code, missing.stdout.count("\n")) == (1, 1)
    assert "3_1.typo.txt: is no file and not in mine/knots.tsv" in missing.stderr
    # A rope that is no longer that of its row is found out, and one of another knot too.
    (family := Atlas(folder / "mine").families["knots"]).put(
        family.rows["3_1"], archive.packed(starts.start("3_1"))
    )
    assert "its row is not that of its rope" in sono("atlas", "3_1", *more).stderr
    (folder / "mine/knots.zip").write_text("no archive")
    assert "mine/knots.zip: is no archive of ropes; remove it" in sono("atlas", "3_1", *more).stderr


def test_a_rope_of_another_knot_is_found_out(folder: Path, sono: Sono) -> None:
    row = Atlas(folder / "mine").take("4_1", tight(folder / "4_1.txt", "4_1", 210))
    wrong = Atlas(folder / "mine")
    wrong.families["knots"].put({**row, "knot": "5_1"}, wrong.families["knots"].ropes["4_1"])
    result = sono("atlas", "--folder", "mine")
    assert (result.exit_code, result.stdout.count("4_1")) == (1, 1)
    assert "mine/knots.zip: is of another knot type than 5_1; remove it" in result.stderr


def test_files_are_taken_in(folder: Path, sono: Sono) -> None:
    tight(folder / "3_1.mine.txt", "3_1", 120)
    assert sono("atlas", "3_1.mine.txt", "--folder", "mine").exit_code == 2
    result = sono("atlas", "3_1.mine.txt", "--folder", "mine", "--update")
    assert result.exit_code == 0
    assert [row["knot"] for row in tables.read("mine/knots.tsv")] == ["3_1"]
    # One of another knot is refused even if it is too long to be taken.
    mirrored = [component * [1, 1, -1.001] for component in starts.start("3_1")]
    formats.write(folder / "3_1.mirror.txt", mirrored)
    result = sono("atlas", "3_1.mirror.txt", "--folder", "mine", "--update")
    assert (result.exit_code, "3_1.mirror.txt: is of another knot type" in result.stderr) == (1, True)


def test_torus_types_that_no_closed_braid_proves_have_a_fingerprint(monkeypatch: pytest.MonkeyPatch) -> None:
    assert confirmed_type("T(30,60)", starts.start("T(30,60)", 1), "link") == "proven"
    with pytest.raises(ValueError, match="link: is of another knot type"):
        confirmed_type("T(30,60)", starts.start("T(30,90)"), "link")
    monkeypatch.setattr("sono.invariants.braids.braid_of", lambda gauss: None)
    assert confirmed_type("T(4,8)", starts.start("T(4,8)", 1), "link") == "fingerprint"
    with pytest.raises(ValueError, match="link: is of another knot type"):
        confirmed_type("T(4,8)", starts.start("T(4,12)"), "link")
    with pytest.raises(ValueError, match="its type cannot be told"):
        confirmed_type("T(30,60)", starts.start("T(30,60)"), "link")
