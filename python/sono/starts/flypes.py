"""Flypes: a tangle of a planar diagram turns over, and a crossing beside it passes to its other side.

All reduced alternating diagrams of a knot are joined by flypes (W. Menasco, M. Thistlethwaite, "The
classification of alternating links", Ann. of Math. 138 (1993) 113). They keep the type of any knot, and what
is drawn from another diagram gets tight in other shapes.
"""

import numpy as np

from sono.starts.diagrams import Diagram, Slot, begun_outside, faces, over, turned, within

MOST = 6
"""The most flypes that are made one after another."""

Site = tuple[int, set[int], list[tuple[Slot, Slot]]]
"""The crossing, those of the tangle before it turns over, and the slots that will be joined after it did."""


def flyped(diagram: Diagram, seed: int) -> Diagram:
    """Return a diagram without nugatory crossings after a random number of random flypes, if it has any."""
    random = np.random.default_rng(seed)
    for _ in range(random.integers(MOST + 1)):
        if sites := _sites(diagram):
            diagram = _flyped(diagram, *sites[random.integers(len(sites))])
    return diagram


def _sites(diagram: Diagram) -> list[Site]:
    """Return where a tangle of two or more crossings has a crossing to its left, as seen from that.

    Of the four slots of the crossing the first two lead to the tangle, south-west and north-west of it. The
    tangle is left by an edge to the upper right, beyond which is the face north of the crossing, and by one
    to the lower right; between them both is a face.
    """
    far, around = diagram.far, faces(diagram.far)
    left = {slot: number for number, face in enumerate(around) for slot in face}
    found = []
    for crossing, k in sorted(far):
        south_east, north_east, north_west, south_west = ((crossing, (k + i) % 4) for i in range(4))
        for upper in around[left[north_east]]:
            for lower in around[left[far[upper]]]:
                ends = {far[south_east], far[north_east], upper, lower}
                touched = {slot[0] for slot in (upper, lower, far[upper], far[lower])}
                if left[far[lower]] != left[south_west] or crossing in touched:
                    continue
                tangle = within(far, ends)
                if len(tangle) > 1:
                    joined = [
                        (far[north_west], over(far[south_east])),
                        (far[south_west], over(far[north_east])),
                        (south_east, far[lower]),
                        (north_east, far[upper]),
                        (north_west, over(lower)),
                        (south_west, over(upper)),
                    ]
                    found.append((crossing, tangle, joined))
    return found


def _flyped(diagram: Diagram, crossing: int, tangle: set[int], joined: list[tuple[Slot, Slot]]) -> Diagram:
    """Return the diagram after the flype at a site."""
    # Strands may run another way through the crossing afterwards, so components begin elsewhere.
    diagram = turned(begun_outside(diagram, crossing), tangle)
    far = dict(diagram.far)
    for one, other in joined:
        far[one], far[other] = other, one
    return Diagram(far, diagram.begins)
