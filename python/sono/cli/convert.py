"""`sono convert IN OUT`: curves from one format to another."""

import os
import sys
from collections import Counter
from collections.abc import Sequence
from typing import TYPE_CHECKING

import click

from sono.cli import options, places
from sono.cli.each import once

if TYPE_CHECKING:
    from sono.formats import Close
    from sono.jobs.sources import Source


@click.command("convert")
@click.argument("given", metavar="IN")
@click.argument("output", metavar="OUT")
@click.option(
    "--format", "format_", metavar="FORMAT", help="Format of OUT, such as vect.  [default: by its suffix]"
)
@options.close
@options.force
@click.option("-q", "--quiet", is_flag=True, help="No messages but errors.")
def command(
    given: str, output: str, format_: str | None, close: "Close | None", force: bool, quiet: bool
) -> None:
    """Write the curve IN, a file, FILE:KEY, - or the NAME of a knot, to OUT, a file, a folder/ or -.

    The suffix of OUT tells the format; .gz after it packs. Comments and every digit are kept where the format
    has room for them. Of a file that holds several curves, OUT holds all if it is a folder/ or .xyz.

    \b
      sono convert 8_18.n960.txt 8_18.obj
      sono convert 3_1 trefoil.json.gz
    """
    from sono.jobs.sources import curves  # here, since numpy would make --help wait

    format = _format(output, format_)
    plan = _plan(curves(given, close), output, format)
    if existing := next((path for path in plan if os.path.isfile(path) and not force), None):
        raise click.UsageError(f"{existing} exists; --force overwrites it")
    heard: list[Sequence[str]] = []
    done = [_converted(path, sources, format, heard) for path, sources in plan.items()]
    for doubt in once(heard) if not quiet else ():
        options.complain(doubt)
    sys.exit(0 if all(done) else 1)


def _format(output: str, named: str | None) -> str:
    """Tell in which format to write."""
    from sono import formats

    if named is None and places.names_one_file(output):
        places.check_suffix(output)
        return formats.by_suffix(output)
    named = named or formats.PLAIN
    if named not in formats.WRITERS:
        known = ", ".join(sorted(formats.WRITERS))
        raise click.UsageError(f"--format {named}: is no format that is written; there are: {known}")
    return named


def _plan(sources: "list[Source]", output: str, format: str) -> "dict[str, list[Source]]":
    """Say which curves go into which file."""
    from sono import formats

    if places.names_one_file(output):
        if len(sources) > 1 and format not in formats.FRAMED:
            cure = f"name a folder (FOLDER/), a file .xyz, or one of them: {sources[0]}"
            raise click.UsageError(f"IN holds {len(sources)} curves, {output} one; {cure}")
        return {output: sources}
    suffix = next(suffix for suffix, known in formats.SUFFIXES.items() if suffix and known == format)
    plan = {os.path.join(output, source.stem + suffix): [source] for source in sources}
    names = Counter(os.path.normcase(source.stem + suffix) for source in sources)
    if double := next((name for name, times in names.items() if times > 1), None):
        cure = "convert those curves one by one, as FILE:KEY"
        raise click.UsageError(f"{os.path.join(output, double)} would be written twice; {cure}")
    places.make_folder(output)
    return plan


def _converted(path: str, sources: "Sequence[Source]", format: str, heard: list[Sequence[str]]) -> bool:
    """Write what can be read of these curves, note doubts; tell of the others, and whether there are none."""
    from sono import formats

    files = []
    for source in sources:
        try:
            files.append(source.read())
        except formats.FormatError as error:
            options.complain(str(error))
    heard += [file.doubts() for file in files]
    try:
        if files:
            formats.write_all(path, [(file.components, file.comments) for file in files], format)
    except formats.FormatError as error:
        options.complain(str(error))
        return False
    return len(files) == len(sources)
