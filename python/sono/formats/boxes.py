"""Periodic boxes of simulations, and how a chain that was wrapped into one is unwrapped."""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from sono.formats.doubts import LEAST, LONGEST, STEPS
from sono.formats.vertices import FormatError

Floats = NDArray[np.float64]
Lines = Sequence[int] | NDArray[np.int64]

UNCLEAR = 1 / 3
"""A step of so many boxes, or more, may as well be one through the box: half a box is as long either way."""

BREAK = 4.0
"""An edge so many times as long as the median one hardly joins neighbours of a chain."""


FITS = 1.05
"""A chain that is wider than so many boxes is not wrapped."""


@dataclass(frozen=True, eq=False)
class Box:
    """A box: its corner `origin` (3,), its `edges` (3, 3), one a row, and which are `periodic` (3,)."""

    origin: Floats
    edges: Floats
    periodic: NDArray[np.bool_]

    def at(self, scaled: Floats) -> Floats:
        """Give the places (n, 3) of scaled coordinates (n, 3), which go from 0 to 1 through the box."""
        return self.origin + scaled @ self.edges

    def boxes(self, steps: Floats) -> Floats:
        """Give steps (n, 3) in boxes, zero along edges that are not periodic."""
        return np.where(self.periodic, steps @ np.linalg.inv(self.edges), 0)

    @classmethod
    def of_bounds(cls, low: Floats, high: Floats, tilts: Floats, periodic: NDArray[np.bool_]) -> "Box":
        """Make a box between two corners (3,), tilted by xy, xz and yz (3,). Raises `ValueError` if flat."""
        edges = np.diag(high - low)
        edges[[1, 2, 2], [0, 0, 1]] = tilts
        return cls(low, edges, periodic).checked()

    @classmethod
    def of_angles(cls, sides: Floats, angles: Floats) -> "Box":
        """Make a box of its sides (3,) and the angles (3,) opposite, in degrees, likewise."""
        (a, b, c), (alpha, beta, gamma) = sides, np.cos(np.radians(angles))
        sine = np.sqrt(1 - gamma**2)
        xz, yz = c * beta, c * (alpha - beta * gamma) / sine
        high = np.array([a, b * sine, np.sqrt(c**2 - xz**2 - yz**2)])
        return cls.of_bounds(np.zeros(3), high, np.array([b * gamma, xz, yz]), np.full(3, True))

    def checked(self) -> "Box":
        """Return the box. Raises `ValueError` if it has no volume or is not finite."""
        if not np.isfinite(self.edges).all() or not np.linalg.det(self.edges) > 0:
            raise ValueError("the box has no volume")
        return self


def unwrapped(box: Box, rows: Floats, name: str, lines: Lines) -> Floats:
    """Give a chain (n, 3) with every atom at its image nearest to the one before.

    Raises `FormatError` for a step that is about as long either way.
    """
    steps = np.diff(rows, axis=0)
    through = np.rint(box.boxes(steps))
    if not through.any():
        return rows
    unclear = (abs(box.boxes(steps) - through) > UNCLEAR).any(axis=1)
    if unclear.any():
        raise FormatError.at(
            name,
            int(lines[1 + int(unclear.argmax())]),
            "the step to this atom is about half the periodic box, so that it may go either way; write the "
            "image flags ix iy iz or the unwrapped xu yu zu",
        )
    return rows - np.vstack([np.zeros(3), np.cumsum(through, axis=0)]) @ box.edges


def rejoined(box: Box, rows: Floats, name: str, lines: Lines, ring: bool = True) -> Floats:
    """Give a chain (n, 3) that its box has wrapped as `unwrapped` does, and any other as it is.

    A file may tell the box of chains that were never wrapped. Raises `FormatError` for a chain of which it is
    not clear whether it was, and for what may be a `ring` and winds round the box.
    """
    fits = np.ptp(rows @ np.linalg.inv(box.edges), axis=0) <= FITS
    box = replace(box, periodic=box.periodic & fits)
    jumping = np.asarray(np.rint(box.boxes(np.diff(rows, axis=0))).any(axis=1))
    whole = unwrapped(box, rows, name, lines) if jumping.any() else rows
    if jumping.any() and not _short_again(rows, whole, jumping):
        raise FormatError.at(
            name,
            int(lines[1 + int(jumping.argmax())]),
            "the step to this atom is longer than half the periodic box, which may have wrapped the chain, "
            "or not; write unwrapped coordinates, and leave out the box",
        )
    if ring or jumping.any():  # in crystals the end of a chain may well touch an image of its beginning
        refuse_winding(box, whole, name, lines)
    return whole


def _short_again(rows: Floats, whole: Floats, jumping: NDArray[np.bool_]) -> bool:
    """Tell whether the jumps stand out from the other steps, and are like these in the unwrapped chain."""
    before, after = (np.linalg.norm(np.diff(chain, axis=0), axis=1) for chain in (rows, whole))
    usual = before[~jumping]
    return bool(
        len(usual) >= LEAST
        and before[jumping].min() >= STEPS * usual.max()
        and after[jumping].max() <= LONGEST * usual.max()
    )


def refuse_winding(box: Box, rows: Floats, name: str, lines: Lines) -> None:
    """Refuse an unwrapped ring (n, 3) whose last atom is next to an image of the first, not to the first."""
    closing = rows[0] - rows[-1]
    nearest = closing - np.rint(box.boxes(closing)) @ box.edges
    near = LONGEST * np.linalg.norm(np.diff(rows, axis=0), axis=1).max(initial=0)
    if np.linalg.norm(nearest) <= near < np.linalg.norm(closing):
        raise FormatError.at(
            name,
            int(lines[-1]),
            "the chain winds round the periodic box: after this atom comes an image of its first, on line "
            f"{lines[0]}, and no knot in space is made of that; take the ring from a larger box",
        )


def second_chain(rows: Floats) -> tuple[int, float] | None:
    """Give the edge along a chain (n, 3) after which another one seems to begin, and its length in medians.

    It is so long that it hardly joins neighbours, or it is rather long where the chain so far has come back
    to its beginning, to which all of it does not come back.
    """
    steps = np.linalg.norm(np.diff(rows, axis=0), axis=1)
    if len(steps) < 3:
        return None
    near = LONGEST * np.median(steps)
    back = np.linalg.norm(rows[:-1] - rows[0], axis=1) <= near
    back[:2] = False
    ring = back & (steps > near) & (np.linalg.norm(rows[-1] - rows[0]) > near)
    found = ring | (steps > BREAK * np.median(steps))
    edge = int(found.argmax())
    return (edge, float(steps[edge] / np.median(steps))) if found[edge] else None
