"""One knot's search as a job of a batch."""

from collections.abc import Iterable, Iterator
from contextlib import suppress
from pathlib import Path

from sono.formats import FormatError
from sono.jobs import checkpoints
from sono.jobs.hunt import KIND, Hunt
from sono.jobs.quest import Quest
from sono.jobs.result import Result, Show


class SearchJob(Quest):
    """A quest, and how it is done."""

    def results(self, show: Show) -> Iterator[Result]:
        """Do the job; `show` is told how far it is, from 0 to 1, and what it does; it may raise `Stopped`."""
        try:
            file = self.source.read()
            yield from (Result(None, note=doubt) for doubt in file.doubts())
            yield from Hunt(self, file, show).results()
        except FormatError as error:
            yield Result(None, str(error))
        except ValueError as error:  # of a curve that cannot be measured
            yield Result(None, f"{self.name}: {error}")


def spent(paths: Iterable[Path | None]) -> str:
    """Tell what the searches of these checkpoints took in all, and how often a trial changed the type."""
    trials = changed = 0
    seconds = 0.0
    for path in paths:
        with suppress(FormatError, LookupError, TypeError):  # searches that did not begin have none
            state = checkpoints.load(path, KIND) if path else {}
            search = state["search"]
            trials, changed = trials + search["trials"], changed + search["changed"]
            seconds += state["seconds"]
    hours = seconds / 3600
    return f"trials: {trials}, of which {changed} changed their knot type; hours of search: {hours:.2f}"
