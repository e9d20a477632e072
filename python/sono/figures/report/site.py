"""The pages of a report: the table of all ropes, the page of each, and what these share.

Nothing is fetched, so that a browser shows them from a folder as well as from a server: data come by scripts.
"""

from collections.abc import Sequence
from html import escape
from itertools import pairwise
from pathlib import Path
from string import Template
from typing import Any
from urllib.parse import quote

from sono import formats
from sono.figures import view
from sono.figures.report.ropes import Rope
from sono.figures.thumbnail import EDGE, SIZE
from sono.figures.view import Links, as_json, clean, linked, part
from sono.formats.files import make_folder
from sono.tables import COLUMNS

INDEX = "index.html"

ALLOWED = "'self' file:"
"""Whence scripts and styles may come: from where the page is."""

HEADERS = {
    "family": "family",
    "l_c": "L_c certified",
    "l_c_fine": "L_c fine",
    "l_a_difference": "L_a − published",
    "l_c_difference": "L_c − published",
}
"""Those that other tables have not, or without room for a line's end."""

SHOWN = (
    *("knot", "family", "crossings", "n", "dl", "l_p", "l_c", "l_c_fine", "l_a"),
    *("published", "source", "l_a_difference", "l_c_difference", "type"),
)
"""The columns of the table."""


def finish(folder: Path, ropes: Sequence[Rope], title: str) -> None:
    """Write all pages of a report whose ropes are `written`, the table of them last.

    Raises `FormatError` where a file cannot be written.
    """
    make_folder(folder / "assets")
    for name, text in _assets(ropes).items():
        formats.save(str(folder / "assets" / name), text)
    for before, rope, after in _neighbours(ropes):
        formats.save(f"{folder.joinpath(*rope.at.split('/'))}.html", _page(before, rope, after))
    index = Template(part("report", INDEX)).substitute(allowed=ALLOWED, title=escape(clean(title)))
    formats.save(str(folder / INDEX), index)


def _assets(ropes: Sequence[Rope]) -> dict[str, str]:
    """Return the files that the pages share."""
    data = {
        "size": SIZE,
        "edge": EDGE,
        "columns": [_column(key) for key in SHOWN],
        "ropes": [rope.row | {"page": quote(f"{rope.at}.html")} for rope in ropes],
    }
    return {
        "view.css": view.style() + part("report", "rope.css"),
        "view.js": view.script(),
        "index.css": part("view", "theme.css") + part("report", "index.css"),
        "index.js": view.wrapped(part("view", "colours.js") + part("report", "index.js")),
        "ropes.js": f"const report = {as_json(data)};\n",
    }


def _column(key: str) -> dict[str, Any]:
    """Return how a column is shown: rounded as in other tables."""
    spec = COLUMNS[key].spec if key in COLUMNS else ""
    digits = None if not spec else 0 if spec == "d" else int(spec.strip("+.f"))
    header = HEADERS.get(key) or COLUMNS[key].header
    return {"key": key, "header": header, "digits": digits, "signed": spec.startswith("+")}


def _neighbours(ropes: Sequence[Rope]) -> list[tuple[Rope | None, Rope, Rope | None]]:
    """Return each rope, with the one before it and the one after it, if there are any."""
    around = [None, *ropes, None]
    return [(a, b, c) for (a, b), (_, c) in pairwise(pairwise(around)) if b]


def _page(before: Rope | None, rope: Rope, after: Rope | None) -> str:
    """Return the page of a rope."""
    stem = quote(rope.at.rpartition("/")[2])
    return linked(
        rope.row["knot"],
        Links(
            allowed=ALLOWED,
            style='<link rel="stylesheet" href="../assets/view.css">',
            data=f'<script type="application/json" id="data"></script>\n<script src="{stem}.js"></script>',
            script='<script src="../assets/view.js"></script>',
            above=_navigation(before, after),
            below=rope.beside,
        ),
    )


def _navigation(before: Rope | None, after: Rope | None) -> str:
    links = (_link(before, "← ", ""), f'<a href="../{INDEX}">All ropes</a>', _link(after, "", " →"))
    return f'<nav aria-label="Ropes">{"".join(links)}</nav>'


def _link(rope: Rope | None, left: str, right: str) -> str:
    if rope is None:
        return "<span></span>"
    name, way = escape(rope.row["knot"]), "prev" if left else "next"
    return f'<a href="../{quote(rope.at)}.html" rel="{way}">{left}{name}{right}</a>'
