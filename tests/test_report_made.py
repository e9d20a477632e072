"""A report that was stopped goes on: what is made is not made again, unless something of it has changed."""

import json
import os
import signal
import time
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import pytest
from conftest import Sono, Spawn
from test_report import rows, wait_for

import sono as package
from sono import starts
from sono.figures.report import ropes
from sono.formats import write

NAMES = ("3_1", "4_1", "5_1", "Hopf")

MADE = "made.jsonl"

PROMPT = 10
"""Seconds, five times what a stop may take on a machine with nothing else to do."""

Written = list[str]


@pytest.fixture
def written(monkeypatch: pytest.MonkeyPatch) -> Written:
    """The names of the ropes that are made."""
    names: Written = []
    made = ropes.written

    def noted(site: Path, at: str, name: str, *more: Any) -> ropes.Rope:
        names.append(name)
        return made(site, at, name, *more)

    monkeypatch.setattr(ropes, "written", noted)
    return names


@pytest.fixture
def stopped_at(monkeypatch: pytest.MonkeyPatch) -> Iterator[Callable[[str], None]]:
    """Have Ctrl-C come when it is the turn of a rope, once."""
    before = signal.getsignal(signal.SIGINT)

    def stop(turn: str) -> None:
        made = ropes.written

        def stopping(site: Path, at: str, name: str, *more: Any) -> ropes.Rope:
            if name == turn:
                monkeypatch.setattr(ropes, "written", made)
                raise KeyboardInterrupt
            return made(site, at, name, *more)

        monkeypatch.setattr(ropes, "written", stopping)

    yield stop
    signal.signal(signal.SIGINT, before)


def lines(site: Path) -> list[str]:
    return [line for line in (site / MADE).read_text().splitlines() if line]


def contents(site: Path) -> dict[Path, bytes]:
    return {path.relative_to(site): path.read_bytes() for path in site.rglob("*") if path.is_file()}


@pytest.mark.parametrize("made", [0, 1, 3])
def test_after_ctrl_c_only_the_others_are_made(
    made: int, sono: Sono, folder: Path, written: Written, stopped_at: Callable[[str], None]
) -> None:
    whole = ("report", *NAMES, "--title", "t")
    sono(*whole, "-o", "other")
    written.clear()
    stopped_at(NAMES[made])
    done = sono(*whole, "-o", "site")
    assert done.exit_code == 130
    assert done.stderr == "sono: site: is not finished; the same command goes on from what is made\n"
    assert not (folder / "site" / "index.html").exists()
    assert written == [*NAMES[:made]]
    assert sono(*whole, "-o", "site").exit_code == 0
    assert written == [*NAMES]
    assert contents(folder / "site") == contents(folder / "other")


def test_a_finished_report_asks_and_makes_what_is_new(sono: Sono, folder: Path, written: Written) -> None:
    sono("report", "3_1", "4_1", "-o", "site")
    assert sono("report", "3_1", "5_1", "4_1", "-o", "site").exit_code == 2
    assert sono("report", "3_1", "5_1", "4_1", "-o", "site", "--force").exit_code == 0
    assert written == ["3_1", "4_1", "5_1"]
    assert list(rows(folder / "site")) == ["3_1", "5_1", "4_1"]


def test_doubts_are_told_again(sono: Sono, folder: Path, written: Written) -> None:
    write(folder / "4_1.n100.txt", starts.start("5_1"))
    first, again = (sono("report", "4_1.n100.txt", "-o", "site", "--force").stderr for _ in range(2))
    assert "is no 4_1 but 5_1" in first
    assert first == again
    assert written == ["4_1.n100"]


def another_vertex(folder: Path) -> None:
    text = (folder / "mine.txt").read_text()
    last = text.splitlines()[-1]
    (folder / "mine.txt").write_text(
        text.replace(last, " ".join(str(1.001 * float(x)) for x in last.split()))
    )


def another_header(folder: Path) -> None:
    (folder / "mine.txt").write_text(f"# another header\n{(folder / 'mine.txt').read_text()}")


def another_file_there(folder: Path) -> None:
    (folder / "site" / "others" / "mine.txt").write_text("0 0 0\n")


def a_file_less(folder: Path) -> None:
    (folder / "site" / "others" / "mine.certificate.json").unlink()


def page_cut_off(folder: Path) -> None:
    path = folder / "site" / "others" / "mine.js"
    os.truncate(path, path.stat().st_size - 1)


def another_figure(folder: Path) -> None:
    path = folder / "site" / MADE
    path.write_text(path.read_text().replace('"l_p": ', '"l_p": 1', 1))


@pytest.mark.parametrize(
    "change", [another_vertex, another_header, another_file_there, a_file_less, page_cut_off, another_figure]
)
def test_what_has_changed_is_made_anew(
    change: Callable[[Path], None], sono: Sono, folder: Path, written: Written
) -> None:
    write(folder / "mine.txt", package.start("3_1", known=True))
    command = ("report", "mine.txt", "Hopf", "-o", "site", "--force")
    sono(*command)
    change(folder)
    assert sono(*command).exit_code == 0
    assert written[:3] == ["mine", "Hopf", "mine"]
    assert (
        sono("report", "mine.txt", "Hopf", "-o", "other", "--title", "Ropes: mine.txt, Hopf").exit_code == 0
    )
    assert contents(folder / "site") == contents(folder / "other")


def test_another_version_makes_all_anew(
    sono: Sono, written: Written, monkeypatch: pytest.MonkeyPatch
) -> None:
    sono("report", "3_1", "-o", "site")
    monkeypatch.setattr(package, "__version__", "99.0")
    sono("report", "3_1", "-o", "site", "--force")
    assert written == ["3_1", "3_1"]


def test_two_ropes_that_take_turns_at_one_place(sono: Sono, folder: Path, written: Written) -> None:
    for given in ("3_1", "3_1.txt", "3_1"):
        sono("report", given, "-o", "site", "--force")
        assert rows(folder / "site")["3_1"]["l_p"] < (50 if given == "3_1" else 1e9)
    assert written == ["3_1", "3_1", "3_1"]


@pytest.mark.parametrize(
    "line", [b"", b"\xff\x00", b"{", b"[]", b"7", b'{"key": "a"}', b'{"rope": 1}', b'{"rope": {"row": {}}}',
             b'{"key": [], "crc": null, "rope": {"row": {"at": 7}, "beside": 1, "doubts": 2}}', b"[" * 99_999]
)  # fmt: skip
def test_damaged_lines_are_left_out(line: bytes, sono: Sono, folder: Path, written: Written) -> None:
    sono("report", "3_1", "4_1", "-o", "site", "--title", "t")
    path, before = folder / "site" / MADE, contents(folder / "site")
    one, _ = path.read_bytes().splitlines()
    path.write_bytes(b"\n".join([line, one, line]))
    assert sono("report", "3_1", "4_1", "-o", "site", "--force", "--title", "t").exit_code == 0
    assert written == ["3_1", "4_1", "4_1"]
    assert contents(folder / "site") == before


def test_a_line_that_was_cut_off(
    sono: Sono, folder: Path, written: Written, stopped_at: Callable[[str], None]
) -> None:
    stopped_at("5_1")
    command = ("report", "3_1", "4_1", "5_1", "Hopf", "-o", "site")
    sono(*command)
    os.truncate(folder / "site" / MADE, (folder / "site" / MADE).stat().st_size - 9)
    stopped_at("Hopf")
    assert sono(*command).exit_code == 130  # and the line of 4_1 is there again, on a line of its own
    assert sono(*command).exit_code == 0
    assert written == ["3_1", "4_1", "4_1", "5_1", "Hopf"]


def test_what_is_made_cannot_be_written_down(sono: Sono, folder: Path) -> None:
    (folder / "site" / MADE).mkdir(parents=True)
    done = sono("report", "3_1", "-o", "site")
    assert done.exit_code == 1
    assert f"{MADE}: cannot be written" in done.stderr


@pytest.mark.slow
@pytest.mark.skipif(os.name != "posix", reason="needs Unix signals")
@pytest.mark.parametrize(
    ("jobs", "number"),
    [("1", signal.SIGINT), ("1", signal.SIGKILL), ("2", signal.SIGINT), ("2", signal.SIGTERM)],
)
def test_signals(jobs: str, number: int, spawn: Spawn, sono: Sono, folder: Path, written: Written) -> None:
    command = ("report", "composites", "-o", "site", "-j")
    process = spawn(*command, jobs)
    wait_for(lambda: (folder / "site" / MADE).exists() and len(lines(folder / "site")) >= 3)
    begun = time.monotonic()
    process.send_signal(number)
    _, said = process.communicate()
    assert time.monotonic() < begun + PROMPT
    assert process.returncode == (130 if number == signal.SIGINT else -number)
    assert ("the same command goes on" in said) == (number == signal.SIGINT)
    made = {json.loads(line)["rope"]["row"]["knot"] for line in lines(folder / "site")}
    assert not (folder / "site" / "index.html").exists()
    assert sono(*command, "1").exit_code == 0
    found = list(rows(folder / "site"))
    assert len(found) > len(made) >= 3
    assert sorted([*written, *made]) == sorted(found)
