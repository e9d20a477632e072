"""`sono report FOLDER|FILE|NAME|FAMILY... -o SITE`: pages of many ropes for a browser."""

import os
import re
import sys
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

import click

import sono
from sono.cli import options, places
from sono.cli.each import rope_of
from sono.cli.reported import atlas, gathered
from sono.cli.streams import complain

if TYPE_CHECKING:
    from sono.figures.report.made import Made
    from sono.formats import Close, VertexFile
    from sono.jobs.sources import Source
    from sono.tables import Row

_UNSAFE = re.compile(r"[^\w+().,#^{}-]")
"""What of a name is not taken into the names of a rope's files."""


@dataclass(frozen=True)
class Task:
    """A rope for the folder `site`: its source, where its files are, and what an earlier run made there."""

    site: Path
    source: "Source"
    at: str
    earlier: "Made | None"


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
    network is needed. After Ctrl-C the same command goes on: a rope that SITE has is not made again, unless
    what it is made from has changed.

    \b
      sono report atlas -o site/
      sono tighten 3_1 4_1 5_1 -n 120,240 -o tight/ && sono report tight/ -o pages/
    """
    from sono.figures.report.site import INDEX

    index = os.path.join(output, INDEX)
    if os.path.exists(index) and not force:
        raise click.UsageError(f"{index} exists; --force overwrites it, -o names another folder")
    sources, code = gathered(given, close, quiet)
    if sources:
        places.make_folder(output)
    try:
        made = list(_told(_made_all(list(_tasks(sources, Path(output))), jobs), len(sources), quiet))
        finished = _finished(Path(output), made, title or _title(given))
    except KeyboardInterrupt:
        complain(f"{output}: is not finished; the same command goes on from what is made")
        raise
    if finished and not quiet:
        count = "1 rope" if len(made) == 1 else f"{len(made)} ropes"
        complain(f"{index}: {count}, to be opened in a browser")
    sys.exit(max(code, int(not finished or len(made) < len(sources))))


def _finished(site: Path, made: "Sequence[Made]", title: str) -> bool:
    """Write all pages, if there is a rope; tell whether they are there."""
    from sono.figures.report.made import keep_only
    from sono.figures.report.site import finish
    from sono.formats import FormatError

    try:
        if made:
            keep_only(site, made)
            finish(site, [one.rope for one in made], title)
    except FormatError as error:
        complain(str(error))
        return False
    return bool(made)


def _title(given: Sequence[str]) -> str:
    names = [os.path.basename(one.rstrip("/" + os.sep)) or one for one in given]
    return "Ropes: " + ", ".join(names[:3]) + (", ..." if len(names) > 3 else "")


def _tasks(sources: "Sequence[Source]", site: Path) -> Iterator[Task]:
    """Say where the files of each rope are: each at a place of its own, on whatever file system."""
    from sono.figures.report.made import earlier
    from sono.figures.report.ropes import family

    there = earlier(site)
    taken: set[str] = set()
    for source in sources:
        stem = _UNSAFE.sub("_", source.stem).lstrip(".") or "rope"
        folder, number = family(source.name), 1
        at = f"{folder}/{stem}"
        while at.casefold() in taken:
            number += 1
            at = f"{folder}/{stem}-{number}"
        taken.add(at.casefold())
        yield Task(site, source, at, there.get(at))


def _made_all(tasks: Sequence[Task], jobs: int) -> "Iterator[Made | str]":
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


def _made(task: Task) -> "Made | str":
    """Write the files of a rope, unless they are there from an earlier run, or say what is wrong with it."""
    from sono.formats import FormatError
    from sono.jobs.curvefiles import digest, measures_of
    from sono.starts.shapes import place

    try:
        curve = rope_of(task.source)
        measures_of(curve)  # says in which line it is none
        knot = place(task.source.given).knot if task.source.knot else ""
        _, row = atlas().get(knot, ("", {}))
        key = digest(curve, sono.__version__, task.source.name, row, [*curve.comments], curve.doubts())
        return _earlier(task, key) or _anew(task, key, curve, row)
    except FormatError as error:
        return str(error)


def _earlier(task: Task, key: str) -> "Made | None":
    """Return what an earlier run made of a rope, if it is what this one would make."""
    from sono.figures.report.made import checksum

    made = task.earlier
    fits = made and made.key == key and made.crc == checksum(task.site, made.rope)
    return made if fits else None


def _anew(task: Task, key: str, curve: "VertexFile", row: "Row") -> "Made":
    """Write the files of a rope, and write down that they are made. Raises `FormatError`."""
    from sono.figures.report.made import keep
    from sono.figures.report.ropes import written
    from sono.patience import patiently

    rope = patiently(lambda: written(task.site, task.at, task.source.name, curve, row))
    rope.doubts.extend(curve.doubts())
    return keep(task.site, key, rope)


def _told(made: "Iterator[Made | str]", count: int, quiet: bool) -> "Iterator[Made]":
    """Give ropes, and show how far it is, and tell what is doubtful, or wrong where there is none."""
    from sono.cli.runner import bar

    with bar(quiet) as progress:
        task = progress.add_task("ropes", total=count, what="")
        for one in made:
            progress.update(task, advance=1)
            for line in [one] if isinstance(one, str) else [] if quiet else one.rope.doubts:
                complain(line)
            if not isinstance(one, str):
                yield one
