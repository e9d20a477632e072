"""The atlas: ropelengths against crossing numbers, and beside what is published."""

import re
from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from sono import tables
from sono.curve import Floats
from sono.figures.plot.sheet import library
from sono.starts import shapes
from sono.starts.shapes import place
from sono.tables import Row, published

if TYPE_CHECKING:
    from matplotlib.axes import Axes

MARKERS = dict(zip(shapes.FAMILIES, "o^sD", strict=True))
"""The families of the atlas, and how they are marked."""

CROSSINGS = "crossing number"

SPREAD = 0.35
"""Types of one crossing number are drawn side by side, by length, so far to the left and the right."""


def rows() -> list[Row]:
    """Return the rows of the atlas that the package carries, all families."""
    paths = (shapes.FOLDER.joinpath(f"{name}.tsv") for name in shapes.FAMILIES)
    return [row for path in paths if path.is_file() for row in tables.read(str(path))]


def crossing_number(name: str) -> int | None:
    """Return the crossing number of a torus type, a name in the tables or a sum of them, None for another.

    That of a sum is taken as the sum of those of its parts, which is known of torus and alternating types.

    >>> [crossing_number(name) for name in ("10_165", "K11n38", "Hopf", "T(3,-5)", "3_1#m3_1", "mine")]
    [10, 11, 2, 10, 6, None]
    """
    where = place(name)
    if where.family == "composites":
        parts = [crossing_number(part) for part in where.knot.split("#")]
        return None if None in parts else sum(part or 0 for part in parts)
    if where.family == "torus":
        p, q = map(int, re.findall(r"\d+", where.knot))
        return min(p * (q - 1), q * (p - 1))
    tabled = re.fullmatch(r"l(\d+)[an]\d+|(\d+)[an]?_\d+", where.knot.casefold())
    return int(tabled[1] or tabled[2]) if tabled else None


def lengths(rows: Sequence[Row], axes: "Axes") -> None:
    """Draw L_a against crossing number."""
    _draw(rows, "l_a", axes)
    axes.set(xlabel=CROSSINGS, ylabel="$L_a$ (length / radius)")
    _logarithmic(axes, "x", "y")
    axes.legend(markerscale=2)


def differences(rows: Sequence[Row], axes: "Axes") -> None:
    """Draw L_a less the shortest published ropelength, where there is one, in percent of this."""
    percent = [
        {**row, "share": 100 * float(str(row["l_a_difference"])) / float(str(row["published"]))}
        for row in rows
        if row.get("l_a_difference") is not None and row.get("published")
    ]
    axes.axhline(0, color=library().rcParams["text.color"], linewidth=0.6)
    _draw(percent, "share", axes)
    axes.set(xlabel=CROSSINGS, ylabel="($L_a -$ published) / published / %")
    _logarithmic(axes, "x")


def _draw(rows: Sequence[Row], key: str, axes: "Axes") -> None:
    """Draw a column of rows, each family by itself. Raises `ValueError` where there is nothing to draw."""
    names = [published.name_of(row["knot"]) for row in rows]
    places: dict[str, list[tuple[int, float]]] = {}
    for name, row in zip(names, rows, strict=True):
        crossings = crossing_number(name)
        if crossings and row.get(key) is not None:
            places.setdefault(place(name).family, []).append((crossings, float(str(row[key]))))
    if key == "l_a" and not places:
        raise ValueError("no row has an L_a and a name that tells its crossing number, such as 8_18")
    for k, (kind, marker) in enumerate(MARKERS.items()):
        if kind in places:
            axes.plot(*_spread(np.array(places[kind])).T, marker, color=f"C{k}", label=kind, markersize=2)


def _spread(places: Floats) -> Floats:
    """Put points (m, 2) of one x side by side, in the order of their y."""
    spread = places.astype(float)
    for x in np.unique(places[:, 0]):
        there = np.flatnonzero(places[:, 0] == x)
        ranks = np.argsort(np.argsort(places[there, 1]))
        spread[there, 0] += SPREAD * (2 * ranks + 1 - len(there)) / len(there)
    return spread


def _logarithmic(axes: "Axes", *which: str) -> None:
    """Make scales logarithmic, with plain numbers."""
    ticks = library("matplotlib.ticker")
    for name in which:
        axes.set(**{f"{name}scale": "log"})
        axis = axes.xaxis if name == "x" else axes.yaxis
        axis.set_major_locator(ticks.LogLocator(subs=(1, 3)))
        axis.set_major_formatter("{x:g}")
        axis.set_minor_formatter(ticks.NullFormatter())
