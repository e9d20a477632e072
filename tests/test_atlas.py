"""The atlas: what it ships, that it never gets worse, and that it believes no name."""

from pathlib import Path

import pytest
from conftest import Sono

from sono import formats, measure, starts, tables
from sono import tighten as sono_tighten
from sono.invariants import fingerprint
from sono.jobs.atlas import Atlas, confirmed_type
from sono.searching import trials
from sono.starts import shapes

KNOTS = Path(__file__).parent.parent / "knots"
SHIPPED = Atlas(KNOTS).rows()


@pytest.fixture(autouse=True)
def quick(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    own = tmp_path / "shapes.npz"  # so that what is found here does not get into the package
    own.write_bytes(shapes.FILE.read_bytes())
    monkeypatch.setattr(shapes, "FILE", own)


def tight(path: Path, knot: str, n: int) -> str:
    """Write a tight rope, as a search would."""
    shape = trials.attempt(trials.Source.of(starts.start(knot), knot), 0)
    assert shape.curve
    found = sono_tighten(shape.curve, n, method="polish")
    header = f"{knot}: tight, rope radius R_s = 1"
    formats.write(path, found.curve, [header, "searched: variant 0, seed 0, met in 1 of 1 trials, 1 s"])
    return str(path)


@pytest.mark.parametrize("knot", SHIPPED)
def test_rows_are_what_their_files_measure(knot: str) -> None:
    row = SHIPPED[knot]
    measures = measure(formats.read(KNOTS / "tight" / f"{knot}.txt").components)
    for key in ("n", "dl", "l_p", "l_c", "l_a"):
        assert row[key] == pytest.approx(getattr(measures, key), rel=1e-11)
    assert abs(measures.r_s - 1) < 1e-8  # ten decimals
    assert measures.dispersion < 1e-9
    assert row["type"] == "homfly"
    assert float(row["l_c"] or 0) > float(row["l_c_fine"] or 0)


@pytest.mark.slow
@pytest.mark.parametrize("knot", ["3_1", "5_2", "8_19"])
def test_the_finer_bound_is_what_the_file_leads_to(knot: str) -> None:
    row = SHIPPED[knot]
    curve = formats.read(KNOTS / "tight" / f"{knot}.txt").components
    fine = sono_tighten(curve, int(row["n_fine"] or 0), method="polish")
    # Beads may lie in another groove on another machine.
    assert fine.measures.l_c == pytest.approx(row["l_c_fine"], rel=1e-4)


@pytest.mark.parametrize("knot", list(SHIPPED)[::6])
def test_files_hold_the_knots_of_their_names(knot: str) -> None:
    curve = formats.read(KNOTS / "tight" / f"{knot}.txt").components
    assert fingerprint(curve) == fingerprint(starts.start(knot))


def test_the_atlas_is_whole() -> None:
    assert list(SHIPPED) == [row["knot"] for row in starts.table("knots")]
    assert {path.stem for path in (KNOTS / "tight").iterdir()} == set(SHIPPED)
    assert sum(float(row["l_a_difference"] or 1) <= 0 for row in SHIPPED.values()) >= 248
    assert sum(float(row["l_c_difference"] or 1) <= 0 for row in SHIPPED.values()) >= 244


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
    assert tables.read(str(tmp_path / "atlas.tsv")) == [better]


def test_ropes_are_brought_to_one_edge_length(tmp_path: Path) -> None:
    atlas = Atlas(tmp_path)
    row = atlas.take("3_1", tight(tmp_path / "coarse.txt", "3_1", 60))
    assert abs(float(row["dl"] or 0) - 0.2) < 0.004
    assert row["l_a"] == pytest.approx(32.7429, abs=1e-3)  # 32.7192 at n = 60
    formats.write(tmp_path / "large.txt", [7 * c for c in formats.read(atlas.path("3_1")).components])
    (tmp_path / "tight/3_1.txt").unlink()
    assert atlas.take("3_1", str(tmp_path / "large.txt"))["l_a"] == pytest.approx(row["l_a"], abs=1e-3)
    assert measure(formats.read(atlas.path("3_1")).components).r_s == pytest.approx(1, abs=1e-9)


def test_another_knot_is_not_taken(tmp_path: Path) -> None:
    atlas = Atlas(tmp_path)
    trefoil = tight(tmp_path / "3_1.txt", "3_1", 120)
    for name in ("4_1", "m3_1"):
        with pytest.raises(ValueError, match=f"3_1.txt: is of another knot type than {name}; remove it"):
            atlas.take(name, trefoil)
    assert not (tmp_path / "tight").exists()
    assert confirmed_type("3_1", starts.start("3_1", 1), "3_1.txt") == "homfly"


def test_the_command_updates_and_checks(folder: Path, sono: Sono) -> None:
    more = ("--folder", "mine", "--checkpoint", "kept")
    assert sono("atlas", "3_1", *more).exit_code == 2
    result = sono("atlas", "3_1", "10_999", "--update", "--trials", "1", *more)
    assert result.exit_code == 1
    assert "10_999: no such file, nor a knot" in result.stderr
    assert "3_1\t164\t32.74" in result.stdout
    assert "trials: 1, of which 0 changed their knot type; hours of search: 0.00" in result.stderr
    assert sono("atlas", "3_1", *more).stdout == result.stdout
    again = sono("atlas", "3_1", "--update", "--trials", "1", *more)
    assert (again.exit_code, again.stdout) == (0, result.stdout)
    missing = sono("atlas", "3_1.typo.txt", *more)
    assert (missing.exit_code, missing.stdout.count("\n")) == (1, 1)
    assert "3_1.typo.txt: is no file and not in mine/atlas.tsv" in missing.stderr
    # A file that is no longer that of its row is found out, and one of another knot too.
    file = folder / "mine/tight/3_1.txt"
    formats.write(file, [2 * component for component in formats.read(file).components])
    formats.write(file, starts.start("3_1"))
    assert "its row is not that of its file" in sono("atlas", "3_1", *more).stderr
    formats.write(file, starts.start("4_1"))
    wrong = "sono: mine/tight/3_1.txt: is of another knot type than 3_1; remove it"
    assert wrong in sono("atlas", "3_1", *more).stderr
    assert wrong in sono("atlas", "3_1", "--update", "--trials", "1", *more).stderr


def test_files_are_taken_in(folder: Path, sono: Sono) -> None:
    tight(folder / "3_1.mine.txt", "3_1", 120)
    assert sono("atlas", "3_1.mine.txt", "--folder", "mine").exit_code == 2
    result = sono("atlas", "3_1.mine.txt", "--folder", "mine", "--update")
    assert result.exit_code == 0
    assert [row["knot"] for row in tables.read("mine/atlas.tsv")] == ["3_1"]
    # One of another knot is refused even if it is too long to be taken.
    mirrored = [component * [1, 1, -1.001] for component in starts.start("3_1")]
    formats.write(folder / "3_1.mirror.txt", mirrored)
    result = sono("atlas", "3_1.mirror.txt", "--folder", "mine", "--update")
    assert (result.exit_code, "3_1.mirror.txt: is of another knot type" in result.stderr) == (1, True)
