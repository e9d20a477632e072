"""`sono measure FILE...`: what curves measure, as they are."""

import sys

import click

from sono import tables
from sono.cli import options


@click.command("measure")
@options.files
@options.table((*tables.DEFAULT, "dispersion", "r_s"))
@options.quiet
def command(sources: tuple[str, ...], format_: str | None, columns: list[str], quiet: bool) -> None:
    """Measure curves: a row for each FILE, - for standard input.

    FILE holds rows of x y z, with # comments and a blank line between the components of a link; or it is a
    Geomview VECT file. Nothing is moved or scaled. L_c, a bound, is a dash where R_s <= dl/sqrt 2.
    """
    # Imported here, since numpy would make --help wait.
    from sono import batch
    from sono.formats import FormatError

    failed = False
    with options.writer(format_, columns) as table:
        for source in sources:
            try:
                curve, measures = batch.measured(source)
            except FormatError as error:
                failed = True
                options.complain(str(error))
                continue
            if measures.l_c is None and not quiet:
                options.complain(f"{curve.name}: no L_c, since R_s <= dl/sqrt 2; refine the curve")
            table.row(batch.as_row(options.knot_name(source), curve.name, measures))
    sys.exit(1 if failed else 0)
