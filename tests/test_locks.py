"""Two processes never write one file: claims are exclusive, and vanish with the process."""

import errno
import os
import re
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest
from conftest import QUICK, Sono, Spawn

from sono import formats, starts
from sono.jobs import locks
from sono.jobs.locks import NAME, Claims, Taken

posix = pytest.mark.skipif(os.name != "posix", reason="needs Unix signals")

HOLDER = """
import sys, time
from sono.jobs.locks import Claims
with Claims() as claims:
    claims.take(sys.argv[1:])
    print("held", flush=True)
    sys.stdin.read()
"""

RIVAL = """
import os, random, sys, time
from sono.jobs.locks import Claims, Taken
won = 0
while won < 40:
    try:
        with Claims() as claims:
            claims.take(["a/one"])
            descriptor = os.open("busy", os.O_CREAT | os.O_EXCL)  # fails if another one is here too
            time.sleep(random.random() / 1000)
            os.close(descriptor)
            os.unlink("busy")
            won += 1
    except Taken:
        pass
"""


def holder(*paths: str) -> "subprocess.Popen[str]":
    """A process that has claimed these files."""
    process = subprocess.Popen(
        [sys.executable, "-c", HOLDER, *paths], stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True
    )
    assert process.stdout
    assert process.stdout.readline() == "held\n"
    return process


def test_a_name_is_claimed_once(folder: Path) -> None:
    (folder / "a").mkdir()
    (folder / "link").symlink_to("a")
    with holder("a/one", "two") as process, Claims() as claims:
        claims.take(["a/two", "one"])
        for path in ("a/one", "link/one", os.path.abspath("two")):
            with pytest.raises(Taken) as caught:
                claims.take(["three", path])
            assert caught.value.path == path
        process.kill()
        process.wait()
        claims.take(["a/one", "two"])  # nothing of the dead process is left
        claims.take(["a/one", "two"])  # and what is claimed stays so
    assert not list(folder.rglob(NAME))


def test_a_claim_outlives_those_of_others(folder: Path) -> None:
    with holder("one") as process:
        with Claims() as claims:
            claims.take(["two"])
        assert (folder / NAME).exists()
        with Claims() as claims, pytest.raises(Taken):
            claims.take(["one"])
        process.communicate("")
    assert not (folder / NAME).exists()


def test_rivals_exclude_each_other(folder: Path) -> None:
    (folder / "a").mkdir()
    rivals = [subprocess.Popen([sys.executable, "-c", RIVAL]) for _ in range(4)]
    assert [rival.wait() for rival in rivals] == [0, 0, 0, 0]
    assert not list(folder.rglob(NAME))


@posix
def test_the_second_process_is_refused(folder: Path, sono: Sono, spawn: Spawn) -> None:
    first = spawn("tighten", "3_1.txt", "-n", "60,50000", *QUICK, "--checkpoint", "saved")
    assert first.stdout
    for _ in range(2):
        first.stdout.readline()
    for more in ((), ("--force",), ("--resume", "--checkpoint", "saved")):
        second = sono("tighten", "3_1.txt", "-n", "50000", *QUICK, *more)
        assert (second.exit_code, second.stdout) == (2, "")
        assert "3_1.n50000.txt: another sono is about to write it" in second.stderr
    # Other files in the same folder are free: so shards of one list share it.
    assert sono("tighten", "Hopf.txt", "-n", "60", *QUICK).exit_code == 0
    first.send_signal(signal.SIGKILL)
    first.wait()
    assert sono("tighten", "3_1.txt", "-n", "60", *QUICK, "--force").exit_code == 0
    assert not (folder / NAME).exists()


@posix
def test_two_updates_of_an_atlas(folder: Path, sono: Sono, spawn: Spawn) -> None:
    first = spawn("atlas", "--update", "--folder", "kept", "--trials", "100000", "10_165")
    while not (folder / "atlas-search" / "10_165.s0.json").exists():
        time.sleep(0.05)
    second = sono("atlas", "--update", "--folder", "kept", "--checkpoint", "elsewhere", "3_1")
    assert second.exit_code == 2
    assert "knots.tsv: another sono is about to write it" in second.stderr
    first.send_signal(signal.SIGKILL)


def test_pipes_at_the_same_time_take_names_of_their_own(folder: Path, spawn: Spawn) -> None:
    knot = (folder / "3_1.txt").read_text()
    processes = [spawn("tighten", "-", "-n", "60", *QUICK, stdin=subprocess.PIPE) for _ in range(3)]
    outputs = [process.communicate(knot) for process in processes]
    assert [process.returncode for process in processes] == [0, 0, 0], outputs
    assert sorted(path.name for path in folder.glob("stdin*")) == [
        "stdin-2.n60.txt",
        "stdin-3.n60.txt",
        "stdin.n60.txt",
    ]


def test_a_file_system_without_locks(folder: Path, sono: Sono, monkeypatch: pytest.MonkeyPatch) -> None:
    def refuse(*_: object) -> None:
        raise OSError(errno.ENOLCK, os.strerror(errno.ENOLCK))

    monkeypatch.setattr(locks, "_lock_byte", refuse)
    result = sono("tighten", "3_1.txt", "-n", "60", *QUICK)
    assert result.exit_code == 0
    assert result.stderr == (
        "sono: .: nothing can be locked here (No locks available); let no other sono write here meanwhile\n"
    )


LONG = "k" * 250


@posix
@pytest.mark.parametrize(
    ("arguments", "path"),
    [
        (["tighten", "3_1", "-n", "60", "-o", f"{LONG}kkkk.txt"], f"{LONG}kkkk.txt"),
        # Its unfinished rope would not fit in.
        (["tighten", "3_1", "-n", "60", "-o", f"o{LONG[1:]}.txt"], f"o{LONG[1:]}.best.txt"),
        (["tighten", f"{LONG}.txt", "-n", "60"], f"{LONG}.n60.txt"),
        (["tighten", f"{LONG}.txt", "-n", "60", "-o", "tight.txt", "--checkpoint", "."], "checkpoint.json"),
        (["tighten", "3_1", "-n", "60", "--contacts", f"{LONG}kk.tsv"], f"{LONG}kk.tsv"),
        (["search", f"{LONG}.txt", "--trials", "1"], f"{LONG}.tight.txt"),
        (["tighten", "3_1", "-n", "60", "--force"], "3_1.n60.txt"),
        (["tighten", "3_1", "-n", "60", "--resume", "-o", "there/"], "there/3_1.n60.txt"),
        (["search", "3_1", "--force"], "3_1.tight.txt"),
        (["tighten", "3_1", "-n", "60", "-o", "Hopf.txt/rope.txt"], "Hopf.txt"),
    ],
    ids=lambda value: value if isinstance(value, str) else " ".join(value),
)
def test_names_are_tried_before_anything_is_computed(
    folder: Path, sono: Sono, arguments: list[str], path: str
) -> None:
    formats.write(f"{LONG}.txt", starts.start("3_1"))
    for taken in ("3_1.n60.txt", "there/3_1.n60.txt", "3_1.tight.txt"):
        if "--contacts" not in arguments:
            (folder / taken).mkdir(parents=True)
    before = {path for path in folder.rglob("*") if path.name != NAME}
    result = sono(*arguments)
    assert (result.exit_code, result.stdout) == (2, "")
    assert f"{path}: cannot be " in result.stderr.replace("\n", "")
    assert set(folder.rglob("*")) == before


@posix
def test_a_long_name_that_fits(folder: Path, sono: Sono) -> None:
    name = "k" * 246 + ".txt"
    assert sono("tighten", "3_1", "-n", "60", *QUICK, "-o", name).exit_code == 0
    assert len(formats.read(name).components[0]) == 60


@posix
def test_a_name_that_is_tried_is_never_there(
    folder: Path, sono: Sono, monkeypatch: pytest.MonkeyPatch
) -> None:
    """What is killed while it tries names leaves no empty file that --resume would take for a rope."""
    made: list[str] = []
    create = os.open

    def spy(path: str | Path, flags: int, mode: int = 0o777) -> int:
        if flags & os.O_CREAT:
            made.append(os.path.basename(path))
        return create(path, flags, mode)

    monkeypatch.setattr(os, "open", spy)
    options = ("--contacts", "forces/", "--checkpoint", "kept", "-o", "out/")
    assert sono("tighten", "3_1.txt", "Hopf.txt", "-n", "60", *QUICK, *options).exit_code == 0
    assert made
    assert all(name == NAME or re.fullmatch(r"\.sono-\w+\.part", name) for name in made)


@posix
@pytest.mark.parametrize("output", ["gone/rope.txt", "link.txt"])
def test_a_link_into_nowhere_is_told_first(folder: Path, sono: Sono, output: str) -> None:
    (folder / "link.txt").symlink_to("nowhere/rope.txt")
    (folder / "gone").symlink_to("nowhere")
    result = sono("tighten", "3_1.txt", "-n", "60", *QUICK, "-o", output)
    assert (result.exit_code, result.stdout) == (2, "")
    assert "cannot be " in result.stderr
