"""`sono identify FILE...`: what knots or links curves are."""

import sys
from contextlib import nullcontext
from typing import TYPE_CHECKING

import click

from sono import tables
from sono.cli import options
from sono.cli.each import each, file_of

if TYPE_CHECKING:
    from sono.formats import Close
    from sono.jobs.sources import Source
    from sono.naming import Identity

COLUMNS = ("file", "knot", "known", "crossings")


@click.command("identify")
@options.files
@click.option("--pd", is_flag=True, help="Write PD codes, a line for each FILE, instead of a table.")
@options.close
@options.table(COLUMNS, "identify")
def command(sources: tuple[str, ...], pd: bool, close: "Close | None", shown: options.Shown) -> None:
    """Name the knot or link of curves: a row for each FILE, - for standard input, or each curve in it.

    Names are those of KnotInfo for prime knots to 13 crossings and of LinkInfo for prime links to 9, and
    T(p,q) for larger torus knots, and for links whose components run in parallel; m is the mirror image, # a
    connected sum, + stands between parts that are not linked, ? is a part that has no name.

    A name is proven where moves make the table's diagram of the curve's, or where this is a closed braid and
    its powers show it to be that of a torus knot. Where only invariants tell, all knots that share them are
    named, if a diagram has so few crossings that the table has its knot. What is not in the table has no
    other name. What is undecided has none: it has too many crossings for HOMFLY, or shares invariants with
    knots in the table, which may_be tells, but may be a larger knot.

    Further columns are may_be, components, determinant, signature, linking (numbers), alexander and homfly,
    which is in Regina's alpha (x) and z (y). The crossings are those of the curve's simplified diagram. Its
    PD code gives for each crossing the four edges, counter-clockwise from the incoming lower one.

    \b
      sono identify mystery.txt
      sono identify mystery.txt --columns file,knot,known,determinant,homfly
      sono identify mystery.txt --pd > mystery.pd
    """
    with nullcontext() if pd else shown.table() as table:

        def name(source: "Source") -> list[str]:
            doubts, found = _identified(source)
            if table:
                table.row(row(str(source), found))
            else:
                _write_pd(str(source), found, shown)
            return doubts

        code = each(sources, close, name, shown.tell)
    sys.exit(code)


def _identified(source: "Source") -> "tuple[list[str], Identity]":
    """Return what is doubtful about a curve, and what it is. Raises `FormatError`."""
    # Imported here, since numpy would make --help wait.
    from sono import naming
    from sono._core import CurveError
    from sono.formats import FormatError
    from sono.invariants import TooEntangledError
    from sono.jobs.curvefiles import located
    from sono.patience import patiently

    file = file_of(source, "identify", "identifies")
    try:
        return file.doubts(), patiently(lambda: naming.identify(file.components))
    except TooEntangledError as error:
        raise FormatError(f"{file.name}: {error}") from error
    except CurveError as error:
        raise located(error, file) from error


def row(name: str, found: "Identity") -> tables.Row:
    """Return the row of a curve."""
    linking = " ".join(map(str, found.linking)) or None
    may_be = " or ".join((*found.may_be, "not in the table")) if found.may_be else None
    return {**found.to_dict(), "file": name, "knot": found.name, "linking": linking, "may_be": may_be}


def _write_pd(name: str, found: "Identity", shown: options.Shown) -> None:
    """Write a PD code as KnotInfo does, on a line."""
    sys.stdout.write(str([list(code) for code in found.pd]).replace(" ", "") + "\n")
    if found.circles > (not found.pd):  # [] alone is read as a circle
        shown.tell(
            f"{name}: {found.circles} of {found.components} components have no crossings, and no trace here"
        )
