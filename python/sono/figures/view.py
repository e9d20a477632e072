"""A page that shows ropes in the round: one HTML file that needs nothing else, neither network nor library.

Its WebGL2 is its own, in `data/view`: a rope needs rods and balls, and no more. That takes 49 kB, where an
offline page with three.js or k3d takes over a megabyte, and it can link the rope with its map of contacts.
"""

import json
import os
from collections.abc import Sequence
from dataclasses import dataclass
from html import escape
from importlib import resources
from pathlib import Path
from string import Template
from typing import Any

import numpy as np
from numpy.typing import NDArray

from sono import shape
from sono.curve import Components, Curve, CurveLike, Floats, Forces, Measures, as_components, forces, measure
from sono.figures import packing
from sono.figures.turning import turned
from sono.invariants import TooEntangledError
from sono.naming import identify
from sono.printing import printable
from sono.tables import COLUMNS

WEAKEST = 1e-3
"""Share of the strongest contact's force below which a contact is left out."""

SCRIPTS = ("curve", "colours", "camera", "paint", "map", "flat", "view")
"""The parts of the page's script, each of which uses those before it."""

ROWS = ("n", "components", "dl", "l_p", "l_c", "l_a", "min_rad", "sr", "dispersion")
"""What the page says of a rope at R_s = 1."""


@dataclass(frozen=True)
class View:
    """A page, which a notebook shows where it stands.

    >>> import sono
    >>> "<iframe" in sono.view("3_1")._repr_html_()
    True
    """

    html: str

    def save(self, path: str | os.PathLike[str]) -> None:
        """Write the page to a file. Raises `OSError`."""
        Path(path).write_text(self.html, encoding="utf-8")

    def _repr_html_(self) -> str:
        """Show the page in a frame that can reach nothing else."""
        style = "width:100%;height:560px;border:0"
        return f'<iframe sandbox="allow-scripts" style="{style}" srcdoc="{escape(self.html)}"></iframe>'


def shown(curves: Sequence[tuple[str, CurveLike]], title: str | None = None) -> View:
    """Return the page of curves to be shown or saved; see `page`, whose errors it raises."""
    return View(page(curves, titled([name for name, _ in curves]) if title is None else title))


def page(curves: Sequence[tuple[str, CurveLike]], title: str) -> str:
    """Return the page of curves, each with its name, of any scale; a curve without one is called by its type.

    A vertex takes 7 to 12 bytes and a contact 4 to 5: about 20 n for a rope of n vertices in the atlas, 33 n
    for a trefoil of 2,000 vertices, whose edges are a 60th of R. Contacts that bear less than WEAKEST of the
    strongest are left out. Several curves are turned alike, and the page goes through them. Raises
    `CurveError` for one that is not embedded.

    >>> import sono
    >>> html = page([("trefoil", sono.start("3_1", known=True))], "A trefoil")
    >>> html.startswith("<!doctype html>"), len(html) < 60_000
    (True, True)
    """
    return linked(
        title,
        Links(
            allowed="'unsafe-inline'",
            style=f"<style>\n{style()}</style>",
            data=f'<script type="application/json" id="data">{as_json(described(curves))}</script>',
            script=f"<script>\n{script()}</script>",
        ),
    )


@dataclass(frozen=True)
class Links:
    """The HTML that gives a page its style, its data and its script, and whence these are `allowed` to come.

    What else there is in the column beside the rope stands `above` and `below`.
    """

    allowed: str
    style: str
    data: str
    script: str
    above: str = ""
    below: str = ""


def linked(title: str, links: Links) -> str:
    """Return a page that has its style, data and script by links; the data are in its element "data"."""
    return Template(part("view", "page.html")).substitute(vars(links), title=escape(clean(title)))


def style() -> str:
    """Return the style of a page."""
    return part("view", "theme.css") + part("view", "view.css")


def script() -> str:
    """Return the script of a page."""
    return wrapped("\n".join(part("view", f"{name}.js") for name in SCRIPTS))


def wrapped(script: str) -> str:
    """Return a script that leaves no names behind."""
    return f'"use strict";\n(() => {{\n{script}}})();\n'


def described(curves: Sequence[tuple[str, CurveLike]]) -> list[dict[str, Any]]:
    """Return what a page knows of curves, each with its name; it raises what `page` does."""
    ropes = [_scaled(as_components(curve)) for _, curve in curves]
    frames = turned([rope for rope, _ in ropes])
    return [
        _described(name, rope, radius) | {"frame": frame.round(6).tolist()}
        for (name, _), (rope, radius), frame in zip(curves, ropes, frames, strict=True)
    ]


def as_json(data: object) -> str:
    """Return data as JSON that ends no script."""
    return json.dumps(data, separators=(",", ":")).replace("<", "\\u003c")


def titled(names: Sequence[str]) -> str:
    """Return a title for a page of curves of these names."""
    more = len(names) - 1
    return f"{names[0] or 'Rope'} and {more} more" if more else names[0] or "Rope"


def curvature(rope: Components) -> Floats:
    """Return the curvature (n,) at each vertex: one over the radius of its inscribed arc."""
    return np.concatenate([shape.curvature(component) for component in rope])


def _scaled(components: list[Floats]) -> tuple[list[Floats], float]:
    """Return a curve at R_s = 1, and the R_s that it had."""
    radius = measure(Curve(components)).r_s
    return [component / radius for component in components], radius


def _described(name: str, rope: list[Floats], radius: float) -> dict[str, Any]:
    """Return what the page knows of a rope."""
    contacts, pressing = _strong(forces(rope))
    strongest = float(pressing.max(initial=0))
    kind, known = _type(rope)
    return {
        "name": clean(name or kind),
        "type": kind,
        "known": known,
        "rows": [*_rows(measure(rope)), ("R_s as given", f"{radius:.9g}")],
        "sizes": list(map(len, rope)),
        **packing.vertices(np.concatenate(rope)),
        "curvature": packing.shares(curvature(rope), 1),
        "pairs": packing.pairs(contacts, sum(map(len, rope))),
        "strongest": strongest,
        "pressing": packing.shares(pressing, strongest),
    }


def _strong(found: Forces) -> tuple[NDArray[np.int64], Floats]:
    """Return the contacts (m, 2) that are shown, in the order of their vertices, and what each bears (m,)."""
    strong = np.flatnonzero(found.pressing > WEAKEST * found.pressing.max(initial=0))
    order = strong[np.lexsort(found.contacts[strong].T[::-1])]
    return found.contacts[order], found.pressing[order]


def _type(rope: Components) -> tuple[str, str]:
    """Say what knot or link it is, and how that is known."""
    try:
        found = identify(rope)
    except TooEntangledError:
        return "too entangled to be identified", "undecided"
    return found.name or found.known, found.known


def _rows(measures: Measures) -> list[tuple[str, str]]:
    """Return the table of measures, as the other tables round them."""
    values = measures.to_dict()
    shown = ((COLUMNS[key], values[key]) for key in ROWS if key != "components" or values[key] > 1)
    return [
        (column.header, "none" if value is None else format(value, column.spec)) for column, value in shown
    ]


def clean(text: str) -> str:
    """Return text as a page can have it: without what steers terminals, and bytes that were no text."""
    return printable(text).encode(errors="replace").decode()


def part(folder: str, name: str) -> str:
    """Return a part of a page: a file in a folder of `data`."""
    return resources.files("sono").joinpath("data", folder, name).read_text(encoding="utf-8")
