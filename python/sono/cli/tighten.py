"""`sono tighten FILE...`: the paper's table of tight knots, and their vertices."""

import io
import os
import signal
import sys
import threading
from collections import Counter
from collections.abc import Iterator
from concurrent.futures import FIRST_COMPLETED, Future, ThreadPoolExecutor, wait
from contextlib import contextmanager
from itertools import chain, count
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from sono import tables
from sono.cli import options

if TYPE_CHECKING:
    from rich.progress import Progress as Bar
    from rich.progress import TaskID

    from sono.batch import Job, Result
    from sono.pipeline import Method, Progress


def _numbers(ctx: click.Context, param: click.Parameter, value: str) -> list[int]:
    """Return numbers separated by commas in increasing order."""
    try:
        numbers = sorted({int(number) for number in value.split(",")})
    except ValueError:
        raise click.BadParameter(f"{value!r}: give whole numbers such as 480 or 120,240,480") from None
    if numbers[0] < 3:
        raise click.BadParameter("a closed curve has at least 3 vertices")
    return numbers


@click.command("tighten")
@options.files
@click.option(
    "-n",
    "targets",
    metavar="N[,N...]",
    callback=_numbers,
    default="480",
    show_default=True,
    help="Vertices; a list gives a row each.",
)
@click.option(
    "--method",
    type=click.Choice(["both", "sono", "polish"]),
    default="both",
    show_default=True,
    help="SONO to find a shape and the polish to make it exact, or one of them alone.",
)
@click.option(
    "--trials",
    type=click.IntRange(1),
    default=8,
    show_default=True,
    help="Shapes to find with the method both, unless the first 4 agree; the shortest is polished.",
)
@click.option(
    "-o",
    "--output",
    metavar="PATH",
    help="File or folder/ for the vertices, - for standard output.  [default: NAME.nN.txt in this folder]",
)
@click.option(
    "--contacts",
    metavar="PATH",
    help="File or folder/ for the forces in the tight rope, as TSV; in a folder NAME.nN.contacts.tsv.",
)
@click.option("--force", is_flag=True, help="Overwrite files that are there.")
@click.option(
    "--seed", type=click.IntRange(0, 2**64 - 1), default=0, help="Seed of the anneals.  [default: 0]"
)
@click.option(
    "--time-limit",
    type=click.FloatRange(0, min_open=True),
    metavar="SECONDS",
    help="Stop each FILE after this time.",
)
@click.option(
    "--set",
    "pairs",
    multiple=True,
    metavar="NAME=VALUE",
    help="Change a setting of SONO, such as anneal_sweeps=400000.",
)
@click.option(
    "-j",
    "--jobs",
    type=click.IntRange(1),
    default=1,
    show_default=True,
    help="Files worked on at the same time.",
)
@click.option(
    "--checkpoint",
    metavar="FOLDER",
    type=click.Path(file_okay=False),
    help="Keep the state of each run here.",
)
@click.option("--resume", is_flag=True, help="Go on from checkpoints; keep outputs that are there.")
@options.table((*tables.DEFAULT, "status"))
@options.quiet
def command(
    sources: tuple[str, ...],
    targets: list[int],
    method: "Method",
    trials: int,
    output: str | None,
    contacts: str | None,
    force: bool,
    seed: int,
    time_limit: float | None,
    pairs: tuple[str, ...],
    jobs: int,
    checkpoint: str | None,
    resume: bool,
    format_: str | None,
    columns: list[str],
    quiet: bool,
) -> None:
    """Tighten each FILE (- for standard input) and write a row for each N, as soon as it is finished.

    The rope has radius 1. L_p, L_c and L_a are what the written vertices measure. Where a run is stopped by
    Ctrl-C, SIGTERM or --time-limit, its best state is written to NAME.nN.best.txt. Standard input has the
    NAME stdin, or else stdin-2 and so on.
    """
    # Imported here, since numpy would make --help wait.
    from sono.batch import Job

    settings = _settings(seed, pairs)
    if force and resume:
        raise click.UsageError("--force starts anew, --resume keeps what is there; give one of them")
    fresh = not (force or resume)
    if contacts and method == "sono":
        raise click.UsageError("--contacts needs the polish; use the method both or polish")
    if output == contacts == "-":
        raise click.UsageError("standard output cannot hold both vertices and contacts; name a file for one")
    work = [
        Job(
            source,
            name,
            outputs,
            settings,
            method,
            trials,
            _forces(contacts, outputs, name, len(sources)),
            time_limit,
            _checkpoint(checkpoint, name),
            resume,
        )
        for source, name, outputs in _plan(sources, targets, output, fresh)
    ]
    paths = [path for job in work for path in job.files()]
    _refuse_to_overwrite(paths, fresh)
    for folder in {os.path.dirname(path) for path in paths}:
        _make_folder(folder or ".")
    if "-" in sources:
        # Here, since a signal does not reach a thread that waits for input.
        sys.stdin = io.TextIOWrapper(io.BytesIO(sys.stdin.buffer.read()))
    table = _table(format_, columns, "-" in (output, contacts), quiet)
    sys.exit(_Batch(table, quiet).run(work, jobs))


class _Batch:
    """Runs jobs in threads (Rust releases the interpreter), writes their rows, stops them upon a signal."""

    def __init__(self, table: tables.TableWriter, quiet: bool) -> None:
        self.table = table
        self.quiet = quiet
        self.bar = _bar(quiet)
        self.lock = threading.Lock()
        self.failed = False
        self.stop = ""
        self.signal = 0
        self.not_begun = 0

    def run(self, work: "list[Job]", jobs: int) -> int:
        """Return the exit code."""
        with self.signals_caught(), self.table, self.bar, ThreadPoolExecutor(jobs) as pool:
            _wait([pool.submit(self.do, job) for job in work])
        if self.not_begun:
            options.complain(f"{self.not_begun} of {len(work)} files were not begun")
        return 128 + self.signal if self.signal else int(self.failed)

    def do(self, job: "Job") -> None:
        """Do one job; whatever is wrong with it stays with it."""
        from sono import batch

        with self.lock:
            if self.stop:
                self.not_begun += 1
                return
            task = self.bar.add_task(job.name, total=1, what="")
        try:
            for result in batch.run(job, lambda progress: self.watch(task, progress)):
                with self.lock, self.bar_hidden():
                    self.show(result)
        except BaseException:
            self.stop = "the table cannot be written"
            raise
        finally:
            with self.lock:
                self.bar.remove_task(task)

    def show(self, result: "Result") -> None:
        """Write a row, and tell what is wrong with it."""
        try:
            if result.row:
                self.table.row(result.row)
        finally:
            if result.note and not self.quiet:
                options.complain(result.note)
            if result.trouble:
                self.failed = True
                options.complain(result.trouble)

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

    def watch(self, task: "TaskID", progress: "Progress") -> None:
        """Show the live state, and stop when it is time to."""
        from sono.pipeline import Stopped

        status = progress.status
        trial = f"trial {progress.trial} " if progress.stage in ("collapse", "anneal", "trial") else ""
        what = f"{trial}{progress.stage} n {progress.n}/{progress.target} L_p {status.best.l_p:.5f}"
        self.bar.update(task, completed=status.progress, what=what)
        if self.stop:
            raise Stopped(self.stop)

    @contextmanager
    def signals_caught(self) -> Iterator[None]:
        """Let Ctrl-C and SIGTERM, which batch systems send, stop the jobs, each at its next slice."""

        def stop(number: int, frame: Any) -> None:
            self.stop, self.signal = "interrupted", number

        before = {
            number: signal.signal(number, stop)
            for number in (signal.SIGINT, signal.SIGTERM)
            if signal.getsignal(number) != signal.SIG_IGN  # as a script has it for its background jobs
        }
        try:
            yield
        finally:
            for number, handler in before.items():
                signal.signal(number, handler)


def _wait(futures: "list[Future[None]]") -> None:
    """Wait in short steps, so that a signal is seen at once; raise what a thread did not expect."""
    pending = set(futures)
    while pending:
        done, pending = wait(pending, timeout=0.2, return_when=FIRST_COMPLETED)
        for future in done:
            future.result()


def _bar(quiet: bool) -> "Bar":
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


def _table(format_: str | None, columns: list[str], taken: bool, quiet: bool) -> tables.TableWriter:
    """The table, which leaves standard output to vertices or contacts if they go there."""
    if not taken:
        return options.writer(format_, columns)
    return options.writer(format_, columns, io.StringIO() if quiet else sys.stderr)


def _plan(
    sources: tuple[str, ...], targets: list[int], output: str | None, fresh: bool
) -> Iterator[tuple[str, str, dict[int, str]]]:
    """Give the name of each source, and where its vertices for each n go."""
    names = [options.knot_name(source) for source in sources]
    if output == "-" or (output and not output.endswith(("/", os.sep)) and not os.path.isdir(output)):
        if len(sources) * len(targets) > 1:
            raise click.UsageError(
                "-o names one file, but there are several results; name a folder (FOLDER/)"
            )
        yield sources[0], names[0], {targets[0]: output}
        return
    for source, name in zip(sources, names, strict=True):
        files = (
            {n: os.path.join(output or "", f"{stem}.n{n}.txt") for n in targets}
            for stem in chain([name], (f"{name}-{number}" for number in count(2)))
        )
        # Nobody chose the name "stdin", so a pipe that is run again takes the next one.
        free = (paths for paths in files if not any(map(os.path.exists, paths.values())))
        yield source, name, next(free if source == "-" and fresh else files)


def _forces(path: str | None, outputs: dict[int, str], name: str, sources: int) -> dict[int, str]:
    """Say where the forces for each n go."""
    if path is None:
        return {}
    if not path:
        raise click.UsageError("--contacts needs the name of a file or folder/")
    if path.endswith(("/", os.sep)) or os.path.isdir(path):
        stems = {n: f"{name}.n{n}" if file == "-" else Path(file).stem for n, file in outputs.items()}
        return {n: os.path.join(path, f"{stem}.contacts.tsv") for n, stem in stems.items()}
    if len(outputs) * sources > 1:
        raise click.UsageError("--contacts names one file, but there are several results; name a folder/")
    return dict.fromkeys(outputs, path)


def _checkpoint(folder: str | None, name: str) -> Path | None:
    return Path(folder, f"{name}.checkpoint.json") if folder else None


def _refuse_to_overwrite(paths: list[str], fresh: bool) -> None:
    for path, times in Counter(paths).items():
        if times > 1:
            raise click.UsageError(f"{times} of the files would write {path}; rename one of them")
        if fresh and os.path.exists(path):
            raise click.UsageError(
                f"{path} exists; --force starts anew, --resume goes on from it, -o names another place"
            )


def _make_folder(folder: str) -> None:
    """Make a folder, or make sure that it can be written to, before hours are spent."""
    try:
        os.makedirs(folder, exist_ok=True)
    except OSError as error:
        raise click.UsageError(f"{folder}: cannot be made: {error.strerror}") from error
    if not os.access(folder, os.W_OK):
        raise click.UsageError(f"{folder}: cannot be written to; -o names another folder")


def _settings(seed: int, pairs: tuple[str, ...]) -> dict[str, Any]:
    from sono.pipeline import check_settings, default_settings

    defaults = default_settings()
    settings = {}
    for pair in (f"seed={seed}", *pairs):
        name, _, value = pair.partition("=")
        try:
            settings[name] = _like(defaults.get(name), value)
            check_settings(settings)
        except ValueError as error:
            raise click.UsageError(f"--set {pair}: {error}") from error
    return settings


def _like(default: Any, value: str) -> Any:
    """Read a value that is of the kind of the default."""
    try:
        return value if default is None else type(default)(value)
    except ValueError:
        kind = "whole number" if isinstance(default, int) else "number"
        raise ValueError(f"{value!r} is no {kind}") from None
