"""A search under way as a job: its files, its checkpoint, its limits, its rows."""

import math
import time
from collections.abc import Callable, Iterator
from contextlib import suppress
from functools import partial
from itertools import zip_longest
from typing import Any

from sono import formats
from sono.curve import measure
from sono.formats import FormatError, VertexFile, is_stream
from sono.formats.ropefile import STOPPED, STUCK, TIGHT, Header, Searched
from sono.jobs import checkpoints
from sono.jobs.curvefiles import digest, measured
from sono.jobs.earlier import Earlier, left_in
from sono.jobs.quest import Quest
from sono.jobs.result import Result, Show, as_row
from sono.patience import patiently, within
from sono.printing import printable
from sono.searching.minima import Minimum, has_edges, merged
from sono.searching.search import KEPT, OutOfTime, Search
from sono.searching.trials import FAILURES, FINE_EDGE, Source, finish
from sono.tables import Row
from sono.tightening import Stopped

ENDLESS = 10**6
"""Trials of a search that a time limit ends."""

REFINING, FINISHING = 0.3, 0.3

LONGEST_LIMIT = 60.0
"""Shares of a time limit, up to so many seconds of it, that are kept for refining the last shapes, and for
polishing minima on other edges where those are asked for."""

MOMENT = 0.5
"""Seconds in which a stopped search compares its best rope with one on other edges."""

KIND = "search"
"""What checkpoints of this module call themselves."""


class Hunt:
    """A search job under way."""

    def __init__(self, job: Quest, file: VertexFile, show: Show) -> None:
        """Prepare the search of the curve in a file."""
        self.job = job
        self.file = file
        self.show = show
        self.over = False
        self.named = job.source.knot
        self.search = Search(job.seed, max(KEPT, job.minima))
        self.begun = time.monotonic()
        self.delivered: tuple[Minimum, str] | None = None
        self.earlier: Earlier | None = None

    def results(self) -> Iterator[Result]:
        """Search, and give a row for each of the shortest minima at the end."""
        search, job = self.search, self.job
        stopped, minima = None, list[Minimum]()
        try:
            source = self.begin()
            search = self.search
            if self.earlier and self.earlier.does(job, job.trials or ENDLESS):
                yield Result(self.earlier.row)
                return
            try:  # at once, so that it is known before hours are spent
                self.save()
            except FormatError as error:
                yield Result(None, f"{error}; it goes on without a checkpoint")
            for _ in search.run(source, job.trials or ENDLESS, self.submit, job.workers.count):
                with suppress(FormatError):  # a full disk may have room again before the search ends
                    if not is_stream(job.output):
                        self.deliver(search.minima[:1], STOPPED)
                    self.save()
            minima = self.finished(source, search.minima[: job.minima]) or self.unrefined()
        except OutOfTime:  # it had not begun
            pass
        except Stopped as why:
            stopped = str(why)
            minima = search.minima[: job.minima] or self.unrefined()
        finally:
            self.over = True
        self.delivered = None  # its header is to tell of all trials
        unfinished = stopped is not None or not search.minima
        try:
            self.deliver(minima[:1], STOPPED if unfinished else None)
        except FormatError as error:
            yield Result(None, str(error))
        yield from self.rows(minima, unfinished)
        yield from self.troubles(minima, stopped)

    def begin(self) -> Source:
        """Look at the curve, at the checkpoint and at the output. Raises `FormatError` and `ValueError`."""
        curve = self.file.components
        source = patiently(partial(Source.of, curve, self.named, self.look), self.look)
        self.restore(source)
        if self.job.resume:
            self.earlier = left_in(self.job, self.origin(), source, self.look)
        return source

    def unrefined(self) -> list[Minimum]:
        """Return the best shape of a search that ended before any was refined."""
        return [Minimum.of(shape) for shape in self.search.shapes[:1]]

    def finer(self, minimum: Minimum, n: int) -> Minimum | None:
        """Polish a rope on n vertices, for which a search that is over has only a moment."""
        polished = partial(finish, minimum, n, self.look)
        if not self.over:
            return patiently(polished, self.look)
        with suppress(Stopped):
            return within(MOMENT, partial(finish, minimum, n))
        return None

    def finished(self, source: Source, minima: list[Minimum]) -> list[Minimum]:
        """Polish minima with the edges that were asked for; return them with the shortest first."""
        dl = self.job.dl
        if dl != FINE_EDGE:
            waiting = [self.submit(finish, minimum, round(minimum.length / dl)) for minimum in minima]
            finer = []
            with suppress(OutOfTime):
                for minimum in waiting:
                    finer.append(self.search.confirmed(minimum(), source))
            minima = [new or old for new, old in zip_longest(finer, minima)]
            # Minima are compared on edges of one length.
            minima = list(filter(self.has_edges, minima)) or minima
        return merged(minima)

    def has_edges(self, minimum: Minimum) -> bool:
        """Tell whether a rope has the edges that were asked for."""
        return has_edges(sum(map(len, minimum.curve)), minimum.length, self.job.dl)

    def submit(self, function: Callable[..., Any], *args: Any, rank: int | None = None) -> Callable[[], Any]:
        """Have a function done by the workers; a trial ends when time is left for no more than refining."""
        finishing = FINISHING if function is not finish and self.job.dl != FINE_EDGE else 0
        refining = REFINING if rank is not None else 0
        watch = partial(self.look, finishing + refining)
        return self.job.workers.submit(function, *args, watch=watch, rank=-1 if rank is None else rank)

    def look(self, reserved: float = 0) -> None:
        """Show the search, and stop it when it is time to, of which a share may be `reserved`."""
        if self.over:
            raise Stopped("the search is over")
        search, job = self.search, self.job
        parts = [search.trials / job.trials] if job.trials else []
        parts += [self.now() / job.time_limit] if job.time_limit else []
        best = f" L_a {search.minima[0].length:.4f}" if search.minima else ""
        self.show(min(max(parts, default=0), 1), f"{search.trials} trials{best}")
        limit = job.time_limit or math.inf
        if self.now() > limit - reserved * min(limit, LONGEST_LIMIT):
            raise OutOfTime

    def now(self) -> float:
        """Return the seconds spent on this search, those before it was resumed included."""
        return time.monotonic() - self.begun

    def deliver(self, best: list[Minimum], status: str | None) -> None:
        """Write the shortest minimum, unless it is written or the output has a better rope.

        Raises `FormatError`.
        """
        for minimum in best:
            status = status or _status(minimum)
            stays = self.earlier and self.earlier.stays(minimum, self.finer)
            if self.delivered == (minimum, status) or stays:
                continue
            header = Header.of(
                self.job.name,
                status,
                measure(minimum.curve),
                searched=self.searched(minimum),
                physics=() if minimum.residual is None else (("residual", minimum.residual),),
                origin=self.origin(),
            )
            formats.write(self.job.output, minimum.curve, header.lines())
            self.earlier, self.delivered = None, (minimum, status)

    def searched(self, minimum: Minimum) -> Searched:
        """Say where a minimum was found, and which time limit the search has ended by, if it has."""
        search, limit = self.search, self.job.time_limit
        over = limit if limit and search.trials < (self.job.trials or ENDLESS) else None
        found = minimum.variant, search.seed, minimum.hits
        return Searched(*found, trials=search.trials, seconds=self.now(), limit=over)

    def rows(self, minima: list[Minimum], unfinished: bool) -> Iterator[Result]:
        """Give a row for what is in the output, and for each of the other minima."""
        if self.earlier:
            yield Result(self.earlier.row)
        for minimum in minima:
            yield Result(self.row(minimum, unfinished))

    def row(self, minimum: Minimum, unfinished: bool) -> Row:
        """Give the row of a minimum."""
        output = self.job.output if self.delivered and self.delivered[0] is minimum else None
        measures = measured(output)[1] if output and not is_stream(output) else measure(minimum.curve)
        work = {key: getattr(minimum, key) for key in ("residual", "hits", "variant")}
        more = work | {"trials": self.search.trials, "seconds": self.now()}
        status = STOPPED if unfinished else _status(minimum)
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
        elif not minima and search.trials:
            yield Result(None, f"{name}: none of {search.trials} trials could be tightened")
        elif not search.minima:
            what = (
                f"a rope was refined; the best so far is in {self.job.output}" if minima else "a trial ended"
            )
            yield Result(
                None, f"{name}: the time limit of {self.job.time_limit:g} s was reached before {what}"
            )
        elif not minima[0].converged:
            yield Result(None, f"{name}: its shortest rope did not get tight")
        elif not self.has_edges(minima[0]):
            yield Result(None, f"{name}: its ropes did not come to edges of {self.job.dl:g}")
        if unsaved:
            yield Result(None, f"{name}: {unsaved}")
        if search.changed:
            yield Result(None, f"{name}: {search.changed} ropes changed their knot type and were dropped")
        if search.failed and minima:
            note = f"{name}: {search.failed} of {search.trials} starts could not be tightened"
            yield Result(None, note=note)

    def restore(self, source: Source) -> None:
        """Take the search up where the checkpoint has it. Raises `FormatError`."""
        path = self.job.checkpoint
        if not (self.job.resume and path and path.exists()):
            return
        state = checkpoints.load(path, KIND)
        try:
            same = state["identity"] == self.identity()
            seconds = float(state["seconds"])
            search = patiently(partial(Search.restore, state["search"]), self.look)
        except (LookupError, TypeError, AttributeError, *FAILURES) as error:
            raise FormatError(f"{path}: holds no state of a search ({error}); remove it") from error
        if not same:
            raise FormatError(f"{path}: is of another knot or seed; repeat those or remove it")
        search.minima = [minimum for minimum in search.minima if search.confirmed(minimum, source)]
        search.kept = max(search.kept, self.job.minima)
        self.search = search
        self.begun -= seconds

    def save(self) -> None:
        """Write the checkpoint, if there is to be one. Raises `FormatError`."""
        if self.job.checkpoint:
            state = {"identity": self.identity(), "seconds": self.now(), "search": self.search.state()}
            checkpoints.save(self.job.checkpoint, KIND, state)

    def identity(self) -> list[str]:
        """Return what must be the same for a checkpoint to be continued."""
        return [self.origin(), str(self.job.seed)]

    def origin(self) -> str:
        """Return the knot's name, or a digest of its curve."""
        return printable(self.named) if self.named else digest(self.file)


def _status(minimum: Minimum) -> str:
    return TIGHT if minimum.converged else STUCK
