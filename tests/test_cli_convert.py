"""`sono convert`: bits and comments that are kept, files that are not lost, and what is refused."""

import os
from pathlib import Path

import pytest
from conftest import Sono

from sono import formats, starts
from sono.formats import xyz

SUFFIXES = ["txt", "dat", "csv", "xyz", "vect", "obj", "json", "npz", "vect.gz"]


@pytest.fixture
def three(folder: Path) -> str:
    """Three frames, the second of which is an open chain that is too short."""
    good = xyz.write(starts.start("3_1"), ["good"])
    (folder / "run.xyz").write_text(f"{good}2\nbad\nC 0 0 0\nC 1 0 0\n{good}")
    return "run.xyz"


def test_every_bit_and_comment_is_kept_all_the_way_round(sono: Sono) -> None:
    formats.write("a.txt", starts.start("Hopf"), ["a Hopf link", "of two rings"])
    first = Path("a.txt").read_bytes()
    here = "a.txt"
    for there in [*(f"b.{suffix}" for suffix in SUFFIXES), "last.txt"]:
        result = sono("convert", here, there)
        assert (result.exit_code, result.output) == (0, "")
        here = there
    assert Path(here).read_bytes() == first


def test_names_streams_and_formats(folder: Path, sono: Sono) -> None:
    drawn = sono("convert", "3_1", "-", "--format", "vect").stdout
    assert drawn.startswith("VECT\n# 3_1\n")
    piped = sono("convert", "-", "k.obj", input=drawn)
    assert (piped.exit_code, piped.stderr) == (0, "")
    assert (formats.read("k.obj").components[0] == starts.start("3_1")[0]).all()
    assert sono("convert", "k.obj", "-").stdout.startswith("# 3_1\n")
    assert sono("convert", "k.obj", "odd.name", "--format", "json").exit_code == 0
    assert Path("odd.name").read_text().startswith("{")


def test_nothing_is_overwritten_unasked(sono: Sono) -> None:
    before = Path("Hopf.txt").read_bytes()
    refused = sono("convert", "3_1.txt", "Hopf.txt")
    assert (refused.exit_code, Path("Hopf.txt").read_bytes()) == (2, before)
    assert "Hopf.txt exists; --force overwrites it" in refused.stderr
    assert sono("convert", "3_1.txt", "Hopf.txt", "--force").exit_code == 0
    assert Path("Hopf.txt").read_bytes() == Path("3_1.txt").read_bytes()


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (["3_1.txt", "k.stl"], "k.stl: .stl is no format for vertices; the suffixes are: .txt"),
        (
            ["3_1.txt", "-", "--format", "stl"],
            "--format stl: is no format that is written; there are: csv, json",
        ),
        (["3_1.txt", "k.txt", "--close", "loose"], "'--close'"),
        (["3_1.txt"], "Missing argument 'OUT'"),
    ],
)
def test_wrong_usage(sono: Sono, arguments: list[str], message: str) -> None:
    result = sono("convert", *arguments)
    assert (result.exit_code, result.stdout) == (2, "")
    assert message in result.stderr


@pytest.mark.parametrize("source", ["nowhere.txt", "bad.txt", "9_99"])
def test_a_wrong_file_is_told(folder: Path, sono: Sono, source: str) -> None:
    (folder / "bad.txt").write_text("0 0 0\n1 0 nought\n")
    result = sono("convert", source, "k.vect")
    assert (result.exit_code, result.stdout, Path("k.vect").exists()) == (1, "", False)
    assert result.stderr.count("\n") == 1
    assert source in result.stderr


def test_several_curves_go_to_a_folder_or_a_file_of_frames(three: str, sono: Sono) -> None:
    refused = sono("convert", three, "k.vect")
    assert refused.exit_code == 2
    assert "IN holds 3 curves, k.vect one; name a folder (FOLDER/)" in refused.stderr
    split = sono("convert", three, "out/", "--format", "obj")
    assert split.exit_code == 1
    assert split.stderr.startswith("sono: run.xyz:74: the component that starts here has too few vertices: 2")
    assert sorted(os.listdir("out")) == ["run.1.obj", "run.3.obj"]
    again = sono("convert", three, "out/", "--format", "obj")
    assert again.exit_code == 2
    frames = sono("convert", three, "good.xyz.gz")
    assert frames.exit_code == 1
    assert [curve.key for curve in formats.read_all("good.xyz.gz")] == ["1", "2"]
    one = sono("convert", f"{three}:3", "k.vect")
    assert (one.exit_code, one.stderr) == (0, "")


def test_open_chains_are_closed_as_asked(folder: Path, sono: Sono) -> None:
    rows = "".join(f"v {k} {k % 3} {k * k % 5}\n" for k in range(20))
    (folder / "open.obj").write_text(f"{rows}l {' '.join(map(str, range(1, 21)))}\n")
    refused = sono("convert", "open.obj", "k.txt")
    assert (refused.exit_code, Path("k.txt").exists()) == (1, False)
    assert "the chain is open" in refused.stderr
    closed = sono("convert", "open.obj", "k.txt", "--close", "sphere")
    assert closed.exit_code == 0
    assert "was closed to line 1 by a sphere round it" in closed.stderr
    quiet = sono("convert", "open.obj", "k.txt", "--close", "sphere", "--force", "--quiet")
    assert (quiet.exit_code, quiet.stderr) == (0, "")
    assert len(formats.read("k.txt").components[0]) > 20
