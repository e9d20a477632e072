"""The compiled module: that the stubs say what it has, and that the interpreter is free while it works."""

import json
import random
import subprocess
import sys
import threading
import time
from collections.abc import Iterator
from functools import reduce
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from sono import _core, starts

ENDLESS = json.dumps({"anneal_sweeps": 4_000_000_000})


@pytest.mark.slow
def test_stubs_match_the_module(tmp_path: Path) -> None:
    # What the rest of sono says, and numpy, is not compared, and mypy would be ten seconds over it.
    settings = tmp_path / "mypy.ini"
    settings.write_text(
        "[mypy]\n[mypy-sono,numpy.*]\nfollow_imports = skip\nfollow_imports_for_stubs = True\n"
    )
    more = ("--ignore-disjoint-bases", "--mypy-config-file", str(settings))
    command = [sys.executable, "-m", "mypy.stubtest", *more, "sono._core"]
    done = subprocess.run(command, cwd=tmp_path, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stdout + done.stderr


def tightener(settings: str = ENDLESS) -> _core.Tightener:
    return _core.Tightener(starts.start("3_1"), "anneal", 60, settings)


def test_other_threads_run_meanwhile() -> None:
    rope = tightener()
    advancing, done = threading.Event(), threading.Event()
    ticks = 0

    def tick() -> None:
        nonlocal ticks
        advancing.wait()
        while not done.is_set():
            time.sleep(0.001)
            ticks += 1

    thread = threading.Thread(target=tick)
    thread.start()
    advancing.set()
    status = rope.advance(0.5)
    meanwhile = ticks
    done.set()
    thread.join()
    assert status["outcome"] == "running"
    assert status["sweeps"] > 0
    # Were the interpreter held, one tick might slip in before the work and none during it.
    assert meanwhile > 3


def test_two_ropes_at_the_same_time_are_as_one_after_the_other() -> None:
    settings = json.dumps({"anneal_sweeps": 2000})
    ropes = [tightener(settings) for _ in range(3)]

    def work(rope: _core.Tightener) -> None:
        while rope.advance(0.01)["outcome"] == "running":
            pass

    threads = [threading.Thread(target=work, args=[rope]) for rope in ropes[1:]]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    work(ropes[0])
    assert ropes[0].state() == ropes[1].state() == ropes[2].state()


def test_state_is_all_there_is() -> None:
    rope = tightener()
    rope.advance(0.01)
    twin = _core.Tightener.restore(rope.state())
    assert twin.state() == rope.state()
    assert np.array_equal(twin.best()[0], rope.best()[0])
    assert twin.advance(0)["sweeps"] == rope.advance(0)["sweeps"]


@pytest.mark.parametrize("state", ["", "{}", "[1]", "null"])
def test_a_state_that_is_none(state: str) -> None:
    for engine in (_core.Collapse, _core.Tightener, _core.Polish):
        with pytest.raises(ValueError, match="not a state of an engine"):
            engine.restore(state)


def places(value: Any, path: tuple[Any, ...] = ()) -> Iterator[tuple[Any, ...]]:
    """Where the values in nested lists and dictionaries are."""
    if path:
        yield path
    for key, inner in value.items() if isinstance(value, dict) else enumerate(value):
        if isinstance(inner, dict | list):
            yield from places(inner, (*path, key))
        else:
            yield (*path, key)


def test_a_damaged_state_is_refused_or_goes_on() -> None:
    rope = starts.start("Hopf")
    engines = (_core.Collapse(rope, False, "{}"), tightener(), _core.Polish(rope, 96, False, 0))
    draw, refused = random.Random(7), 0
    for engine in engines:
        engine.advance(1e-3)
        whole = json.loads(engine.state())
        everywhere = list(places(whole))
        for _ in range(200):
            state = json.loads(json.dumps(whole))
            *path, last = draw.choice(everywhere if draw.random() < 0.5 else everywhere[:40])
            value = reduce(lambda value, key: value[key], path, state)
            new = draw.choice([0, -1, 1e9, 1e300, 2**31, 2**64 - 1, None, "x", [], value[last]])
            value[last] = new[1:] if isinstance(new, list) else new
            try:
                again = type(engine).restore(json.dumps(state))
            except ValueError:
                refused += 1
                continue
            for _ in range(3):
                again.advance(1e-3)
            assert len(again.best()) == len(rope) or engine is engines[1]
    assert refused > 200


@pytest.mark.parametrize("seconds", [-1.0, float("nan"), float("inf"), 1e300])
def test_a_time_that_is_none(seconds: float) -> None:
    with pytest.raises(ValueError, match="seconds"):
        tightener().advance(seconds)


def test_errors_hold_the_place() -> None:
    curve = [np.eye(3), np.array([[0, 0, 5.0], [1, 0, 5], [1, 0, 5]])]
    with pytest.raises(_core.CurveError) as caught:
        _core.measure(curve)
    assert str(caught.value).startswith("vertices 1 and 2 of component 1 coincide")
    assert caught.value.places == [(1, 1), (1, 2)]
    assert issubclass(_core.CurveError, ValueError)


def test_the_shape_must_be_right() -> None:
    with pytest.raises(ValueError, match=r"\(n, 3\)"):
        _core.measure([np.zeros((4, 2))])


def test_refine_gives_the_number_asked_for() -> None:
    fine = _core.refine(starts.start("Hopf"), 200)
    assert sum(map(len, fine)) == 200
    assert _core.measure(fine)["components"] == 2


def test_too_few_vertices_to_refine_to() -> None:
    hopf = starts.start("Hopf")
    for make in (
        lambda: _core.refine(hopf, 4),
        lambda: _core.Polish(hopf, 4, False, 0),
        lambda: _core.Tightener(hopf, "anneal", 4, "{}"),
    ):
        with pytest.raises(
            _core.CurveError, match=r"n = 4 is too small; 3 vertices for each .* make 6"
        ) as caught:
            make()
        assert caught.value.needed == 6
    assert [len(component) for component in _core.refine(hopf, 6)] == [3, 3]


def test_an_unknown_stage() -> None:
    with pytest.raises(ValueError, match="unknown stage 'setle'; the stages are: anneal, reanneal, settle"):
        _core.Tightener(starts.start("3_1"), "setle", 60, "{}")  # type: ignore[arg-type]
