"""`sono view FILE|NAME...`: a page that shows ropes in the round."""

import os
import sys
from collections.abc import Sequence
from typing import TYPE_CHECKING

import click

from sono.cli import options
from sono.cli.each import each, rope_of, waited

if TYPE_CHECKING:
    from sono.curve import Components
    from sono.formats import Close, VertexFile
    from sono.jobs.sources import Source

SUFFIXES = (".html", ".htm")


@click.command("view")
@click.argument("given", metavar="FILE|NAME...", nargs=-1, required=True)
@options.output("The page, .html; - is standard output.  [default: NAME.html, of the first curve]")
@options.close
@options.force
@click.option("-q", "--quiet", is_flag=True, help="No messages but errors.")
def command(
    given: tuple[str, ...], output: str | None, close: "Close | None", force: bool, quiet: bool
) -> None:
    """Write a page that shows ropes in the round, with the contacts between their strands, for any browser.

    A FILE is scaled to R = 1; - is standard input. A NAME is the rope that the atlas has of the knot. Of
    several curves one is shown at a time. The page is one file and needs no network.

    \b
      sono view 8_18
      sono view trefoil.n15.txt trefoil.n60.txt trefoil.n480.txt -o trefoils.html
    """
    if output is not None:
        _check(output, force)
    taken: list[tuple[Source, VertexFile]] = []

    def take(source: "Source") -> None:
        from sono.jobs.curvefiles import measures_of

        curve = rope_of(source)
        measures_of(curve)  # says in which line it is none
        for doubt in [] if quiet else curve.doubts():
            options.complain(doubt)
        taken.append((source, curve))

    code = each(given, close, take)
    if not taken:
        sys.exit(1)
    if output is None:
        output = f"{taken[0][0].stem}.html"
        _check(output, force)
    curves = [(source.name, curve.components) for source, curve in taken]
    sys.exit(_written(output, curves, quiet) or code)


def _check(output: str, force: bool) -> None:
    """Refuse a file that is no page by its name, or that is there."""
    from sono import formats

    if not formats.is_stream(output) and not output.lower().endswith(SUFFIXES):
        raise click.UsageError(f"{output}: a page is called .html; -o names it")
    if os.path.isfile(output) and not force:
        raise click.UsageError(f"{output} exists; --force overwrites it, -o names another place")


def _written(output: str, curves: "Sequence[tuple[str, Components]]", quiet: bool) -> int:
    """Write the page; return the exit code."""
    from sono import formats
    from sono.figures.view import page, titled

    count = sum(len(component) for _, components in curves for component in components)
    what = "" if quiet else f"the forces in ropes of {count:,} vertices take a while"
    html = waited(lambda: page(curves, titled([name for name, _ in curves])), what)
    try:
        formats.save(output, html)
    except formats.FormatError as error:
        options.complain(str(error))
        return 1
    if output != "-" and not quiet:
        options.complain(f"{output}: {len(html.encode()) / 1000:.0f} kB, to be opened in a browser")
    return 0
