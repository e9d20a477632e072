"""`sono measure FILE...`: what curves measure, as they are."""

import sys
from collections.abc import Sequence
from dataclasses import replace
from functools import partial
from typing import TYPE_CHECKING

import click

from sono import tables
from sono.cli import options
from sono.cli.each import each, file_of

if TYPE_CHECKING:
    from sono.formats import Close
    from sono.jobs.sources import Source


@click.command("measure")
@options.files
@click.option("--residual", is_flag=True, help="Add how far the forces in the rope are from balance.")
@click.option("--all", "everything", is_flag=True, help="Add all descriptors of shape, in a time like n^2.")
@options.close
@options.table((*tables.DEFAULT, "dispersion", "r_s", "file"))
def command(
    sources: tuple[str, ...],
    residual: bool,
    everything: bool,
    close: "Close | None",
    shown: options.Shown,
) -> None:
    """Measure curves: a row for each FILE, - for standard input, or for each curve in it; FILE:KEY is one.

    FILE holds rows of x y z, with # comments and a blank line between the components of a link, or a header
    that names the columns; or it is of another format that is read. Nothing is moved or scaled. L_c, a bound,
    is a dash where R_s <= dl/sqrt 2.

    The residual is the largest force, tension being 1, that is left over on a vertex when tensions, contact
    forces and bending couples balance as well as they can (non-negative least squares): 0 for a tight rope,
    below 1e-6 for a polished one.

    Descriptors tell shapes from each other. Of the crossings seen, in the mean over all directions, the
    writhe is the sum of signs, ACN the number; the self-writhe leaves out those between components, whose
    signs add up to twice the linking numbers. R_g is the radius of gyration of a wire, gyration 1 to 3 are
    the eigenvalues of its tensor, the diameter is the largest distance of two vertices. Total curvature and
    torsion are sums of angles in radians, the maximal curvature is 1/MinRad, contacts are pairs of vertices
    2 R_s apart. Any of them can be asked for alone: --columns knot,writhe,acn

    \b
      sono measure --residual trefoil.n480.txt
      sono measure trefoil.n480.txt --columns knot,writhe,acn
    """
    wanted = [*(tables.SHAPE if everything else ()), *(["residual"] if residual else ())]
    shown = replace(shown, columns=list(dict.fromkeys([*shown.columns, *wanted])))
    with shown.table() as table:

        def measure(source: "Source") -> None:
            row, doubts = _measured(source, shown.columns)
            for doubt in doubts:
                shown.tell(doubt)
            table.row(row)

        code = each(sources, close, measure)
    sys.exit(code)


def _measured(source: "Source", columns: Sequence[str]) -> tuple[tables.Row, list[str]]:
    """Return the row of a curve, and what is doubtful about it. Raises `FormatError`."""
    # Imported here, since numpy would make --help wait.
    from sono.curve import forces
    from sono.jobs.curvefiles import measures_of
    from sono.jobs.result import as_row, shape_of
    from sono.patience import patiently

    curve = file_of(source, "measure", "measures")
    measures = measures_of(curve)
    doubts = curve.doubts()
    file = f"{curve.name}:{curve.key}" if curve.key else curve.name
    if measures.l_c is None:
        doubts.append(f"{file}: no L_c, since R_s <= dl/sqrt 2; refine the curve")
    more: dict[str, tables.Value] = {}
    if "residual" in columns:
        more["residual"] = patiently(partial(forces, curve.components)).residual
    if {*columns} & {*tables.SHAPE}:
        more |= patiently(partial(shape_of, curve.components))
    return as_row(source.name, file, measures, **more), doubts
