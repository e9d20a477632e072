"""`sono measure FILE...`: what curves measure, as they are."""

import sys
from collections.abc import Sequence
from dataclasses import replace
from functools import partial
from typing import TYPE_CHECKING, Literal

import click

from sono import tables
from sono.cli import options
from sono.cli.each import each, file_of

if TYPE_CHECKING:
    from sono.formats import Close, VertexFile
    from sono.jobs.sources import Source

OF_CHAINS = ("knot", "file", "components", "n", "length", *(key for key in tables.SHAPE if key != "contacts"))
"""What can be told of an open chain as it is."""


@click.command("measure")
@options.files
@click.option("--residual", is_flag=True, help="Add how far the forces in the rope are from balance.")
@click.option("--all", "everything", is_flag=True, help="Add all descriptors of shape, in a time like n^2.")
@options.close
@options.table((*tables.DEFAULT, "dispersion", "r_s", "file"), "measure")
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

    Descriptors of an open chain are of its own vertices and edges, also where --close closes it for the rest.
    With no columns but these, n, length, knot and file, none needs be closed.

    \b
      sono measure --residual trefoil.n480.txt
      sono measure trefoil.n480.txt --columns knot,writhe,acn
    """
    wanted = [*(tables.SHAPE if everything else ()), *(["residual"] if residual else ())]
    shown = replace(shown, columns=list(dict.fromkeys([*shown.columns, *wanted])))
    with shown.table() as table:

        def measure(source: "Source") -> list[str]:
            row, doubts = _measured(source, shown.columns)
            table.row(row)
            return doubts

        code = each(sources, close or _left_open(shown.columns), measure, shown.tell)
    sys.exit(code)


def _left_open(columns: Sequence[str]) -> 'Literal["open"] | None':
    """Leave chains open if all that is asked of them is known without a closure."""
    return "open" if {*columns} <= {*OF_CHAINS} else None


def _measured(source: "Source", columns: Sequence[str]) -> tuple[tables.Row, list[str]]:
    """Return the row of a curve, and what is doubtful about it. Raises `FormatError`."""
    # Imported here, since numpy would make --help wait.
    from sono.curve import forces
    from sono.jobs.curvefiles import measures_of
    from sono.jobs.result import as_row, shape_of
    from sono.patience import patiently

    curve = file_of(source, "measure", "measures")
    doubts = curve.doubts()
    file = f"{curve.name}:{curve.key}" if curve.key else curve.name
    if source.close == "open" and not all(curve.rings):
        return _of_chains(curve) | {"knot": source.name, "file": file}, doubts
    measures = measures_of(curve)
    if measures.l_c is None and "l_c" in columns:
        doubts.append(f"{file}: no L_c, since R_s <= dl/sqrt 2; refine the curve")
    more: dict[str, tables.Value] = {}
    if "residual" in columns:
        more["residual"] = patiently(partial(forces, curve.components)).residual
    if {*columns} & {*tables.SHAPE}:
        more |= patiently(partial(shape_of, curve.chains, curve.rings))
    return as_row(source.name, file, measures, **more), doubts


def _of_chains(curve: "VertexFile") -> dict[str, tables.Value]:
    """Return what can be told of open chains, and of rings beside them."""
    from sono.jobs.result import shape_of
    from sono.patience import patiently
    from sono.strands import length

    size = {"n": sum(map(len, curve.chains)), "components": len(curve.chains)}
    shape = patiently(partial(shape_of, curve.chains, curve.rings))
    return {**size, "length": length(curve.chains, curve.rings), **shape}
