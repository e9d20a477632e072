"""What `sono tighten`, `sono search` and `sono atlas` share: jobs done side by side, their rows, Ctrl-C."""

import os
import signal
import sys
import threading
import time
from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import FIRST_COMPLETED, Future, ThreadPoolExecutor, wait
from contextlib import contextmanager
from typing import TYPE_CHECKING, Any, Protocol

from sono.cli import options
from sono.printing import printable
from sono.tables import Row, TableWriter

if TYPE_CHECKING:
    from rich.progress import Progress as Bar
    from rich.progress import TaskID

    from sono.jobs.result import Result

SIGNALS = [number for name in ("SIGINT", "SIGTERM", "SIGHUP") if (number := getattr(signal, name, None))]
"""Ctrl-C, what batch systems send, and the end of the terminal."""

ECHO = 0.3
"""Seconds in which a signal is taken for the first one again: wrappers pass on what a terminal sends all."""

Show = Callable[[float, str], None]
"""Takes how far a job is, from 0 to 1, and what it does; it may raise `Stopped`."""


class Job(Protocol):
    """One knot's work."""

    @property
    def name(self) -> str:
        """The knot's name in tables."""

    def results(self, show: Show) -> "Iterator[Result]":
        """Do it."""


class Batch:
    """Does jobs in threads (Rust releases the interpreter), writes their rows, stops them upon a signal."""

    def __init__(self, table: TableWriter, quiet: bool) -> None:
        """Show rows in a table, and unless `quiet` progress and notes on standard error."""
        self.table = table
        self.quiet = quiet
        self.bar = bar(quiet)
        self.lock = threading.Lock()
        self.failed = False
        self.stop = ""
        self.signal = 0
        self.not_begun = 0
        self.turn = 0
        self.done: set[int] = set()
        self.held: dict[int, list[Row]] = {}

    def run(self, work: "Sequence[Job]", jobs: int) -> int:
        """Do so many jobs at a time; return the exit code."""
        with self.signals_caught(), self.table, self.bar, ThreadPoolExecutor(jobs) as pool:
            _wait([pool.submit(self.do, number, job) for number, job in enumerate(work)])
        if self.not_begun:
            options.complain(f"{self.not_begun} of {len(work)} knots were not begun")
        return 128 + self.signal if self.signal else int(self.failed)

    def do(self, number: int, job: "Job") -> None:
        """Do one job; whatever is wrong with it stays with it."""
        with self.lock:
            if self.stop:
                self.not_begun += 1
                return
            task = self.bar.add_task(printable(job.name), total=1, what="")
        try:
            for result in _guarded(job, lambda done, what: self.watch(task, done, what)):
                with self.lock, self.bar_hidden():
                    self.show(number, result)
            with self.lock, self.bar_hidden():
                self.end(number)
        except BaseException:
            self.stop = "the table cannot be written"
            raise
        finally:
            with self.lock:
                self.bar.remove_task(task)

    def show(self, number: int, result: "Result") -> None:
        """Tell what is wrong, and write a row when its job has its turn: rows keep the order of the jobs."""
        try:
            if result.row and number == self.turn:
                self.table.row(result.row)
            elif result.row:
                self.held.setdefault(number, []).append(result.row)
        finally:
            if result.note and not self.quiet:
                options.complain(result.note)
            if result.trouble:
                self.failed = True
                options.complain(result.trouble)

    def end(self, number: int) -> None:
        """Let the next job have its turn, and write the rows that have been waiting for that."""
        self.done.add(number)
        while self.turn in self.done:
            self.turn += 1
            for row in self.held.pop(self.turn, []):
                self.table.row(row)

    @contextmanager
    def bar_hidden(self) -> Iterator[None]:
        """Clear the line of the terminal that the bar is on."""
        tasks = self.bar.task_ids
        for task in tasks:
            self.bar.update(task, visible=False)
        self.bar.refresh()
        yield
        for task in tasks:
            self.bar.update(task, visible=True)

    def watch(self, task: "TaskID", done: float, what: str) -> None:
        """Show how far a job is, from 0 to 1, and stop it when it is time to."""
        from sono.tightening import Stopped

        self.bar.update(task, completed=done, what=what)
        if self.stop:
            raise Stopped(self.stop)

    @contextmanager
    def signals_caught(self) -> Iterator[None]:
        """Let a signal stop the jobs, which takes a second or two; another one ends all at once."""
        first = 0.0

        def stop(number: int, frame: Any) -> None:
            nonlocal first
            if not self.signal:
                first = time.monotonic()
                self.stop, self.signal = "interrupted", number
            elif time.monotonic() > first + ECHO:
                _leave_at_once(number)

        before = {
            number: signal.signal(number, stop)
            for number in SIGNALS
            if signal.getsignal(number) != signal.SIG_IGN  # as a script has it for its background jobs
        }
        try:
            yield
        finally:
            for number, handler in before.items():
                signal.signal(number, handler)


def _guarded(job: Job, show: Show) -> "Iterator[Result]":
    """Give a job's results; what nobody expected, such as a lost cluster, ends this job alone."""
    from sono.jobs.result import Result

    try:
        yield from job.results(show)
    except OSError:  # standard output is full or closed
        raise
    except Exception as error:
        kind = type(error).__name__
        yield Result(None, f"{job.name}: unexpected {kind}: {error}; please report it if sono is to blame")


def _leave_at_once(number: int) -> None:
    """End by a signal without another word, but show the cursor, which the bar hides."""
    if sys.stderr.isatty():
        os.write(sys.stderr.fileno(), b"\x1b[?25h\n")
    os._exit(128 + number)


def _wait(futures: "list[Future[None]]") -> None:
    """Wait in short steps, so that a signal is seen at once; raise what a thread did not expect."""
    pending = set(futures)
    while pending:
        done, pending = wait(pending, timeout=0.2, return_when=FIRST_COMPLETED)
        for future in done:
            future.result()


def bar(quiet: bool) -> "Bar":
    """A progress bar on standard error, if that is a terminal."""
    from rich.console import Console
    from rich.progress import BarColumn, Progress, TextColumn, TimeElapsedColumn

    console = Console(stderr=True)
    return Progress(
        TextColumn("{task.description}", markup=False),
        BarColumn(20),
        TextColumn("{task.fields[what]}"),
        TimeElapsedColumn(),
        console=console,
        transient=True,
        disable=quiet or not (sys.stderr.isatty() and console.is_interactive),
    )
