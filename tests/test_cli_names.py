"""Codes and names that look like files, as arguments and options of the commands."""

import os
from pathlib import Path

import pytest
from conftest import QUICK, Sono

from sono import formats, starts
from sono.invariants import fingerprint
from sono.jobs.sources import Source

TREFOIL = "X[1,5,2,4] X[3,1,4,6] X[5,3,6,2]"
FIGURE_EIGHT = "[(4,2,5,1),(8,6,1,5),(6,3,7,4),(2,7,3,8)]"


@pytest.mark.parametrize(
    ("arguments", "name"),
    [
        (["--pd", TREFOIL], f"pd:{TREFOIL}"),
        (["--dt", "4 6 8 2"], "dt:4 6 8 2"),
        (["--gauss", "1 -2 | 2 -1"], "gauss:1 -2 | 2 -1"),
        (["--gauss=-1 2 -3 1 -2 3", "--variant", "-2"], "gauss:-1 2 -3 1 -2 3"),
        (["5/2"], "5/2"),
        (["5.2.1", "--variant", "-1"], "5.2.1"),
    ],
)
def test_start_takes_codes(folder: Path, sono: Sono, arguments: list[str], name: str) -> None:
    result = sono("start", *arguments, "-o", "out.txt")
    assert (result.exit_code, result.stderr) == (0, "")
    assert (folder / "out.txt").read_text().startswith(f"# {name}")
    assert fingerprint(formats.read("out.txt").components) == fingerprint(starts.start(name))


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (["--pd", "hello"], "PD code 'hello': not readable; write it like"),
        (["--gauss", "1 -2 -1 2"], "cannot be drawn in the plane"),
        (["--dt", "4 6 2", "--pd", TREFOIL], "give one NAME"),
        (["3_1", "--dt", "4 6 2"], "give one NAME"),
        (["--dt", "4 6 2", "--braid", "1 1"], "give one NAME"),
        (["--list", "--dt", "4 6 2"], "--list stands alone"),
    ],
)
def test_what_start_does_not_take(sono: Sono, arguments: list[str], message: str) -> None:
    result = sono("start", *arguments)
    assert (result.exit_code, result.stdout) == (2, "")
    assert message in result.stderr


def test_a_braid_in_pieces_is_doubted(sono: Sono) -> None:
    for command in (["tighten", "-n", "60", *QUICK], ["search", "--trials", "1"]):
        result = sono(*command, "2 2")
        assert (result.exit_code, result.stderr.count("'2 2' is read as a closed braid, and falls")) == (0, 1)


def test_tighten_takes_codes_and_dotted_names_side_by_side(folder: Path, sono: Sono) -> None:
    options = ("--pd", FIGURE_EIGHT, "--dt", "4 6 2", "--dt", "4 x 2", "-n", "60", "-o", "out/", *QUICK)
    result = sono("tighten", "3.1", "5/2", *options)
    assert result.exit_code == 1
    assert "DT code '4 x 2': not readable" in result.stderr
    knots = [row.split("\t")[0] for row in result.stdout.splitlines()[1:]]
    assert knots == ["3.1", "5/2", "pd:[(4,2,5,1),(8,6,1,5),(6,3,7,4),(2,7,3,8)]", "dt:4 6 2"]
    names = (knot.replace("/", "-").replace(":", "_") for knot in knots)
    assert sorted(os.listdir("out")) == sorted(f"{name}.n60.txt" for name in names)
    tight = formats.read("out/5-2.n60.txt").components
    assert fingerprint(tight) == fingerprint(starts.start("4_1"))


def test_search_takes_codes(folder: Path, sono: Sono) -> None:
    result = sono("search", "--gauss", "1 -2 3 -1 2 -3", "--trials", "3")
    assert result.exit_code == 0
    (name,) = (name for name in os.listdir(".") if name.endswith(".tight.txt"))
    assert fingerprint(formats.read(name).components) == fingerprint(starts.start("3_1"))


def test_a_file_goes_before_a_name(folder: Path, sono: Sono) -> None:
    formats.write("4_1.txt", starts.start("4_1"))
    os.rename("4_1.txt", "3.1")
    assert sono("tighten", "3.1", "-n", "60", *QUICK).exit_code == 0
    assert fingerprint(formats.read("3.n60.txt").components) == fingerprint(starts.start("4_1"))
    for missing in ("3_1.dat", "./3.1.2", "knots/5/2", "3.txt"):
        assert "cannot be read" in sono("tighten", missing, *QUICK).stderr


def test_lists_may_have_sums_and_codes(folder: Path, sono: Sono) -> None:
    (folder / "list.txt").write_text("3_1#m3_1  # the square knot\n# none\ndt:4 6 2\n#none\n")
    result = sono("tighten", "--list", "list.txt", "-n", "120", *QUICK)
    assert result.exit_code == 0
    square = formats.read("3_1#m3_1.n120.txt").components
    assert fingerprint(square) == fingerprint(starts.start("3_1#m3_1"))


def test_long_codes_name_files_that_may_be_made(folder: Path) -> None:
    long = "pd:" + str([(k, k + 1, k + 2, k + 3) for k in range(100)])
    assert len(Source(long).stem) < 100
    assert Source(long).stem != Source(long.replace("99", "98")).stem
    assert Source("T(2,5)").stem == Source("T(2,5)").name == "T(2,5)"
    assert Source("folder/3_1.txt").stem == "3_1"
    assert Source("-").stem == "stdin"
