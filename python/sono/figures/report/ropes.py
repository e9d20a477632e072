"""One rope of a report: its row, and what stands beside it, all from its vertices as they are written."""

import json
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from sono import formats, starts
from sono._core import CurveError
from sono.certificates import Certificate, certify
from sono.curve import measure
from sono.figures.plot.atlas import crossing_number
from sono.figures.report.beside import beside, rounded_up
from sono.figures.thumbnail import drawing
from sono.figures.view import as_json, clean, described
from sono.formats import VertexFile
from sono.formats.files import make_folder
from sono.starts.shapes import place
from sono.tables import Row, published

OTHERS = "others"
"""The family of what has the name of no knot."""

SUFFIXES = (".txt", ".certificate.json", ".js")
"""Of a rope's files but its page: vertices, the certificate if it has one, and what its page shows."""


@dataclass(frozen=True)
class Rope:
    """A rope of a report: its row in the table, what stands `beside` it on its page, and what is doubtful."""

    row: dict[str, Any]
    beside: str
    doubts: list[str]

    @property
    def at(self) -> str:
        """Where its files are in the folder of the report, without their suffix."""
        return str(self.row["at"])


def family(name: str) -> str:
    """Return the family of the atlas that a rope belongs to by its name.

    >>> [family(name) for name in ("8_18.n480", "T(2,5)", "3_1#4_1", "L5a1", "rope")]
    ['knots', 'torus', 'composites', 'links', 'others']
    """
    name = published.name_of(name)
    return place(name).family if starts.knows(name) else OTHERS


def written(folder: Path, at: str, name: str, file: VertexFile, atlas: Row) -> Rope:
    """Write the files of a rope, called so in the report's folder; return what its pages say of it.

    They have SUFFIXES. A finer L_c, which the vertices do not tell, is that of the rope's row in the `atlas`.
    Raises `CurveError` for a curve that is not embedded, `FormatError` where a file cannot be written.
    """
    base = folder.joinpath(*at.split("/"))
    make_folder(base.parent)
    formats.write(f"{base}.txt", file.components, file.comments)
    (shown,) = described([(name, file.components)])
    data = json.dumps(as_json([shown]))
    formats.save(f"{base}.js", f'document.getElementById("data").textContent = {data};\n')
    proof = _certified(base, file)
    knot, doubts = _knot(name, shown["type"], shown["known"])
    row = {
        "knot": knot,
        **_measured(file),
        "l_c": float(proof.l_c) if isinstance(proof, Certificate) else None,
    }
    row |= {key: atlas.get(key) for key in ("n_fine", "l_c_fine")}
    compared = published.beside(row, published.table(), published.VALUE)
    if shown["known"] != "proven" and (doubt := published.doubt({**compared, "file": f"{base}.txt"})):
        doubts.append(doubt)
    return Rope(
        _row(name, knot, at, compared) | {"type": shown["type"], "drawing": _drawn(file)},
        beside(at, compared, proof),
        doubts,
    )


def _measured(file: VertexFile) -> dict[str, Any]:
    """Return what the vertices measure, and the length of edges over the radius."""
    m = measure(file.components)
    return {"n": m.n, "dl": m.dl / m.r_s, "l_p": m.l_p, "l_a": m.l_a}


def _certified(base: Path, file: VertexFile) -> Certificate | str:
    """Certify the vertices and write that down; where nothing is proven, say why."""
    path = Path(f"{base}.certificate.json")
    try:
        proof = certify(file.components)
    except CurveError as error:
        path.unlink(missing_ok=True)
        return str(error)
    formats.save(str(path), json.dumps(proof.document(f"{base}.txt"), indent=1) + "\n")
    return proof


def _knot(name: str, type: str, known: str) -> tuple[str, list[str]]:
    """Return the knot that a rope is compared as, and what is wrong with its name: its type decides."""
    given, name = name, published.name_of(name)
    types = type.split(" or ") if known in ("proven", "invariants") else []
    if not starts.knows(name):
        return (types[0] if len(types) == 1 else name), []
    if not types or starts.canonical(name) in map(starts.canonical, types):
        return name, []
    return types[0], [f"{given}: is no {name} but {type}, with which it is compared"]


def _row(name: str, knot: str, at: str, compared: Row) -> dict[str, Any]:
    """Return a row of the table; what it has of proven bounds is rounded up."""
    keys = ("n", "dl", "l_p", "l_a", "published", "source", "l_a_difference", "l_c_difference")
    figures: dict[str, Any] = {key: compared[key] for key in keys}
    figures |= {key: rounded_up(compared[key]) for key in ("l_c", "l_c_fine")}
    crossings = crossing_number(knot) if starts.knows(knot) else None
    return {"knot": clean(name), "family": family(knot), "crossings": crossings, "at": at, **figures}


def _drawn(file: VertexFile) -> list[Any]:
    found = drawing(file.components)
    return [found.width, found.layers]
