"""`sono start`: starting conformations by name and by braid word."""

from pathlib import Path

import numpy as np
import pytest
from conftest import Sono

from sono import formats, starts
from sono.curve import Components
from sono.starts.braids import braid
from sono.starts.scramble import scramble


def same(path: Path, curve: Components) -> bool:
    read = formats.read(path).components
    return len(read) == len(curve) and all(map(np.array_equal, read, curve))


def test_a_name(folder: Path, sono: Sono) -> None:
    result = sono("start", "4_1")
    assert (result.exit_code, result.stderr) == (0, "")
    assert result.stdout.startswith("# 4_1\n")
    (folder / "out.txt").write_text(result.stdout)
    assert same(folder / "out.txt", starts.start("4_1"))


def test_a_braid_word(folder: Path, sono: Sono) -> None:
    assert sono("start", "--braid", "1, -2 1 -2", "-o", "out.txt").exit_code == 0
    assert same(folder / "out.txt", braid([1, -2, 1, -2]))


def test_scrambled(folder: Path, sono: Sono) -> None:
    assert sono("start", "3_1", "--scramble", "5", "-o", "out.txt").exit_code == 0
    assert same(folder / "out.txt", scramble(starts.start("3_1"), 5))


def test_the_suffix_gives_the_format(folder: Path, sono: Sono) -> None:
    assert sono("start", "Hopf", "-o", "out.vect").exit_code == 0
    assert (folder / "out.vect").read_text().startswith("VECT\n")
    assert same(folder / "out.vect", starts.start("Hopf"))


def test_list(sono: Sono) -> None:
    assert sono("start", "--list").stdout.split() == list(starts.names())


def test_a_name_that_is_too_long(sono: Sono) -> None:
    name = "k" * 5000
    result = sono("start", "3_1", "-o", name)
    assert (result.exit_code, result.stderr) == (1, f"sono: {name}: cannot be written: File name too long\n")
    assert f"{name}: no atlas is there" in sono("atlas", "--folder", name).stderr.replace("\n", "")
    assert sono("atlas", name, "--folder", ".").exit_code == 2


def test_a_file_is_not_overwritten(folder: Path, sono: Sono) -> None:
    (folder / "out.txt").write_text("mine")
    result = sono("start", "3_1", "-o", "out.txt")
    assert result.exit_code == 2
    assert "out.txt exists; --force overwrites it" in result.stderr
    assert (folder / "out.txt").read_text() == "mine"
    assert sono("start", "3_1", "-o", "out.txt", "--force").exit_code == 0
    assert same(folder / "out.txt", starts.start("3_1"))


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        ([], "give one NAME, a --pd, --dt or --gauss code, or a --braid word"),
        (["3_1", "--braid", "1"], "give one NAME, a --pd, --dt or --gauss code, or a --braid word"),
        (["3-1"], "did you mean '3_1'?"),
        (["T(0,3)"], "p and q must not be zero"),
        ([f"T({'9' * 5000},2)"], "unknown knot"),
        (["--braid", "9" * 5000], "give whole numbers"),
        (["--braid", "1 0"], "a braid generator must not be 0"),
        (["--braid", "a b"], "give whole numbers"),
        (["3_1", "--scramble", "x"], "'--scramble'"),
        (["3_1", "--scramble", "-1"], "'--scramble'"),
        (["--braid", ""], "give whole numbers"),
        (["--braid", "1 1", "--variant", "-2"], "--variant -2: a braid word has no planar diagram"),
        (["chain3", "--variant", "-2"], "chain3 has no planar diagram"),
        (["3_1", "-o", "out.png"], "out.png: .png is no format for vertices"),
        (["T(999999,3)"], "T(999999,3) would take over 500,000 vertices"),
        (["chain99999999"], "a chain of 99999999 rings would take over 500,000 vertices"),
        (["--braid", f"1 {10**20}"], f"a braid of {10**20 + 1} strands, 2 crossings would take over"),
        (["--braid", 30_000 * "1 "], "a braid of 2 strands, 30000 crossings would take over"),
        (["--list", "3_1"], "--list stands alone"),
        (["--list", "-o", "names.txt"], "--list stands alone"),
    ],
)
def test_usage_errors(sono: Sono, arguments: list[str], message: str) -> None:
    result = sono("start", *arguments)
    assert (result.exit_code, result.stdout) == (2, "")
    assert message in result.stderr


def test_a_folder_that_is_not_there(sono: Sono) -> None:
    result = sono("start", "3_1", "-o", "nowhere/out.txt")
    assert result.exit_code == 1
    assert result.stderr.startswith("sono: nowhere/out.txt: cannot be written: ")


@pytest.mark.parametrize("name", ["3_1", "10_100", "T(2,4)"])
def test_variants_are_numbers_of_any_size(sono: Sono, name: str) -> None:
    result = sono("start", name, "--variant", str(10**20))
    assert (result.exit_code, result.stderr) == (0, "")
    if name != "T(2,4)":
        assert sono("start", name, f"--variant=-{10**20}").exit_code == 0


def test_without_its_table_a_knot_may_have_a_known_rope(sono: Sono, monkeypatch: pytest.MonkeyPatch) -> None:
    def missing(name: str) -> None:
        raise ImportError

    monkeypatch.setattr("sono.starts.knotinfo.knot_row", missing)
    assert "; or --known, for the rope of the atlas" in sono("start", "11n_34").stderr
    assert sono("start", "11n_34", "--known").exit_code == 0
    assert "--known" not in sono("start", "13n_5110").stderr.split("Error: ")[1]
