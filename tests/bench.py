"""What things cost: `python -m tests.bench` prints what the engines do; `--report` writes docs/speed.md.

`--report --beside PYTHON` puts other programs beside sono, as far as that Python has them; without it the
page's tables of these are kept. Counts are exact and the same on every machine of one kind; seconds are
those of a core, whatever it is and whoever else works on it.
"""

import json
import sys
import time
from collections.abc import Iterable, Iterator
from pathlib import Path

import sono
from sono._core import Polish, Tightener, measure
from sono.tightening import Method, Progress, Stopped

GOAL = 32.7402
"""L_p of the trefoil at n = 480 up to which SONO and the polish race; the paper has 32.74005."""

Row = list[str]


def race() -> Iterator[Row]:
    """Give the seconds until a trefoil of 480 vertices measures GOAL or less, by each method."""
    yield ["method", "core-seconds", "L_p then"]
    for method in ("sono", "both"):
        seconds, l_p = _run(method)
        yield [method, f"{seconds:.2f}", f"{l_p:.5f}"]


def _run(method: Method) -> tuple[float, float]:
    """Return when the GOAL was reached, or all was done, and what the trefoil measured then."""
    start = time.process_time()
    reached: list[tuple[float, float]] = []

    def watch(progress: Progress) -> None:
        best = progress.status and progress.status.best
        if best and best.n == 480 and best.l_p <= GOAL:
            reached.append((time.process_time() - start, best.l_p))
            raise Stopped

    try:
        tight = sono.tighten(sono.start("3_1"), 480, method=method, watch=watch)
    except Stopped:
        return reached[0]
    return time.process_time() - start, tight.measures.l_p


def levels() -> Iterator[Row]:
    """Polish the trefoil to the end at each n, from the one before: Newton steps and what they cost."""
    curve = list(sono.tighten(sono.start("3_1"), 120).curve)
    yield ["n", "L_p", "L_c", "steps", "factorisations", "core-seconds", "ms a factorisation"]
    for n in (240 * 2**k for k in range(7)):
        start = time.process_time()
        polish = Polish(curve, n, False, 0)
        while polish.advance(1)["outcome"] == "running":
            pass
        seconds = time.process_time() - start
        status, curve = polish.status(), polish.best()
        best, each = status["best"], 1e3 * seconds / status["factorisations"]
        lengths = [f"{best['l_p']:.8f}", f"{best['l_c']:.8f}"]
        counts = [str(status["iterations"]), str(status["factorisations"])]
        yield [str(n), *lengths, *counts, f"{seconds:.2f}", f"{each:.2f}"]


def sweeps() -> Iterator[Row]:
    """What a sweep of SONO and a measurement cost a vertex, on a trefoil that settles."""
    curve = sono.tighten(sono.start("3_1"), 480).curve
    endless = json.dumps({"settle_sweeps": 10_000_000})
    yield ["n", "ns a sweep and bead", "ns a measurement and bead"]
    for n in (480, 1920, 7680, 30_000):
        tightener = Tightener(curve, "settle", n, endless)
        before = tightener.advance(1)["sweeps"]
        start = time.process_time()
        swept = tightener.advance(2)["sweeps"] - before
        each = (time.process_time() - start) / (swept * n)
        fine, measures, start = tightener.best(), 0, time.process_time()
        while time.process_time() < start + 0.5:
            measure(fine)
            measures += 1
        yield [str(n), f"{1e9 * each:.1f}", f"{1e9 * (time.process_time() - start) / (measures * n):.0f}"]


def tsv(rows: Iterable[Row]) -> None:
    """Print a table as it comes."""
    for row in rows:
        print("\t".join(row), flush=True)


if __name__ == "__main__":
    if "--report" in sys.argv:
        sys.path.insert(0, str(Path(__file__).parent))
        import bench_page

        bench_page.write(sys.argv[sys.argv.index("--beside") + 1] if "--beside" in sys.argv else None)
    else:
        for table in (race, levels, sweeps):
            tsv(table())
