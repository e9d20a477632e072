"""Knots and links drawn from a planar diagram: by the method of Tutte, then lifted at the crossings.

The diagram is a plane graph of crossings and middles of edges. With a point amid each face but the outer one
it is a triangulation; once the outer face is fixed on a circle, every point is put into the weighted mean of
its neighbours, and no two lines cross, whatever the weights (W. Tutte, "How to draw a graph", Proc. London
Math. Soc. 13 (1963) 743; M. Floater, Comput. Aided Geom. Design 14 (1997) 231). Another outer face gives
another conformation: strands that ran inside now run round all others.
"""

from collections.abc import Sequence
from contextlib import suppress
from itertools import product

import numpy as np
from numpy.typing import NDArray

from sono.curve import Components, Floats, measure
from sono.starts.diagrams import Diagram, Slot, faces, pieces, reduced
from sono.starts.drawing import divided
from sono.starts.evening import areas, evened
from sono.starts.torus import chain

ROUNDS = 12
"""Rounds in which long lines get more weight; the drawing with the most even lines is taken."""

UNEVEN = 25
"""Ratio of the longest line to the shortest up to which a drawing is taken."""

LONGEST = 2000
"""Ropelength up to which a drawing is taken; one in a hundred is longer. A rope in flat triangles is thin: at
a length of 10,000 it takes ten seconds to collapse, if it does."""

TRIES = 6
"""Outer faces that are tried from the one on that the seed chooses, and as many of the largest."""

PULL = 0.3
"""The power of its length by which a line's weight grows in a round."""


FLAT = 1e-12
"""Twice the area of a triangle, in a circle of radius 1, up to which rounding may have turned it over."""

LARGEST = 50_000
"""The length of all lines together, in radii, up to which a drawing is measured."""

STEPS = 50
"""Steps in which an uneven drawing is made even."""

APART = 4.0
"""Distance of the pieces of a split link, in radii."""


def lifted(diagram: Diagram, seed: int) -> Components:
    """Return the knot or link of a planar diagram, from which nugatory crossings are removed first.

    The seed chooses the outer face and draws the first weights. The shortest line is 1 long, strands cross 2
    apart. A drawing that leaves some faces too little room is made even; where that does not help, the next
    face is taken, and where none helps, the drawing with the shortest rope. Pieces of a split link come side
    by side. Raises ValueError where no drawing has room for a rope.
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
    drawings = []
    begun = [(seed + k) % len(around) for k in range(TRIES)]
    for outer, steps in product(dict.fromkeys([*begun, *range(min(TRIES, len(around)))]), (0, STEPS)):
        with suppress(ValueError):  # one without thickness, or far too large
            ratio, curve = _drawing(diagram, around, outer, seed, steps)
            drawings.append((measure(curve).l_p, curve))
            if ratio < UNEVEN and drawings[-1][0] < LONGEST:
                return curve
    if not drawings:
        raise ValueError("the diagram cannot be drawn with room for a rope; give one of fewer crossings")
    return min(drawings, key=lambda drawing: drawing[0])[1]


def _drawing(
    diagram: Diagram, around: Sequence[Sequence[Slot]], outer: int, seed: int, steps: int
) -> tuple[float, Components]:
    """Return the curve with this outer face, made even in so many steps, after how uneven its lines are.

    Raises ValueError where rounding might have let lines cross, or they are so uneven that all are `LARGEST`.
    """
    crossing, edge = _points(diagram)
    lines, triangles, boundary = _triangulated(crossing, edge, around, outer)
    points = _drawn(lines, boundary, np.random.default_rng(seed))
    if areas(points, triangles).min() > FLAT:
        points = evened(points, triangles, boundary, steps)
    if areas(points, triangles).min() <= FLAT:
        raise ValueError("a triangle of the drawing is flat")
    lengths = np.linalg.norm(points[lines[:, 0]] - points[lines[:, 1]], axis=1)
    points /= lengths.min()
    if lengths.sum() > LARGEST * lengths.min():
        raise ValueError("some lines are far longer than others")
    curve = [
        _raised([(crossing[slot[0]], edge[slot], slot[1] % 2) for slot in entered], points)
        for entered in diagram.circuits()
    ]
    return lengths.max() / lengths.min(), curve


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
) -> tuple[NDArray[np.int_], NDArray[np.int_], NDArray[np.int_]]:
    """Return the lines (m, 2), the triangles (k, 3), and the points round the outer face, counter-clockwise.

    Points are the crossings, then the middles of edges, then those amid faces.
    """
    lines = [(crossing[slot[0]], edge[slot]) for slot in sorted(edge)]
    triangles: list[tuple[int, int, int]] = []
    boundary: list[int] = []
    for number, face in enumerate(around):
        circuit = [point for slot in face for point in (crossing[slot[0]], edge[slot])]
        if number == outer:
            boundary = circuit
        else:
            amid = 3 * len(crossing) + number - (number > outer)
            lines += [(amid, point) for point in circuit]
            triangles += [(amid, circuit[k - 1], point) for k, point in enumerate(circuit)]
    return np.array(lines), np.array(triangles), np.array(boundary[::-1])


def _drawn(lines: NDArray[np.int_], boundary: NDArray[np.int_], random: np.random.Generator) -> Floats:
    """Return the points (n, 2) of the drawing in which the longest line is least in terms of the shortest."""
    count = lines.max() + 1
    angle = 2 * np.pi * np.arange(len(boundary)) / len(boundary)
    points = np.zeros((count, 2))
    points[boundary] = np.column_stack([np.cos(angle), np.sin(angle)])
    free = np.setdiff1d(np.arange(count), boundary)
    middle = (count // 4 <= free) & (free < 3 * (count // 4))
    weights = np.exp(random.normal(scale=0.5, size=len(lines)))
    best, least = points, np.inf
    for _ in range(ROUNDS):
        form = np.zeros((count, count))
        for one, other in (lines.T, lines.T[::-1]):
            np.add.at(form, (one, one), weights)
            np.add.at(form, (one, other), -weights)
        pull = -form[np.ix_(free, boundary)] @ points[boundary]
        points[free] = _solved(form[np.ix_(free, free)], pull, middle)
        lengths = np.linalg.norm(points[lines[:, 0]] - points[lines[:, 1]], axis=1)
        if lengths.max() < least * lengths.min():
            best, least = points.copy(), lengths.max() / lengths.min()
        weights *= (lengths / lengths.mean()) ** PULL
    return best


def _solved(form: Floats, pull: Floats, middle: NDArray[np.bool_]) -> Floats:
    """Return the solution (n, 2) of a linear system whose `middle` unknowns are joined to others alone.

    These go first, which halves the system: threads that share a larger one wait on a busy machine.
    """
    rest, weight = ~middle, form.diagonal()[middle, None]
    joins = form[middle][:, rest]
    share = joins / weight
    solved = np.empty_like(pull)
    solved[rest] = np.linalg.solve(form[rest][:, rest] - joins.T @ share, pull[rest] - share.T @ pull[middle])
    solved[middle] = pull[middle] / weight - share @ solved[rest]
    return solved
