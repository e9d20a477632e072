"""One curve of a batch: read, tighten, write each result as it is ready, keep the rest when stopped."""

import os
from collections.abc import Callable, Iterator
from functools import partial

from sono.formats import FormatError
from sono.jobs.kept import kept_row
from sono.jobs.order import Order
from sono.jobs.result import Result
from sono.jobs.task import Task
from sono.tightening import Progress


class Job(Order):
    """An order, and how it is done here."""

    def results(self, show: Callable[[float, str], None]) -> Iterator[Result]:
        """Do the job, giving each row when its vertices are on the disk.

        `show` is told how far the run is, from 0 to 1, and what it does; it may raise `Stopped`.
        """
        return run(self, partial(_told, show))


def run(job: Order, watch: Callable[[Progress], None]) -> Iterator[Result]:
    """Do a job, giving each row when its vertices are on the disk; `watch` may raise `Stopped`."""
    try:
        file = job.source.read()
        yield from (Result(None, note=doubt) for doubt in file.doubts())
        kept = [n for n, output in job.outputs.items() if job.resume and os.path.isfile(output)]
        for n in kept:
            yield kept_row(job, file, n)
        if todo := set(job.outputs) - set(kept):
            yield from Task(job, file, todo).results(watch)
    except FormatError as error:
        yield Result(None, str(error))


def _told(show: Callable[[float, str], None], progress: Progress) -> None:
    status = progress.status
    if status is None:
        show(0, f"{progress.stage} n {progress.n}/{progress.target}")
        return
    trial = f"trial {progress.trial} " if progress.stage in ("collapse", "anneal", "trial") else ""
    what = f"{trial}{progress.stage} n {progress.n}/{progress.target} L_p {status.best.l_p:.5f}"
    show(status.progress, what)
