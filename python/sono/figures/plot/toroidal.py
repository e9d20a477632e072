"""The paper's toroidal model: how far dL_p, dL_c and dL_a are from the truth, and the weight a."""

from typing import TYPE_CHECKING

import numpy as np

from sono import model

if TYPE_CHECKING:
    from matplotlib.axes import Axes

MOST = 1.0
"""The longest edge, in radii."""

EDGE = "edge length $dl$ / R"


def deviations(axes: "Axes") -> None:
    """Draw the relative deviations (dL_p - dL)/dL, (dL_c - dL)/dL and (dL_a - dL)/dL, in percent."""
    dl = np.linspace(0, MOST, 201)[1:]
    true = model.true(dl)
    curves = (("$dL_c$", model.inscribed, "C1"), ("$dL_a$", model.average, "C2"), ("$dL_p$", model.raw, "C0"))
    for name, length, colour in curves:
        axes.plot(dl, 100 * (length(dl) / true - 1), color=colour, label=name)
    axes.set(xlim=(0, MOST), xlabel=EDGE, ylabel="deviation from $dL$ / %")
    axes.legend()


def weight(axes: "Axes") -> None:
    """Draw the weight a, and its series."""
    dl = np.linspace(0, MOST, 201)[1:]
    axes.plot(dl, model.weight(dl), color="C0", label="$a(dl)$")
    axes.plot(dl, model.weight_series(dl), "--", color="C1", label=r"$4 + \frac{353}{480}\,dl^2$")
    axes.set(xlim=(0, MOST), xlabel=EDGE, ylabel="weight $a$")
    axes.legend()
