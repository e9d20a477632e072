"""`sono verify A B`: whether two curves are the same knot or link."""

import sys
from typing import TYPE_CHECKING

import click

from sono import tables
from sono.cli import options

if TYPE_CHECKING:
    from sono.formats import Close, VertexFile

COLUMNS = ("file", "other", "verdict", "known", "differs")


@click.command("verify")
@click.argument("one", metavar="A")
@click.argument("other", metavar="B")
@options.close
@options.table(COLUMNS)
def command(one: str, other: str, close: "Close | None", shown: options.Shown) -> None:
    """Tell whether A and B are the same knot or link: files, - for standard input, or names of knots.

    The verdict is same, mirror images, different or undecided. It is proven where moves make one diagram of
    the other, or both diagrams of knots in the table, or both are closed braids and torus knots; else it is
    known by invariants: linking numbers, signatures, Alexander and HOMFLY polynomials. That these agree is
    evidence and no proof; that one of them differs decides. What shares them with several types is undecided,
    and so is what has too many crossings for HOMFLY.

    It does not matter in which order a link's components come, nor whether all are reversed. Further columns
    are knot and other_knot, the names. The exit code is 0 for the same, and else 1:

    \b
      sono verify 8_18 8_18.n960.txt
    """
    from sono.formats import FormatError  # here, since numpy would make --help wait

    if one == other == "-":
        raise click.UsageError("only one of A and B can be standard input")
    options.tell_of_shadows((one, other), shown)
    try:
        row, doubts = _compared(one, other, close)
    except FormatError as error:
        options.complain(str(error))
        sys.exit(1)
    for doubt in doubts:
        shown.tell(doubt)
    with shown.table() as table:
        table.row(row)
    sys.exit(0 if row["verdict"] == "same" else 1)


def _compared(one: str, other: str, close: "Close | None") -> tuple[tables.Row, list[str]]:
    """Return the row, and what is doubtful about the curves. Raises `FormatError`."""
    from sono import naming
    from sono._core import CurveError
    from sono.formats import FormatError
    from sono.invariants import TooEntangledError
    from sono.patience import patiently

    here, there = (_file(given, close) for given in (one, other))
    try:
        found = patiently(lambda: naming.verify(here.components, there.components))
    except TooEntangledError as error:
        raise FormatError(f"{one}, {other}: {error}") from error
    except CurveError:
        _refuse_crossing(here, there)
        raise
    names = {"knot": found.name, "other_knot": found.other_name}
    return {"file": one, "other": other, **names, **found.to_dict()}, [*here.doubts(), *there.doubts()]


def _file(given: str, close: "Close | None") -> "VertexFile":
    """Return a curve as from a file. Raises `FormatError`."""
    from sono.formats import FormatError
    from sono.jobs.sources import curves

    found = curves(given, close)
    if len(found) != 1:
        raise FormatError(f"{given}: holds {len(found)} curves; give one of them, such as {found[0]}")
    return found[0].read()


def _refuse_crossing(*files: "VertexFile") -> None:
    """Raise `FormatError` for the first curve that crosses itself."""
    from sono._core import CurveError
    from sono.invariants.crossings import simplify
    from sono.jobs.curvefiles import located

    for file in files:
        try:
            simplify(file.components)
        except CurveError as error:
            raise located(error, file) from error
