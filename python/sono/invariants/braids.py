"""Closed braids: the one that a diagram is, and whether it is that of a torus knot or link.

T(p,q) is the closure of delta^q, where delta = s_1 s_2 ... s_(p-1) on p strands; delta^p is the full twist,
which commutes with all braids. Let w be a braid on p strands with w^k = delta^(qk), where p divides qk. One
of its powers is a power of the full twist, so w is conjugate to a power of delta or of epsilon = delta s_1
(B. de Kerekjarto, 1919; S. Eilenberg, 1934; a whole proof is by A. Constantin and B. Kolev, 1994). The signs
of its crossings add up to q(p-1), so it is conjugate to delta^q, or to epsilon^(q(p-1)/p), which is the same
power of the full twist. So the closure of w is T(p,q); and whatever is conjugate to delta^q fulfils the
equation.

>>> trefoil = ([[-1, 2, -3, 1, -2, 3]], [True, True, True])
>>> braid_of(trefoil), torus_type(trefoil)
((2, [1, 1, 1]), (2, 3))
"""

import math
from collections.abc import Iterable, Iterator
from typing import TypeAlias

from sono.invariants.diagrams import Gauss

Braid: TypeAlias = tuple[int, list[int]]
"""The number of strands; and generators, counted from 1, negative where crossings are left-handed."""

MORE_BITS = 64
"""Bits of coordinates, besides two for each generator, beyond which a braid is given up."""


def torus_type(gauss: Gauss) -> tuple[int, int] | None:
    """Return p > 1 and q of a diagram that is a closed braid on p parallel strands, and T(p,q); q may be < 0.

    None says nothing: torus links have other diagrams as well.
    """
    braid = braid_of(gauss)
    if braid is None or braid[0] == 1:
        return None
    p, word = braid
    q, rest = divmod(sum(1 if letter > 0 else -1 for letter in word), p - 1)
    if not q or rest or len(gauss[0]) != math.gcd(p, q):
        return None
    return (p, q) if _is_root(p, word, q) else None


def braid_of(gauss: Gauss) -> Braid | None:
    """Return a braid whose closure has this diagram, if its Seifert circles share crossings as in a row.

    Two that share some meet them in one order, as they run side by side. So generators can be put in an order
    in which all circles have them. Their closure has the Gauss code that is given, and a link is known by it;
    only where a circle has both neighbours on one side, the summands that they begin are turned over.
    """
    row = _row(list(_seifert_circles(gauss)))
    if row is None:
        return None
    word: list[int] = []
    for circle in row:
        if not _merge(word, circle):
            return None
    strand = {crossing: number for number, circle in reversed([*enumerate(row, 1)]) for crossing in circle}
    return len(row), [strand[k] if gauss[1][k - 1] else -strand[k] for k in word]


def _seifert_circles(gauss: Gauss) -> Iterator[list[int]]:
    """Give the crossings along each of the circles that are left when strands turn off at every crossing."""
    following: dict[int, int] = {}
    for along in gauss[0]:
        following |= zip(along, along[1:] + along[:1], strict=True)
        if not along:
            yield []
    while following:
        circle = [-next(iter(following))]
        while (passage := following.pop(-circle[-1])) != circle[0]:
            circle.append(passage)
        yield [abs(passage) for passage in circle]


def _row(circles: list[list[int]]) -> list[list[int]] | None:
    """Put circles in a row, in which each shares crossings with its neighbours alone, if that can be done."""
    owners: dict[int, set[int]] = {}
    for number, circle in enumerate(circles):
        for crossing in circle:
            owners.setdefault(crossing, set()).add(number)
    if any(len(pair) == 1 for pair in owners.values()):
        return None  # no diagram in a plane
    beside = [set[int]().union(*(owners[crossing] for crossing in circle)) for circle in circles]
    row = [number for number, near in enumerate(beside) if len(near) <= 2][:1]
    while row and (more := beside[row[-1]] - {*row}):
        if len(more) > 1:
            return None
        row += more
    return [circles[number] for number in row] if len(row) == len(circles) else None


def _merge(word: list[int], circle: list[int]) -> bool:
    """Put the crossings of the next circle among those of a word, if it has them in the same order."""
    old, new = set(word), set(circle)
    shared = [crossing for crossing in word if crossing in new]
    begin = circle.index(shared[0]) if shared else 0
    circle = circle[begin:] + circle[:begin]
    if shared != [crossing for crossing in circle if crossing in old]:
        return False
    rest, before = iter(circle), word.copy()
    word.clear()
    for crossing in before:
        if crossing in new:
            while (another := next(rest)) != crossing:
                word.append(another)
        word.append(crossing)
    word += rest
    return True


def _is_root(p: int, word: list[int], q: int) -> bool:
    """Tell whether w^k = delta^(qk) for the least k that makes this a power of the full twist."""
    k = p // math.gcd(p, q)
    trivial = [0, 1] * p
    moved = trivial
    for _ in range(k):
        moved = _moved(moved, word)
        if max(map(int.bit_length, moved)) > MORE_BITS + 2 * len(word):
            return False
    back = range(1 - p, 0) if q > 0 else range(1, p)
    for _ in range(abs(q) * k):
        moved = _moved(moved, back)
    return moved == trivial


def _moved(lamination: list[int], word: Iterable[int]) -> list[int]:
    """Return the coordinates of a lamination that a braid has moved: a_1, b_1, a_2, b_2, ...

    A braid is trivial if and only if it leaves 0, 1, 0, 1, ... as it is. Source: I. Dynnikov, 2002, as in
    P. Dehornoy, Efficient solutions to the braid isotopy problem, 2008.
    """
    moved = list(lamination)
    for letter in word:
        at = 2 * abs(letter) - 2
        a, b, c, d = moved[at : at + 4]
        # A left-handed generator is a right-handed one in a mirror, in which a and c have other signs.
        hand = 1 if letter > 0 else -1
        a, c = hand * a, hand * c
        e = a - min(b, 0) - c + max(d, 0)
        a, c = a + max(b, 0) + max(max(d, 0) - e, 0), c + min(d, 0) + min(min(b, 0) + e, 0)
        moved[at : at + 4] = hand * a, d - max(e, 0), hand * c, b + max(e, 0)
    return moved
