"""Biarcs: two arcs of circles that touch where they meet, from a node to the next along the tangents of both.

They meet where libbiarc's midpoint rule lets them. Source: J. Smutny, "Global radii of curvature, and the
biarc approximation of space curves" (thesis, EPFL, 2004); M. Carlen's libbiarc, `Biarc::make`.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Self

import numpy as np
from numpy.typing import NDArray

from sono.formats.sampling import Drawing

Floats = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class Arcs:
    """Arcs of circles one after the other: where they begin, their unit `tangents` there, and where they end.

    All are (m, 3). An `open` curve goes on to the last end; `proper` (m / 2,) tells where a biarc fits.
    """

    starts: Floats
    tangents: Floats
    ends: Floats
    open: bool
    proper: NDArray[np.bool_]

    @classmethod
    def of(cls, nodes: Floats, closed: bool) -> Self:
        """Make two arcs between any two neighbours of nodes (n, 6)."""
        last = len(nodes) if closed else -1
        following = np.roll(nodes, -1, axis=0)[:last]
        q0, t0 = nodes[:last, :3], _unit(nodes[:last, 3:])
        q1, t1 = following[:, :3], _unit(following[:, 3:])
        d = q1 - q0
        a, b, dd = _dot(t0, d), _dot(t1, d), _dot(d, d)
        # Both arcs touch the sides of a polygon q0, b0, b1, q1 along t0, t1 and the tangent where they meet.
        # The first side is s/a, the last s/b and the middle one s/a + s/b long: this gives s.
        s = dd / (2 + np.sqrt(4 + 2 * (1 - _dot(t0, t1)) * dd / (a * b)))
        b0, b1 = q0 + s / a * t0, q1 - s / b * t1
        middle = b0 + b / (a + b) * (b1 - b0)
        proper = ((a > 0) & (b > 0))[:, 0]
        starts, tangents = _in_turn(q0, middle), _in_turn(t0, _unit(b1 - b0))
        return cls(starts, tangents, _in_turn(middle, q1), not closed, proper)

    def drawn(self, pieces: int) -> tuple[Floats, float, float]:
        """Give the vertices when each arc is so many edges, their distance from the arcs and their angle."""
        chords = self.ends - self.starts
        along = _dot(chords, self.tangents)
        across = chords - along * self.tangents
        half = np.arctan2(np.sqrt(_dot(across, across)), along)  # an arc turns by twice as much
        aside, lengths = _unit(across), np.sqrt(_dot(chords, chords))
        points = []
        for share in np.arange(pieces) / pieces:
            turned = np.cos(share * half) * self.tangents + np.sin(share * half) * aside
            on_circle = lengths * np.sin(share * half) / np.sin(half) * turned
            points.append(self.starts + np.where(half > 0, on_circle, share * chords))
        rows = np.stack(points, axis=1).reshape(-1, 3)
        far = np.where(half > 0, lengths / np.sin(half) * np.sin(half / (2 * pieces)) ** 2, 0).max()
        rows = np.vstack([rows, self.ends[-1:]]) if self.open else rows
        return rows, float(far), float(half.max() / pieces)


def drawn(arcs: Sequence[Arcs], pieces: int) -> Drawing:
    """Draw several curves, each arc as so many edges."""
    curves, far, angles = zip(*(arc.drawn(pieces) for arc in arcs), strict=True)
    return list(curves), max(far), max(angles)


def _dot(a: Floats, b: Floats) -> Floats:
    return np.asarray((a * b).sum(axis=1, keepdims=True))


def _unit(a: Floats) -> Floats:
    return np.asarray(a / np.sqrt(_dot(a, a)))


def _in_turn(a: Floats, b: Floats) -> Floats:
    return np.stack([a, b], axis=1).reshape(-1, 3)
