"""Knots drawn from a planar diagram: in the plane by the method of Tutte, then lifted at the crossings.

The diagram is a plane graph of crossings and middles of edges. With a point amid each face but the outer one
it is a triangulation; once the outer face is fixed on a circle, every point is put into the weighted mean of
its neighbours, and no two lines cross, whatever the weights (W. Tutte, "How to draw a graph", Proc. London
Math. Soc. 13 (1963) 743; M. Floater, Comput. Aided Geom. Design 14 (1997) 231). Another outer face gives
another conformation: strands that ran inside now run round all others.
"""

from collections.abc import Sequence
from typing import TypeAlias

import numpy as np
from numpy.typing import NDArray

from sono.curve import Components, measure
from sono.starts.drawing import divided

Diagram: TypeAlias = list[tuple[int, int, int, int]]
"""A PD code: for each crossing its four edges, from 1, counter-clockwise from the incoming lower one."""

Slot: TypeAlias = tuple[int, int]
"""A crossing, and the place of an edge among its four."""

ROUNDS = 12
"""Rounds in which long lines get more weight; the drawing with the most even lines is taken."""

UNEVEN = 25
"""Ratio of the longest line to the shortest up to which a drawing is taken."""

LONGEST = 2000
"""Ropelength up to which a drawing is taken; one in a hundred is longer. A rope in flat triangles is thin: at
a length of 10,000 it takes ten seconds to collapse, if it does."""

PULL = 0.3
"""The power of its length by which a line's weight grows in a round."""


def lifted(diagram: Diagram, seed: int) -> Components:
    """Return the knot of a planar diagram without nugatory crossings.

    The seed chooses the outer face and draws the first weights. The shortest line is 1 long, strands cross 2
    apart, and the next face is taken instead of one that leaves the others too little room; where all do, the
    drawing with the shortest rope.
    """
    around = faces(diagram)
    drawings = []
    for outer in (np.arange(len(around)) + seed % len(around)) % len(around):
        lines, boundary = _triangulated(diagram, around, int(outer))
        points = _drawn(lines, boundary, np.random.default_rng(seed))
        lengths = np.linalg.norm(points[lines[:, 0]] - points[lines[:, 1]], axis=1)
        curve = _raised(diagram, points / lengths.min())
        drawings.append((measure([curve]).l_p, curve))
        if lengths.max() < UNEVEN * lengths.min() and drawings[-1][0] < LONGEST:
            return [curve]
    return [min(drawings, key=lambda drawing: drawing[0])[1]]


def _raised(diagram: Diagram, points: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return the knot (n, 3) above a drawing of its diagram."""
    corners = []
    for edge in range(1, 2 * len(diagram) + 1):
        crossing = _left_by(diagram, edge)
        z = -1 if diagram[crossing][0] == edge else 1
        corners += [[*points[len(diagram) + edge - 1], 0], [*points[crossing], z]]
    return divided(np.array(corners, float), 0.6)


def _left_by(diagram: Diagram, edge: int) -> int:
    """Return the crossing that an edge leads to: where the slot across is that of the next edge."""
    after = edge % (2 * len(diagram)) + 1
    for crossing, slots in enumerate(diagram):
        if any((slots[k], slots[k - 2]) == (edge, after) for k in range(4)):
            return crossing
    raise ValueError(f"a planar diagram in which edge {edge} does not lead on to {after}")


def across(diagram: Diagram) -> dict[Slot, Slot]:
    """Return the slot at the other end of the edge in each slot."""
    ends: dict[int, list[Slot]] = {}
    for crossing, edges in enumerate(diagram):
        for slot, edge in enumerate(edges):
            ends.setdefault(edge, []).append((crossing, slot))
    return {slot: other for one, two in ends.values() for slot, other in ((one, two), (two, one))}


def faces(diagram: Diagram) -> list[list[Slot]]:
    """Return the slots from which edges have each face to their left, those of the largest face first."""
    far = across(diagram)
    unseen = set(far)
    found = []
    while unseen:
        slot = min(unseen)
        face = []
        while slot in unseen:
            unseen.remove(slot)
            face.append(slot)
            # Along the edge to its other end; the face goes on at the slot clockwise from there.
            crossing, end = far[slot]
            slot = crossing, (end - 1) % 4
        found.append(face)
    return sorted(found, key=len, reverse=True)


def _triangulated(
    diagram: Diagram, around: Sequence[Sequence[Slot]], outer: int
) -> tuple[NDArray[np.int_], NDArray[np.int_]]:
    """Return the lines (m, 2) of the triangulation, and the points round the outer face, clockwise.

    Points are the crossings, then the middles of edges, then those amid faces.
    """
    crossings = len(diagram)
    lines = [(x, crossings + edge - 1) for x, slots in enumerate(diagram) for edge in slots]
    boundary: list[int] = []
    for number, face in enumerate(around):
        circuit = [point for x, slot in face for point in (x, crossings + diagram[x][slot] - 1)]
        if number == outer:
            boundary = circuit
        else:
            lines += [(3 * crossings + number - (number > outer), point) for point in circuit]
    return np.array(lines), np.array(boundary[::-1])


def _drawn(
    lines: NDArray[np.int_], boundary: NDArray[np.int_], random: np.random.Generator
) -> NDArray[np.float64]:
    """Return the points (n, 2) of the drawing in which the longest line is least in terms of the shortest."""
    count = lines.max() + 1
    angle = 2 * np.pi * np.arange(len(boundary)) / len(boundary)
    points = np.zeros((count, 2))
    points[boundary] = np.column_stack([np.cos(angle), np.sin(angle)])
    free = np.setdiff1d(np.arange(count), boundary)
    weights = np.exp(random.normal(scale=0.5, size=len(lines)))
    best, least = points, np.inf
    for _ in range(ROUNDS):
        form = np.zeros((count, count))
        for one, other in (lines.T, lines.T[::-1]):
            np.add.at(form, (one, one), weights)
            np.add.at(form, (one, other), -weights)
        pull = -form[np.ix_(free, boundary)] @ points[boundary]
        points[free] = np.linalg.solve(form[np.ix_(free, free)], pull)
        lengths = np.linalg.norm(points[lines[:, 0]] - points[lines[:, 1]], axis=1)
        if lengths.max() < least * lengths.min():
            best, least = points.copy(), lengths.max() / lengths.min()
        weights *= (lengths / lengths.mean()) ** PULL
    return best
