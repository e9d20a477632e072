"""Sono beside other programs, which run in another Python: each is given the same curves and diagrams."""

import json
import subprocess
import tempfile
import time
from collections.abc import Callable, Iterable, Iterator
from functools import partial
from pathlib import Path
from statistics import median
from typing import Any

import sono

KNOTS = ("3_1", "4_1", "5_2", "6_3", "7_7", "8_18", "8_19", "9_42", "10_124", "10_165")

Answers = list[dict[str, Any]]


def tables(python: str) -> dict[str, Callable[[], Iterable[list[str]]]]:
    """Give the tables, for which all programs are run now."""
    curves = {knot: sono.start(knot, known=True)[0] for knot in KNOTS}
    given = {"a tight rope": curves}
    diagrams = {knot: sono.identify(curve).pd for knot, curve in curves.items()}
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder, "given.json")
        lists = {kind: {knot: c.tolist() for knot, c in some.items()} for kind, some in given.items()}
        path.write_text(json.dumps({"curves": lists, "diagrams": diagrams}))
        script = Path(__file__).parent / "rivals.py"
        done = subprocess.run([python, script, path], capture_output=True, text=True, check=True)
    lines = [
        line for line in done.stdout.splitlines() if line.startswith("{")
    ]  # some print what nobody asked
    answers = [*map(json.loads, lines), *ours(given)]
    tasks = {"names": "name", "crossing-numbers": "ACN", "tubes": "tube"}
    return {table: partial(rows, task, answers) for table, task in tasks.items()}


def ours(given: dict[str, dict[str, Any]]) -> Iterator[dict[str, Any]]:
    """Give sono's answers."""
    for kind, curves in given.items():
        for knot, curve in curves.items():
            yield answer("name", kind, knot, partial(name, curve))
    with tempfile.TemporaryDirectory() as folder:
        for knot, curve in given["a tight rope"].items():
            yield answer("ACN", "a tight rope", knot, partial(crossings, curve))
            yield answer("tube", "a tight rope", knot, partial(tube, str(Path(folder, "rope.stl")), curve))


def name(curve: Any) -> str | None:
    return sono.identify(curve).name


def crossings(curve: Any) -> float:
    return sono.descriptors(curve).acn


def tube(path: str, curve: Any) -> str:
    """Write a solid, and tell how many triangles it has."""
    return f"{sono.export(path, curve).triangles} triangles, watertight"


def answer(task: str, kind: str, knot: str, do: Callable[[], object]) -> dict[str, Any]:
    start = time.process_time()
    found = do()
    seconds = time.process_time() - start
    who = f"sono {sono.__version__}"
    return {"program": who, "task": task, "kind": kind, "knot": knot, "seconds": seconds, "found": found}


def rows(task: str, answers: Answers) -> Iterator[list[str]]:
    """Give a row for each program and kind of curve: the median of its core-seconds, and what it found."""
    yield ["program", "given", "core-seconds, median", "most", "found"]
    for program in dict.fromkeys(one["program"] for one in answers if one["task"] == task):
        for kind in dict.fromkeys(one["kind"] for one in answers):
            some = [a for a in answers if (a["program"], a["task"], a["kind"]) == (program, task, kind)]
            if some:
                seconds = [one["seconds"] for one in some]
                yield [program, kind, f"{median(seconds):.3f}", f"{max(seconds):.2f}", summary(task, some)]


def summary(task: str, some: Answers) -> str:
    """Tell how good the answers are."""
    if task == "name":
        right = sum(one["found"] == one["knot"] for one in some)
        almost = sum(one["found"] in (f"m{one['knot']}", f"±{one['knot']}") for one in some)
        return f"{right} of {len(some)} by name and hand" + (f", {almost} by name" if almost else "")
    if task == "ACN":
        return f"{max(abs(a['found'] - exact(a['knot'])) / exact(a['knot']) for a in some):.0e} off at most"
    return str(some[-1]["found"])


def exact(knot: str) -> float:
    """Return the average crossing number of the atlas's rope."""
    return crossings(sono.start(knot, known=True))
