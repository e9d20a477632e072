"""Along a rope: where its vertices are, component after component, and how axes show that."""

from typing import TYPE_CHECKING, Literal

import numpy as np

from sono.curve import Components, Floats
from sono.figures.plot.sheet import library

if TYPE_CHECKING:
    from matplotlib.axes import Axes

ARCLENGTH = "arclength / R"


def edges(component: Floats) -> Floats:
    """Return the lengths (n,) of the edges, that from each vertex to the next one."""
    lengths: Floats = np.linalg.norm(np.roll(component, -1, axis=0) - component, axis=1)
    return lengths


def arclength(components: Components) -> list[Floats]:
    """Return the arclengths (n_i,) of vertices; a component begins where the one before it ends."""
    begins = np.cumsum([0, *(edges(component).sum() for component in components)])
    return [
        begin + np.cumsum([0, *edges(component)[:-1]])
        for begin, component in zip(begins, components, strict=False)
    ]


def mark(components: Components, axes: "Axes", which: Literal["x", "xy"] = "x") -> None:
    """Have axes reach along all components, with a line where one ends and the next begins."""
    ends = np.cumsum([edges(component).sum() for component in components])
    grid = library().rcParams["grid.color"]
    for end in ends[:-1]:
        axes.axvline(end, color=grid, zorder=0.5)
        if which == "xy":
            axes.axhline(end, color=grid, zorder=0.5)
    axes.set(xlim=(0, ends[-1]), xlabel=ARCLENGTH)
    if which == "xy":
        axes.set(ylim=(0, ends[-1]), ylabel=ARCLENGTH, aspect="equal")
