"""The atlas: ropelengths against crossing numbers, and beside what is published."""

import re
from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from sono import tables
from sono.curve import Floats
from sono.figures.plot.sheet import library
from sono.starts import shapes
from sono.tables import Row

if TYPE_CHECKING:
    from matplotlib.axes import Axes

MARKERS = {"knots": "o", "links": "^", "sums": "s", "torus": "D"}

CROSSINGS = "crossing number"

SPREAD = 0.35
"""Types of one crossing number are drawn side by side, by length, so far to the left and the right."""


def rows() -> list[Row]:
    """Return the rows of the atlas that the package carries, all families."""
    paths = (shapes.FOLDER.joinpath(f"{name}.tsv") for name in shapes.FAMILIES)
    return [row for path in paths if path.is_file() for row in tables.read(str(path))]


def crossing_number(name: str) -> int | None:
    """Return the crossing number of a name in the atlas, None for another.

    That of a sum is taken as the sum of those of its parts, which is known of torus and alternating types.

    >>> [crossing_number(name) for name in ("10_165", "11n_38", "L9a14", "T(3,5)", "3_1#3_1", "mine")]
    [10, 11, 9, 10, 6, None]
    """
    total = 0
    for part in name.split("#"):
        if torus := re.fullmatch(r"T\((\d+),(\d+)\)", part):
            p, q = map(int, torus.groups())
            total += min(p * (q - 1), q * (p - 1))
        elif tabled := re.fullmatch(r"m?(?:L(\d+)[an]\d+|(\d+)[an]?_\d+)(\{.*\})?", part):
            total += int(tabled[1] or tabled[2])
        else:
            return None
    return total


def family(name: str) -> str:
    """Return the kind of a name in the atlas."""
    kinds = ((r".*#", "sums"), (r"T\(", "torus"), (r"m?L", "links"))
    return next((kind for pattern, kind in kinds if re.match(pattern, name)), "knots")


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
    for k, (kind, marker) in enumerate(MARKERS.items()):
        places = [
            (x, float(str(row[key])))
            for row in rows
            if family(str(row["knot"])) == kind
            and row.get(key) is not None
            and (x := crossing_number(str(row["knot"]))) is not None
        ]
        if places:
            axes.plot(*_spread(np.array(places)).T, marker, color=f"C{k}", label=kind, markersize=2)


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
