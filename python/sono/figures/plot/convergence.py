"""L_p, L_c and L_a of one knot against the length of edges, and what they tend to."""

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from sono.curve import Floats
from sono.tables import Row

if TYPE_CHECKING:
    from matplotlib.axes import Axes

LENGTHS = {"l_p": ("$L_p$", "C0", "o"), "l_a": ("$L_a$", "C2", "s"), "l_c": ("$L_c$", "C1", "^")}

LEAST = 3
"""Points that determine a fit."""


@dataclass(frozen=True)
class Fit:
    """L = `limit` + b dl + c dl^2: the `coefficients` (3,), and the standard error of the limit.

    Without more points than coefficients there is no `error`.
    """

    coefficients: Floats
    error: float | None

    @property
    def limit(self) -> float:
        """L at dl = 0."""
        return float(self.coefficients[0])

    @classmethod
    def of(cls, dl: Floats, lengths: Floats) -> "Fit":
        """Fit lengths (m,) at edge lengths (m,) by least squares. Raises `ValueError` below 3 edge lengths.

        >>> dl = np.array([0.1, 0.2, 0.3, 0.4])
        >>> Fit.of(dl, 5 + 2 * dl - 3 * dl**2).coefficients.round(9).tolist()
        [5.0, 2.0, -3.0]
        """
        if len(np.unique(dl)) < LEAST:
            given = f"{LEAST} lengths of edges, and these are {len(np.unique(dl))}"
            raise ValueError(f"a fit of second order takes {given}; tighten the knot at more n")
        powers = (dl / dl.max())[:, None] ** np.arange(LEAST)
        found = np.linalg.lstsq(powers, lengths)[0]
        spare = len(dl) - LEAST
        rest = ((powers @ found - lengths) ** 2).sum() / spare if spare else math.nan
        error = math.sqrt(rest * np.linalg.inv(powers.T @ powers)[0, 0])
        return cls(found / dl.max() ** np.arange(LEAST), error if spare else None)

    def at(self, dl: Floats) -> Floats:
        """Return the lengths at these edge lengths."""
        lengths: Floats = dl[:, None] ** np.arange(LEAST) @ self.coefficients
        return lengths

    def shown(self) -> str:
        """Return the limit and its error, to the digits that the error leaves."""
        if self.error is None:
            return f"{self.limit:.5f}"
        digits = min(max(1 - math.floor(math.log10(self.error or 1e-12)), 0), 8)
        return f"{self.limit:.{digits}f} ± {self.error:.{digits}f}"


def draw(rows: Sequence[Row], axes: "Axes") -> None:
    """Draw the rows of ropes, with fits of second order. Raises `ValueError` where there are too few."""
    axes.set(xlabel="edge length $dl$ / R", ylabel="ropelength (length / radius)")
    for key, (name, colour, marker) in LENGTHS.items():
        points = np.array([(_edge(row), row[key]) for row in rows if row.get(key) is not None], float)
        dl, lengths = points.reshape(-1, 2).T
        if not len(dl) and key != "l_p":
            continue
        if len(dl) < LEAST and key != "l_p":  # coarse ropes have no L_c
            axes.plot(dl, lengths, marker, color=colour, label=name)
            continue
        fit = Fit.of(dl, lengths)
        label = rf"{name} $\to$ {fit.shown()}"
        axes.plot(dl, lengths, marker, color=colour, label=label, clip_on=False, zorder=3)
        line = np.linspace(0, dl.max(), 200)
        axes.plot(line, fit.at(line), color=colour, linewidth=0.8)
    axes.set_xlim(0)
    axes.legend()


def _edge(row: Mapping[str, object]) -> float:
    """Return the mean length of edges in radii, whatever the unit of dl is: L_p is n times that."""
    return float(str(row["l_p"])) / int(str(row["n"]))
