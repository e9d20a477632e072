"""Prompt stops: while a call takes long, at many vertices, by limits and by signals; the best is kept."""

import os
import signal
import subprocess
import sys
import threading
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from conftest import QUICK, Sono, Spawn

import sono as package
from sono import _core, formats, measure, starts
from sono.invariants import fingerprint
from sono.patience import patiently
from sono.starts.drawing import divided
from sono.tightening import Method, Progress, Run, Stopped, engines
from sono.tightening import run as pipeline
from sono.tightening.coarser import FINER
from sono.tightening.settings import MOST

PROMPT = 10
"""Seconds, five times what a stop may take on a machine with nothing else to do."""

posix = pytest.mark.skipif(os.name != "posix", reason="needs Unix signals")


def ring(n: int) -> list[np.ndarray]:
    """A rope of n vertices round an ellipse: loose, and far from tight."""
    t = 2 * np.pi * np.arange(n) / n
    return [np.column_stack([9 * np.cos(t), 3 * np.sin(t), 0.1 * np.sin(2 * t)])]


class Stop:
    """Raises `Stopped` once it is told to."""

    def __init__(self) -> None:
        self.now = False
        self.seen: list[Progress] = []

    def __call__(self, progress: Progress) -> None:
        self.seen.append(progress)
        if self.now:
            raise Stopped("enough")


def test_patience_gives_what_the_call_gives() -> None:
    looks: list[None] = []
    later = threading.Event()
    assert patiently(lambda: later.wait(0.5), lambda: looks.append(None)) is False
    assert looks
    with pytest.raises(ZeroDivisionError):
        patiently(lambda: 1 // 0)


def test_patience_ends() -> None:
    forever = threading.Event()

    def look() -> None:
        raise Stopped("enough")

    start = time.monotonic()
    with pytest.raises(Stopped, match="enough"):
        patiently(lambda: forever.wait(60), look)
    assert time.monotonic() < start + PROMPT
    forever.set()


@pytest.mark.parametrize("stage", ["collapse", "anneal", "trial", "climb", "polish"])
@pytest.mark.parametrize("what", ["begins", "goes on"])
def test_a_stop_while_the_core_is_busy(monkeypatch: pytest.MonkeyPatch, stage: str, what: str) -> None:
    """Whichever call takes too long, the best state is there; when it has ended, the run can be saved."""
    stop, free, stuck = Stop(), threading.Event(), threading.Event()
    run = Run(starts.start("3_1"), [300], {"anneal_sweeps": 5000}, trials=2)

    def hold(call: Callable[..., Any]) -> Callable[..., Any]:
        def held(*arguments: Any) -> Any:
            if run.plan.rung[0] == stage and run.plan.shapes:
                stop.now = True
                stuck.set()
                assert free.wait(60)
            return call(*arguments)

        return held

    if what == "begins":
        monkeypatch.setattr(Run, "_engine", hold(Run._engine))
    else:
        monkeypatch.setattr(pipeline, "advanced", hold(engines.advanced))
    start = time.monotonic()
    with pytest.raises(Stopped):
        run.tighten(stop)
    assert stuck.is_set()
    best = run.best()
    assert time.monotonic() < start + PROMPT
    assert not best.converged
    assert best.measures.l_p < 33
    assert best.forces is None
    assert run.at_rest == (what == "begins")
    free.set()
    while not run.at_rest:
        time.sleep(0.01)
    monkeypatch.undo()
    again = Run.restore(run.state()).tighten()
    whole = Run(starts.start("3_1"), [300], {"anneal_sweeps": 5000}, trials=2).tighten()
    assert all(map(np.array_equal, again.curve, whole.curve))


def test_what_is_stopped_at_once_is_not_much_finer_than_what_was_asked_for() -> None:
    run = Run(ring(5000), [60], {})
    run.type = fingerprint(run.plan.curve)
    best = run.best()
    assert best.measures.n <= FINER * 60
    assert best.measures.r_s == pytest.approx(1)
    trefoil = _core.refine(package.tighten(starts.start("3_1"), 60, trials=1).curve, 3000)
    tight = Run(trefoil, [100], {}).best()
    assert tight.measures.n == 100
    assert tight.measures.l_p < 33
    assert fingerprint(tight.curve) == fingerprint(trefoil)
    # A long thin rope cannot have few beads: few long edges are left of it.
    stalk = [(0, 0), (1e5, 0), (1e5, -1), (1e5 + 1, 0.5), (1e5, 1), (0, 0.1)]
    thin = [divided(np.array([[x, y, 0.0] for x, y in stalk]), 100)]
    assert Run(thin, [30], {}).best().measures.n <= 120


@pytest.mark.parametrize("n", [15_360, 60_000])
@pytest.mark.parametrize("method", ["polish", "sono"])
def test_a_time_limit_at_many_vertices(n: int, method: Method) -> None:
    start = time.monotonic()
    tight = package.tighten(ring(n), n, method=method, time_limit=1)
    assert time.monotonic() < start + 1 + PROMPT
    assert not tight.converged
    assert measure(tight.curve).l_p == tight.measures.l_p


@posix
@pytest.mark.parametrize(("number", "code"), [(signal.SIGTERM, 143), (signal.SIGHUP, 129)])
def test_a_signal_at_many_vertices(folder: Path, spawn: Spawn, number: signal.Signals, code: int) -> None:
    formats.write("ring.txt", ring(15_360))
    process = spawn("tighten", "ring.txt", "-n", "15360", "--method", "polish", "--checkpoint", "kept")
    while not (folder / "kept/ring.checkpoint.json").exists():
        time.sleep(0.01)
    time.sleep(1)
    start = time.monotonic()
    process.send_signal(number)
    output, messages = process.communicate()
    assert time.monotonic() < start + PROMPT
    assert process.returncode == code
    assert "interrupted; the best state so far, n = 15360, is in ring.n15360.best.txt" in messages
    assert output.splitlines()[1].endswith("\tstopped")
    assert measure(formats.read("ring.n15360.best.txt").components).n == 15_360


DEAF = """
import time
from sono import patience
from sono.tightening import run as pipeline
from sono.cli import run
patience.GRACE = 100
pipeline.advanced = lambda worker: time.sleep(100)
run()
"""


@posix
def test_a_second_signal_ends_at_once(folder: Path) -> None:
    command = [sys.executable, "-c", DEAF, "tighten", "3_1.txt", "-n", "60", "--checkpoint", "kept"]
    with subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE) as process:
        while not (folder / "kept/3_1.checkpoint.json").exists():
            time.sleep(0.01)
        time.sleep(0.5)
        process.send_signal(signal.SIGTERM)
        process.send_signal(signal.SIGTERM)  # as wrappers do, at the same time
        time.sleep(0.7)
        assert process.poll() is None
        process.send_signal(signal.SIGTERM)
        assert process.wait(PROMPT) == 143


def test_impossible_numbers_are_refused(sono: Sono) -> None:
    for n in (MOST + 1, 10**9, 10**26):
        with pytest.raises(ValueError, match=f"n = {n} is too large; 500,000 vertices are the most"):
            package.tighten(starts.start("3_1"), n)
        result = sono("tighten", "3_1.txt", "-n", f"60,{n}", *QUICK)
        assert (result.exit_code, result.stdout) == (2, "")
        assert "500,000 vertices are the most" in result.stderr
