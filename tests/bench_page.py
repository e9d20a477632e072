"""The tables of docs/speed.md, each between two comments that name it; the prose around them is by hand."""

import platform
import re
import resource
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable, Iterable, Iterator
from datetime import date
from pathlib import Path

import bench
import beside

import sono

PAGE = Path(__file__).parent.parent / "docs" / "speed.md"

COMMANDS = (
    "--help",
    "start 8_18",
    "tighten 8_18 -n 480 -o rope.txt",
    "tighten 3_1 -n 480 --start drawn -o trefoil.txt",
    "measure rope.txt",
    "measure --all --residual rope.txt",
    "identify rope.txt",
    "verify rope.txt 8_18",
    "certify rope.txt",
    "certify --sharp rope.txt",
    "convert rope.txt rope.obj",
    "export rope.txt -o rope.3mf",
    "view rope.txt -o rope.html",
    "plot knot rope.txt -o rope.png",
)

SEARCHED = ("3_1", "4_1", "6_1", "8_4", "8_18")

TRIALS = 4


def commands() -> Iterator[bench.Row]:
    """Run each command of a rope, and tell the core-seconds of its process."""
    yield ["command", "core-seconds"]
    with tempfile.TemporaryDirectory() as folder:
        for line in COMMANDS:
            yield [f"`sono {line}`", f"{_spent(line, folder):.2f}"]


def _spent(line: str, folder: str) -> float:
    program = [sys.executable, "-c", "from sono.cli import run; run()", *line.split()]
    force = (
        [] if line.startswith(("--", "measure", "identify", "verify", "certify", "start")) else ["--force"]
    )
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    subprocess.run(
        [*program, *force], cwd=folder, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, check=True
    )
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    return after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime


def searches() -> Iterator[bench.Row]:
    """Search for the shortest rope of some knots from nothing, by so many trials."""
    yield ["knot", "trials", "core-seconds", "L_a", "published"]
    for knot in SEARCHED:
        start = time.process_time()
        best = sono.search(knot, TRIALS)[0]
        seconds = time.process_time() - start
        published = sono.compare(best, knot).published
        yield [knot, str(TRIALS), f"{seconds:.1f}", f"{best.length:.4f}", f"{published:.4f}"]


def machine() -> Iterator[bench.Row]:
    """Tell what all this was measured on, and when."""
    from sono import _core

    yield ["what", "which"]
    yield ["measured on", date.today().isoformat()]
    yield ["sono", sono.__version__]
    yield ["processor", _processor()]
    yield ["core", " ".join(_core.about()[1:3])]
    yield ["Python", platform.python_version()]


def _processor() -> str:
    try:
        lines = Path("/proc/cpuinfo").read_text(encoding="utf-8")
    except OSError:
        return platform.processor()
    found = {
        key: re.search(rf"^{key}\s*: (.*)$", lines, re.MULTILINE)
        for key in ("model name", "cpu family", "model")
    }
    named = {key: match[1] for key, match in found.items() if match}
    numbers = f"family {named.get('cpu family', '?')}, model {named.get('model', '?')}"
    return f"{named.get('model name', platform.processor())} ({numbers})"


TABLES: dict[str, Callable[[], Iterable[bench.Row]]] = {
    "machine": machine,
    "race": bench.race,
    "polish": bench.levels,
    "sweeps": bench.sweeps,
    "commands": commands,
    "searches": searches,
}


def markdown(rows: Iterable[bench.Row]) -> str:
    """Write a table whose first row is its head."""
    head, *body = [f"| {' | '.join(row)} |" for row in rows]
    return "\n".join([head, "|" + "---|" * (head.count(" | ") + 1), *body])


def filled(page: str, name: str, table: str) -> str:
    """Put a table where the page has the one of this name. Raises `ValueError` if it has none."""
    begin, end = f"<!-- {name}: made by tests.bench -->\n", f"\n<!-- end of {name} -->"
    before, found, rest = page.partition(begin)
    if not found or end not in rest:
        raise ValueError(f"{PAGE.name}: has no place for the table {name}")
    return before + begin + table + end + rest.partition(end)[2]


def write(python: str | None) -> None:
    """Measure everything, and write the page; other programs are run by this `python`."""
    tables = TABLES | (beside.tables(python) if python else {})
    for name, table in tables.items():
        print(f"{name} ...", file=sys.stderr, flush=True)
        made = markdown(table())
        PAGE.write_text(filled(PAGE.read_text(encoding="utf-8"), name, made), encoding="utf-8")
