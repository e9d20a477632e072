"""The atlas: what it ships, that it never gets worse, and that it believes no name."""

from pathlib import Path

import pytest
from conftest import Sono

from sono import formats, library, measure, search, tables
from sono.atlas import Atlas, confirmed_type
from sono.invariants import fingerprint

KNOTS = Path(__file__).parent.parent / "knots"
SHIPPED = Atlas(KNOTS).rows()


@pytest.fixture(autouse=True)
def quick(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(search, "ANNEAL", {"anneal_sweeps": 5000, "anneal_tolerance": 0.5})


def tight(path: Path, knot: str, n: int) -> str:
    """Write a tight rope, as a search would."""
    found = search.finish(search.refine(search.attempt(search.Source.of(library.start(knot), knot), 0)), n)
    formats.write(path, found.curve, ["searched: variant 0, seed 0, met in 1 of 1 trials, 1 s"])
    return str(path)


@pytest.mark.parametrize("knot", SHIPPED)
def test_rows_are_what_their_files_measure(knot: str) -> None:
    row = SHIPPED[knot]
    measures = measure(formats.read(KNOTS / "tight" / f"{knot}.txt").components)
    assert [row[key] for key in ("n", "dl", "l_p", "l_c", "l_a")] == [
        getattr(measures, key) for key in ("n", "dl", "l_p", "l_c", "l_a")
    ]
    assert abs(measures.r_s - 1) < 1e-9
    assert measures.dispersion < 1e-9
    assert row["type"] == "homfly"
    assert float(row["l_c"] or 0) > float(row["l_c_fine"] or 0) > measures.l_p


@pytest.mark.parametrize("knot", list(SHIPPED)[::6])
def test_files_hold_the_knots_of_their_names(knot: str) -> None:
    curve = formats.read(KNOTS / "tight" / f"{knot}.txt").components
    assert fingerprint(curve) == fingerprint(library.start(knot))


def test_the_atlas_is_whole() -> None:
    assert list(SHIPPED) == [row["knot"] for row in library.table("knots")]
    assert {path.stem for path in (KNOTS / "tight").iterdir()} == set(SHIPPED)
    assert sum(float(row["l_a_difference"] or 1) <= 0 for row in SHIPPED.values()) >= 240
    assert sum(float(row["l_c_difference"] or 1) <= 0 for row in SHIPPED.values()) >= 200


def test_a_row_never_gets_worse(tmp_path: Path) -> None:
    atlas = Atlas(tmp_path)
    coarse, fine = (tight(tmp_path / f"{n}.txt", "3_1", n) for n in (120, 164))
    row = atlas.take("3_1", fine)  # L_a rises with n
    kept = Path(atlas.path("3_1")).read_text()
    better = atlas.take("3_1", coarse)
    assert float(better["l_a"] or 0) < float(row["l_a"] or 0)
    assert atlas.take("3_1", fine) == better == atlas.checked("3_1")
    assert Path(atlas.path("3_1")).read_text() != kept
    assert (row["variant"], row["seed"], row["published"]) == (0, 0, 32.7436)
    assert list(tables.read(str(tmp_path / "atlas.tsv"))) == [better]


def test_another_knot_is_not_taken(tmp_path: Path) -> None:
    atlas = Atlas(tmp_path)
    trefoil = tight(tmp_path / "3_1.txt", "3_1", 120)
    for name in ("4_1", "m3_1"):
        with pytest.raises(ValueError, match="another knot type; it is not taken"):
            atlas.take(name, trefoil)
    assert not (tmp_path / "tight").exists()
    assert confirmed_type("3_1", library.start("3_1", 1)) == "homfly"


def test_the_command_updates_and_checks(folder: Path, sono: Sono) -> None:
    more = ("--folder", "mine", "--checkpoint", "kept")
    assert sono("atlas", "3_1", *more).exit_code == 1
    result = sono("atlas", "3_1", "10_999", "--update", "--trials", "1", *more)
    assert result.exit_code == 1
    assert "10_999: no such file, nor a knot" in result.stderr
    assert "3_1\t164\t32.74" in result.stdout
    assert sono("atlas", "3_1", *more).stdout == result.stdout
    again = sono("atlas", "3_1", "--update", "--trials", "1", *more)
    assert (again.exit_code, again.stdout) == (0, result.stdout)
    # A file that is no longer that of its row is found out, and one of another knot too.
    file = folder / "mine/tight/3_1.txt"
    formats.write(file, [2 * component for component in formats.read(file).components])
    formats.write(file, library.start("3_1"))
    assert "in its row is not that of its file" in sono("atlas", "3_1", *more).stderr
    formats.write(file, library.start("4_1"))
    assert "another knot type" in sono("atlas", "3_1", *more).stderr


def test_files_are_taken_in(folder: Path, sono: Sono) -> None:
    tight(folder / "3_1.mine.txt", "3_1", 120)
    assert sono("atlas", "3_1.mine.txt", "--folder", "mine").exit_code == 2
    result = sono("atlas", "3_1.mine.txt", "--folder", "mine", "--update")
    assert result.exit_code == 0
    assert [row["knot"] for row in tables.read("mine/atlas.tsv")] == ["3_1"]
