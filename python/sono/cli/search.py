"""`sono search NAME|FILE...`: the shortest tight rope of a knot, from many starts."""

import os
import sys
from collections.abc import Iterator
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from sono import tables
from sono.cli import options, places
from sono.cli.runner import Batch

if TYPE_CHECKING:
    from sono.jobs.sources import Source

COLUMNS = (*tables.DEFAULT, "residual", "hits", "trials", "variant", "status")


@click.command("search")
@options.knots
@click.option(
    "--trials", type=click.IntRange(1, 10**6), help="Starts to try.  [default: 64, or until the time limit]"
)
@options.time_limit(
    "End the search of each knot after this time, and trials before the last 30 % of it, 18 s at most, which "
    "are for refining; twice as much with another --dl."
)
@click.option(
    "--dl",
    type=options.Number(0.005, 0.5),
    default=0.2,
    show_default=True,
    help="Edge length of the ropes at the end, in radii.",
)
@click.option(
    "--minima",
    type=click.IntRange(1),
    default=5,
    show_default=True,
    metavar="M",
    help="Rows for each knot: its M shortest minima.",
)
@options.output("File or folder/ for the vertices of the shortest.  [default: NAME.tight.txt in this folder]")
@options.force
@options.other_starts
@options.parallel("Trials made at the same time.")
@options.checkpoint("Keep the state of each search here.")
@options.resume("finished")
@options.table(COLUMNS)
def command(
    sources: "list[Source]",
    trials: int | None,
    time_limit: float | None,
    dl: float,
    minima: int,
    output: str | None,
    force: bool,
    seed: int,
    pool: options.Pool,
    checkpoint: str | None,
    resume: bool,
    shown: options.Shown,
) -> None:
    """Search for the shortest tight rope of each knot, a NAME such as 8_20 or a FILE, or each curve in it.

    Each trial tightens another starting conformation on few beads; the most promising shapes are refined and
    polished. The rows are the shortest minima found: hits tells in how many trials. The best rope so far is
    always in NAME.tight.txt.

    \b
      sono search 8_4 --time-limit 60
      sono search 6_1 9_1 --trials 64 --jobs 2 -o found/
    """
    # Imported here, since numpy would make --help wait.
    from sono.jobs.search import SearchJob

    fresh = places.fresh(force, resume)
    trials = trials or (None if time_limit else 64)
    with pool.workers() as workers:
        same: dict[str, Any] = {"time_limit": time_limit, "seed": seed, "dl": dl, "minima": minima}
        work = [
            SearchJob(
                *(source, source.name, path, workers, trials),
                checkpoint=_checkpoint(checkpoint, source.stem),
                resume=resume,
                **same,
            )
            for source, path in _plan(sources, output)
        ]
        places.prepare([path for job in work for path in job.files()], fresh)
        options.tell_of_shadows(sources, shown)
        sys.exit(Batch(shown.table(output == "-"), shown.quiet).run(work, workers.count))


def _checkpoint(folder: str | None, name: str) -> Path | None:
    return Path(folder, f"{name}.search.json") if folder else None


def _plan(sources: "list[Source]", output: str | None) -> "Iterator[tuple[Source, str]]":
    """Say where each source's vertices go."""
    for source in sources:
        if output and places.names_one_file(output):
            if len(sources) > 1:
                raise click.UsageError("-o names one file for several knots; name a folder (FOLDER/)")
            places.check_suffix(output)
            yield source, output
        else:
            yield source, os.path.join(output or "", f"{source.stem}.tight.txt")
