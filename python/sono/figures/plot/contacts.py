"""A map of the contact forces in a rope: which beads press against each other, and how hard."""

from typing import TYPE_CHECKING

import numpy as np

from sono.curve import Components, Forces
from sono.figures.plot.along import arclength, mark

if TYPE_CHECKING:
    from matplotlib.axes import Axes

LEAST = 1e-3
"""Forces below this share of the largest one, or of a thousandth of the tension, are what rounding leaves."""

SIZES = 1.0, 18.0
"""Areas of the dots of the least and the largest force, in square points."""


def draw(components: Components, forces: Forces, axes: "Axes") -> None:
    """Draw each contact twice, at (s, t) and (t, s), the arclengths of its beads, in radii.

    Its force, in units of the mean tension, is its colour and its size.
    """
    shown = forces.pressing > LEAST * forces.pressing.max(initial=LEAST)
    order = np.argsort(forces.pressing[shown], kind="stable")  # the largest last, on top of the others
    pressing = forces.pressing[shown][order]
    one, other = np.concatenate(arclength(components))[forces.contacts[shown][order]].T
    share = np.repeat(pressing / pressing.max(initial=1e-300), 2)
    dots = axes.scatter(
        np.column_stack([one, other]).ravel(),
        np.column_stack([other, one]).ravel(),
        c=np.repeat(pressing, 2),
        s=SIZES[0] + (SIZES[1] - SIZES[0]) * share,
        vmin=0,
        linewidths=0,
    )
    mark(components, axes, "xy")
    scale = axes.figure.colorbar(dots, ax=axes, shrink=0.8, pad=0.02)
    scale.set_label("force of a contact / mean tension")
    scale.outline.set_visible(False)
