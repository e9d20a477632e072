"""Curvature and torsion along a rope."""

from typing import TYPE_CHECKING

import numpy as np

from sono.curve import Components, Floats
from sono.figures.plot.along import arclength, edges, mark
from sono.figures.plot.sheet import library
from sono.shape import curvature

if TYPE_CHECKING:
    from matplotlib.axes import Axes

STRAIGHT = 0.05
"""Curvature below which a rope is so straight that it has no torsion to speak of."""

BASE = 0.5
"""Torsion is that of vertices so many radii apart: over single edges the grooves between beads drown it."""

TURNED = 2.0
"""Where planes turn by a larger angle the rope begins to bend the other way, which is no torsion."""

HEIGHT = 3.0
"""What is drawn ends above and below this at the latest."""


def torsion(component: Floats) -> Floats:
    """Return the torsions (n,) between each vertex and the one about `BASE` further on, for R = 1.

    That is the angle from the plane of the vertices before, here and there to that of here, there and beyond,
    over their distance: positive for a right-handed helix, nan where the curve is straight or bends over.
    """
    apart = steps(component)
    edge = np.roll(component, -apart, axis=0) - component
    normal = np.cross(np.roll(edge, apart, axis=0), edge)
    following = np.roll(normal, -apart, axis=0)
    lengths = np.linalg.norm(edge, axis=1)
    sine = (np.cross(normal, following) * edge).sum(axis=1) / lengths
    angle = np.arctan2(sine, (normal * following).sum(axis=1))
    bent = np.linalg.norm(normal, axis=1) > STRAIGHT * lengths**3
    return np.where(bent & np.roll(bent, -apart) & (abs(angle) < TURNED), angle / lengths, np.nan)


def steps(component: Floats) -> int:
    """Return how many edges are about `BASE` long, three turns of which are less than the curve."""
    return int(np.clip(round(BASE / edges(component).mean()), 1, max(len(component) // 4, 1)))


def draw(components: Components, axes: "Axes") -> None:
    """Draw both along a rope of R = 1, with a line where curvature is 1, the most that a rope can have."""
    colours = library().rcParams
    axes.axhline(0, color=colours["grid.color"], linewidth=0.6, zorder=0.5)
    axes.axhline(1, color=colours["text.color"], linewidth=0.6, linestyle=(0, (4, 3)), label="1/R")
    for k, (s, component) in enumerate(zip(arclength(components), components, strict=True)):
        first = k == 0
        middle = s + steps(component) * edges(component).mean() / 2
        axes.plot(middle, torsion(component), color="C1", label="torsion" if first else None)
        axes.plot(s, curvature(component), color="C0", label="curvature" if first else None)
    mark(components, axes)
    low, high = axes.get_ylim()
    axes.set(ylim=(max(low, -HEIGHT), min(high, HEIGHT)), ylabel="curvature, torsion · R")
    axes.legend(loc="lower right", bbox_to_anchor=(1, 1), ncols=3)
