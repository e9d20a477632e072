"""`sono compare TABLE...`: our ropelengths beside the published ones."""

import sys

import click

from sono import tables
from sono.cli import options

COLUMNS = (
    *("knot", "n", "l_a", "l_c", "limit", "limit_error", "published", "source"),
    *("l_a_difference", "l_c_difference", "limit_difference"),
)


SHOWN = 12
"""Knots that a message names at most."""


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
    of the finer level where the table has one. The limit is an estimate of a tight rope's L_a on ever finer
    edges, with its error. Where a row names a file that is there, the type of the curve is compared with the
    name. `-` is standard input:

    \b
      sono measure knots/tight/*.txt | sono compare -
    """
    from sono.formats import FormatError
    from sono.tables import published

    count = {"l_a_difference": 0, "l_c_difference": 0, "limit_difference": 0}
    coarse: list[str] = []
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
                beside = published.beside(published.extrapolated(row), bounds)
                table.row(beside)
                total += beside["published"] is not None
                unknown += beside["published"] is None
                for key in count:
                    difference = beside.get(key)
                    count[key] += isinstance(difference, float) and difference <= 0
                if published.is_too_coarse(beside):
                    coarse.append(str(row["knot"]))
                if not quiet and (doubt := published.doubt(beside)):
                    options.complain(doubt)
    if not quiet and total:
        l_a, l_c, limit = count.values()
        shorter = f"L_a is at most the published value in {l_a}, L_c in {l_c}, the limit in {limit}"
        options.complain(f"of {total} rows {shorter}")
    if not quiet and coarse:
        names = ", ".join(coarse[:SHOWN]) + (", ..." if len(coarse) > SHOWN else "")
        why = "edges too coarse to tell which is shorter: the error of the limit exceeds the difference"
        options.complain(f"{len(coarse)} rows have {why}: {names}")
    if not quiet and unknown:
        options.complain(f"of {unknown} rows no ropelength is published under the name they have")
    sys.exit(1 if failed else 0)
