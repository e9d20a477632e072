"""`sono search`: batches of names and files, what is written, what is kept."""

import os
import signal
import threading
import time
from pathlib import Path

import pytest
from click.testing import CliRunner
from conftest import Sono, Spawn, vertices

from sono import formats, measure, starts, tables
from sono.cli import main
from sono.curve import packed, unpacked
from sono.invariants import fingerprint
from sono.jobs import checkpoints, hunt
from sono.searching import minima, search, trials

PROMPT = 8
"""Seconds, four times what a stop may take on a machine with nothing else to do."""

ONE = ("--trials", "1", "--minima", "1")


def rows(text: str) -> list[tables.Row]:
    Path("rows.tsv").write_text(text)
    return tables.read("rows.tsv")


@pytest.mark.slow
def test_the_rows_are_minima_and_the_file_is_the_shortest(folder: Path, sono: Sono) -> None:
    result = sono("search", "5_2", "--trials", "10", "-j", "2")
    assert (result.exit_code, result.stderr) == (0, "")
    best, *others = rows(result.stdout)
    assert best["status"] == "tight"
    assert 49.4 < float(best["l_a"] or 0) < 49.47
    assert all(float(row["l_a"] or 0) > float(best["l_a"] or 0) for row in others)
    assert measure(formats.read("5_2.tight.txt").components).l_a == best["l_a"]
    assert "# searched: variant " in (folder / "5_2.tight.txt").read_text()


def test_a_batch_goes_on_past_what_is_wrong(folder: Path, sono: Sono) -> None:
    (folder / "list.txt").write_text("# a library\nT(2,4)  # a link\n\nm3_1\n")
    result = sono("search", "3_2", "3_1.txt", "--list", "list.txt", *ONE, "-o", "out/")
    assert result.exit_code == 1
    assert "3_2: no such file, nor a knot: unknown knot" in result.stderr
    assert sorted(str(row["knot"]) for row in rows(result.stdout)) == ["3_1", "T(2,4)", "m3_1"]
    assert sorted(os.listdir("out")) == ["3_1.tight.txt", "T(2,4).tight.txt", "m3_1.tight.txt"]


def test_shards_share_a_list(folder: Path, sono: Sono) -> None:
    shares = [
        sono(
            "search",
            "3_1",
            "T(2,4)",
            "Hopf",
            "--trials",
            "1",
            "--minima",
            "1",
            "--shard",
            f"{i}/2",
            "-o",
            "out/",
        )
        for i in (1, 2)
    ]
    knots = [[row["knot"] for row in rows(share.stdout)] for share in shares]
    assert knots == [["3_1", "Hopf"], ["T(2,4)"]]


def test_finer_edges(sono: Sono) -> None:
    (row,) = rows(sono("search", "3_1", "--trials", "1", "--dl", "0.05", "--minima", "1").stdout)
    assert float(row["dl"] or 0) == pytest.approx(0.05, rel=0.01)
    assert row["status"] == "tight"
    assert measure(formats.read("3_1.tight.txt").components).n == row["n"]


def test_what_is_finished_is_kept(folder: Path, sono: Sono) -> None:
    sono("search", "3_1", "--trials", "2", "-o", "3_1.tight.txt")
    before = (folder / "3_1.tight.txt").stat().st_mtime_ns
    result = sono("search", "3_1", "--trials", "2", "--resume")
    assert result.exit_code == 0
    (row,) = rows(result.stdout)
    assert (row["trials"], row["status"]) == (2, "tight")
    assert (folder / "3_1.tight.txt").stat().st_mtime_ns == before
    # More trials are another matter, and so is a file that was tampered with.
    assert rows(sono("search", "3_1", "--trials", "3", "--resume").stdout)[0]["trials"] == 3
    text = (folder / "3_1.tight.txt").read_text().splitlines(True)
    (folder / "3_1.tight.txt").write_text("".join(text[:-1]))
    assert rows(sono("search", "3_1", "--trials", "3", "--resume").stdout)[0]["variant"] is not None


@pytest.mark.slow
def test_a_checkpoint_makes_the_whole_of_two_halves(
    folder: Path, sono: Sono, monkeypatch: pytest.MonkeyPatch
) -> None:
    tried = []

    def attempt(source: trials.Source, variant: int, watch: trials.Watch) -> minima.Shape:
        tried.append(variant)
        return make(source, variant, watch)

    make = trials.attempt
    monkeypatch.setattr(search, "attempt", attempt)
    more = ("--checkpoint", "kept", "--minima", "1")
    sono("search", "4_1", "--trials", "4", *more)
    assert tried == [0, -1, 1, -2]
    tried.clear()
    half = rows(sono("search", "4_1", "--trials", "8", "--resume", *more).stdout)
    assert tried == [2, -3, 3, -4]
    whole = rows(sono("search", "4_1", "--trials", "8", "-o", "whole.txt", "--minima", "1").stdout)
    assert half[0]["l_a"] == pytest.approx(whole[0]["l_a"], abs=1e-4)
    assert half[0]["trials"] == 8


def test_a_checkpoint_of_another_knot(folder: Path, sono: Sono) -> None:
    sono("search", "3_1", "--trials", "1", "--checkpoint", "kept")
    os.rename("kept/3_1.search.json", "kept/4_1.search.json")
    result = sono("search", "4_1", "--trials", "1", "--checkpoint", "kept", "--resume")
    assert result.exit_code == 1
    assert "is of another knot or seed" in result.stderr
    (folder / "kept/4_1.search.json").write_text("{}")
    result = sono("search", "4_1", "--trials", "1", "--checkpoint", "kept", "--resume")
    assert "4_1.search.json: is no checkpoint, or an old or damaged one; remove it" in result.stderr


def test_standard_input_and_output(folder: Path, sono: Sono) -> None:
    result = sono("search", "-", "--trials", "1", "-o", "-", input=(folder / "3_1.txt").read_text())
    assert result.exit_code == 0
    assert result.stdout.startswith("# stdin: ")
    assert "\tl_a\t" in result.stderr


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        ([], "give a FILE or the NAME of a knot"),
        (["3_1", "4_1", "-o", "one.txt"], "-o names one file for several knots"),
        (["3_1", "--force", "--resume"], "give one of them"),
        (["3_1", "--shard", "3/2"], "give I/N with I from 1 to N"),
        (["3_1", "--list", "nowhere.txt"], "does not exist"),
        (["3_1", "-o", "rope.stl"], "rope.stl: .stl is no format for vertices"),
        (["3_1", "3_1"], "3_1.tight.txt would be written 2 times; give each knot once"),
        (["3_1", "--dl", "3"], "--dl"),
        (["3_1", "--dl", "nan"], "nan is not a number"),
        (["3_1", "--shard", f"{'9' * 5000}/1"], "give I/N with I from 1 to N"),
    ],
)
def test_usage_errors(sono: Sono, arguments: list[str], message: str) -> None:
    result = sono("search", *arguments)
    assert (result.exit_code, result.stdout) == (2, "")
    assert message in result.stderr


@pytest.mark.slow
def test_a_signal_keeps_the_best(folder: Path, spawn: Spawn) -> None:
    process = spawn("search", "3_1", "--time-limit", "600", "--checkpoint", "kept")
    for _ in range(600):
        if (folder / "3_1.tight.txt").exists():
            break
        time.sleep(0.1)
    process.send_signal(signal.SIGINT)
    output, messages = process.communicate(timeout=60)
    assert process.returncode == 130
    assert "interrupted; the best of" in messages
    assert "--resume goes on from here" in messages
    assert rows(output)[0]["status"] == "stopped"
    assert "stopped" in (folder / "3_1.tight.txt").read_text()
    assert vertices(folder / "3_1.tight.txt")
    assert (folder / "kept/3_1.search.json").exists()


def test_a_time_limit_ends_well(folder: Path, sono: Sono) -> None:
    start = time.monotonic()
    result = sono("search", "3_1", "--time-limit", "4", "--minima", "1")
    assert time.monotonic() < start + 4 + PROMPT
    assert result.exit_code == 0
    assert rows(result.stdout)[0]["status"] == "tight"
    assert " s of 4 s\n" in (folder / "3_1.tight.txt").read_text()
    # Which is all that was asked for.
    again = sono("search", "3_1", "--time-limit", "4", "--minima", "1", "--resume")
    assert (again.exit_code, rows(again.stdout)[0]["l_a"]) == (0, rows(result.stdout)[0]["l_a"])
    assert time.monotonic() < start + 8 + PROMPT


@pytest.mark.parametrize("what", ["attempt", "refine", "finish"])
def test_a_time_limit_waits_for_nobody(
    folder: Path, sono: Sono, monkeypatch: pytest.MonkeyPatch, what: str
) -> None:
    free = threading.Event()
    make = getattr(trials, what)

    def hold(*arguments: object) -> object:
        assert free.wait(100)
        return make(*arguments)

    for module in (trials, search, hunt):
        if hasattr(module, what):
            monkeypatch.setattr(module, what, hold)
    start = time.monotonic()
    result = sono("search", "3_1", "--time-limit", "4", "--minima", "1", "--dl", "0.1")
    free.set()
    assert time.monotonic() < start + 4 + PROMPT
    assert result.exit_code == 1
    if what == "attempt":
        assert "the time limit of 4 s was reached before a trial ended" in result.stderr
        return
    row = rows(result.stdout)[0]
    assert measure(formats.read("3_1.tight.txt").components).l_a == row["l_a"]
    if what == "refine":
        assert "before a rope was refined; the best so far is in 3_1.tight.txt" in result.stderr
        assert row["status"] == "stopped"
    else:
        assert "its ropes did not come to edges of 0.1" in result.stderr
        assert row["status"] == "tight"


@pytest.mark.parametrize(
    ("knot", "dl"), [("unknot", "0.5"), ("3_1", "0.45"), ("3_1", "0.07"), ("Hopf", "0.5"), ("Hopf", "0.2")]
)
def test_a_finished_search_is_not_repeated(
    sono: Sono, monkeypatch: pytest.MonkeyPatch, knot: str, dl: str
) -> None:
    line = ("search", knot, "--trials", "2", "--dl", dl)
    first = sono(*line, "--checkpoint", "kept")
    assert first.exit_code == 0
    best = rows(first.stdout)[0]
    assert abs(float(best["dl"] or 0) - float(dl)) <= max(0.02, float(dl) / float(best["n"] or 1)) * float(dl)
    monkeypatch.setattr(search, "attempt", None)
    again = sono(*line, "--resume")
    assert again.exit_code == 0
    assert [rows(again.stdout)[0][key] for key in ("n", "l_a")] == [best[key] for key in ("n", "l_a")]


@pytest.mark.slow
def test_jobs_change_nothing(folder: Path, sono: Sono) -> None:
    line = ("search", "4_1", "3_1", "5_1", "--trials", "4", "--minima", "3")
    one, many = (sono(*line, "-j", jobs, "-o", f"{jobs}/") for jobs in ("1", "6"))
    assert one.exit_code == many.exit_code == 0
    keys = ("knot", "n", "l_a", "hits", "variant")
    found = [sorted([row[key] for key in keys] for row in rows(text.stdout)) for text in (one, many)]
    assert found[0] == found[1]
    for path in (folder / "1").iterdir():
        assert vertices(path) == vertices(folder / "6" / path.name)


def test_a_damaged_checkpoint_spoils_nothing(folder: Path, sono: Sono) -> None:
    line = ("search", "3_1", "4_1", *ONE, "--checkpoint", "kept", "--resume", "-o", "out/")
    sono(*line)
    path = folder / "kept/3_1.search.json"
    state = checkpoints.load(path, hunt.KIND)
    text = path.read_text()
    path.write_text(text.replace('"trials": 1', '"trials": 7'))
    result = sono(*line)
    assert result.exit_code == 1
    assert "sono: kept/3_1.search.json: is damaged; remove it" in result.stderr
    assert [row["knot"] for row in rows(result.stdout)] == ["4_1"]
    # One vertex is wrong, and nothing else tells of it.
    minimum = state["search"]["minima"][0]
    curve = unpacked(minimum["curve"])
    assert curve
    curve[0][5] *= 1.2
    minimum["curve"] = packed(curve)
    checkpoints.save(path, hunt.KIND, state)
    (folder / "out/3_1.tight.txt").unlink()
    result = sono("search", "3_1", "--trials", "2", "--checkpoint", "kept", "--resume", "-o", "out/")
    assert float(rows(result.stdout)[0]["l_a"] or 0) == pytest.approx(32.743, abs=1e-2)
    assert all(row["status"] != "tight" or float(row["l_a"] or 0) < 33 for row in rows(result.stdout))


def test_tighten_takes_names_too(folder: Path, sono: Sono) -> None:
    result = sono("tighten", "m3_1", "-n", "60", "--trials", "1", "--set", "anneal_sweeps=5000")
    assert result.exit_code == 0
    assert [row["knot"] for row in rows(result.stdout)] == ["m3_1"]
    assert starts.start("m3_1")


def test_a_finished_file_of_another_knot_or_edge_length_is_not_kept(folder: Path, sono: Sono) -> None:
    sono("search", "3_1", *ONE)
    finer = rows(sono("search", "3_1", *ONE, "--resume", "--dl", "0.1").stdout)
    measures = measure(formats.read("3_1.tight.txt").components)
    assert measures.n == finer[0]["n"]
    assert measures.dl == pytest.approx(0.1, rel=0.02)
    before = (folder / "3_1.tight.txt").read_text()
    other = sono("search", "4_1", *ONE, "-o", "3_1.tight.txt", "--resume")
    assert (other.exit_code, (folder / "3_1.tight.txt").read_text()) == (1, before)
    assert "3_1.tight.txt: is another knot than 4_1; move it away" in other.stderr


def test_a_knot_with_the_same_invariants_is_another_knot(folder: Path, sono: Sono) -> None:
    assert fingerprint(starts.start("8_8")) == fingerprint(starts.start("10_129"))
    assert sono("search", "8_8", *ONE, "--dl", "0.5", "-o", "one.txt").exit_code == 0
    before = (folder / "one.txt").read_text()
    other = sono("search", "10_129", *ONE, "--dl", "0.5", "-o", "one.txt", "--resume")
    assert (other.exit_code, len(other.stdout.splitlines())) == (1, 1)
    assert "one.txt: was found from another curve than 10_129; move it away" in other.stderr
    assert (folder / "one.txt").read_text() == before
    # A rope that somebody else made is only known by its invariants.
    (folder / "one.txt").write_text(vertices(folder / "one.txt"))
    assert sono("search", "8_8", *ONE, "--dl", "0.5", "-o", "one.txt", "--resume").exit_code == 0


@pytest.mark.slow
def test_a_resumed_search_takes_nothing_away(folder: Path, sono: Sono, spawn: Spawn) -> None:
    row = rows(sono("search", "3_1", "--trials", "2", "--dl", "0.1").stdout)[0]
    finished = (folder / "3_1.tight.txt").read_text()
    # Neither coarser edges nor a search that is stopped before it has refined a shape.
    coarser = sono("search", "3_1", *ONE, "--dl", "0.4", "--resume")
    assert (coarser.exit_code, rows(coarser.stdout)[0]["l_c"]) == (0, row["l_c"])
    assert (folder / "3_1.tight.txt").read_text() == finished
    process = spawn("search", "3_1", "--trials", "10000", "--resume", "--checkpoint", "kept")
    state = folder / "kept/3_1.search.json"
    for _ in range(600):
        if state.exists() and '"trials": 0' not in state.read_text():
            break
        time.sleep(0.1)
    process.send_signal(signal.SIGINT)
    output, messages = process.communicate(timeout=60)
    assert process.returncode == 130
    assert "trials is no better than what is in 3_1.tight.txt; --resume goes on from here" in messages
    assert rows(output)[0]["l_c"] == row["l_c"]
    assert (folder / "3_1.tight.txt").read_text() == finished


@pytest.fixture(scope="module")
def rope_of_6_1(tmp_path_factory: pytest.TempPathFactory) -> str:
    """The file of the shortest rope of 6_1, as a search of eight trials writes it."""
    path = tmp_path_factory.mktemp("searched") / "6_1.tight.txt"
    CliRunner().invoke(main, ["search", "6_1", "--trials", "8", "--minima", "1", "-o", str(path)])
    return path.read_text()


def search_again_by_the_braid(sono: Sono) -> list[tables.Row]:
    """Resume a search of 6_1 with another seed, but with variant 0 alone: the braid ends 1.6 % longer."""
    with pytest.MonkeyPatch.context() as patched:
        patched.setattr(search, "SEED_STRIDE", 0)
        return rows(sono("search", "6_1", "--trials", "1", "--seed", "1", "--resume").stdout)


@pytest.mark.slow
def test_what_a_stopped_search_left_is_not_replaced_by_a_longer_rope(
    folder: Path, sono: Sono, rope_of_6_1: str
) -> None:
    file = folder / "6_1.tight.txt"
    before = rope_of_6_1.replace("6_1: tight", "6_1: stopped")
    assert before != rope_of_6_1
    file.write_text(before)
    again = search_again_by_the_braid(sono)
    assert (file.read_text(), again[0]["l_a"]) == (before, measure(formats.read(str(file)).components).l_a)


@pytest.mark.slow
def test_a_better_rope_is_not_overwritten(folder: Path, sono: Sono, rope_of_6_1: str) -> None:
    file = folder / "6_1.tight.txt"
    file.write_text(rope_of_6_1)
    again = search_again_by_the_braid(sono)
    assert file.read_text() == rope_of_6_1
    assert again[0]["l_a"] == measure(formats.read(str(file)).components).l_a
    assert float(again[0]["l_a"] or 0) < 56.71
    assert float(again[1]["l_a"] or 0) > 57.5


def test_standard_output_gets_one_curve(folder: Path, sono: Sono) -> None:
    result = sono("search", "3_1", "--trials", "10", "-o", "-", "-q")
    (folder / "out.txt").write_text(result.stdout)
    assert measure(formats.read("out.txt").components).dl == pytest.approx(0.2, rel=0.02)


def test_what_nobody_expected_stays_with_its_knot(
    folder: Path, sono: Sono, monkeypatch: pytest.MonkeyPatch
) -> None:
    def broken(*_: object) -> None:
        raise RuntimeError("lost")

    monkeypatch.setattr("sono.jobs.hunt.finish", broken)
    result = sono("search", "3_1", "Hopf", *ONE, "--dl", "0.1")
    assert result.exit_code == 1
    assert result.stderr.count("unexpected RuntimeError: lost") == 2
    assert sorted(os.listdir()) == ["3_1.tight.txt", "3_1.txt", "Hopf.tight.txt", "Hopf.txt"]


def test_a_full_disk_under_the_checkpoint_loses_no_rope(
    folder: Path, sono: Sono, monkeypatch: pytest.MonkeyPatch
) -> None:
    write = formats.save

    def full(target: str, content: str) -> None:
        if target.endswith("search.json") and '"trials": 0' not in content:
            raise formats.FormatError(f"{target}: cannot be written: No space left on device")
        write(target, content)

    monkeypatch.setattr(formats, "save", full)
    result = sono("search", "3_1", *ONE, "--checkpoint", "kept")
    assert result.exit_code == 1
    assert "No space left on device" in result.stderr
    assert rows(result.stdout)[0]["status"] == "tight"
    assert (folder / "3_1.tight.txt").exists()


@pytest.mark.parametrize("times", [1, 100])
def test_a_full_disk_under_the_output_loses_no_row(
    folder: Path, sono: Sono, monkeypatch: pytest.MonkeyPatch, times: int
) -> None:
    write = formats.write
    failed: list[str] = []

    def full(target: str, *more: object) -> None:
        if len(failed) < times:
            failed.append(target)
            raise formats.FormatError(f"{target}: cannot be written: No space left on device")
        write(target, *more)  # type: ignore[arg-type]

    monkeypatch.setattr(formats, "write", full)
    result = sono("search", "3_1", "--trials", "2", "--minima", "1")
    assert rows(result.stdout)[0]["status"] == "tight"
    if times == 1:  # there was room again
        assert (result.exit_code, result.stderr) == (0, "")
        assert measure(formats.read("3_1.tight.txt").components).l_a == rows(result.stdout)[0]["l_a"]
    else:
        assert result.exit_code == 1
        assert result.stderr == "sono: 3_1.tight.txt: cannot be written: No space left on device\n"


def test_an_empty_shard_has_nothing_to_do(sono: Sono) -> None:
    result = sono("tighten", "3_1", "--shard", "2/2", "-o", "one.txt")
    assert result.exit_code == 0
    assert "fewer knots than shards" in result.stderr
