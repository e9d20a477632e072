"""`sono export FILE|NAME... -o PATH`: ropes as solids, for printers."""

import os
import re
import shlex
import sys
from collections.abc import Callable
from dataclasses import dataclass, field
from functools import partial
from pathlib import PurePath
from typing import TYPE_CHECKING, Any

import click

from sono.cli import options, places
from sono.cli.each import each, knot_of, rope_of
from sono.cli.options import Function

if TYPE_CHECKING:
    from sono.curve import Components
    from sono.figures.lengths import Lengths
    from sono.figures.solids import Solid
    from sono.formats import Close, VertexFile
    from sono.jobs.sources import Source

LOOSE = 0.6
"""Residual of a curve that is no rope: that of tight ropes is near 0, of ropes of a few beads 0.4 at most."""

UNITS = {"": 1.0, "mm": 1.0, "cm": 10.0, "in": 25.4}


def _length(ctx: click.Context, param: click.Parameter, value: str | None) -> float | None:
    """Return a length in millimetres."""
    if value is None:
        return None
    found = re.fullmatch(r"([0-9.]+(?:e[+-]?[0-9]+)?) *([a-z]*)", value.strip().lower())
    try:
        number, unit = found.groups() if found else ("", "")
        return float(number) * UNITS[unit]
    except (ValueError, KeyError):
        raise click.BadParameter(f"{value!r} is no length; give one such as 6mm, 0.6cm or 0.25in") from None


def length(name: str, variable: str, default: str | None, help: str) -> Callable[[Function], Function]:
    """Return an option that is a length, in millimetres."""
    return click.option(
        name, variable, metavar="LENGTH", default=default, show_default=True, callback=_length, help=help
    )


@click.command("export")
@click.argument("given", metavar="FILE|NAME...", nargs=-1, required=True)
@click.option(
    "-o", "--output", metavar="PATH", required=True, help="File to write, or a FOLDER/ for several."
)
@click.option(
    "--format",
    "format_",
    metavar="FORMAT",
    help="stl, obj, ply, glb or 3mf.  [default: by the suffix, or stl]",
)
@length(
    "--rope-diameter",
    "diameter",
    None,
    "Scale of the print: strands of such a rope touch.  [default: 6mm]",
)
@length("--size", "size", None, "Scale by the longest side of the print instead.")
@length("--gap", "gap", "0.4mm", "Between strands, which are printed thinner by it.")
@length("--tolerance", "tolerance", "0.02mm", "How far facets may be off the round tube.")
@options.close
@options.force
@click.option("-q", "--quiet", is_flag=True, help="No messages but errors.")
def command(
    given: tuple[str, ...],
    output: str,
    format_: str | None,
    close: "Close | None",
    force: bool,
    quiet: bool,
    **lengths: float | None,
) -> None:
    """Write ropes as closed tubes for a 3D printer: .stl, .obj, .ply, .glb or .3mf, in millimetres.

    A FILE is a curve of any scale, - is standard input. A NAME is the rope that the atlas has of the knot.
    Lengths are in mm, or as their unit says: 6mm, 0.6cm, 0.25in.

    The rope is laid along the curve's inscribed knot, scaled so that strands of the rope's diameter just
    touch, or so that the print is of a size. What is printed is thinner than the rope by the gap, which
    strands keep everywhere, so that they do not fuse. It lies flat. The components of a link are bodies of
    their own, but for .stl and .ply, which have one; .glb and .3mf have their colours, too. All but .3mf
    needs the extra sono[mesh].

    \b
      sono export 4_1 -o figure8.stl --rope-diameter 6mm
      sono export 3_1 -o trefoil.3mf --size 80mm
      sono export 6^3_2 tight.txt -o prints/ --format 3mf --gap 0.5mm
    """
    if len(given) > 1 and places.names_one_file(output):
        raise click.UsageError(f"{output} is one file; name a folder, {output}/, for {len(given)} ropes")
    maker = _Maker(output, _format(output, format_), _checked(lengths), force)

    def export(source: "Source") -> None:
        path, solid, curve = maker.written(source)
        if quiet:
            return
        options.complain(f"{path}: {_told(solid)}")
        if not knot_of(source) and (doubt := _doubt(source, curve)):
            options.complain(doubt)

    if not places.names_one_file(output):
        places.make_folder(output)
    sys.exit(each(given, close, export))


def _format(output: str, named: str | None) -> str:
    """Tell in which format to write."""
    from sono.figures import solidfiles
    from sono.formats import FormatError

    if named is None and not places.names_one_file(output):
        return "stl"
    try:
        return solidfiles.by_suffix(f"--format .{named.lower()}" if named else output)
    except FormatError as error:
        folder = "" if named or PurePath(output).suffix else f"; {output}/ is a folder, and --format tells"
        raise click.UsageError(f"{error}{folder}") from error


def _checked(lengths: dict[str, Any]) -> "Lengths":
    """Refuse lengths that make no rope."""
    from sono.figures.lengths import Lengths

    if lengths["diameter"] is not None and lengths["size"] is not None:
        raise click.UsageError("--rope-diameter and --size both tell the scale; give one of them")
    try:
        return Lengths(**lengths)
    except ValueError as error:
        raise click.UsageError(str(error)) from error


def _told(solid: "Solid") -> str:
    """Say what is printed."""
    size = " x ".join(f"{edge:.1f}" for edge in solid.size)
    rope = f"{solid.length:.0f} mm of rope {solid.diameter:.3g} mm thick"
    return f"{size} mm, {rope}, printed {2 * solid.radius:.3g} mm thick, {solid.triangles:,} triangles"


def _doubt(source: "Source", curve: "Components") -> str:
    """Say that a curve is loose, if forces do not balance on it at all."""
    from sono.curve import forces, measure
    from sono.patience import patiently

    if patiently(partial(forces, curve)).residual < LOOSE:
        return ""
    tighten = f"`sono tighten {shlex.quote(source.given)} -o rope.txt`"
    return f"{source}: is loose, of ropelength {measure(curve).l_p:.4g}; {tighten} makes it shorter first"


@dataclass(frozen=True)
class _Maker:
    """Makes solids of such lengths, in millimetres, and writes each to a file of its own."""

    output: str
    format: str
    lengths: "Lengths"
    force: bool
    done: set[str] = field(default_factory=set)

    def written(self, source: "Source") -> "tuple[str, Solid, Components]":
        """Write the solid of a curve; return the file's name, it, and the curve. Raises `FormatError`."""
        from sono.figures import solidfiles

        path, curve = self._path(source), rope_of(source)
        solid = self._made(source, curve)
        solidfiles.write(path, solid, self.format)
        self.done.add(path)
        return path, solid, curve.components

    def _path(self, source: "Source") -> str:
        """Return the name of a file that may be written. Raises `FormatError`."""
        from sono.formats import FormatError

        path = self.output
        if not places.names_one_file(path):
            path = os.path.join(path, f"{source.stem}.{self.format}")
        if path in self.done:
            raise FormatError(
                f"{source}: {path} is written already; -o FOLDER/ takes several, of other names"
            )
        if os.path.isfile(path) and not self.force:
            raise FormatError(f"{path} exists; --force overwrites it")
        return path

    def _made(self, source: "Source", curve: "VertexFile") -> "Solid":
        """Make the solid of a curve. Raises `FormatError`."""
        # Imported here, since numpy would make --help wait.
        from sono._core import CurveError
        from sono.figures.solids import solid
        from sono.formats import FormatError
        from sono.jobs.curvefiles import located
        from sono.patience import patiently

        try:
            return patiently(lambda: solid(curve.components, self.lengths))
        except CurveError as error:
            raise located(error, curve) from error
        except ValueError as error:
            raise FormatError(f"{source}: {error}") from error
