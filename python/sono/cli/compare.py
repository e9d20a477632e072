"""`sono compare TABLE...`: our ropelengths beside the published ones."""

import sys
from collections.abc import Iterator
from typing import cast

import click

from sono import tables
from sono.cli import options
from sono.tables import Row

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
def command(sources: tuple[str, ...], published_file: str | None, shown: options.Shown) -> None:
    """Put the published ropelength beside each row of a TABLE, which sono wrote as TSV, CSV or JSON.

    A negative difference is ours being shorter. The difference of L_c, a proven bound up to rounding, is that
    of the finer level where the table has one. The limit is an estimate of a tight rope's L_a on ever finer
    edges, with its error. Where a row names a file that is there, the type of the curve is compared with the
    name. `-` is standard input:

    \b
      sono compare knots/atlas/knots.tsv
    """
    from sono.formats import FormatError
    from sono.tables import published

    compared: list[Row] = []
    failed = False
    try:
        bounds = published.from_file(published_file) if published_file else published.table()
    except FormatError as error:
        options.complain(str(error))
        sys.exit(1)
    with shown.table() as table:
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
                compared.append(beside)
                if not shown.quiet and (doubt := published.doubt(beside)):
                    options.complain(doubt)
    for line in _summary(compared, [str(row["knot"]) for row in compared if published.is_too_coarse(row)]):
        shown.tell(line)
    sys.exit(1 if failed else 0)


def _summary(rows: list[Row], coarse: list[str]) -> Iterator[str]:
    """Count the rows shorter than published, those too coarse to tell, and those of no known name."""
    known = [row for row in rows if row["published"] is not None]
    if known:
        l_a, l_c, limit = (
            sum(isinstance(row.get(key), float) and cast("float", row[key]) <= 0 for row in rows)
            for key in ("l_a_difference", "l_c_difference", "limit_difference")
        )
        shorter = f"L_a is at most the published value in {l_a}, L_c in {l_c}, the limit in {limit}"
        yield f"of {len(known)} rows {shorter}"
    if coarse:
        names = ", ".join(coarse[:SHOWN]) + (", ..." if len(coarse) > SHOWN else "")
        why = "edges too coarse to tell which is shorter: the error of the limit exceeds the difference"
        yield f"{len(coarse)} rows have {why}: {names}"
    if len(rows) > len(known):
        yield f"of {len(rows) - len(known)} rows no ropelength is published under the name they have"
