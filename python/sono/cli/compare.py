"""`sono compare TABLE...`: our ropelengths beside the published ones."""

import sys

import click

from sono import tables
from sono.cli import options

COLUMNS = ("knot", "n", "l_a", "l_c", "published", "source", "l_a_difference", "l_c_difference")


@click.command("compare")
@click.argument("sources", metavar="TABLE...", nargs=-1, required=True)
@click.option(
    "--published",
    "published_file",
    metavar="TABLE",
    help="Compare with this table's column published, or else L_a.  [default: ACPR 2011 and KnotInfo]",
)
@options.table(COLUMNS)
@options.quiet
def command(
    sources: tuple[str, ...], published_file: str | None, format_: str | None, columns: list[str], quiet: bool
) -> None:
    """Put the published ropelength beside each row of a TABLE, which sono wrote as TSV, CSV or JSON.

    A negative difference is ours being shorter. The difference of L_c, a proven bound up to rounding, is that
    of the finer level where the table has one. `-` is standard input:

    \b
      sono measure knots/tight/*.txt | sono compare -
    """
    from sono import published
    from sono.formats import FormatError

    count = {"l_a_difference": 0, "l_c_difference": 0}
    total = unknown = 0
    failed = False
    try:
        bounds = published.from_file(published_file) if published_file else published.table()
    except FormatError as error:
        options.complain(str(error))
        sys.exit(1)
    with options.writer(format_, columns) as table:
        for source in sources:
            try:
                rows = tables.read(source)
            except FormatError as error:
                failed = True
                options.complain(str(error))
                continue
            for row in rows:
                beside = published.beside(row, bounds)
                table.row(beside)
                total += beside["published"] is not None
                unknown += beside["published"] is None
                for key in count:
                    difference = beside.get(key)
                    count[key] += isinstance(difference, float) and difference <= 0
    if not quiet and total:
        l_a, l_c = count.values()
        options.complain(f"of {total} rows L_a is at most the published value in {l_a}, L_c in {l_c}")
    if not quiet and unknown:
        options.complain(f"of {unknown} rows no ropelength is published under the name they have")
    sys.exit(1 if failed else 0)
