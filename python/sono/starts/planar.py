"""Knots and links drawn from a planar diagram: by the method of Tutte, then lifted at the crossings.

The diagram is a plane graph of crossings and middles of edges. With a point amid each face but the outer one
it is a triangulation; once the outer face is fixed on a circle, every point is put into the weighted mean of
its neighbours, and no two lines cross, whatever the weights (W. Tutte, "How to draw a graph", Proc. London
Math. Soc. 13 (1963) 743; M. Floater, Comput. Aided Geom. Design 14 (1997) 231). Another outer face gives
another conformation: strands that ran inside now run round all others.
"""

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from sono.curve import Components, Floats, measure
from sono.starts.diagrams import Diagram, Slot, faces, pieces, reduced
from sono.starts.drawing import divided
from sono.starts.torus import chain

ROUNDS = 12
"""Rounds in which long lines get more weight; the drawing with the most even lines is taken."""

UNEVEN = 25
"""Ratio of the longest line to the shortest up to which a drawing is taken."""

LONGEST = 2000
"""Ropelength up to which a drawing is taken; one in a hundred is longer. A rope in flat triangles is thin: at
a length of 10,000 it takes ten seconds to collapse, if it does."""

TRIES = 12
"""Outer faces that are tried; a knot of 10 crossings has as many."""

PULL = 0.3
"""The power of its length by which a line's weight grows in a round."""


APART = 4.0
"""Distance of the pieces of a split link, in radii."""


def lifted(diagram: Diagram, seed: int) -> Components:
    """Return the knot or link of a planar diagram, from which nugatory crossings are removed first.

    The seed chooses the outer face and draws the first weights. The shortest line is 1 long, strands cross 2
    apart, and the next face is taken instead of one that leaves the others too little room; where all do, the
    drawing with the shortest rope. Pieces of a split link come side by side.
    """
    diagram = reduced(diagram)
    curve = [*chain(1)] * len(diagram.begins)
    groups = [[number] for number, begin in enumerate(diagram.begins) if not begin]
    for piece in pieces(diagram.far):
        group = [number for number, begin in enumerate(diagram.begins) if begin and begin[0] in piece]
        drawn = _lifted(_part(diagram, piece, group), seed)
        for number, component in zip(group, drawn, strict=True):
            curve[number] = component
        groups.append(group)
    right = 0.0
    for group in groups if len(groups) > 1 else ():
        left = min(curve[number][:, 0].min() for number in group)
        for number in group:
            curve[number] = curve[number] + [right - left, 0, 0]
        right = max(curve[number][:, 0].max() for number in group) + APART
    return curve


def _part(diagram: Diagram, piece: Sequence[int], group: Sequence[int]) -> Diagram:
    """Return a piece of a diagram, which has these components."""
    far = {slot: other for slot, other in diagram.far.items() if slot[0] in piece}
    return Diagram(far, [diagram.begins[number] for number in group])


def _lifted(diagram: Diagram, seed: int) -> Components:
    """Return the curve of a diagram that is neither split nor has a nugatory crossing."""
    around = faces(diagram.far)
    crossing, edge = _points(diagram)
    drawings = []
    for outer in ((np.arange(len(around)) + seed % len(around)) % len(around))[:TRIES]:
        lines, boundary = _triangulated(crossing, edge, around, int(outer))
        points = _drawn(lines, boundary, np.random.default_rng(seed))
        lengths = np.linalg.norm(points[lines[:, 0]] - points[lines[:, 1]], axis=1)
        points /= lengths.min()
        curve = [
            _raised([(crossing[slot[0]], edge[slot], slot[1] % 2) for slot in entered], points)
            for entered in diagram.circuits()
        ]
        drawings.append((measure(curve).l_p, curve))
        if lengths.max() < UNEVEN * lengths.min() and drawings[-1][0] < LONGEST:
            return curve
    return min(drawings, key=lambda drawing: drawing[0])[1]


def _points(diagram: Diagram) -> tuple[dict[int, int], dict[Slot, int]]:
    """Number the crossings, and then the edges along the components, by the slots at both ends."""
    crossing = {number: point for point, number in enumerate(sorted({x for x, _ in diagram.far}))}
    edge: dict[Slot, int] = {}
    for slot in (slot for circuit in diagram.circuits() for slot in circuit):
        edge[slot] = edge[diagram.far[slot]] = len(crossing) + len(edge) // 2
    return crossing, edge


def _raised(passages: Sequence[tuple[int, int, int]], points: Floats) -> Floats:
    """Return the component (n, 3) above a drawing: its crossings, the edges into them, and if it is over."""
    corners = []
    for crossing, edge, over in passages:
        corners += [[*points[edge], 0], [*points[crossing], 2 * over - 1]]
    return divided(np.array(corners, float), 0.6)


def _triangulated(
    crossing: dict[int, int], edge: dict[Slot, int], around: Sequence[Sequence[Slot]], outer: int
) -> tuple[NDArray[np.int_], NDArray[np.int_]]:
    """Return the lines (m, 2) of the triangulation, and the points round the outer face, clockwise.

    Points are the crossings, then the middles of edges, then those amid faces.
    """
    lines = [(crossing[slot[0]], edge[slot]) for slot in sorted(edge)]
    boundary: list[int] = []
    for number, face in enumerate(around):
        circuit = [point for slot in face for point in (crossing[slot[0]], edge[slot])]
        if number == outer:
            boundary = circuit
        else:
            lines += [(3 * len(crossing) + number - (number > outer), point) for point in circuit]
    return np.array(lines), np.array(boundary[::-1])


def _drawn(lines: NDArray[np.int_], boundary: NDArray[np.int_], random: np.random.Generator) -> Floats:
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
