"""`sono measure`: rows for what can be measured, a message for what cannot."""

import json
import os
import sys
from pathlib import Path

import pytest
from conftest import Sono, Spawn

import sono as package
from sono import formats, tables
from sono.cli import options

ROWS = "0 0 0\n2 0 0\n2 2 1\n0 2 0\n"


def test_a_row_is_what_the_library_measures(folder: Path, sono: Sono) -> None:
    result = sono(
        *("measure", "3_1.txt", "Hopf.txt", "--format", "jsonl"),
        *("--columns", ",".join(options.FILLED["measure"])),
    )
    assert (result.exit_code, result.stderr) == (0, "")
    for name, line in zip(["3_1", "Hopf"], result.stdout.splitlines(), strict=True):
        row = json.loads(line)
        assert (row["knot"], row["file"]) == (name, f"{name}.txt")
        assert None not in row.values()
        measures = package.measure(formats.read(folder / f"{name}.txt").components)
        for key in ("n", "components", "dl", "l_p", "l_c", "l_a", "r_s", "min_rad", "length"):
            assert row[key] == getattr(measures, key)


def test_standard_input(folder: Path, sono: Sono) -> None:
    piped = sono("measure", "-", input=(folder / "3_1.txt").read_text())
    told = sono("measure", "3_1.txt").stdout
    assert piped.stdout == told.replace("3_1.txt", "<stdin>").replace("3_1", "stdin")


def test_tsv_elsewhere_than_on_a_terminal(sono: Sono) -> None:
    header, row = sono("measure", "3_1.txt").stdout.splitlines()
    assert header.split("\t") == ["knot", "n", "dl", "l_p", "l_c", "l_a", "dispersion", "r_s", "file"]
    assert len(row.split("\t")) == 9


@pytest.mark.skipif(os.name != "posix", reason="needs a pseudoterminal")
def test_aligned_text_on_a_terminal(spawn: Spawn) -> None:
    ours, theirs = os.openpty()
    process = spawn("measure", "3_1.txt", stdout=theirs)
    process.wait()
    os.close(theirs)
    assert os.read(ours, 1 << 16).decode().startswith(tables.CAPTION)
    os.close(ours)


@pytest.mark.parametrize("format", tables.FORMATS)
def test_every_format(sono: Sono, format: str) -> None:
    result = sono("measure", "3_1.txt", "--format", format, "--columns", "knot, L_p")
    assert result.exit_code == 0
    assert "36.7319" in result.stdout


@pytest.mark.parametrize("arguments", [["--format", "xml"], ["--columns", "n,weight"], ["--columns", ","]])
def test_wrong_options(sono: Sono, arguments: list[str]) -> None:
    result = sono("measure", "3_1.txt", *arguments)
    assert (result.exit_code, result.stdout) == (2, "")
    assert f"'{arguments[0]}'" in result.stderr


WRONG = {
    "text": ("0 0 0\n1 0 nought\n", ":2: 'nought' is not a number"),
    "nan": ("0 0 0\n1 0 0\n0 nan 0\n", ":3: a coordinate is not finite"),
    "two": ("0 0 0\n1 0 0\n", ":1: the component that starts here has too few vertices: 2"),
    "columns": ("0 0 0\n1 0\n0 1 0\n", ":2: 2 columns; give three numbers"),
    "twice": ("0 0 0\n1 0 0\n1 0 0\n0 1 0\n", ":3: this vertex equals its neighbour on line 2"),
    "crossing": ("# 8\n0 0 0\n2 2 0\n2 0 0\n0 2 0\n", ":2: the curve crosses itself"),
    "close": ("0 0 0\n2 2 0\n2 0 1e-9\n0 2 1e-9\n", ":1: the curve crosses itself"),
    "folded": ("0 0 0\n1 0 0\n2 0 0\n", ":1: the curve crosses itself"),
    "open": ("VECT\n1 3 0\n3\n0\n0 0 0\n1 0 0\n0 1 0\n", ":7: the chain is open"),
    "huge": ("0 0 0\n1e200 0 0\n0 1e200 1e200\n", ":2: vertex 1 of component 0 is not finite"),
    "empty": ("", ":1: the file holds no vertices"),
    "utf-16": ("\xff\xfe\0\0", ":1: this is UTF-16 text, or none; save it as UTF-8"),
    "binary": ("\x80\xff\0\0", ":1: byte 0x80 is not UTF-8 text"),
}


def test_wrong_files_do_not_stop_the_others(folder: Path, sono: Sono) -> None:
    for name, (content, _) in WRONG.items():
        (folder / f"{name}.txt").write_bytes(content.encode("latin-1"))
    (folder / "directory.txt").mkdir()
    names = [*WRONG, "directory", "missing", "3_1"]
    result = sono("measure", *(f"{name}.txt" for name in names))
    assert result.exit_code == 1
    assert [row.split("\t")[0] for row in result.stdout.splitlines()] == ["knot", "3_1"]
    messages = result.stderr.splitlines()
    expected = [f"sono: {name}.txt{message}" for name, (_, message) in WRONG.items()]
    expected += ["sono: directory.txt: cannot be read: ", "sono: missing.txt: cannot be read: "]
    for message, start in zip(messages, expected, strict=True):
        assert message.startswith(start)


def test_a_wrong_line_of_standard_input(sono: Sono) -> None:
    result = sono("measure", "-", input="0 0 0\nx\n")
    assert result.exit_code == 1
    assert result.stderr.startswith("sono: <stdin>:2: 1 columns")


def test_no_bound_for_a_coarse_curve(folder: Path, sono: Sono) -> None:
    (folder / "coarse.txt").write_text(ROWS)
    loud, quiet = sono("measure", "coarse.txt"), sono("measure", "coarse.txt", "--quiet")
    assert loud.stdout == quiet.stdout
    assert loud.stdout.splitlines()[1].split("\t")[4:6] == ["-", "-"]
    assert loud.stderr == "sono: coarse.txt: no L_c, since R_s <= dl/sqrt 2; refine the curve\n"
    assert (loud.exit_code, quiet.exit_code, quiet.stderr) == (0, 0, "")


@pytest.mark.skipif(sys.platform != "linux", reason="needs file names that are any bytes")
def test_a_name_that_is_no_text(folder: Path, spawn: Spawn) -> None:
    name = os.fsdecode(b"\xff.txt")
    (folder / name).write_text(ROWS)
    (folder / os.fsdecode(b"\xfe.txt")).write_text("x")
    process = spawn("measure", name, os.fsdecode(b"\xfe.txt"))
    stdout, stderr = process.communicate()
    assert stdout.splitlines()[1].startswith("?\t4\t")
    assert r"sono: \udcfe.txt:1: 1 columns" in stderr
    assert process.returncode == 1


def test_a_name_is_no_file(folder: Path, sono: Sono) -> None:
    result = sono("measure", "8_18", "3_1.txt", "T(2,5)")
    assert result.exit_code == 1
    assert len(result.stdout.splitlines()) == 2
    for knot, quoted in (("8_18", "8_18"), ("T(2,5)", "'T(2,5)'")):
        assert f"sono: {knot}: no such file; measure takes files; `sono start {quoted} |" in result.stderr
