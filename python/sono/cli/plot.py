"""`sono plot KIND FILE|NAME... -o PICTURE`: pictures of ropes and of tables."""

import os
import sys
from collections.abc import Sequence
from typing import TYPE_CHECKING

import click

from sono.cli import options
from sono.cli.pictured import Pictured
from sono.figures.plot import sheet

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

    from sono.formats import Close

SIZES = {
    "atlas": (3.4, 2.2),
    "contacts": (3.4, 2.9),
    "convergence": (3.4, 2.7),
    "curvature": (3.4, 2.2),
    "knot": (3.4, 3.4),
    "minima": (3.4, 2.1),
    "model": (3.4, 2.1),
}
"""The kinds, and how large a panel is, in inches: as wide as a column of a paper."""


@click.command("plot")
@click.argument("kind", type=click.Choice(list(SIZES)))
@click.argument("given", metavar="[FILE|NAME]...", nargs=-1)
@click.option("-o", "--output", metavar="PICTURE", required=True, help="A .png, .svg or .pdf; - is a PNG.")
@click.option("--style", type=click.Choice(sheet.STYLES), default="light", show_default=True, help="Colours.")
@click.option("--beads", is_flag=True, help="Draw the beads of a knot instead of a smooth tube.")
@options.close
@options.force
@click.option("-q", "--quiet", is_flag=True, help="No messages but errors.")
def command(
    kind: str,
    given: tuple[str, ...],
    output: str,
    style: sheet.Style,
    beads: bool,
    close: "Close | None",
    force: bool,
    quiet: bool,
) -> None:
    """Draw a picture; needs the extra sono[plot]. A NAME is the rope that the atlas has of the knot.

    \b
      knot         ropes as one sees them, side by side; coloured by component
      curvature    curvature and torsion along each rope
      contacts     which beads press against each other in each rope, and how hard
      convergence  L_p, L_c and L_a of one knot's ropes, or tables of them, against dl, with fits
      minima       lengths and hits in tables of `sono search`
      atlas        lengths of the atlas, or of tables like its, against crossing number
      model        the toroidal model; takes no FILE

    Lengths are in radii, ropelengths are lengths over the RADIUS.

    \b
      sono plot knot 3_1 L6a4 -o knots.png
      sono tighten 3_1 -n 240,480,960,1920 | sono plot convergence - -o 3_1.pdf
    """
    suffix = _checked(kind, given, output, beads, force)
    from sono.formats import save  # here, since numpy would make --help wait

    read = Pictured(given, close, options.Shown(None, [], quiet))
    try:
        with sheet.style(style):
            save(output, sheet.saved(_figure(kind, read, beads), suffix))
    except ValueError as error:
        options.complain(str(error))
        sys.exit(1)
    sys.exit(read.code)


def _checked(kind: str, given: tuple[str, ...], output: str, beads: bool, force: bool) -> str:
    """Refuse a wrong call, before anything is read; return the suffix of the picture."""
    if given and kind == "model":
        raise click.UsageError("model takes no FILE")
    if not given and kind not in ("model", "atlas"):
        raise click.UsageError(f"give {kind} a FILE{'' if kind == 'minima' else ' or a NAME'}")
    if beads and kind != "knot":
        raise click.UsageError("--beads are those of a knot")
    try:
        suffix = sheet.suffix_of(output)
        sheet.library()
    except (ValueError, ImportError) as error:
        raise click.UsageError(str(error)) from error
    if output != "-" and os.path.exists(output) and not force:
        raise click.UsageError(f"{output} exists; --force overwrites it")
    return suffix


def _figure(kind: str, read: Pictured, beads: bool) -> "Figure":
    """Draw what was given. Raises `ValueError` where that is too little."""
    from sono import plot

    if kind in ("model", "atlas"):
        figure, axes = sheet.sheet(2, 1, SIZES[kind])
        if kind == "model":
            plot.model(axes=axes)
        else:
            plot.atlas(read.rows() if read.given else None, axes=axes)
    elif kind == "convergence":
        figure, axes = sheet.sheet(1, 1, SIZES[kind])
        plot.convergence(read.points(), axes=axes[0])
    elif kind == "minima":
        knots = read.searches()
        figure, axes = _panels(kind, list(knots))
        for panel, (knot, rows) in zip(axes, knots.items(), strict=True):
            plot.minima(rows, knot, axes=panel)
    elif kind == "knot":
        labels, ropes = zip(*read.ropes(), strict=True)
        figure, axes = sheet.sheet(1, 1, SIZES[kind])
        plot.knot(*ropes, axes=axes[0], beads=beads, labels=labels if len(ropes) > 1 else ())
    else:
        labels, ropes = zip(*read.ropes(), strict=True)
        figure, axes = _panels(kind, labels)
        for panel, rope in zip(axes, ropes, strict=True):
            (plot.contacts if kind == "contacts" else plot.curvature)(rope, axes=panel)
    return figure


def _panels(kind: str, titles: Sequence[str]) -> "tuple[Figure, list[Axes]]":
    """Return a figure with a panel for each title, two in a row, and the axes."""
    columns = min(len(titles), 2)
    figure, axes = sheet.sheet(-(-len(titles) // columns), columns, SIZES[kind])
    for panel in axes[len(titles) :]:
        panel.remove()
    for panel, title in zip(axes, titles, strict=False):
        panel.set_title(sheet.label(title) if len(titles) > 1 else "", loc="left")
    return figure, axes[: len(titles)]
