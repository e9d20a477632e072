"""One knot's search as a job of a batch: its files, its checkpoint, its rows."""

import hashlib
import json
import math
import os
import re
import time
from collections.abc import Callable, Iterable, Iterator
from contextlib import suppress
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
    measured,
    says_tight,
    title,
)
from sono.formats import FormatError, VertexFile, is_stream
from sono.invariants import fingerprint
from sono.pipeline import Stopped, forces, measure
from sono.search import FINE_EDGE, SAME_LENGTH, Minimum, Search, Shape, Source, finish, rank, same_edges
from sono.tables import Row
from sono.workers import Workers

ENDLESS = 10**6
"""Trials of a search that a time limit ends."""

SAME_ROPE = 1e-8
"""Relative difference in L_a up to which ropes of the same edges are one, found again."""

Show = Callable[[float, str], None]

_SEARCHED = re.compile(
    r"^# searched: variant (-?\d+), seed (\d+), met in (\d+) of (\d+) trials, (\d+) s$", re.MULTILINE
)


@dataclass(frozen=True)
class SearchJob:
    """Search the knot that `source` names, or the curve in that file, for its shortest tight rope.

    The search ends after so many `trials`, or begins no further round of them after `time_limit` seconds. The
    shortest minimum is written to `output` whenever a shorter one is found; in the end the `minima` shortest
    are polished with edges `dl` long, in radii. `checkpoint` is the file that keeps the state of the search;
    with `resume` it goes on from there, an output whose search was finished is kept, and any other is only
    replaced by a better one; an output that holds another knot is an error. `way_on` tells the user how to go
    on from a checkpoint.
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
    way_on: str = "--resume goes on from here"

    def files(self) -> list[str]:
        """Return the files that the job writes."""
        outputs = [] if is_stream(self.output) else [self.output]
        return [*outputs, os.fspath(self.checkpoint)] if self.checkpoint else outputs

    def results(self, show: Show) -> Iterator[Result]:
        """Do the job; `show` is told how far it is, from 0 to 1, and what it does; it may raise `Stopped`."""
        try:
            file = sources.read(self.source)
            yield from (Result(None, note=doubt) for doubt in file.doubts())
            yield from _Hunt(self, file, show).results()
        except FormatError as error:
            yield Result(None, str(error))
        except ValueError as error:  # of a curve that cannot be measured
            yield Result(None, f"{self.name}: {error}")


@dataclass(frozen=True)
class _Earlier:
    """A rope that is in the output already: its row, and what it says of the search that found it."""

    row: Row
    seed: int | None = None
    trials: int = 0
    seconds: int = 0

    @property
    def tight(self) -> bool:
        """Whether its forces are in balance."""
        return self.row["status"] == TIGHT

    @property
    def dl(self) -> float:
        """Its edge length, in radii."""
        return float(self.row["dl"] or 0) / float(self.row["r_s"] or 1)

    @property
    def length(self) -> float:
        """Its L_a."""
        return float(self.row["l_a"] or math.inf)


class _Hunt:
    """A search job under way."""

    def __init__(self, job: SearchJob, file: VertexFile, show: Show) -> None:
        """Begin, or go on from the checkpoint. Raises `FormatError`."""
        self.job = job
        self.show = show
        self.over = False
        self.named = job.source if sources.is_name(job.source) else None
        measure(file.components)  # refuses a curve that crosses itself
        self.source = Source.of(file.components, self.named)
        self.search = Search(job.seed)
        self.seconds = 0.0
        self.restore()
        self.begun = time.monotonic() - self.seconds
        self.delivered: tuple[Minimum, str] | None = None
        self.earlier = self.left_earlier() if job.resume else None

    def results(self) -> Iterator[Result]:
        """Search, and give a row for each of the shortest minima at the end."""
        search, job, earlier = self.search, self.job, self.earlier
        if earlier and self.is_enough(earlier):
            yield Result(earlier.row)
            return
        try:  # at once, so that it is known before hours are spent
            self.save()
        except FormatError as error:
            yield Result(None, f"{error}; it goes on without a checkpoint")
        stopped = None
        try:
            rounds = takewhile(self.time_is_left, search.rounds(job.trials or ENDLESS))
            for _ in search.run(self.source, rounds, self.submit):
                with suppress(FormatError):  # a full disk may have room again before the search ends
                    if not is_stream(job.output):
                        self.deliver(search.minima[:1], STOPPED)
                    self.save()
            minima = self.finished(search.minima[: job.minima])
        except Stopped as why:
            stopped = str(why)
            minima = search.minima[: job.minima] or [_unrefined(shape) for shape in search.shapes[:1]]
        finally:
            self.over = True
        self.delivered = None  # its header is to tell of all trials
        try:
            self.deliver(minima[:1], STOPPED if stopped else None)
        except FormatError as error:
            yield Result(None, str(error))
        yield from self.rows(minima, stopped)
        yield from self.troubles(minima, stopped)

    def left_earlier(self) -> _Earlier | None:
        """Return what is in the output, if there is any. Raises `FormatError` for another knot."""
        output = self.job.output
        if not os.path.isfile(output):
            return None
        file, measures = measured(output)
        if fingerprint(file.components) != self.source.type:
            raise FormatError(
                f"{output}: is another knot than {self.job.name}; move it away or name another -o"
            )
        residual = forces(file.components).residual
        status = TIGHT if residual <= KEPT_RESIDUAL else STOPPED
        row = as_row(self.job.name, output, measures, status=status, residual=residual)
        work = _SEARCHED.search(formats.load(output)[1])
        if not work:
            return _Earlier(row)
        variant, seed, hits, trials, seconds = map(int, work.groups())
        return _Earlier({**row, "variant": variant, "hits": hits, "trials": trials}, seed, trials, seconds)

    def is_enough(self, earlier: _Earlier) -> bool:
        """Tell whether the earlier search was finished and did what this one is to do."""
        job = self.job
        done = earlier.trials >= (job.trials or ENDLESS) or earlier.seconds >= (job.time_limit or math.inf)
        same = earlier.seed == job.seed and same_edges(earlier.dl, job.dl)
        return done and same and earlier.tight and says_tight(job.output)

    def is_worse(self, minimum: Minimum) -> bool:
        """Tell whether the rope that is in the output is to stay there."""
        earlier, dl = self.earlier, measure(minimum.curve).dl
        if not earlier:
            return False
        if earlier.tight and not minimum.tight:
            return True
        if same_edges(earlier.dl, dl):
            return minimum.length > earlier.length * (1 + SAME_ROPE)
        # The finer rope stays, unless the other's is another minimum.
        blur = _blur(max(earlier.dl, dl))
        return minimum.length >= earlier.length * (1 + blur if dl < earlier.dl else 1 - blur)

    def finished(self, minima: list[Minimum]) -> list[Minimum]:
        """Polish minima with the edges that were asked for; return them with the shortest first."""
        dl = self.job.dl
        if dl != FINE_EDGE:
            waiting = [self.submit(finish, minimum, round(minimum.length / dl)) for minimum in minima]
            finer = [self.search.confirmed(minimum(), self.source) for minimum in waiting]
            minima = [new or old for new, old in zip(finer, minima, strict=True)]
        return sorted(minima, key=rank)

    def submit(self, function: Callable[..., Any], *args: Any) -> Callable[[], Any]:
        """Have a function done by the workers."""
        return self.job.workers.submit(function, *args, watch=self.look)

    def look(self) -> None:
        """Show the search, and stop it when it is time to."""
        if self.over:
            raise Stopped("the search is over")
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
        """Write the shortest minimum, unless it is written or the output has a better rope.

        Raises `FormatError`.
        """
        for minimum in best:
            status = status or _status(minimum)
            if self.delivered == (minimum, status) or self.is_worse(minimum):
                continue
            comments = [
                *title(self.job.name, status, measure(minimum.curve)),
                f"searched: variant {minimum.variant}, seed {self.search.seed}, met in {minimum.hits} of "
                f"{self.search.trials} trials, {self.now():.0f} s",
                f"residual {minimum.residual:.1e}",
            ]
            formats.write(self.job.output, minimum.curve, comments)
            self.earlier, self.delivered = None, (minimum, status)

    def rows(self, minima: list[Minimum], stopped: str | None) -> Iterator[Result]:
        """Give a row for what is in the output, and for each of the other minima."""
        if self.earlier:
            yield Result(self.earlier.row)
        for minimum in minima:
            yield Result(self.row(minimum, stopped))

    def row(self, minimum: Minimum, stopped: str | None) -> Row:
        """Give the row of a minimum."""
        output = self.job.output if self.delivered and self.delivered[0] is minimum else None
        measures = measured(output)[1] if output and not is_stream(output) else measure(minimum.curve)
        work = {key: getattr(minimum, key) for key in ("residual", "hits", "variant")}
        more = work | {"trials": self.search.trials, "seconds": self.now()}
        status = STOPPED if stopped else _status(minimum)
        return as_row(self.job.name, output, measures, status=status, **more)

    def troubles(self, minima: list[Minimum], stopped: str | None) -> Iterator[Result]:
        """Tell what else the user should hear."""
        search, name = self.search, self.job.name
        unsaved = None
        try:
            if not stopped:  # in the middle of a round; the checkpoint has what was before it
                self.save()
        except FormatError as error:
            unsaved = str(error)
        if stopped:
            place = "no rope yet"
            if self.delivered or self.earlier:
                which = "is in" if self.delivered else "is no better than what is in"
                place = f"the best of {search.trials} trials {which} {self.job.output}"
            way_on = f"; {self.job.way_on}" if self.job.checkpoint and not unsaved else ""
            yield Result(None, f"{name}: {stopped}; {place}{way_on}")
        elif not minima:
            yield Result(None, f"{name}: none of {search.trials} trials could be tightened")
        elif not minima[0].tight:
            yield Result(None, f"{name}: its shortest rope did not get tight")
        if unsaved:
            yield Result(None, f"{name}: {unsaved}")
        if search.changed:
            yield Result(None, f"{name}: {search.changed} ropes changed their knot type and were dropped")
        if search.failed and minima:
            note = f"{name}: {search.failed} of {search.trials} starts could not be tightened"
            yield Result(None, note=note)

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
        if self.named:
            return [self.named, str(self.job.seed)]
        digest = hashlib.sha256()
        for component in self.source.curve:
            digest.update(component.tobytes() + b"end of component")
        return [digest.hexdigest(), str(self.job.seed)]


def spent(checkpoints: Iterable[Path | None]) -> str:
    """Tell what the searches of these checkpoints took in all, and how often a trial changed the type."""
    trials = changed = 0
    seconds = 0.0
    for path in checkpoints:
        with suppress(OSError, ValueError, LookupError, TypeError):  # searches that did not begin have none
            state = json.loads(path.read_text(encoding="utf-8")) if path else {}
            trials, changed = trials + state["trials"], changed + state["changed"]
            seconds += state["seconds"]
    hours = seconds / 3600
    return f"trials: {trials}, of which {changed} changed their knot type; hours of search: {hours:.2f}"


def _unrefined(shape: Shape) -> Minimum:
    """Return a shape as the best there is of a search that was stopped early."""
    assert shape.curve is not None
    residual = forces(shape.curve).residual
    return Minimum(shape.variant, shape.length, False, residual, shape.curve, [shape.radii], shape.hits)


def _blur(dl: float) -> float:
    """Return the relative difference in L_a that edges of this length may make to one minimum.

    Two ropes with edges of 0.2 differ by SAME_LENGTH at most; among 551 minima no rope with edges of 0.45 was
    shorter by more than 2e-3 than it became on finer ones.
    """
    return SAME_LENGTH * (dl / FINE_EDGE) ** 3


def _status(minimum: Minimum) -> str:
    return TIGHT if minimum.tight else STUCK
