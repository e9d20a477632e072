"""One knot's search as a job of a batch: its files, its checkpoint, its rows."""

import hashlib
import json
import math
import os
import re
import time
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from itertools import takewhile
from pathlib import Path
from typing import Any

from sono import formats, sources
from sono.batch import (
    KEPT_RESIDUAL,
    STOPPED,
    STUCK,
    TIGHT,
    Result,
    as_row,
    is_stream,
    measured,
    says_tight,
    title,
)
from sono.formats import FormatError, VertexFile
from sono.invariants import fingerprint
from sono.pipeline import Curve, Stopped, forces, measure
from sono.search import FINE_EDGE, Minimum, Search, Source, finish, rank
from sono.workers import Workers

ENDLESS = 10**6
"""Trials of a search that a time limit ends."""

Show = Callable[[float, str], None]


@dataclass(frozen=True)
class SearchJob:
    """Search the knot that `source` names, or the curve in that file, for its shortest tight rope.

    The search ends after so many `trials` or, begun trials included, after `time_limit` seconds. The shortest
    minimum is written to `output` whenever a shorter one is found; in the end the `minima` shortest are
    polished with edges `dl` long, in radii. `checkpoint` is the file that keeps the state of the search; with
    `resume` it goes on from there, and an output whose search was finished is kept.
    """

    source: str
    name: str
    output: str
    workers: Workers
    trials: int | None = None
    time_limit: float | None = None
    seed: int = 0
    dl: float = FINE_EDGE
    minima: int = 5
    checkpoint: Path | None = None
    resume: bool = False

    def files(self) -> list[str]:
        """Return the files that the job writes."""
        outputs = [] if is_stream(self.output) else [self.output]
        return [*outputs, os.fspath(self.checkpoint)] if self.checkpoint else outputs

    def results(self, show: Show) -> Iterator[Result]:
        """Do the job; `show` is told how far it is, from 0 to 1, and what it does; it may raise `Stopped`."""
        try:
            if self.resume and os.path.isfile(self.output) and (kept := self._kept()):
                yield kept
                return
            yield from _Hunt(self, sources.read(self.source), show).results()
        except FormatError as error:
            yield Result(None, str(error))
        except ValueError as error:  # of a start that cannot be drawn, or an invariant not be computed
            yield Result(None, f"{self.name}: {error}")

    def _kept(self) -> Result | None:
        """Give the row of an output that is there from an earlier, finished search."""
        work = re.search(
            r"^# searched: .* in (\d+) of (\d+) trials, (\d+) s$", formats.load(self.output)[1], re.MULTILINE
        )
        if not work:
            return None
        hits, trials, seconds = map(int, work.groups())
        if trials < (self.trials or ENDLESS) and seconds < (self.time_limit or float("inf")):
            return None
        file, measures = measured(self.output)
        residual = forces(file.components).residual
        if not says_tight(self.output) or residual > KEPT_RESIDUAL:
            return None
        more = {"status": TIGHT, "residual": residual, "hits": hits, "trials": trials}
        return Result(as_row(self.name, self.output, measures, **more))


class _Hunt:
    """A search job under way."""

    def __init__(self, job: SearchJob, file: VertexFile, show: Show) -> None:
        """Begin, or go on from the checkpoint. Raises `FormatError`."""
        self.job = job
        self.show = show
        name = job.source if sources.is_name(job.source) else None
        measure(file.components)  # refuses a curve that crosses itself
        self.source = Source.of(file.components, name)
        self.search = Search(job.seed)
        self.seconds = 0.0
        self.restore()
        self.begun = time.monotonic() - self.seconds
        self.delivered: tuple[Curve, str] | None = None

    def results(self) -> Iterator[Result]:
        """Search, and give a row for each of the shortest minima at the end."""
        search, job = self.search, self.job
        stopped = None
        try:
            rounds = takewhile(self.time_is_left, search.rounds(job.trials or ENDLESS))
            for _ in search.run(self.source, rounds, self.submit):
                self.save()
                self.deliver(search.minima[:1], STOPPED)
            minima = self.finished(search.minima[: job.minima])
        except Stopped as why:
            stopped, minima = str(why), search.minima[: job.minima]
        self.deliver(minima[:1], STOPPED if stopped else None)
        for place, minimum in enumerate(minima):
            yield self.row(minimum, stopped, None if place else job.output)
        yield from self.troubles(stopped)

    def finished(self, minima: list[Minimum]) -> list[Minimum]:
        """Polish minima with the edges that were asked for; return them with the shortest first."""
        dl = self.job.dl
        if dl != FINE_EDGE:
            waiting = [self.submit(finish, minimum, round(minimum.length / dl)) for minimum in minima]
            minima = [minimum() for minimum in waiting]
        return sorted(minima, key=rank)

    def submit(self, function: Callable[..., Any], *args: Any) -> Callable[[], Any]:
        """Have a function done by the workers."""
        return self.job.workers.submit(function, *args, watch=self.look)

    def look(self) -> None:
        """Show the search, and stop it when it is time to."""
        search, job = self.search, self.job
        parts = [search.trials / job.trials] if job.trials else []
        parts += [self.now() / job.time_limit] if job.time_limit else []
        best = f" L_a {search.minima[0].length:.4f}" if search.minima else ""
        self.show(min(max(parts, default=0), 1), f"{search.trials} trials{best}")

    def now(self) -> float:
        """Return the seconds spent on this search, those before it was resumed included."""
        return time.monotonic() - self.begun

    def time_is_left(self, _: range) -> bool:
        """Tell whether to begin another round."""
        return self.now() < (self.job.time_limit or math.inf)

    def deliver(self, best: list[Minimum], status: str | None) -> None:
        """Write the shortest minimum if it is another one than before. Raises `FormatError`."""
        for minimum in best:
            status = status or _status(minimum)
            if self.delivered and self.delivered[0] is minimum.curve and self.delivered[1] == status:
                continue
            if fingerprint(minimum.curve) != self.source.type:
                raise FormatError(
                    f"{self.job.name}: the shortest rope is of another knot type; nothing is written"
                )
            comments = [
                *title(self.job.name, status, measure(minimum.curve)),
                f"searched: variant {minimum.variant}, seed {self.search.seed}, met in {minimum.hits} of "
                f"{self.search.trials} trials, {self.now():.0f} s",
                f"residual {minimum.residual:.1e}",
            ]
            formats.write(self.job.output, minimum.curve, comments)
            self.delivered = minimum.curve, status

    def row(self, minimum: Minimum, stopped: str | None, output: str | None) -> Result:
        """Give the row of a minimum."""
        to_file = output is not None and not is_stream(output)
        measures = measured(output)[1] if output and to_file else measure(minimum.curve)
        work = {key: getattr(minimum, key) for key in ("residual", "hits", "variant")}
        more = work | {"trials": self.search.trials, "seconds": self.now()}
        status = STOPPED if stopped else _status(minimum)
        trouble = f"{self.job.name}: n = {measures.n} did not get tight" if status == STUCK else None
        return Result(as_row(self.job.name, output, measures, status=status, **more), trouble)

    def troubles(self, stopped: str | None) -> Iterator[Result]:
        """Tell what else the user should hear."""
        search, name = self.search, self.job.name
        if stopped:
            place = (
                f"the best of {search.trials} trials is in {self.job.output}"
                if search.minima
                else "no rope yet"
            )
            way_on = "; --resume goes on from here" if self.job.checkpoint else ""
            yield Result(None, f"{name}: {stopped}; {place}{way_on}")
        elif not search.minima:
            yield Result(None, f"{name}: none of {search.trials} trials could be tightened")
        if search.changed:
            yield Result(None, f"{name}: {search.changed} trials changed their knot type and were dropped")
        if search.failed and search.minima:
            yield Result(
                None, note=f"{name}: {search.failed} of {search.trials} starts could not be tightened"
            )

    def restore(self) -> None:
        """Take the search up where the checkpoint has it."""
        path = self.job.checkpoint
        if not (self.job.resume and path and path.exists()):
            return
        try:
            state = json.loads(path.read_text(encoding="utf-8"))
            same = state.pop("identity") == self.identity()
            self.seconds = float(state.pop("seconds"))
            self.search = Search.restore(state)
        except (OSError, ValueError, LookupError, TypeError, AttributeError) as error:
            raise FormatError(f"{path}: is no checkpoint of a search ({error}); remove it") from error
        if not same:
            raise FormatError(f"{path}: is of another knot or seed; repeat those or remove it")

    def save(self) -> None:
        """Write the checkpoint, if there is to be one. Raises `FormatError`."""
        if self.job.checkpoint:
            state = self.search.state() | {"identity": self.identity(), "seconds": self.now()}
            formats.save(os.fspath(self.job.checkpoint), json.dumps(state))

    def identity(self) -> list[str]:
        """Return what must be the same for a checkpoint to be continued."""
        digest = hashlib.sha256()
        for component in self.source.curve:
            digest.update(component.tobytes() + b"end of component")
        return [digest.hexdigest(), str(self.job.seed)]


def _status(minimum: Minimum) -> str:
    return TIGHT if minimum.tight else STUCK
