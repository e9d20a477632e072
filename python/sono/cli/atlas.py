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
@click.argument("sources", metavar="[NAME|FAMILY|FILE]...", nargs=-1)
@click.option(
    "--folder",
    type=click.Path(file_okay=False),
    help="Where the tables and the archives are.  [default: in the package]",
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
@options.parallel("Trials made at the same time, or ropes checked.")
@options.checkpoint("Keep the searches here; the next update goes on from them.", "atlas-search")
@options.table(COLUMNS)
def command(
    sources: tuple[str, ...],
    folder: str | None,
    update: bool,
    trials: int,
    seed: int,
    pool: options.Pool,
    checkpoint: str,
    shown: options.Shown,
) -> None:
    """Check the atlas, or with --update improve it; a row never gets worse.

    For each NAME, for all those of a FAMILY (knots, links, composites, torus), by default for all that there
    are, the rope in the atlas is measured and its type confirmed. With --update its search goes on to so many
    --trials, and what is shorter is taken in; so is a rope from a FILE called NAME.txt or NAME.more.txt. The
    ropes in the package are those with which `sono tighten NAME` begins. Only one process at a time may
    update a folder.

    \b
      sono atlas 8_18 3_1#3_1
    """
    # Imported here, since numpy would make --help wait.
    from sono.jobs.atlas import Atlas
    from sono.jobs.atlasjob import AtlasJob, atlas_search
    from sono.jobs.search import spent
    from sono.starts import shapes

    atlas = Atlas(Path(folder or str(shapes.FOLDER)))
    names = _named(sources, atlas, update)
    options.tell_of_shadows(names, shown)
    with pool.workers() as workers:
        searches = partial(atlas_search, folder=checkpoint, workers=workers, trials=trials, seed=seed)
        work = [AtlasJob.of(atlas, source, searches if update else None) for source in names]
        paths = [path for job in work if job.search for path in job.search.files()]
        paths += [path for family in atlas.families.values() for path in family.files] if update else []
        places.prepare(paths, False)
        code = Batch(shown.table(), shown.quiet).run(work, workers.count)
    searched = [job.search.checkpoint for job in work if job.search]
    if searched:
        shown.tell(spent(searched))
    sys.exit(code)


def _named(sources: tuple[str, ...], atlas: "Atlas", update: bool) -> list[str]:
    """Return the names and files, with those of families in their place, or refuse what cannot be done."""
    from sono.formats import FormatError

    if "-" in sources:
        raise click.UsageError("standard input has no name; give a file NAME.txt")
    if not update and any(map(os.path.isfile, sources)):
        raise click.UsageError("give --update to take ropes from files into the atlas")
    try:
        families = {name: list(family.rows) for name, family in atlas.families.items()}
    except FormatError as error:
        raise click.UsageError(str(error)) from error
    if not any(families.values()) and not (update and sources):
        raise click.UsageError(
            f"{atlas.folder}: no atlas is there; --folder says where one is, --update NAME makes one"
        )
    return [name for source in sources or families for name in families.get(source, [source])]
