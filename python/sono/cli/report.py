"""`sono report FOLDER|FILE|NAME|FAMILY... -o SITE`: pages of many ropes for a browser."""

import os
import re
import sys
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

import click

from sono.cli import options, places
from sono.cli.each import rope_of
from sono.cli.reported import atlas, gathered
from sono.cli.streams import complain

if TYPE_CHECKING:
    from sono.figures.report.ropes import Rope
    from sono.formats import Close
    from sono.jobs.sources import Source

_UNSAFE = re.compile(r"[^\w+().,#^{}-]")
"""What of a name is not taken into the names of a rope's files."""


@dataclass(frozen=True)
class Task:
    """A rope to be written into the folder `site`: its source, and where its files are there."""

    site: str
    source: "Source"
    at: str


@click.command("report")
@click.argument("given", metavar="FOLDER|FILE|NAME|FAMILY...", nargs=-1, required=True)
@click.option("-o", "--output", metavar="SITE", required=True, help="The folder to write pages into.")
@click.option("--title", help="What the first page is called.  [default: what is given]")
@click.option("-j", "--jobs", type=click.IntRange(1, options.MOST_JOBS), default=1, show_default=True,
              help="Ropes worked on at the same time.")  # fmt: skip
@options.close
@options.force
@click.option("-q", "--quiet", is_flag=True, help="No progress and no messages but errors.")
def command(
    given: tuple[str, ...],
    output: str,
    title: str | None,
    jobs: int,
    close: "Close | None",
    force: bool,
    quiet: bool,
) -> None:
    """Write pages that show many ropes in a browser: a table to sort and to search, and a page of each rope.

    A FOLDER stands for the files of curves in it, atlas for all ropes of the atlas, and a FAMILY (knots,
    links, composites, torus) for those that it has of that. A rope's page shows it in the round, with what it
    measures, what is published, its vertices and the certificate of its L_c. SITE/index.html is the table; no
    network is needed.

    \b
      sono report atlas -o site/
      sono tighten 3_1 4_1 5_1 -n 120,240 -o tight/ && sono report tight/ -o pages/
    """
    from sono.figures.report.site import INDEX, finish
    from sono.formats import FormatError

    index = os.path.join(output, INDEX)
    if os.path.exists(index) and not force:
        raise click.UsageError(f"{index} exists; --force overwrites it, -o names another folder")
    sources, code = gathered(given, close, quiet)
    if sources:
        places.make_folder(output)
    made = list(_told(_made_all(list(_tasks(sources, output)), jobs), len(sources), quiet))
    ropes = [rope for rope in made if rope]
    if not ropes:
        sys.exit(1)
    try:
        finish(Path(output), ropes, title or _title(given))
    except FormatError as error:
        complain(str(error))
        sys.exit(1)
    if not quiet:
        count = "1 rope" if len(ropes) == 1 else f"{len(ropes)} ropes"
        complain(f"{index}: {count}, to be opened in a browser")
    sys.exit(max(code, int(len(ropes) < len(made))))


def _title(given: Sequence[str]) -> str:
    names = [os.path.basename(one.rstrip("/" + os.sep)) or one for one in given]
    return "Ropes: " + ", ".join(names[:3]) + (", ..." if len(names) > 3 else "")


def _tasks(sources: "Sequence[Source]", site: str) -> Iterator[Task]:
    """Say where the files of each rope are: each at a place of its own, on whatever file system."""
    from sono.figures.report.ropes import family

    taken: set[str] = set()
    for source in sources:
        stem = _UNSAFE.sub("_", source.stem).lstrip(".") or "rope"
        folder, number = family(source.name), 1
        at = f"{folder}/{stem}"
        while at.casefold() in taken:
            number += 1
            at = f"{folder}/{stem}-{number}"
        taken.add(at.casefold())
        yield Task(site, source, at)


def _made_all(tasks: Sequence[Task], jobs: int) -> "Iterator[Rope | str]":
    """Make ropes, in other processes if there is more than one job."""
    if min(jobs, len(tasks)) <= 1:
        yield from map(_made, tasks)
        return
    from concurrent.futures import ProcessPoolExecutor
    from concurrent.futures.process import BrokenProcessPool
    from multiprocessing import active_children, get_context

    with ProcessPoolExecutor(jobs, get_context("spawn"), initializer=_in_another) as pool:
        try:
            yield from pool.map(_made, tasks, chunksize=4)
        except BrokenProcessPool as error:  # the system kills those that take too much
            raise MemoryError from error
        except BaseException:
            for process in active_children():
                process.terminate()
            pool.shutdown(cancel_futures=True)
            raise


def _in_another() -> None:
    """Leave Ctrl-C to the process that waits for this one, and end when that does, however it ends."""
    import signal
    from threading import Thread

    signal.signal(signal.SIGINT, signal.SIG_IGN)
    Thread(target=_end_with_parent, daemon=True).start()


def _end_with_parent() -> None:
    from multiprocessing import parent_process

    if parent := parent_process():
        parent.join()
        os._exit(1)


def _made(task: Task) -> "Rope | str":
    """Write the files of a rope, or say what is wrong with it."""
    from sono.figures.report.ropes import written
    from sono.formats import FormatError
    from sono.jobs.curvefiles import measures_of
    from sono.patience import patiently
    from sono.starts.shapes import place

    try:
        curve = rope_of(task.source)
        measures_of(curve)  # says in which line it is none
        knot = place(task.source.given).knot if task.source.knot else ""
        _, row = atlas().get(knot, ("", {}))
        rope = patiently(lambda: written(Path(task.site), task.at, task.source.name, curve, row))
        rope.doubts.extend(curve.doubts())
        return rope
    except FormatError as error:
        return str(error)


def _told(made: "Iterator[Rope | str]", count: int, quiet: bool) -> "Iterator[Rope | None]":
    """Show how far it is, and tell what is wrong with a rope, for which there is None, or doubtful."""
    from sono.cli.runner import bar

    with bar(quiet) as progress:
        task = progress.add_task("ropes", total=count, what="")
        for rope in made:
            progress.update(task, advance=1)
            for line in [rope] if isinstance(rope, str) else [] if quiet else rope.doubts:
                complain(line)
            yield None if isinstance(rope, str) else rope
