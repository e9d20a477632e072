"""Gauss words put into the plane: which way round each crossing is, where only the words are given.

Two crossings of a knot are interlaced if the knot meets them in turn. The words of a knot tell how each of
two interlaced crossings is turned if the other is known, by how many crossings are interlaced with both: P.
Rosenstiehl, C. R. Acad. Sci. Paris 283 (1976) 417. What is not linked so is another summand or a loop,
and its mirror image has the same words.

>>> trefoil = embedded([[(1, True), (2, False), (3, True), (1, False), (2, True), (3, False)]])
>>> [len(circuit) for circuit in trefoil.circuits()]
[6]
"""

from collections.abc import Iterator, Sequence
from itertools import count
from typing import TypeAlias

import numpy as np

from sono.starts.diagrams import Diagram, Slot, check_planar

Passage: TypeAlias = tuple[int, bool]
"""A crossing, and whether it is passed above."""

Word: TypeAlias = Sequence[Passage]
"""What a component passes, in order."""


def embedded(words: Sequence[Word], signs: dict[int, int] | None = None) -> Diagram:
    """Return the diagram with a Gauss word for each component; an empty one is a circle.

    `signs` has +1 for each right-handed crossing and -1 for the others. Without signs each prime summand has
    two diagrams, mirror images; that is taken whose first crossing is right-handed. Raises ValueError where
    a crossing is not passed once above and once below, or there is no diagram in the plane.
    """
    passages = [passage for word in words for passage in word]
    for crossing in dict.fromkeys(crossing for crossing, _ in passages):
        ways = sorted(over for passed, over in passages if passed == crossing)
        if ways != [False, True]:
            raise ValueError(
                f"crossing {crossing} is passed {ways.count(True)} times above and {ways.count(False)} times "
                "below; a component passes it once above, and it or another once below"
            )
    if signs is None:
        signs = {}
        for word in _merged(words):
            signs |= _signs(word, [crossing for crossing, _ in passages])
    diagram = _joined(words, signs)
    check_planar(diagram.far)
    return diagram


def _joined(words: Sequence[Word], signs: dict[int, int]) -> Diagram:
    """Return the diagram, whose crossings are numbered from 0."""
    number = {crossing: k for k, crossing in enumerate(signs)}
    far: dict[Slot, Slot] = {}
    begins: list[Slot | None] = []
    for word in words:
        ends = []
        for crossing, over in word:
            # The upper strand of a right-handed crossing comes from the left of the lower one.
            enters = (3 if signs[crossing] > 0 else 1) if over else 0
            ends.append(((number[crossing], enters), (number[crossing], (enters + 2) % 4)))
        for (_, leaves), (enters_next, _) in zip(ends, ends[1:] + ends[:1], strict=True):
            far[leaves], far[enters_next] = enters_next, leaves
        begins.append(ends[-1][1] if ends else None)
    return Diagram(far, begins)


def _merged(words: Sequence[Word]) -> Iterator[Word]:
    """Give one word for each piece of a link.

    Two components become one where a crossing of both gets a twin, behind which their strands have changed
    places: the diagram is still planar if it was, and the crossing keeps its turn.
    """
    rest = [list(word) for word in words if word]
    twins = count(1 + max((crossing for word in words for crossing, _ in word), default=0))
    while rest:
        whole = rest.pop(0)
        while found := _shared(whole, rest):
            k, i, j = found
            other = rest.pop(k)
            twin = next(twins)
            one, two = [whole[i], (twin, False)], [other[j], (twin, True)]
            whole = one + other[j + 1 :] + other[:j] + two + whole[i + 1 :] + whole[:i]
        yield whole


def _shared(whole: Word, rest: Sequence[Word]) -> tuple[int, int, int] | None:
    """Return a word that shares a crossing with the whole one, and the places of that in both."""
    place = {crossing: i for i, (crossing, _) in enumerate(whole)}
    for k, other in enumerate(rest):
        for j, (crossing, _) in enumerate(other):
            if crossing in place:
                return k, place[crossing], j
    return None


def _signs(word: Word, order: Sequence[int]) -> dict[int, int]:
    """Return the signs of crossings in a word; the first of each summand, in this order, is right-handed."""
    places: dict[int, list[int]] = {}
    for place, (crossing, _) in enumerate(word):
        places.setdefault(crossing, []).append(place)
    known = [crossing for crossing in dict.fromkeys(order) if crossing in places]
    crossings = known + [crossing for crossing in places if crossing not in known]
    first, last = np.array([places[crossing] for crossing in crossings]).T
    inside = (first[:, None] < first) & (first < last[:, None])
    interlaced = inside & (last[:, None] < last)
    interlaced |= interlaced.T
    same = interlaced.astype(int) @ interlaced % 2 == 1
    # +1 where the second strand crosses the first from right to left, but for a factor in turn.
    turn = np.zeros(len(crossings), int)
    factor = (-1) ** first * [1 if word[place][1] else -1 for place in first]
    for root in range(len(crossings)):
        todo = [] if turn[root] else [root]
        turn[root] = turn[root] or factor[root]
        while todo:
            one = todo.pop()
            reached = np.flatnonzero(interlaced[one] & (turn == 0))
            turn[reached] = np.where(same[one, reached], turn[one], -turn[one])
            todo += reached.tolist()
    return {
        crossing: int(sign)
        for crossing, sign in zip(crossings, turn * factor, strict=True)
        if crossing in known
    }
