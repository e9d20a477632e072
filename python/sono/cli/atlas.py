"""`sono atlas`: the shortest known tight rope of every knot, checked or improved."""

import os
import sys
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING

import click

from sono.cli import options, places
from sono.cli.runner import Batch

if TYPE_CHECKING:
    from sono.jobs.atlas import Atlas

COLUMNS = ("knot", "n", "l_a", "l_c", "l_c_fine", "published", "l_a_difference", "l_c_difference", "type")


@click.command("atlas")
@click.argument("sources", metavar="[NAME|FILE]...", nargs=-1)
@click.option(
    "--folder",
    type=click.Path(file_okay=False),
    default="knots",
    show_default=True,
    help="Where atlas.tsv and tight/ are.",
)
@click.option("--update", is_flag=True, help="Search for shorter ropes, and take them in.")
@click.option(
    "--trials",
    type=click.IntRange(1, 10**6),
    default=64,
    show_default=True,
    help="Starts to try for each knot.",
)
@options.other_starts
@options.parallel("Trials made at the same time.")
@options.checkpoint("Keep the searches here; the next update goes on from them.", "atlas-search")
@options.table(COLUMNS)
def command(
    sources: tuple[str, ...],
    folder: str,
    update: bool,
    trials: int,
    seed: int,
    pool: options.Pool,
    checkpoint: str,
    shown: options.Shown,
) -> None:
    """Check the atlas, or with --update improve it; a row never gets worse.

    For each NAME, by default all prime knots up to 10 crossings, the rope in the atlas is measured and its
    type confirmed by invariants. With --update its search goes on to so many --trials, and what is shorter is
    taken in; so is a rope from a FILE called NAME.txt or NAME.more.txt. What is shorter than the shapes that
    the package carries, with which `sono tighten NAME` begins, takes their place. Only one process at a time
    may update a folder.
    """
    # Imported here, since numpy would make --help wait.
    from sono import starts
    from sono.jobs.atlas import Atlas
    from sono.jobs.atlasjob import AtlasJob, atlas_search
    from sono.jobs.search import spent

    atlas = Atlas(Path(folder))
    _refuse(sources, folder, update)
    names = sources or [row["knot"] for row in starts.table("knots")]
    options.tell_of_shadows(names, shown)
    with pool.workers() as workers:
        searches = partial(atlas_search, folder=checkpoint, workers=workers, trials=trials, seed=seed)
        work = [AtlasJob.of(atlas, source, searches if update else None) for source in names]
        paths = [path for job in work if job.search for path in job.search.files()]
        paths += [str(Path(folder, "atlas.tsv")), atlas.path("any")] if update else []
        places.prepare(paths, False)
        code = Batch(shown.table(), shown.quiet).run(work, workers.count)
    if update and code < 128:
        code = max(code, _refresh(atlas, shown))
    searched = [job.search.checkpoint for job in work if job.search]
    if searched:
        shown.tell(spent(searched))
    sys.exit(code)


def _refresh(atlas: "Atlas", shown: options.Shown) -> int:
    """Let the package carry what is shorter; return the exit code."""
    from sono.formats import FormatError
    from sono.jobs.shapes import refresh

    try:
        if shorter := refresh(atlas):
            shown.tell(f"`sono tighten` now begins with these ropes of: {', '.join(shorter)}")
    except FormatError as error:
        options.complain(str(error))
        return 1
    return 0


def _refuse(sources: tuple[str, ...], folder: str, update: bool) -> None:
    """Refuse what cannot be done."""
    if "-" in sources:
        raise click.UsageError("standard input has no name; give a file NAME.txt")
    if not update and not os.path.exists(os.path.join(folder, "atlas.tsv")):
        raise click.UsageError(f"{folder}/atlas.tsv: no such file; --folder says where, --update makes one")
    if not update and any(map(os.path.isfile, sources)):
        raise click.UsageError("give --update to take ropes from files into the atlas")
