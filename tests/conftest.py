"""What the tests of the command line share: `sono` in this process, and `sono` as a process of its own."""

import os
import random
import signal
import subprocess
import sys
import time
from collections.abc import Callable, Iterable, Iterator, Sequence
from pathlib import Path
from typing import Any, TypeAlias, TypeVar

import pytest
from click.testing import CliRunner, Result
from hypothesis import settings

from sono import formats, starts
from sono.cli import main
from sono.tightening import engines

Sono: TypeAlias = Callable[..., Result]
T = TypeVar("T")

Spawn: TypeAlias = Callable[..., subprocess.Popen[str]]

settings.register_profile("unhurried", settings(), deadline=None)  # no test is about speed
settings.load_profile("unhurried")

QUICK = ("--trials", "1", "--set", "anneal_sweeps=5000")
"""Options with which 60 beads of a trefoil are tight in a few hundredths of a second."""


def pytest_xdist_auto_num_workers() -> int:
    """Work on one test more than there are cores, as some wait for a signal, a browser or a clock."""
    return (os.cpu_count() or 1) + 1


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """An empty folder to work in, but for two starting conformations."""
    monkeypatch.chdir(tmp_path)
    for name in ("3_1", "Hopf"):
        formats.write(tmp_path / f"{name}.txt", starts.start(name))
    return tmp_path


@pytest.fixture
def sono(folder: Path) -> Sono:
    """Run `sono ARGUMENT...` in the folder; what it does not expect fails the test."""

    def run(*arguments: str, input: str | None = None) -> Result:
        return CliRunner().invoke(main, arguments, input=input, catch_exceptions=False)

    return run


@pytest.fixture
def slices(monkeypatch: pytest.MonkeyPatch) -> None:
    """Cut runs into slices so short that each stage has several."""
    monkeypatch.setattr(engines, "SLICE", 1e-4)


@pytest.fixture
def spawn(folder: Path) -> Iterator[Spawn]:
    """Start `sono ARGUMENT...` as a process in the folder, with its output in pipes."""
    processes = []

    def start(
        *arguments: str, limit: Callable[[], None] = lambda: None, **more: Any
    ) -> subprocess.Popen[str]:
        def prepare() -> None:
            # Background jobs of a shell ignore Ctrl-C, those of nohup SIGHUP, and so would their children.
            for number in (signal.SIGINT, signal.SIGTERM, signal.SIGHUP):
                signal.signal(number, signal.SIG_DFL)
            limit()

        pipes = {"stdin": subprocess.DEVNULL, "stdout": subprocess.PIPE, "stderr": subprocess.PIPE}
        process = subprocess.Popen(
            [sys.executable, "-c", "from sono.cli import run; run()", *arguments],
            text=True,
            preexec_fn=prepare if os.name == "posix" else None,
            **(pipes | more),
        )
        processes.append(process)
        return process

    yield start
    for process in processes:
        process.kill()
        with process:  # closes its pipes
            pass


def vertices(path: Path) -> str:
    """The rows of a file, without its comments."""
    return "".join(row for row in path.read_text().splitlines(True) if not row.startswith("#"))


def a_tenth(names: Iterable[str]) -> list[str]:
    """A tenth of names, another one each time, but the same in all workers of one run."""
    every = sorted(names)
    return some(every, -(-len(every) // 10))


def some(every: Sequence[T], many: int) -> list[T]:
    """So many of them, other ones each time, but the same in all workers of one run."""
    one_run = os.environ.get("PYTEST_XDIST_TESTRUNUID", str(time.time_ns()))
    return random.Random(one_run).sample(every, many)
