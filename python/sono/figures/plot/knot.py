"""A rope as one sees it: a smooth tube, or the beads that it is made of."""

import math
from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from sono import _core
from sono.curve import Components, Floats, measure
from sono.figures.plot.balls import Balls, picture
from sono.figures.plot.sheet import label, library
from sono.figures.turning import facing

if TYPE_CHECKING:
    from matplotlib.axes import Axes

PIXELS = 1000
"""Across a picture."""

SPACING = 0.06
"""Distance of the balls of a tube, in radii of it."""

THINNEST = 0.005
"""A tube is drawn at least so thick, its radius over the size of the picture."""

LABEL = 0.06
"""Height of a label over the width of a picture."""


def draw(ropes: Sequence[Components], labels: Sequence[str], beads: bool, axes: "Axes") -> None:
    """Draw ropes of R_s = 1 side by side, each with its label below, all on one scale, in radii.

    A tube has the axis K_P and the radius R_c, or R_s where there is none: it fits into the bead rope. The
    components of a link have the colours of the cycle.
    """
    drawn = [_balls(facing(rope), beads) for rope in ropes]
    bounds = [balls.bounds() for balls in drawn]
    columns = len(ropes) if len(ropes) <= 3 else math.ceil(math.sqrt(len(ropes)))
    rows = math.ceil(len(ropes) / columns)
    width, height = np.max([high - low for low, high in bounds], axis=0)
    below = LABEL * columns * width if any(labels) else 0
    step = columns * width / PIXELS
    for k, (balls, (low, high)) in enumerate(zip(drawn, bounds, strict=True)):
        middle = np.array([(k % columns + 0.5) * width, -(k // columns + 0.5) * (height + below)])
        shape = tuple(math.ceil(size / step) for size in (high - low)[::-1])
        corner = middle - (high - low) / 2
        extent = (corner[0], corner[0] + shape[1] * step, corner[1], corner[1] + shape[0] * step)
        axes.imshow(picture(balls, low, step, shape), origin="lower", extent=extent)
        if below:
            axes.text(middle[0], middle[1] - height / 2, label(labels[k]), ha="center", va="top")
    axes.set(xlim=(0, columns * width), ylim=(-rows * (height + below), 0), aspect="equal")
    axes.set_axis_off()


def _balls(rope: Components, beads: bool) -> Balls:
    """Return the balls of a rope: its beads, or those of a smooth tube."""
    colours = [library("matplotlib.colors").to_rgb(f"C{k % 10}") for k in range(len(rope))]
    measures = measure(rope)
    radius = max(1 if beads else measures.r_c or 1, THINNEST * float(np.ptp(np.vstack(rope), axis=0).max()))
    if beads:
        axes = [np.zeros_like(component) for component in rope]
    else:
        rope = _core.refine(rope, math.ceil(measures.length / (SPACING * radius)))
        axes = [_axes(component) for component in rope]
    painted = np.repeat(colours, [len(component) for component in rope], axis=0)
    return Balls(np.vstack(rope), radius, painted, np.vstack(axes))


def _axes(component: Floats) -> Floats:
    """Return the unit tangents (n, 3) at the vertices of a smooth closed curve."""
    chords = np.roll(component, -1, axis=0) - np.roll(component, 1, axis=0)
    tangents: Floats = chords / np.linalg.norm(chords, axis=1)[:, None]
    return tangents
