"""Planar diagrams: crossings with four slots each, and which of these are joined by an edge.

>>> trefoil = from_codes([(1, 5, 2, 4), (3, 1, 4, 6), (5, 3, 6, 2)])
>>> len(faces(trefoil.far)), codes(trefoil)
(5, [(1, 5, 2, 4), (3, 1, 4, 6), (5, 3, 6, 2)])
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import TypeAlias

Slot: TypeAlias = tuple[int, int]
"""A crossing, and one of its slots 0 to 3, counter-clockwise; the lower strand ends in 0 and 2."""

Code: TypeAlias = tuple[int, int, int, int]
"""A crossing of a PD code: its four edges, counter-clockwise from the incoming lower one."""

MOST_CROSSINGS = 300
"""Crossings of a diagram that is drawn; one of so many takes ten seconds."""


@dataclass(frozen=True)
class Diagram:
    """A diagram on the sphere of an oriented link.

    `far` gives the slot at the other end of the edge in each slot. `begins` has one slot for each component,
    by which it leaves a crossing, or None for a circle without crossings.
    """

    far: dict[Slot, Slot]
    begins: list[Slot | None]

    def circuits(self) -> list[list[Slot]]:
        """Return the slots by which each component enters crossings, in order."""
        return [circuit(self.far, begin) for begin in self.begins]


def circuit(far: dict[Slot, Slot], begin: Slot | None) -> list[Slot]:
    """Return the slots by which a component enters crossings that leaves one by this slot."""
    entered: list[Slot] = []
    slot = begin
    while slot and (not entered or slot != begin):
        entered.append(far[slot])
        slot = across(far[slot])
    return entered


def across(slot: Slot) -> Slot:
    """Return the other end of a strand in its crossing."""
    return slot[0], (slot[1] + 2) % 4


def over(slot: Slot) -> Slot:
    """Return where a slot gets as its crossing turns over, whose lower strand becomes the upper one."""
    return slot[0], 3 - slot[1]


def faces(far: dict[Slot, Slot]) -> list[list[Slot]]:
    """Return the slots from which edges have each face to their left, those of the largest face first."""
    unseen = dict.fromkeys(sorted(far))
    found = []
    while unseen:
        slot = next(iter(unseen))
        face = []
        while slot in unseen:
            del unseen[slot]
            face.append(slot)
            # Along the edge to its other end; the face goes on at the slot clockwise from there.
            crossing, end = far[slot]
            slot = crossing, (end - 1) % 4
        found.append(face)
    return sorted(found, key=len, reverse=True)


def within(far: dict[Slot, Slot], ends: set[Slot]) -> set[int]:
    """Return the crossings of the tangle that has these ends."""
    todo = {crossing for crossing, _ in ends}
    tangle: set[int] = set()
    while todo:
        crossing = todo.pop()
        tangle.add(crossing)
        slots = {(crossing, k) for k in range(4)} - ends
        todo |= {far[slot][0] for slot in slots} - tangle
    return tangle


def pieces(far: dict[Slot, Slot]) -> list[list[int]]:
    """Return the crossings of each piece of a diagram that may be split."""
    found: list[list[int]] = []
    for slot in sorted(far):
        if not any(slot[0] in piece for piece in found):
            found.append(sorted(within(far, {slot, far[slot]})))
    return found


def check_planar(far: dict[Slot, Slot]) -> None:
    """Raise ValueError where edges cannot be drawn in the plane, or join too many crossings."""
    crossings = len(far) // 4
    if crossings > MOST_CROSSINGS:
        raise ValueError(f"{crossings} crossings are too many to draw; {MOST_CROSSINGS} are the most")
    if len(faces(far)) != crossings + 2 * len(pieces(far)):  # Euler's formula
        raise ValueError("no knot or link in space has this diagram: it cannot be drawn in the plane")


def from_codes(codes: Sequence[Code], circles: int = 0) -> Diagram:
    """Return the diagram of a PD code, with so many circles besides, which come last.

    Labels are any whole numbers. Components come in the order of their least labels, and are oriented as
    they pass under. One that never does, and so lies above all, runs from its least label to the least of
    the two beside it. Raises ValueError where a label does not occur twice, or a strand enters a crossing by
    its third edge from below, or the diagram is not planar.
    """
    ends: dict[int, list[Slot]] = {}
    for crossing, edges in enumerate(codes):
        for k, edge in enumerate(edges):
            ends.setdefault(edge, []).append((crossing, k))
    check_twice(ends)
    far = {slot: other for one, two in ends.values() for slot, other in ((one, two), (two, one))}
    check_planar(far)  # so that a component passes two crossings or more, or one twice
    begins: list[Slot | None] = []
    unseen = set(far)
    for edge in sorted(ends):
        if ends[edge][0] in unseen:
            begins.append(_begin(far, codes, ends[edge]))
            entered = circuit(far, begins[-1])
            unseen -= {*entered, *map(across, entered)}
    return Diagram(far, [*begins, *(circles * [None])])


def check_twice(ends: Mapping[int, Sequence[object]]) -> None:
    """Raise ValueError where an edge has not two ends."""
    for edge, places in ends.items():
        if len(places) != 2:
            many = "once" if len(places) == 1 else f"{len(places)} times"
            raise ValueError(f"edge {edge} occurs {many} in the PD code; each edge has two ends")


def _begin(far: dict[Slot, Slot], codes: Sequence[Code], ends: list[Slot]) -> Slot:
    """Return the one of the two ends of an edge by which its component leaves a crossing."""
    entered = circuit(far, ends[0])
    forward = {crossing for crossing, k in entered if k == 0}
    backward = {crossing for crossing, k in entered if k == 2}
    if forward and backward:
        crossing = min(backward if len(forward) > len(backward) else forward)
        raise ValueError(
            f"crossing {crossing + 1} of the PD code, {codes[crossing]}, is passed below from its third edge "
            "to its first, as others tell; the first of the four is where the lower strand comes in"
        )
    if not forward and not backward:
        labels = [codes[crossing][k] for crossing, k in entered]
        return ends[labels[1] > labels[-1]]
    return ends[0] if forward else ends[1]


def codes(diagram: Diagram) -> list[Code]:
    """Return the PD code, its edges numbered from 1 along the components; circles leave no trace."""
    edge: dict[Slot, int] = {}
    entered = [slot for circuit in diagram.circuits() for slot in circuit]
    for number, slot in enumerate(entered):
        edge[slot] = edge[diagram.far[slot]] = number + 1
    turned = {crossing: k for crossing, k in entered if k in (0, 2)}
    found = []
    for crossing, turn in sorted(turned.items()):
        a, b, c, d = (edge[crossing, (turn + k) % 4] for k in range(4))
        found.append((a, b, c, d))
    return found


def reduced(diagram: Diagram) -> Diagram:
    """Return a diagram of the same type without nugatory crossings.

    Such a crossing is the only one that some circle meets: one side of it is turned over, and it is gone.
    """
    while found := _nugatory(diagram.far):
        crossing, k = found
        side = {diagram.far[crossing, (k + turn) % 4] for turn in (1, 2)}
        diagram = begun_outside(diagram, crossing)
        if crossing not in {slot[0] for slot in side}:
            diagram = turned(diagram, within(diagram.far, side))
        far = dict(diagram.far)
        for turn in range(2):
            one, other = far.pop((crossing, turn)), far.pop((crossing, turn + 2))
            far[one], far[other] = other, one
        kept = {slot: end for slot, end in far.items() if slot[0] != crossing}  # but not a circle's own ends
        diagram = Diagram(kept, diagram.begins)
    return diagram


def _nugatory(far: dict[Slot, Slot]) -> Slot | None:
    """Return a slot of a nugatory crossing that has one face to the left of it and of the slot across."""
    left = {slot: number for number, face in enumerate(faces(far)) for slot in face}
    return next((slot for slot in far if left[slot] == left[across(slot)]), None)


def turned(diagram: Diagram, tangle: set[int]) -> Diagram:
    """Return the diagram in which these crossings have turned over, with the edges that they had."""

    def moved(slot: Slot) -> Slot:
        return over(slot) if slot[0] in tangle else slot

    far = {moved(slot): moved(other) for slot, other in diagram.far.items()}
    return Diagram(far, [begin and moved(begin) for begin in diagram.begins])


def begun_outside(diagram: Diagram, crossing: int) -> Diagram:
    """Return the diagram with components begun outside of a crossing; one that has no other is a circle."""
    circuits = (map(across, entered) for entered in diagram.circuits())
    begins = [next((slot for slot in slots if slot[0] != crossing), None) for slots in circuits]
    return Diagram(diagram.far, begins)
