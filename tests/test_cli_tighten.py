"""`sono tighten`: rows and files, names that nobody loses, signals, and going on after them."""

import json
import math
import os
import re
import signal
import subprocess
import sys
import time
from contextlib import suppress
from pathlib import Path
from typing import Any

import pytest
from conftest import QUICK, Sono, Spawn, vertices

from sono import formats, measure, starts, tables
from sono._core import PanicError
from sono.cli import places
from sono.jobs import checkpoints, task
from sono.tightening import Run

posix = pytest.mark.skipif(os.name != "posix", reason="needs Unix signals")

AT_ONCE = ("--time-limit", "1e-9")
"""Stops a run after its first slice."""


def names(folder: Path) -> list[str]:
    """What is in the folder besides the starting conformations."""
    return sorted(path.name for path in folder.iterdir() if path.name not in ("3_1.txt", "Hopf.txt"))


def test_a_row_for_each_n(folder: Path, sono: Sono) -> None:
    columns = ",".join(tables.COLUMNS)
    result = sono("tighten", "3_1.txt", "-n", "60,40,60", *QUICK, "--format", "jsonl", "--columns", columns)
    assert (result.exit_code, result.stderr) == (0, "")
    rows = [json.loads(line) for line in result.stdout.splitlines()]
    assert [row["n"] for row in rows] == [40, 60]
    assert [row["file"] for row in rows] == names(folder) == ["3_1.n40.txt", "3_1.n60.txt"]
    for row in rows:
        assert (row["knot"], row["status"]) == ("3_1", "tight")
        # The figures are those of the file.
        measures = measure(formats.read(row["file"]).components)
        for key in ("n", "dl", "l_p", "l_c", "l_a", "dispersion", "r_s"):
            assert row[key] == getattr(measures, key)
    assert rows[1]["factorisations"] > rows[0]["factorisations"] > 0
    assert rows[1]["seconds"] > rows[0]["seconds"] > 0


def test_default_columns_are_the_papers_and_the_status(sono: Sono) -> None:
    header, row = sono("tighten", "3_1.txt", "-n", "60", *QUICK).stdout.splitlines()
    assert header.split("\t") == ["knot", "n", "dl", "l_p", "l_c", "l_a", "status"]
    assert row.split("\t")[-1] == "tight"


def test_the_file_says_what_it_is(folder: Path, sono: Sono) -> None:
    sono("tighten", "3_1.txt", "-n", "60", *QUICK, "--seed", "3")
    head = (folder / "3_1.n60.txt").read_text().splitlines()[:3]
    assert head[0] == "# 3_1: tight, rope radius R_s = 1"
    assert head[1].startswith("# n 60  dl 0.54")
    assert '"seed": 3' in head[2]


def test_the_seed_decides(folder: Path, sono: Sono) -> None:
    for output, seed in {"a/": "1", "b/": "1", "c/": "2"}.items():
        sono("tighten", "3_1.txt", "-n", "60", *QUICK, "-o", output, "--seed", seed)
    a, b, c = (folder / name / "3_1.n60.txt" for name in "abc")
    assert a.read_bytes() == b.read_bytes()
    assert vertices(a) != vertices(c)


def test_jobs_change_nothing(folder: Path, sono: Sono) -> None:
    for output, jobs in {"a/": "1", "b/": "3"}.items():
        result = sono("tighten", "3_1.txt", "Hopf.txt", "-n", "60,80", *QUICK, "-o", output, "-j", jobs)
        assert len(result.stdout.splitlines()) == 5
    assert [path.name for path in sorted((folder / "a").iterdir())] == names(folder / "b")
    for path in (folder / "a").iterdir():
        assert path.read_bytes() == (folder / "b" / path.name).read_bytes()


def test_one_output_file(folder: Path, sono: Sono) -> None:
    assert sono("tighten", "Hopf.txt", "-n", "60", *QUICK, "-o", "tight.vect").exit_code == 0
    assert (folder / "tight.vect").read_text().startswith("VECT\n")
    assert len(formats.read("tight.vect").components) == 2


def test_a_folder_that_is_there_needs_no_slash(folder: Path, sono: Sono) -> None:
    (folder / "results").mkdir()
    sono("tighten", "3_1.txt", "-n", "60", *QUICK, "-o", "results")
    assert names(folder / "results") == ["3_1.n60.txt"]


def test_vertices_on_standard_output(folder: Path, sono: Sono) -> None:
    to_file = sono("tighten", "3_1.txt", "-n", "60", *QUICK)
    piped = sono("tighten", "3_1.txt", "-n", "60", *QUICK, "-o", "-")
    assert piped.stdout == (folder / "3_1.n60.txt").read_text()
    assert piped.stderr == to_file.stdout
    silent = sono("tighten", "3_1.txt", "-n", "60", *QUICK, "-o", "-", "--quiet")
    assert (silent.stdout, silent.stderr) == (piped.stdout, "")


def test_standard_input_takes_the_next_free_name(folder: Path, sono: Sono) -> None:
    knot = (folder / "3_1.txt").read_text()
    for _ in range(3):
        result = sono("tighten", "-", "-n", "60,80", *QUICK, "--columns", "knot,file", input=knot)
        assert result.exit_code == 0
    assert "stdin\tstdin-3.n80.txt" in result.stdout
    stems = ["stdin", "stdin-2", "stdin-3"]
    assert names(folder) == sorted(f"{stem}.n{n}.txt" for stem in stems for n in (60, 80))
    sono("tighten", "-", "-n", "60", *QUICK, "--force", input=knot)
    assert len(names(folder)) == 6


def test_files_are_not_overwritten(folder: Path, sono: Sono) -> None:
    (folder / "3_1.n60.txt").write_text("mine")
    result = sono("tighten", "Hopf.txt", "3_1.txt", "-n", "60", *QUICK)
    assert (result.exit_code, result.stdout) == (2, "")
    assert "3_1.n60.txt exists; --force starts anew, --resume goes on from it" in result.stderr
    assert names(folder) == ["3_1.n60.txt"]
    assert (folder / "3_1.n60.txt").read_text() == "mine"
    assert sono("tighten", "3_1.txt", "-n", "60", *QUICK, "--force").exit_code == 0
    assert len(formats.read("3_1.n60.txt").components[0]) == 60


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (["3_1.txt", "-n", "2"], "a closed curve has at least 3 vertices"),
        (["3_1.txt", "-n", "60,"], "'60,': give whole numbers such as"),
        (["3_1.txt", "-n", "1e3"], "'1e3': give whole numbers such as"),
        (["3_1.txt", "--method", "magic"], "'magic' is not one of 'both', 'sono', 'polish'"),
        (["3_1.txt", "--seed", "-1"], "-1 is not in the range"),
        (["3_1.txt", "--seed", str(2**64)], f"{2**64} is not in the range"),
        (["3_1.txt", "--jobs", "0"], "0 is not in the range"),
        (["3_1.txt", "--jobs", "9" * 20], "is not in the range 1<=x<=256"),
        (["3_1.txt", "--time-limit", "0"], "0.0 is no number of seconds above 0"),
        (["3_1.txt", "--time-limit", "nan"], "nan is no number of seconds above 0"),
        (["3_1.txt", "--time-limit", "inf"], "inf is no number of seconds above 0"),
        (["3_1.txt", "--set", "speed=1"], "unknown setting 'speed'; the settings are: c_1, "),
        (["3_1.txt", "--set", "c_1"], "--set c_1: '' is no number"),
        (["3_1.txt", "--set", "c_1=half"], "--set c_1=half: 'half' is no number"),
        (["3_1.txt", "--set", "c_1=nan"], "--set c_1=nan: setting c_1 = nan is not a finite number"),
        (["3_1.txt", "--set", "c_1=0.6"], "--set c_1=0.6: setting c_1 = 0.6 is out of range: in (0, 0.5]"),
        (["3_1.txt", "--set", "anneal_sweeps=1e3"], "'1e3' is no whole number"),
        (["3_1.txt", "--set", "anneal_sweeps=-1"], "= -1 is not a whole number from 0 to 4294967295"),
        (["3_1.txt", "--set", f"anneal_sweeps={2**32}"], f"= {2**32} is not a whole number from 0 to "),
        (
            ["3_1.txt", "--set", f"seed={10**20}"],
            f"seed = {10**20} is not a whole number from 0 to 1844674407",
        ),
        (["3_1.txt", "Hopf.txt", "-o", "one.txt"], "name a folder (FOLDER/)"),
        (["3_1.txt", "-n", "60,80", "-o", "-"], "name a folder (FOLDER/)"),
        (["3_1.txt", "-o", "rope.stl"], "rope.stl: .stl is no format for vertices; the suffixes are: .txt, "),
        (["3_1.txt", "--contacts", "forces.png"], "forces.png: .png is no format for forces"),
        (["3_1.txt", "3_1.txt"], "3_1.n480.txt would be written 2 times"),
        (["-", "-"], "stdin.n480.txt would be written 2 times"),
        (["3_1.txt", "-o", "Hopf.txt/"], "Hopf.txt: cannot be made: "),
        (["3_1.txt", "--checkpoint", "Hopf.txt"], "'Hopf.txt' is a file"),
        (["3_1.txt", "--force", "--resume"], "give one of them"),
    ],
    ids=lambda value: " ".join(value[1:]) if isinstance(value, list) else "",
)
def test_usage_errors(folder: Path, sono: Sono, arguments: list[str], message: str) -> None:
    result = sono("tighten", *arguments)
    assert (result.exit_code, result.stdout) == (2, "")
    assert message in " ".join(result.stderr.split())
    assert names(folder) == []


def test_one_bad_file_does_not_stop_the_others(folder: Path, sono: Sono) -> None:
    (folder / "open.txt").write_text("0 0 0\n1 0 0\n")
    (folder / "crossing.txt").write_text("0 0 0\n2 2 0\n2 0 0\n0 2 0\n")
    result = sono("tighten", "open.txt", "crossing.txt", "nowhere.txt", "3_1.txt", "-n", "60", *QUICK)
    assert result.exit_code == 1
    assert result.stdout.splitlines()[1].startswith("3_1\t60\t")
    expected = ["sono: open.txt:1: ", "sono: crossing.txt:1: the curve crosses", "sono: nowhere.txt: cannot"]
    assert [line[: len(start)] for line, start in zip(result.stderr.splitlines(), expected, strict=True)] == (
        expected
    )
    assert names(folder) == ["3_1.n60.txt", "crossing.txt", "open.txt"]


def test_an_open_chain_is_told(folder: Path, sono: Sono) -> None:
    chain = "".join(f"{k} {math.cos(k)} {math.sin(k)}\n" for k in range(20))
    (folder / "chain.txt").write_text(chain)
    for command in (["measure"], ["tighten", "-n", "60", *QUICK], ["search", "--trials", "1"]):
        quiet = sono(*command, "chain.txt", "-q")
        loud = sono(*command, "chain.txt", *([] if command == ["measure"] else ["--force"]))
        assert (loud.exit_code, quiet.exit_code, quiet.stderr) == (0, 0, "")
        assert "sono: chain.txt:20: the edge that closes the curve, from here back to line 1" in loud.stderr


@pytest.mark.parametrize("method", ["both", "sono", "polish"])
def test_too_few_vertices_do_not_stop_the_larger_n(folder: Path, sono: Sono, method: str) -> None:
    result = sono("tighten", "3_1.txt", "-n", "12,60", "--method", method, *QUICK)
    assert result.exit_code == 1
    assert result.stderr.startswith("sono: 3_1.txt: 12 vertices are too few: ")
    assert names(folder) == ["3_1.n60.txt"]


def test_a_trial_that_fails_is_told(folder: Path, sono: Sono, monkeypatch: pytest.MonkeyPatch) -> None:
    begin, anneals = Run._engine, 0

    def engine(self: Run, stage: Any, n: int) -> Any:
        nonlocal anneals
        anneals += stage == "anneal"
        if stage == "anneal" and anneals == 2:
            raise PanicError("index out of bounds")
        return begin(self, stage, n)

    monkeypatch.setattr(Run, "_engine", engine)
    result = sono("tighten", "3_1.txt", "-n", "60", "--trials", "3", "--set", "anneal_sweeps=5000")
    assert (result.exit_code, result.stdout.splitlines()[1].split("\t")[-1]) == (0, "tight")
    assert result.stderr.endswith("; the best was taken; 1 failed: index out of bounds\n")
    assert "method both  trials 3 " in (folder / "3_1.n60.txt").read_text()


def test_a_bug_in_the_core_stays_with_its_n(
    folder: Path, sono: Sono, monkeypatch: pytest.MonkeyPatch
) -> None:
    begin = Run._engine

    def engine(self: Run, stage: Any, n: int) -> Any:
        if n == 70:
            raise PanicError("index out of bounds")
        return begin(self, stage, n)

    monkeypatch.setattr(Run, "_engine", engine)
    result = sono("tighten", "3_1.txt", "Hopf.txt", "-n", "60,70,80", *QUICK)
    assert result.exit_code == 1
    message = "n = 70: the core came upon a bug (index out of bounds); please report it"
    assert result.stderr == f"sono: 3_1: {message}\nsono: Hopf: {message}\n"
    assert names(folder) == ["3_1.n60.txt", "3_1.n80.txt", "Hopf.n60.txt", "Hopf.n80.txt"]


def test_too_few_vertices_for_the_components(sono: Sono) -> None:
    result = sono("tighten", "Hopf.txt", "-n", "5,60")
    assert result.exit_code == 1
    assert "Hopf.txt: n = 5 is too small; 3 vertices for each component make 6" in result.stderr


def test_what_does_not_settle_is_told(folder: Path, sono: Sono) -> None:
    settings = ("--method", "sono", "--set", "settle_sweeps=20", "--set", "tolerance=1e-12")
    result = sono("tighten", "3_1.txt", "-n", "60", *settings)
    assert result.exit_code == 1
    assert result.stdout.splitlines()[1].endswith("\tstuck")
    assert result.stderr == "sono: 3_1: n = 60 did not settle to 1e-12; 3_1.n60.txt has its best\n"
    assert (folder / "3_1.n60.txt").read_text().startswith("# 3_1: stuck, rope")
    resumed = sono("tighten", "3_1.txt", "-n", "60", *settings, "--resume")
    assert (resumed.exit_code, resumed.stdout, resumed.stderr) == (1, result.stdout, result.stderr)


@pytest.mark.usefixtures("slices")
@pytest.mark.parametrize("name", ["[bold]", "[x]%s{}", "a b\nc", "-n"])
def test_strange_names(folder: Path, sono: Sono, name: str) -> None:
    (folder / "3_1.txt").rename(folder / f"{name}.txt")
    result = sono("tighten", f"./{name}.txt", "-n", "60", *QUICK, *AT_ONCE)
    assert result.exit_code == 1
    assert len(result.stdout.splitlines()) == 2
    assert len(formats.read(f"{name}.n60.best.txt").components) == 1


@pytest.mark.skipif(sys.platform != "linux", reason="needs file names that are any bytes")
def test_a_name_that_is_no_text(folder: Path, spawn: Spawn) -> None:
    (folder / "3_1.txt").rename(folder / os.fsdecode(b"\xff.txt"))
    process = spawn("tighten", os.fsdecode(b"\xff.txt"), "-n", "60", *QUICK)
    stdout, stderr = process.communicate()
    assert (process.returncode, stderr) == (0, "")
    assert stdout.splitlines()[1].startswith("?\t60\t")
    assert (folder / os.fsdecode(b"\xff.n60.txt")).read_text().startswith("# ?: tight")


@pytest.mark.usefixtures("slices")
class TestTimeLimit:
    def test_keeps_the_best_state(self, folder: Path, sono: Sono) -> None:
        result = sono("tighten", "3_1.txt", "-n", "60", *QUICK, *AT_ONCE)
        assert result.exit_code == 1
        assert result.stdout.splitlines()[1].endswith("\tstopped")
        n = result.stdout.splitlines()[1].split("\t")[1]
        place = f"the best state so far, n = {n}, is in 3_1.n60.best.txt"
        assert result.stderr == f"sono: 3_1: the time limit of 1e-09 s was reached; {place}\n"
        assert names(folder) == ["3_1.n60.best.txt"]
        sono("tighten", "3_1.txt", "-n", "60", *QUICK, *AT_ONCE)
        assert names(folder) == ["3_1.n60.best.txt", "3_1.n60.best2.txt"]

    def test_goes_to_standard_output_too(self, folder: Path, sono: Sono) -> None:
        result = sono("tighten", "3_1.txt", "-n", "60", *QUICK, *AT_ONCE, "-o", "-")
        assert result.stdout.startswith("# 3_1: stopped, rope")
        assert names(folder) == []

    def test_resumed_run_gives_the_same_bytes(self, folder: Path, sono: Sono) -> None:
        line = ("tighten", "3_1.txt", "Hopf.txt", "-n", "60,100", *QUICK)
        assert sono(*line, "-o", "whole/").exit_code == 0
        stopped = sono(*line, "-o", "parts/", "--checkpoint", "saved", *AT_ONCE)
        assert stopped.stderr.count("--resume goes on from here") == 2
        assert names(folder / "saved") == ["3_1.checkpoint.json", "Hopf.checkpoint.json"]
        resume = (*line, "-o", "parts/", "--checkpoint", "saved", "--resume")
        for _ in range(3):
            assert sono(*resume, *AT_ONCE).exit_code == 1
        assert sono(*resume).exit_code == 0
        assert names(folder / "saved") == []
        for path in (folder / "whole").iterdir():
            assert path.read_bytes() == (folder / "parts" / path.name).read_bytes()

    def test_checkpoints_are_not_overwritten(self, folder: Path, sono: Sono) -> None:
        line = ("tighten", "3_1.txt", "-n", "60", *QUICK, "--checkpoint", ".")
        sono(*line, *AT_ONCE)
        result = sono(*line)
        assert result.exit_code == 2
        assert "3_1.checkpoint.json exists; --force starts anew, --resume goes on" in result.stderr
        assert sono(*line, "--force").exit_code == 0
        assert names(folder) == ["3_1.n60.txt"]

    def test_a_checkpoint_of_something_else(self, folder: Path, sono: Sono) -> None:
        sono("tighten", "3_1.txt", "-n", "60", *QUICK, "--checkpoint", ".", *AT_ONCE)
        for change in (["-n", "61"], ["-n", "60", "--seed", "1"]):
            result = sono("tighten", "3_1.txt", *change, *QUICK, "--checkpoint", ".", "--resume")
            assert result.exit_code == 1
            expected = (
                "sono: 3_1.checkpoint.json: is of another curve, n or setting; repeat those or remove it\n"
            )
            assert result.stderr == expected

    def test_a_checkpoint_that_is_none_spoils_no_other_knot(self, folder: Path, sono: Sono) -> None:
        line = ("tighten", "3_1.txt", "Hopf.txt", "-n", "60", *QUICK, "--checkpoint", ".")
        sono(*line, *AT_ONCE)
        path = folder / "3_1.checkpoint.json"
        state = path.read_text()
        for content, why in {
            "": "is no checkpoint, or an old or damaged one; remove it",
            state.replace('"trials": 1', '"trials": 2'): "is damaged; remove it",
            state.replace(task.KIND, "search"): "is no checkpoint of a tightening; remove it",
        }.items():
            path.write_text(content)
            result = sono(*line, "--resume")
            assert result.exit_code == 1
            assert result.stderr == f"sono: 3_1.checkpoint.json: {why}\n"
            assert result.stdout.splitlines()[1].startswith("Hopf\t60\t")

    def test_a_checkpoint_of_nonsense(self, folder: Path, sono: Sono) -> None:
        line = ("tighten", "3_1.txt", "-n", "60", *QUICK, "--checkpoint", ".")
        sono(*line, *AT_ONCE)
        path = folder / "3_1.checkpoint.json"
        state = checkpoints.load(path, task.KIND)
        run = state["run"]
        of_plan = {"curve": ["AAAA"], "rungs": [3], "targets": None, "trial": {"stage": "anneal"}, "more": 1}
        wrong = [{"plan": run["plan"] | {key: value}} for key, value in of_plan.items()]
        for part in (*wrong, {"engine": ["Polish", "{}"]}, {"more": 1}, {"work": None}):
            checkpoints.save(path, task.KIND, state | {"run": run | part})
            result = sono(*line, "--resume")
            assert result.exit_code == 1
            assert result.stderr.startswith("sono: 3_1.checkpoint.json: holds no state of a run (")


def test_resume_keeps_what_is_there(folder: Path, sono: Sono) -> None:
    line = ("tighten", "3_1.txt", "-n", "60,80", *QUICK)
    first = sono(*line)
    written = (folder / "3_1.n60.txt").stat()
    (folder / "3_1.n80.txt").unlink()
    second = sono(*line, "--resume")
    assert (second.exit_code, len(second.stdout.splitlines())) == (0, 3)
    assert second.stdout.splitlines()[1] == first.stdout.splitlines()[1]
    assert (folder / "3_1.n60.txt").stat() == written
    assert names(folder) == ["3_1.n60.txt", "3_1.n80.txt"]


def test_resume_does_not_take_another_file_for_a_result(folder: Path, sono: Sono) -> None:
    (folder / "3_1.n60.txt").write_text("mine")
    (folder / "3_1.n80.txt").write_bytes((folder / "3_1.txt").read_bytes())
    result = sono("tighten", "3_1.txt", "-n", "60,80,100", *QUICK, "--resume")
    assert result.exit_code == 1
    assert len(result.stdout.splitlines()) == 2
    assert "sono: 3_1.n60.txt:1: 1 columns" in result.stderr
    assert "sono: 3_1.n80.txt: has 69 vertices, not n = 80; move it away" in result.stderr
    assert (folder / "3_1.n60.txt").read_text() == "mine"


@pytest.mark.parametrize(
    ("change", "line", "why"),
    [
        ("4_1", (), "is of another curve, method or setting; repeat those or move it away"),
        ("m3_1", (), "is of another curve, method or setting"),
        ("", ("--method", "sono"), "is of another curve, method or setting"),
        ("", ("--method", "polish"), "is of another curve, method or setting"),
        ("", ("--seed", "1"), "is of another curve, method or setting"),
        ("", ("--trials", "2"), "is of another curve, method or setting"),
        ("vertex", (), "is not as it was written; move it away, or --force starts anew"),
        ("swap", (), "is not as it was written"),
        ("header", (), "is of another curve, method or setting"),
        ("end", (), "has 59 vertices, not n = 60"),
    ],
)
@pytest.mark.parametrize("suffix", ["txt", "vect"])
def test_resume_takes_no_output_of_another_job(
    folder: Path, sono: Sono, change: str, line: tuple[str, ...], why: str, suffix: str
) -> None:
    output = folder / f"tight.{suffix}"
    job = ("tighten", "3_1.txt", "-n", "60", *QUICK, "-o", output.name)
    assert sono(*job).exit_code == 0
    again = sono(*job, "--resume")
    assert (again.exit_code, again.stderr) == (0, "")
    head, *rows = re.split(r"^(?=-?\d\S+ \S+ \S+\n)", output.read_text(), flags=re.MULTILINE)
    if change in ("4_1", "m3_1"):
        formats.write("3_1.txt", starts.start(change))
    elif change == "vertex":
        x, rest = rows[7].split(" ", 1)
        rows[7] = f"{float(x) + 1e-6} {rest}"
    elif change == "swap":
        rows[7], rows[8] = rows[8], rows[7]
    elif change == "end":
        formats.write(output.name, [formats.read(output.name).components[0][:-1]])
    elif change == "header":
        head = head.replace("# input", "# output")
    if change != "end":
        output.write_text("".join((head, *rows)))
    written = output.read_bytes()
    result = sono(*job, *line, "--resume")
    assert (result.exit_code, len(result.stdout.splitlines())) == (1, 1)
    assert result.stderr.startswith(f"sono: {output.name}: {why}")
    assert output.read_bytes() == written


def test_resume_keeps_what_sono_alone_left(folder: Path, sono: Sono) -> None:
    line = ("tighten", "3_1.txt", "-n", "60", "--method", "sono", "--set", "anneal_sweeps=5000")
    first = sono(*line)
    assert first.stdout.splitlines()[1].endswith("\tsettled")
    again = sono(*line, "--resume")
    assert (again.exit_code, again.stdout, again.stderr) == (0, first.stdout, "")


def until_first_row(process: subprocess.Popen[str]) -> None:
    """Wait for the row of the first n: from then on the run is at the next."""
    assert process.stdout
    assert process.stdout.readline().startswith("knot\t")
    assert process.stdout.readline().endswith("\ttight\n")


@posix
@pytest.mark.parametrize(("number", "code"), [(signal.SIGINT, 130), (signal.SIGTERM, 143)])
def test_a_signal_keeps_the_best_state(
    folder: Path, spawn: Spawn, sono: Sono, number: signal.Signals, code: int
) -> None:
    line = ("tighten", "3_1.txt", "Hopf.txt", "-n", "60,50000", *QUICK, "--checkpoint", "saved")
    process = spawn(*line)
    until_first_row(process)
    process.send_signal(number)
    process.send_signal(number)  # as wrappers do, which pass on what the terminal has sent already
    stdout, stderr = process.communicate()
    assert process.returncode == code
    name, n, *_, status = stdout.rstrip("\n").split("\t")
    assert (name, status) == ("3_1", "stopped")
    first, second = stderr.splitlines()
    best = f"n = {n}, is in 3_1.n50000.best.txt; --resume goes on from here"
    assert first == f"sono: 3_1: interrupted; the best state so far, {best}"
    assert second == "sono: 1 of 2 knots were not begun"
    assert len(formats.read("3_1.n50000.best.txt").components[0]) == int(n)
    assert names(folder) == ["3_1.n50000.best.txt", "3_1.n60.txt", "saved"]
    assert names(folder / "saved") == ["3_1.checkpoint.json"]


@posix
def test_a_signal_while_waiting_for_input(spawn: Spawn, folder: Path) -> None:
    process = spawn("tighten", "-", "-n", "60", *QUICK, stdin=subprocess.PIPE)
    assert process.stdin
    process.stdin.write("# more than a pipe holds, so that it has been read in part\n" * 10000)
    time.sleep(0.5)  # by then it waits
    while process.poll() is None:  # Python may miss one that comes just before it reads on
        process.send_signal(signal.SIGINT)
        with suppress(subprocess.TimeoutExpired):  # but another one on its way out would end it at once
            process.wait(5)
    assert process.returncode == 130
    assert names(folder) == []


@posix
def test_ctrl_c_ignored_stays_ignored(spawn: Spawn, folder: Path) -> None:
    def ignore() -> None:
        signal.signal(signal.SIGINT, signal.SIG_IGN)

    process = spawn("tighten", "3_1.txt", "-n", "60,100", *QUICK, limit=ignore)
    until_first_row(process)
    process.send_signal(signal.SIGINT)
    assert process.wait() == 0
    assert names(folder) == ["3_1.n100.txt", "3_1.n60.txt"]


def small_files() -> None:
    """Let this process write no file larger than 1000 bytes."""
    import resource  # which only Unix has

    resource.setrlimit(resource.RLIMIT_FSIZE, (1000, 1000))


@posix
def test_a_full_disk(folder: Path, spawn: Spawn) -> None:
    process = spawn("tighten", "3_1.txt", "-n", "60", *QUICK, limit=small_files)
    stdout, stderr = process.communicate()
    assert process.returncode == 1
    assert stdout.splitlines()[1].startswith("3_1\t60\t")
    assert stderr == "sono: 3_1.n60.txt: cannot be written: File too large\n"
    assert names(folder) == []


def test_a_checkpoint_that_cannot_be_written_ends_no_run(
    folder: Path, sono: Sono, monkeypatch: pytest.MonkeyPatch
) -> None:
    write = formats.save

    def full(target: str, content: str) -> None:
        if target.endswith(".json"):
            raise formats.FormatError(f"{target}: cannot be written: No space left on device")
        write(target, content)

    monkeypatch.setattr(formats, "save", full)
    why = "checkpoint.json: cannot be written: No space left on device"
    line = ("-n", "60", "--checkpoint", "saved", *QUICK)
    result = sono("tighten", "3_1.txt", "Hopf.txt", *line)
    assert result.exit_code == 1
    assert result.stderr.splitlines() == [
        f"sono: saved/{name}.{why}; it goes on without a checkpoint" for name in ("3_1", "Hopf")
    ]
    assert [row.split("\t")[0] for row in result.stdout.splitlines()] == ["knot", "3_1", "Hopf"]
    assert names(folder) == ["3_1.n60.txt", "Hopf.n60.txt", "saved"]
    stopped = sono("tighten", "3_1.txt", "-n", "60", *line, "--force", *AT_ONCE)
    assert (folder / "3_1.n60.best.txt").exists()
    assert stopped.stderr.splitlines()[-1].endswith(f"is in 3_1.n60.best.txt; saved/3_1.{why}")
    search = sono("search", "Hopf", "--trials", "1", "--checkpoint", "saved")
    assert search.exit_code == 1
    assert search.stderr.count("search.json: cannot be written: No space left on device") == 2
    assert (folder / "Hopf.tight.txt").exists()


def test_unfinished_ropes_go_when_there_is_a_tight_one(folder: Path, sono: Sono) -> None:
    line = ("tighten", "3_1.txt", "-n", "60", *QUICK)
    for _ in range(2):
        sono(*line, *AT_ONCE)
    unfinished = [folder / "3_1.n60.best.txt", folder / "3_1.n60.best2.txt"]
    assert all(path.exists() for path in unfinished)
    kept = {
        "3_1.n60.best3.txt": (folder / "Hopf.txt").read_text(),  # another type, and nobody's stopped rope
        "3_1.n60.best4.txt": "mine",
        "3_1.n60.best.tsv": "mine",
    }
    formats.write("other.txt", starts.start("4_1"))
    sono("tighten", "other.txt", "-n", "60", *QUICK, *AT_ONCE, "-o", "4_1.txt")
    kept["3_1.n60.best5.txt"] = (folder / "4_1.best.txt").read_text()
    for name, content in kept.items():
        (folder / name).write_text(content)
    assert sono(*line).exit_code == 0
    assert not any(path.exists() for path in unfinished)
    for name, content in kept.items():
        assert (folder / name).read_text() == content
    # A better rope stays, and so does any beside one that did not get tight.
    best = (folder / "3_1.n60.txt").read_text().replace("3_1: tight", "3_1: stopped")
    (folder / "3_1.n40.best.txt").write_text(best)
    stuck = ("--method", "sono", "--set", "settle_sweeps=1", "--set", "tolerance=1e-12")
    assert sono("tighten", "3_1.txt", "-n", "60", "-o", "3_1.n40.txt", *stuck).exit_code == 1
    assert sono("tighten", "3_1.txt", "-n", "40", *QUICK, "--force").exit_code == 0
    assert (folder / "3_1.n40.best.txt").read_text() == best


def test_a_result_that_cannot_be_written_is_not_lost(
    folder: Path, sono: Sono, monkeypatch: pytest.MonkeyPatch
) -> None:
    line = ("tighten", "3_1.txt", "-n", "60,80", *QUICK, "--checkpoint", "saved")
    sono(*line, "-o", "whole/")
    (folder / "3_1.n60.txt").mkdir()
    with monkeypatch.context() as later:  # as if it had been made after the names were tried
        later.setattr(places, "_try", lambda path: None)
        result = sono(*line, "--force")
    assert result.exit_code == 1
    assert len(result.stdout.splitlines()) == 2
    assert result.stderr.startswith("sono: 3_1.n60.txt: cannot be written: ")
    assert result.stderr.endswith("; --resume goes on from here\n")
    (folder / "3_1.n60.txt").rmdir()
    assert sono(*line, "--resume").exit_code == 0
    for name in ("3_1.n60.txt", "3_1.n80.txt"):
        assert (folder / name).read_bytes() == (folder / "whole" / name).read_bytes()


@pytest.mark.skipif(os.name != "posix" or os.geteuid() == 0, reason="root may write everywhere")
def test_a_folder_that_is_read_only(folder: Path, sono: Sono) -> None:
    (folder / "locked").mkdir(mode=0o500)
    result = sono("tighten", "3_1.txt", "-n", "60", "-o", "locked/")
    assert result.exit_code == 2
    assert "locked: cannot be written to; -o names another folder" in result.stderr


@pytest.mark.skipif(not os.path.exists("/dev/full"), reason="needs /dev/full")
def test_devices(folder: Path, sono: Sono) -> None:
    assert sono("tighten", "3_1.txt", "-n", "60", *QUICK, "-o", "/dev/null").exit_code == 0
    result = sono("tighten", "3_1.txt", "-n", "60", *QUICK, "-o", "/dev/full")
    assert result.exit_code == 1
    assert len(result.stdout.splitlines()) == 2
    assert result.stderr == "sono: /dev/full: cannot be written: No space left on device\n"


@posix
def test_progress_on_a_terminal(spawn: Spawn) -> None:
    ours, theirs = os.openpty()
    line = ("tighten", "3_1.txt", "-n", "50000", *QUICK)
    process = spawn(*line, stderr=theirs, env=os.environ | {"TERM": "xterm", "COLUMNS": "120"})
    os.close(theirs)
    shown = b""
    while not re.search(rb"3_1 .*(collapse|anneal|trial|climb) n \d+/50000 L_p \d", shown):
        shown += os.read(ours, 1 << 16)
    process.send_signal(signal.SIGINT)
    with suppress(OSError):  # the end of a pseudoterminal
        while more := os.read(ours, 1 << 16):
            shown += more
    os.close(ours)
    assert b"interrupted; the best state so far" in shown
    assert process.stdout
    header, row = process.stdout.read().splitlines()
    assert (header[:5], row[:4]) == ("knot\t", "3_1\t")


@posix
def test_quiet_shows_no_progress(spawn: Spawn) -> None:
    ours, theirs = os.openpty()
    process = spawn("tighten", "3_1.txt", "-n", "60", "--quiet", *QUICK, stderr=theirs)
    assert process.wait() == 0
    os.write(theirs, b"nothing")
    assert os.read(ours, 1 << 16) == b"nothing"
    os.close(theirs)
    os.close(ours)


def test_edges_of_a_length(folder: Path, sono: Sono) -> None:
    line = ("tighten", "3_1.txt", "Hopf", "--dl", "0.3,0.5", *QUICK, "-o", "out/")
    result = sono(*line, "--columns", "knot,n,dl,l_p,status,file", "--format", "jsonl")
    assert result.exit_code == 0
    rows = [json.loads(row) for row in result.stdout.splitlines()]
    assert [row["file"] for row in rows] == [
        f"out/{knot}.dl{dl}.txt" for knot in ("3_1", "Hopf") for dl in (0.5, 0.3)
    ]
    for row, dl in zip(rows, (0.5, 0.3, 0.5, 0.3), strict=True):
        assert row["n"] == round(row["l_p"] / dl)
        assert row["status"] == "tight"
    again = sono(*line, "--columns", "knot,n,dl,l_p,status,file", "--format", "jsonl", "--resume")
    assert again.stdout == result.stdout
    for wrong in (("--dl", "0.3", "-n", "60"), ("--dl", "2"), ("--dl", "x"), ("--dl", "nan")):
        assert sono("tighten", "3_1.txt", *wrong).exit_code == 2


@pytest.mark.parametrize("method", ["sono", "polish"])
def test_edges_of_a_length_by_one_engine(folder: Path, sono: Sono, method: str) -> None:
    result = sono("tighten", "3_1.txt", "--dl", "0.4", "--method", method, "--columns", "n,l_p")
    assert result.exit_code == 0
    n, l_p = result.stdout.splitlines()[1].split("\t")
    assert int(n) == round(float(l_p) / 0.4)
