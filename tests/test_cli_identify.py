"""`sono identify`: rows for what has a name and for what has none, a message for what cannot be told."""

import json
from pathlib import Path

import numpy as np
import pytest
from conftest import Sono

import sono as package
from sono import formats, starts
from sono.cli import options


@pytest.fixture
def curves(folder: Path) -> Path:
    for file, name in {"mirror": "m3_1", "sum": "3_1#4_1", "new": "P(3,5,7)", "unknot": "0_1"}.items():
        formats.write(folder / f"{file}.txt", starts.start(name))
    return folder


def test_a_row_for_each_file(curves: Path, sono: Sono) -> None:
    result = sono("identify", "3_1.txt", "mirror.txt", "sum.txt", "new.txt", "unknot.txt", "Hopf.txt")
    assert (result.exit_code, result.stderr) == (0, "")
    assert [line.split("\t") for line in result.stdout.splitlines()] == [
        ["file", "knot", "known", "crossings"],
        ["3_1.txt", "3_1", "proven", "3"],
        ["mirror.txt", "m3_1", "proven", "3"],
        ["sum.txt", "3_1#4_1", "proven", "7"],
        ["new.txt", "-", "not in the table", "15"],
        ["unknot.txt", "0_1", "proven", "0"],
        ["Hopf.txt", "L2a1{1}", "proven", "2"],
    ]


def test_invariants_are_columns(sono: Sono) -> None:
    result = sono(
        "identify", "Hopf.txt", "--format", "jsonl", "--columns", ",".join(options.FILLED["identify"])
    )
    row = json.loads(result.stdout)
    found = package.identify("Hopf")
    assert (row["determinant"], row["signature"], row["linking"], row["components"]) == (2, -1, "1", 2)
    assert (row["homfly"], row["alexander"]) == (found.homfly, "t - 1")


def test_pd_codes(curves: Path, sono: Sono) -> None:
    result = sono("identify", "--pd", "mirror.txt", "unknot.txt", "--quiet")
    assert (result.exit_code, result.stderr) == (0, "")
    trefoil, unknot = map(json.loads, result.stdout.splitlines())
    assert (len(trefoil), unknot) == (3, [])
    assert sorted(edge for code in trefoil for edge in code) == [1, 1, 2, 2, 3, 3, 4, 4, 5, 5, 6, 6]
    loud = sono("identify", "--pd", "unknot.txt")
    assert loud.stdout == "[]\n"
    assert "no trace" not in loud.stderr  # since [] is read as the unknot
    Path("apart.pd").write_text("Loop[1] Loop[2]")
    told = sono("identify", "--pd", "apart.pd").stderr
    assert "sono: apart.pd: 2 of 2 components have no crossings, and no trace here" in told
    assert sono("identify", "--pd", "mirror.txt", "3_1.txt").stderr == ""


def test_what_may_be_larger_than_the_table_is_not_named(folder: Path, sono: Sono) -> None:
    # K14n4749 of the table of J. Hoste, M. Thistlethwaite and J. Weeks, 1998.
    (folder / "larger.pd").write_text(
        "(3,1,4,28),(1,7,2,6),(7,3,8,2),(4,16,5,15),(16,6,17,5),(17,8,18,9),(9,20,10,21),"
        "(19,10,20,11),(11,18,12,19),(25,12,26,13),(13,24,14,25),(21,14,22,15),(27,23,28,22),(23,27,24,26)"
    )
    result = sono("identify", "larger.pd", "3_1.txt", "--columns", "knot,known,may_be")
    assert (result.exit_code, result.stderr) == (0, "")
    assert [line.split("\t") for line in result.stdout.splitlines()] == [
        ["knot", "known", "may_be"],
        ["-", "undecided", "12a_786 or not in the table"],
        ["3_1", "proven", "-"],
    ]


def test_standard_input(folder: Path, sono: Sono) -> None:
    result = sono("identify", "-", input=(folder / "3_1.txt").read_text())
    assert result.stdout.splitlines()[1].split("\t")[1:] == ["3_1", "proven", "3"]


def test_wrong_files_do_not_stop_the_others(folder: Path, sono: Sono) -> None:
    (folder / "crossing.txt").write_text("# 8\n0 0 0\n2 2 0\n2 0 0\n0 2 0\n")
    (folder / "text.txt").write_text("0 0 0\n1 0 nought\n")
    formats.write(folder / "tangle.txt", [np.random.default_rng(1).normal(size=(140, 3))])
    result = sono("identify", "crossing.txt", "text.txt", "missing.txt", "8_18", "tangle.txt", "3_1.txt")
    assert result.exit_code == 1
    assert [line.split("\t")[0] for line in result.stdout.splitlines()] == ["file", "3_1.txt"]
    expected = [
        "crossing.txt:2: the curve crosses itself",
        "text.txt:2: 'nought' is not a number",
        "missing.txt: cannot be read: ",
        "8_18: no such file; identify takes files; `sono start 8_18 | sono identify -`",
        "tangle.txt: the curve has over 1000 crossings: its type cannot be told",
    ]
    for message, start in zip(result.stderr.splitlines(), expected, strict=True):
        assert message.startswith(f"sono: {start}")


@pytest.mark.parametrize("arguments", [[], ["3_1.txt", "--columns", "weight"]])
def test_wrong_arguments(sono: Sono, arguments: list[str]) -> None:
    result = sono("identify", *arguments)
    assert (result.exit_code, result.stdout) == (2, "")
