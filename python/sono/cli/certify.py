"""`sono certify FILE|NAME...`: bounds on ropelength that are proven, and certificates that prove them."""

import json
import os
import shlex
import sys
from contextlib import nullcontext
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import click

from sono import tables
from sono.cli import options, places
from sono.cli.each import each, knot_of, rope_of

if TYPE_CHECKING:
    from sono.certificates import Certificate
    from sono.formats import Close, VertexFile
    from sono.jobs.sources import Source
    from sono.thickness import Thickness

CERTIFICATE, THICKNESS = ".certificate.json", ".thickness.json"
"""What the names of files end in that prove bounds, and sharper ones."""

FINE = 0.02
"""Edges of a rope whose L_c is worth quoting: it exceeds the limit by 30 millionths."""

COLUMNS = ("knot", "n", "certified", "r_c", "min_rad", "decided_by", "file")


@click.command("certify")
@click.argument("given", metavar="FILE|NAME...", nargs=-1, required=True)
@click.option("--json", "as_json", is_flag=True, help="Write certificates, one a line, instead of a table.")
@click.option("-o", "--output", metavar="FOLDER", help="Write certificates, and vertices, into this folder.")
@click.option(
    "--sharp", is_flag=True, help="Prove a sharper bound too, by the thickness of the inscribed knot."
)
@click.option("--check", metavar="CERTIFICATE", help="Check a certificate of FILE instead of making one.")
@options.close
@options.force
@options.table(COLUMNS)
def command(
    given: tuple[str, ...],
    as_json: bool,
    output: str | None,
    sharp: bool,
    check: str | None,
    close: "Close | None",
    force: bool,
    shown: options.Shown,
) -> None:
    """Prove that each curve's type has a ropelength of at most so much: L_c, rounded up.

    A FILE is taken as it is, of any scale; - is standard input. A NAME is the rope that the atlas has of the
    knot, with edges of 0.2; a rope tightened with --dl 0.02 proves a bound worth quoting. R is held down by a
    bend or a pair of vertices: component:vertex, both counted from 0. Where the edges are too long for a
    proof, the message says by how much, and where.

    A certificate is of a file of plain rows x y z, whose SHA-256 it has. With -o the vertices of all else are
    written as FOLDER/NAME.txt, next to NAME.certificate.json. --check believes nothing that a certificate
    says, and shares no code with what made it. With --sharp there is a column sharp, and --json or -o give
    what proves that, NAME.thickness.json, which --check takes as well:

    \b
      sono certify 8_18 -o proofs/
      sono certify --check proofs/8_18.certificate.json proofs/8_18.txt
    """
    if check is not None:
        if output or as_json or sharp or len(given) != 1:
            raise click.UsageError("--check CERTIFICATE takes one FILE, and nothing is written")
        sys.exit(_checked(check, given[0]))
    if as_json and output:
        raise click.UsageError("give --json or -o FOLDER, not both")
    if output:
        places.make_folder(output)
    if sharp and "certified" in shown.columns and "sharp" not in shown.columns:
        shown.columns.insert(shown.columns.index("certified") + 1, "sharp")
    sys.exit(_certified(given, close, _Maker(output, force, sharp), as_json, shown))


def _certified(
    given: tuple[str, ...], close: "Close | None", maker: "_Maker", as_json: bool, shown: options.Shown
) -> int:
    """Certify curves, in a table or as documents; return the exit code."""
    with nullcontext() if as_json else shown.table() as table:

        def certify(source: "Source") -> None:
            curve, certificate = _proven(source)
            sharp = _sharpened(source, curve) if maker.sharp else None
            for doubt in (*curve.doubts(), *_finer(source, curve)):
                shown.tell(doubt)
            if table:
                file = maker.written(source, curve, certificate, sharp) if maker.folder else str(source)
                table.row(row(source.name, file, certificate, sharp))
            else:
                click.echo(json.dumps(maker.document(source, curve, sharp or certificate)[1]))

        return each(given, close, certify)


def _checked(certificate: str, file: str) -> int:
    """Have a certificate checked by what knows nothing of its making; return the exit code."""
    from sono import check_certificate, check_thickness

    try:
        if certificate.endswith(THICKNESS):
            bound = check_thickness.check(certificate, file)["l_k"]
        else:
            bound = check_certificate.check(certificate, file)["l_c"]
    except OSError as error:
        options.complain(f"{error.filename}: cannot be read: {error.strerror}")
    except ValueError as error:
        options.complain(f"{certificate}: proves nothing of {file}: {error}")
    else:
        click.echo(f"{file}: proven: the ropelength of its type is at most {bound}")
        return 0
    return 1


def _proven(source: "Source") -> "tuple[VertexFile, Certificate]":
    """Return a curve, or the atlas's rope of a knot, and what is proven of it. Raises `FormatError`."""
    # Imported here, since numpy would make --help wait.
    from sono._core import CurveError
    from sono.certificates import certify
    from sono.jobs.curvefiles import located
    from sono.patience import patiently

    curve = rope_of(source)
    try:
        return curve, patiently(lambda: certify(curve.components))
    except CurveError as error:
        raise located(error, curve) from error


def _finer(source: "Source", curve: "VertexFile") -> list[str]:
    """Say how to prove less than the atlas's rope of a name does, whose edges are coarse."""
    from sono.curve import measure
    from sono.tables import published

    if not knot_of(source):
        return []
    rope = measure(curve.components)
    row = published.extrapolated({"knot": source.name, "n": rope.n, "l_a": rope.l_a, "l_c": rope.l_c})
    if not (isinstance(limit := row["limit"], float) and rope.l_c):
        return []
    about = limit + (rope.l_c - limit) * (FINE / rope.dl) ** 2
    file = shlex.quote(f"fine/{source.stem}.dl{FINE}.txt")
    line = f"sono tighten {shlex.quote(source.given)} --dl {FINE} -o fine/ && sono certify {file}"
    return [f"{source}: edges of {rope.dl:.1f}, a coarse bound; `{line}` proves about {about:.1f}"]


def _sharpened(source: "Source", curve: "VertexFile") -> "Thickness":
    """Return what is proven besides, where that is sharper. Raises `FormatError`."""
    from sono.formats import FormatError
    from sono.patience import patiently
    from sono.thickness import sharpen

    try:
        return patiently(lambda: sharpen(curve.components))
    except ValueError as error:
        raise FormatError(f"{source}: {error}") from error


def row(name: str, file: str, certificate: "Certificate", sharp: "Thickness | None" = None) -> tables.Row:
    """Return the row of a curve; what readers see of L_c is rounded up as well."""
    figures: dict[str, Any] = {key: float(getattr(certificate, key)) for key in ("r_c", "min_rad")}
    figures |= {"n": certificate.n, "components": len(certificate.components), "knot": name, "file": file}
    figures |= {"certified": certificate.rounded(), "decided_by": str(certificate.decided_by)}
    return figures | ({"sharp": sharp.rounded()} if sharp else {})


@dataclass(frozen=True)
class _Maker:
    """Makes the documents, each of a file that it writes into the folder if there is none to be had."""

    folder: str | None
    force: bool
    sharp: bool = False

    def written(
        self, source: "Source", curve: "VertexFile", certificate: "Certificate", sharp: "Thickness | None"
    ) -> str:
        """Write what proves bounds into the folder; return the file that it is of. Raises `FormatError`."""
        from sono import formats

        path = self._path(source, CERTIFICATE)
        path_of_sharp = self._path(source, THICKNESS) if sharp else ""
        file, document = self.document(source, curve, certificate)
        formats.save(path, json.dumps(document, indent=1) + "\n")
        if sharp:
            formats.save(path_of_sharp, json.dumps(sharp.document(file), indent=1) + "\n")
        return file

    def document(
        self, source: "Source", curve: "VertexFile", certificate: "Certificate | Thickness"
    ) -> tuple[str, dict[str, Any]]:
        """Return the file that a certificate is of, and its document. Raises `FormatError`."""
        from sono import formats

        try:
            return source.given, certificate.document(source.given)
        except (OSError, ValueError):  # a name, standard input, or a file that is no plain rows
            pass
        if self.folder is None:
            why = "a certificate is of a file of plain rows x y z"
            raise formats.FormatError(f"{source}: {why}; -o FOLDER writes one, and the certificate")
        file = self._path(source, ".txt")
        formats.write(file, curve.components, curve.comments)
        return file, certificate.document(file)

    def _path(self, source: "Source", suffix: str) -> str:
        """Return the name of a file in the folder. Raises `FormatError` where that is taken."""
        from sono.formats import FormatError

        path = os.path.join(self.folder or "", source.stem + suffix)
        if os.path.exists(path) and not self.force:
            raise FormatError(f"{path}: exists; --force overwrites it, -o names another folder")
        return path
