"""What tightening costs: `python -m tests.bench` prints the README's benchmark tables (about a minute).

Counts are exact and the same on every machine of one kind; seconds are of one core, whatever it is.
"""

import json
import time

import sono
from sono._core import Polish, Tightener, measure
from sono.tightening import Method, Progress, Stopped

GOAL = 32.7402
"""L_p of the trefoil at n = 480 up to which SONO and the polish race; the paper has 32.74005."""


def race(method: Method) -> tuple[float, float | None]:
    """Return the seconds until a trefoil of 480 vertices measures GOAL or less, and what it measures then."""
    start = time.perf_counter()
    reached: list[tuple[float, float]] = []

    def watch(progress: Progress) -> None:
        best = progress.status and progress.status.best
        if best and best.n == 480 and best.l_p <= GOAL:
            reached.append((time.perf_counter() - start, best.l_p))
            raise Stopped

    try:
        tight = sono.tighten(sono.start("3_1"), 480, method=method, watch=watch)
    except Stopped:
        return reached[0]
    seconds = time.perf_counter() - start
    return seconds, tight.measures.l_p if tight.measures.l_p <= GOAL else None


def levels() -> None:
    """Polish the trefoil to the end at each n, from the one before: Newton steps and what they cost."""
    curve = list(sono.tighten(sono.start("3_1"), 120).curve)
    print("n\tL_p\tL_c\tsteps\tfactorisations\tseconds\tms a factorisation")
    n = 240
    while n <= 15_360:
        start = time.perf_counter()
        polish = Polish(curve, n, False, 0)
        while polish.advance(1)["outcome"] == "running":
            pass
        seconds = time.perf_counter() - start
        status, curve = polish.status(), polish.best()
        each = 1e3 * seconds / status["factorisations"]
        best, steps = status["best"], (status["iterations"], status["factorisations"])
        figures = f"{best['l_p']:.8f}\t{best['l_c']:.8f}\t{steps[0]}\t{steps[1]}"
        print(f"{n}\t{figures}\t{seconds:.2f}\t{each:.2f}", flush=True)
        n *= 2


def sweeps() -> None:
    """What a sweep of SONO and a measurement cost a vertex, on a trefoil that settles."""
    curve = sono.tighten(sono.start("3_1"), 480).curve
    endless = json.dumps({"settle_sweeps": 10_000_000})
    print("n\tns a sweep and vertex\tns a measurement and vertex")
    for n in (480, 1920, 7680, 30_000):
        tightener = Tightener(curve, "settle", n, endless)
        before = tightener.advance(1)["sweeps"]
        start = time.perf_counter()
        sweeps = tightener.advance(2)["sweeps"] - before
        swept = time.perf_counter()
        measures = 0
        fine = tightener.best()
        started = time.perf_counter()
        while time.perf_counter() < started + 1:
            measure(fine)
            measures += 1
        measured = time.perf_counter() - started
        print(
            f"{n}\t{1e9 * (swept - start) / (sweeps * n):.1f}\t{1e9 * measured / (measures * n):.0f}",
            flush=True,
        )


if __name__ == "__main__":
    for method in ("sono", "both"):
        seconds, reached = race(method)
        print(f"trefoil, n = 480, L_p <= {GOAL} by {method}: {seconds:.2f} s (L_p {reached})", flush=True)
    levels()
    sweeps()
