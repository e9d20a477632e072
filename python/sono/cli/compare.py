"""`sono compare TABLE...`: our ropelengths beside the published ones."""

import sys
from collections.abc import Iterator
from itertools import chain
from typing import cast

import click

from sono import tables
from sono.cli import options
from sono.tables import Row

COLUMNS = (
    *("knot", "n", "l_a", "l_c", "limit", "limit_error", "published", "source"),
    *("l_a_difference", "l_c_difference", "limit_difference", "kind"),
)


def _sources(ctx: click.Context, param: click.Parameter, value: bool) -> None:
    """List the sources and leave."""
    if not value or ctx.resilient_parsing:
        return
    from sono.tables import reference

    for source in reference.sources().values():
        over = f"over the {source.per}: {source.place}"
        click.echo(f"{source.source}\n  {source.citation}\n  {over}\n  checked: {source.checked}")
    ctx.exit()


@click.command("compare")
@click.argument("sources", metavar="TABLE...", nargs=-1, required=True)
@click.option(
    "--published",
    "published_file",
    metavar="TABLE",
    help="Compare with this table's column published, or else L_a.  [default: those of --sources]",
)
@click.option("--all", "all_", is_flag=True, help="A row for each published value, estimates too.")
@click.option(
    "--sources",
    "listed",
    is_flag=True,
    is_eager=True,
    expose_value=False,
    callback=_sources,
    help="List where published values are from, and what was checked of them.",
)
@options.table(COLUMNS)
def command(sources: tuple[str, ...], published_file: str | None, all_: bool, shown: options.Shown) -> None:
    """Put the published ropelength beside each row of a TABLE, which sono wrote as TSV, CSV or JSON.

    A negative difference is ours being shorter. The difference of L_c, a proven bound up to rounding, is that
    of the finer level where the table has one. The limit is an estimate of a tight rope's L_a on ever finer
    edges, with its error. Where a row names a file that is there, the type of the curve is compared with the
    name. `-` is standard input.

    Any name of `sono start` will do, of any mirror image or orientation. Of several published values the
    shortest one counts that is exact, or else a bound, or else another, but no estimate. All are over the
    radius; the columns printed and per tell what the source has.

    \b
      sono tighten 3_1 4_1 -n 240 | sono compare -
    """
    from sono.formats import FormatError
    from sono.tables import published

    if all_ and published_file:
        raise click.UsageError("--all is of the built-in table; give either --all or --published")
    try:
        bounds = published.from_file(published_file) if published_file else published.table()
    except FormatError as error:
        options.complain(str(error))
        sys.exit(1)
    compared: list[Row] = []
    unread: list[str] = []
    with shown.table() as table:
        for row in chain.from_iterable(_read(source, unread) for source in sources):
            ours = published.extrapolated(row)
            compared.append(published.beside(ours, bounds, published.VALUE))
            for each in published.beside_all(ours) if all_ else compared[-1:]:
                table.row(each)
            if not shown.quiet and (doubt := published.doubt(compared[-1])):
                options.complain(doubt)
    for line in _summary(compared):
        shown.tell(line)
    sys.exit(1 if unread else 0)


def _read(source: str, unread: list[str]) -> list[Row]:
    """Return the rows of a table; where it is none, say so, and note it in `unread`."""
    from sono.formats import FormatError

    try:
        return tables.read(source)
    except FormatError as error:
        options.complain(str(error))
        unread.append(source)
        return []


def _summary(rows: list[Row]) -> Iterator[str]:
    """Count the rows shorter than published, those too coarse to tell, and those of no known name.

    What is exact is left out: no rope is shorter, and of an estimate that is there is nothing to say.
    """
    from sono.tables import published

    counted = [row for row in rows if row["published"] is not None and row["kind"] != "exact"]
    if counted:
        l_a, l_c, limit = (
            sum(isinstance(row.get(key), float) and cast("float", row[key]) <= 0 for row in counted)
            for key in ("l_a_difference", "l_c_difference", "limit_difference")
        )
        shorter = f"L_a is at most the published value in {l_a}, L_c in {l_c}, the limit in {limit}"
        yield f"of {len(counted)} rows {shorter}"
    if coarse := [str(row["knot"]) for row in counted if published.is_too_coarse(row)]:
        why = "edges too coarse to tell which is shorter: the error of the limit exceeds the difference"
        yield f"{len(coarse)} rows have {why}: {published.listed(coarse)}"
    if unknown := list(dict.fromkeys(str(row["knot"]) for row in rows if row["published"] is None)):
        cure = "`sono identify FILE` says what a curve is called, and 3_1.txt is compared with 3_1"
        yield f"no ropelength is published under the names {published.listed(unknown)}; {cure}"
    yield from published.claims(rows)
