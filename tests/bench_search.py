"""What a search costs until it meets the published ropelength: `python -m tests.bench_search [KNOT ...]`.

Each of the knots 3_1 to 10_70, or of those named, is searched from nothing on one core, until a minimum is no
longer than published or after 32 trials. A row for each tells the core-seconds until then, or of the whole
search where `met` is "no". With PYTHONPATH=CHECKOUT/python another version is measured. A version is as good
as the median of its seconds, and the number of knots that it meets.
"""

import sys
import time
from collections.abc import Callable
from heapq import heappop, heappush
from statistics import median
from typing import Any

from sono import starts
from sono.searching.minima import Minimum
from sono.searching.search import Search
from sono.searching.trials import Source, attempt
from sono.tables import published

TRIALS = 32

KNOTS = 154
"""Knots of the default, in the order of the table."""


class EnoughError(Exception):
    """A minimum is no longer than published."""


class OneCore:
    """Does one function after the other, in the order of one worker; stops at a tight rope that is short."""

    def __init__(self, source: Source, enough: float) -> None:
        """Stop at a rope of the source's type that is no longer than `enough`."""
        self.source, self.enough = source, enough
        self.best, self.trials = float("inf"), 0
        self.waiting: list[tuple[int, int, Callable[..., Any], tuple[Any, ...]]] = []
        self.results: dict[int, Any] = {}
        self.begun = 0

    def submit(self, function: Callable[..., Any], *args: Any, rank: int | None = None) -> Callable[[], Any]:
        """Queue a function; refining goes before all trials."""
        self.begun += 1
        number = self.begun
        heappush(self.waiting, (-1 if rank is None else rank, number, function, args))

        def result() -> Any:
            while number not in self.results:
                self.do_the_next()
            return self.results.pop(number)

        return result

    def do_the_next(self) -> None:
        """Do what comes first of what waits."""
        _, number, function, args = heappop(self.waiting)
        self.trials += function is attempt
        found = self.results[number] = function(*args)
        if isinstance(found, Minimum) and found.converged:
            self.best = min(self.best, found.length)
            if Search().confirmed(found, self.source) and found.length <= self.enough:
                raise EnoughError


def searched(knot: str, enough: float) -> tuple[bool, float, OneCore]:
    """Tell whether a search meets the published length, and in how many seconds."""
    source = Source.of(starts.start(knot), knot)
    core = OneCore(source, enough)
    begun = time.process_time()
    try:
        for _ in Search().run(source, TRIALS, core.submit):
            pass
    except EnoughError:
        pass
    return core.best <= enough, time.process_time() - begun, core


def main(knots: list[str]) -> None:
    """Search the knots; print a row for each, and what they come to on stderr."""
    all_seconds, lengths = [], published.table()
    print("knot\tpublished\tmet\tseconds\ttrials\tbest", flush=True)
    for knot in knots or [row["knot"] for row in starts.table("knots")][:KNOTS]:
        length = float(str(lengths[knot]["published"]))
        met, seconds, core = searched(knot, length)
        all_seconds.append(seconds if met else float("inf"))
        figures = f"{seconds:.2f}", core.trials, f"{core.best:.4f}"
        print(knot, length, "yes" if met else "no", *figures, sep="\t", flush=True)
    met_knots = sum(map(float("inf").__gt__, all_seconds))
    print(f"{met_knots} of {len(all_seconds)} met, median {median(all_seconds):.2f} s", file=sys.stderr)


if __name__ == "__main__":
    main(sys.argv[1:])
