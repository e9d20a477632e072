"""Flypes: a tangle of a planar diagram turns over, and a crossing beside it passes to its other side.

All reduced alternating diagrams of a knot are joined by flypes (W. Menasco, M. Thistlethwaite, "The
classification of alternating links", Ann. of Math. 138 (1993) 113). They keep the type of any knot, and what
is drawn from another diagram gets tight in other shapes.
"""

import numpy as np

from sono.starts.planar import Diagram, Slot, across, faces

MOST = 6
"""The most flypes that are made one after another."""

Site = tuple[set[int], list[tuple[Slot, Slot]]]
"""The crossings of the tangle, before it turns over, and the slots that will be joined, after it did."""


def flyped(diagram: Diagram, seed: int) -> Diagram:
    """Return the diagram after a random number of random flypes, if it has any."""
    random = np.random.default_rng(seed)
    for _ in range(random.integers(MOST + 1)):
        if sites := _sites(diagram):
            diagram = _turned(diagram, *sites[random.integers(len(sites))])
    return diagram


def _sites(diagram: Diagram) -> list[Site]:
    """Return where a tangle of two or more crossings has a crossing to its left, as seen from that.

    Of the four slots of the crossing the first two lead to the tangle, south-west and north-west of it. The
    tangle is left by an edge to the upper right, beyond which is the face north of the crossing, and by one
    to the lower right; between them both is a face.
    """
    far, around = across(diagram), faces(diagram)
    left = {slot: number for number, face in enumerate(around) for slot in face}
    found = []
    for crossing in range(len(diagram)):
        for k in range(4):
            south_east, north_east, north_west, south_west = ((crossing, (k + i) % 4) for i in range(4))
            for upper in around[left[north_east]]:
                for lower in around[left[far[upper]]]:
                    ends = {far[south_east], far[north_east], upper, lower}
                    touched = {slot[0] for slot in (upper, lower, far[upper], far[lower])}
                    if left[far[lower]] != left[south_west] or crossing in touched:
                        continue
                    tangle = _within(far, ends)
                    if len(tangle) > 1:
                        joined = [
                            (far[north_west], _over(far[south_east])),
                            (far[south_west], _over(far[north_east])),
                            (south_east, far[lower]),
                            (north_east, far[upper]),
                            (north_west, _over(lower)),
                            (south_west, _over(upper)),
                        ]
                        found.append((tangle, joined))
    return found


def _over(slot: Slot) -> Slot:
    """Return where a slot gets as its crossing turns over, whose lower strand becomes the upper one."""
    return slot[0], 3 - slot[1]


def _within(far: dict[Slot, Slot], ends: set[Slot]) -> set[int]:
    """Return the crossings of the tangle that has these ends."""
    todo = {crossing for crossing, _ in ends}
    tangle: set[int] = set()
    while todo:
        crossing = todo.pop()
        tangle.add(crossing)
        slots = {(crossing, k) for k in range(4)} - ends
        todo |= {far[slot][0] for slot in slots} - tangle
    return tangle


def _turned(diagram: Diagram, tangle: set[int], joined: list[tuple[Slot, Slot]]) -> Diagram:
    """Return the diagram after the flype at a site."""

    def moved(slot: Slot) -> Slot:
        return _over(slot) if slot[0] in tangle else slot

    far = {moved(slot): moved(other) for slot, other in across(diagram).items()}
    for one, other in joined:
        far[one], far[other] = other, one
    return _numbered(far)


def _numbered(far: dict[Slot, Slot]) -> Diagram:
    """Return the diagram in which these slots are joined, its edges numbered along the knot."""
    edge: dict[Slot, int] = {}
    slot = 0, 2
    while slot not in edge:
        other = far[slot]
        edge[slot] = edge[other] = len(edge) // 2 + 1
        slot = other[0], (other[1] + 2) % 4
    diagram = []
    for crossing in range(len(far) // 4):
        a, b, c, d = (edge[crossing, k] for k in range(4))
        diagram.append((a, b, c, d) if c == a % (len(far) // 2) + 1 else (c, d, a, b))
    return diagram
