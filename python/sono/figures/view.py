"""A page that shows ropes in the round: one HTML file that needs nothing else, neither network nor library.

Its WebGL2 is its own, in `data/view`: a rope needs rods and balls, and no more. That takes 47 kB, where an
offline page with three.js or k3d takes over a megabyte, and it can link the rope with its map of contacts.
"""

import base64
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

from sono.curve import Components, Curve, CurveLike, Floats, Measures, as_components, forces, measure
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

    A curve of n vertices takes about 50 n bytes, most of them for its contacts, of which those that bear less
    than WEAKEST of the strongest are left out. Several are turned alike, and the page goes through them.
    Raises `CurveError` for one that is not embedded.

    >>> import sono
    >>> html = page([("trefoil", sono.start("3_1", known=True))], "A trefoil")
    >>> html.startswith("<!doctype html>"), len(html) < 60_000
    (True, True)
    """
    ropes = [_scaled(as_components(curve)) for _, curve in curves]
    names = [name for name, _ in curves]
    frames = turned([rope for rope, _ in ropes])
    data = [
        _described(name, rope, radius) | {"frame": frame.round(6).tolist()}
        for name, (rope, radius), frame in zip(names, ropes, frames, strict=True)
    ]
    return Template(_part("page.html")).substitute(
        title=escape(_clean(title)),
        style=_part("view.css"),
        script="\n".join(_part(f"{name}.js") for name in SCRIPTS),
        data=json.dumps(data, separators=(",", ":")).replace("<", "\\u003c"),
    )


def titled(names: Sequence[str]) -> str:
    """Return a title for a page of curves of these names."""
    more = len(names) - 1
    return f"{names[0] or 'Rope'} and {more} more" if more else names[0] or "Rope"


def curvature(rope: Components) -> Floats:
    """Return the curvature (n,) at each vertex: one over the radius of its inscribed arc."""
    return np.concatenate([_curvature(component) for component in rope])


def _curvature(component: Floats) -> Floats:
    after = np.roll(component, -1, axis=0) - component
    before = np.roll(after, 1, axis=0)
    edge = np.linalg.norm(after, axis=1)
    shorter = np.minimum(edge, np.roll(edge, 1))
    turn = np.arctan2(np.linalg.norm(np.cross(before, after), axis=1), (before * after).sum(axis=1))
    found: Floats = 2 * np.tan(turn / 2) / shorter
    return found


def _scaled(components: list[Floats]) -> tuple[list[Floats], float]:
    """Return a curve at R_s = 1, and the R_s that it had."""
    radius = measure(Curve(components)).r_s
    return [component / radius for component in components], radius


def _described(name: str, rope: list[Floats], radius: float) -> dict[str, Any]:
    """Return what the page knows of a rope."""
    found = forces(rope)
    strong = found.pressing > WEAKEST * found.pressing.max(initial=0)
    kind = _type(rope)
    return {
        "name": _clean(name or kind),
        "type": kind,
        "rows": [*_rows(measure(rope)), ("R_s as given", f"{radius:.9g}")],
        "sizes": list(map(len, rope)),
        "vertices": _packed(np.concatenate(rope), "<f4"),
        "curvature": _packed(curvature(rope), "<f4"),
        "pairs": _packed(found.contacts[strong], "<u4"),
        "pressing": _packed(found.pressing[strong], "<f4"),
    }


def _type(rope: Components) -> str:
    """Say what knot or link it is."""
    try:
        found = identify(rope)
    except TooEntangledError:
        return "too entangled to be identified"
    return found.name or found.known


def _rows(measures: Measures) -> list[tuple[str, str]]:
    """Return the table of measures, as the other tables round them."""
    values = measures.to_dict()
    shown = ((COLUMNS[key], values[key]) for key in ROWS if key != "components" or values[key] > 1)
    return [
        (column.header, "none" if value is None else format(value, column.spec)) for column, value in shown
    ]


def _packed(array: NDArray[Any], kind: str) -> str:
    return base64.b64encode(array.astype(kind).tobytes()).decode()


def _clean(text: str) -> str:
    """Return text as a page can have it: without what steers terminals, and bytes that were no text."""
    return printable(text).encode(errors="replace").decode()


def _part(name: str) -> str:
    return resources.files("sono").joinpath("data", "view", name).read_text(encoding="utf-8")
