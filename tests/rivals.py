"""Other programs' answers to what tests/beside.py gives, a line of JSON each; sono is not needed."""

import contextlib
import io
import json
import os
import sys
from collections.abc import Callable
from importlib import import_module, metadata
from pathlib import Path
from typing import Any

LEAST = 40
"""Crossings that a curve's diagram may have where a program wants to know."""


def topoly(given: Any, tell: Callable[..., None]) -> None:
    program = import_module("topoly")

    closed = program.params.Closure.CLOSED
    for kind, curves in given["curves"].items():
        for knot, curve in curves.items():
            tell(
                "name",
                kind,
                knot,
                lambda c=curve: f"±{program.homfly(c, closure=closed, max_cross=LEAST, run_parallel=False)}",
            )


def pyknotid(given: Any, tell: Callable[..., None]) -> None:
    import numpy as np

    knots = import_module("pyknotid.spacecurves")

    for knot, curve in given["curves"]["a tight rope"].items():
        made = knots.Knot(np.array(curve), verbose=False)
        tell("ACN", "a tight rope", knot, lambda made=made: made.average_crossing_number(samples=10))


def snappy(given: Any, tell: Callable[..., None]) -> None:
    program = import_module("snappy")

    for knot, code in given["diagrams"].items():
        tell(
            "name",
            "the PD code of a small diagram",
            knot,
            lambda code=code, knot=knot: named(program.Link(code), knot),
        )


def named(link: Any, knot: str) -> str:
    """Return the name, among those that SnapPy's census has of the complement, that is of a knot."""
    names = [manifold.name() for manifold in link.exterior().identify()]
    return f"±{knot}" if knot in names else " ".join(names)


def trimesh(given: Any, tell: Callable[..., None]) -> None:
    import numpy as np

    program, disks = import_module("trimesh"), import_module("shapely.geometry")

    for knot, curve in given["curves"]["a tight rope"].items():
        line = np.array([*curve, curve[0]])
        tell(
            "tube",
            "a tight rope",
            knot,
            lambda line=line: swept(program, disks.Point(0, 0).buffer(0.93), line),
        )


def swept(program: Any, disk: Any, line: Any) -> str:
    mesh = program.creation.sweep_polygon(disk, line)
    mesh.export(io.BytesIO(), "stl")
    return f"{len(mesh.faces)} triangles, {'' if mesh.is_watertight else 'not '}watertight"


def spent() -> float:
    """Return the core-seconds of this process and of those that it has begun and waited for."""
    return sum(os.times()[:4])


def main(path: str) -> None:
    given = json.loads(Path(path).read_text(encoding="utf-8"))
    for name in ("topoly", "pyknotid", "snappy", "trimesh"):
        try:
            who = f"{name} {metadata.version(name)}"
        except metadata.PackageNotFoundError:
            continue

        def tell(task: str, kind: str, knot: str, do: Callable[[], object], who: str = who) -> None:
            start = spent()
            with contextlib.redirect_stdout(io.StringIO()):
                found = do()
            seconds = spent() - start
            line = {
                "program": who,
                "task": task,
                "kind": kind,
                "knot": knot,
                "seconds": seconds,
                "found": found,
            }
            print(json.dumps(line), flush=True)

        globals()[name](given, tell)


if __name__ == "__main__":
    main(sys.argv[1])
