"""Pretzels and two-bridge links, put together of tangles.

The pretzel P(p,q,...) has columns of half turns, p > 0 of them right-handed: P(-2,3,3) is 8_19, a torus knot
that is right-handed, and P(-1,-1,-1) is 3_1, since the strands of its columns run against each other. The
two-bridge link of the fraction p/q is a knot for odd p; 3/1 is the right-handed trefoil, 5/2 is 4_1, and -7/3
is the mirror image of 7/3. Conway's notation C(a,b,...,z) is that of the fraction z + 1/(... + 1/(b + 1/a)).

>>> len(two_bridge(5, 2).far) // 4, len(pretzel([-2, 3, 7]).far) // 4
(4, 12)
"""

import math
import re
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from functools import reduce
from itertools import count

from sono.starts.diagrams import MOST_CROSSINGS, Diagram, Slot, across


@dataclass(frozen=True)
class Tangle:
    """Crossings whose slots are joined but for four: the upper left, upper right, lower right, lower left."""

    far: dict[Slot, Slot]
    ends: tuple[Slot, Slot, Slot, Slot]


def pretzel(columns: Sequence[int]) -> Diagram:
    """Return the diagram of a pretzel, oriented at will. Raises ValueError for a column of 0 crossings."""
    _check(columns, f"P({','.join(map(str, columns))})")
    numbers = count()
    # A right-handed crossing of a column is left-handed for strands that run across.
    stacks = [reduce(_below, _row(numbers, -column)) for column in columns]
    return _closed(reduce(_beside, stacks))


def two_bridge(p: int, q: int) -> Diagram:
    """Return the diagram of the two-bridge link of a fraction, oriented as `conway` does.

    Raises ValueError unless the fraction is in lowest terms.
    """
    if not p or not q:
        raise ValueError(f"{p}/{q} is the fraction of no two-bridge link; neither number may be 0")
    if (divisor := math.gcd(p, q)) > 1:
        raise ValueError(f"{p}/{q} is not in lowest terms; write {p // divisor}/{q // divisor}")
    p, q = (p, q) if p > 0 else (-p, -q)
    # Knots are the same for all q that differ by p, oriented links for all that differ by 2 p.
    q = q % p if p % 2 else (q + p) % (2 * p) - p
    hand, q = (1, q) if q > 0 else (-1, -q)
    terms = []
    while q:
        terms.append(hand * (p // q))
        p, q = q, p % q
    return conway([*reversed(terms)] or [1])


def conway(terms: Sequence[int]) -> Diagram:
    """Return the diagram of a two-bridge link in Conway's notation. Raises ValueError for a term 0.

    The strands that close it above and below run the same way, so C(4) is T(2,4).
    """
    _check(terms, f"C({','.join(map(str, terms))})")
    numbers = count()
    tangle = None
    for place, term in enumerate(terms):
        for crossing in _row(numbers, term):
            across = (len(terms) - place) % 2
            tangle = crossing if tangle is None else (_beside if across else _below)(tangle, crossing)
    assert tangle
    return _closed(tangle)


def conway_terms(text: str) -> list[int]:
    """Return the terms of Conway's notation, where digits without spaces are one each, as he wrote them.

    Only 10 to 19 alone are one number, as KnotInfo has them: no reduced notation begins with 1.

    >>> conway_terms("312"), conway_terms("10 2"), conway_terms("11")
    ([3, 1, 2], [10, 2], [11])
    """
    return [*map(int, text)] if re.fullmatch(r"[2-9]\d|\d{3,}", text) else [*map(int, text.split())]


def _check(terms: Sequence[int], name: str) -> None:
    if 0 in terms:
        raise ValueError(f"{name[:60]}: a number of half turns must not be 0")
    if sum(map(abs, terms)) > MOST_CROSSINGS:
        raise ValueError(f"{name[:60]} has too many crossings to draw; {MOST_CROSSINGS} are the most")


def _row(numbers: Iterator[int], turns: int) -> list[Tangle]:
    """Return so many crossings, right-handed for two strands that run from left to right."""
    slots = (3, 2, 1, 0) if turns > 0 else (0, 3, 2, 1)
    crossings = (next(numbers) for _ in range(abs(turns)))
    return [Tangle({}, tuple((crossing, slot) for slot in slots)) for crossing in crossings]  # type: ignore[arg-type]


def _beside(left: Tangle, right: Tangle) -> Tangle:
    a, b, c, d = left.ends
    e, f, g, h = right.ends
    return Tangle(_joined(left.far | right.far, (b, e), (c, h)), (a, f, g, d))


def _below(upper: Tangle, lower: Tangle) -> Tangle:
    a, b, c, d = upper.ends
    e, f, g, h = lower.ends
    return Tangle(_joined(upper.far | lower.far, (d, e), (c, f)), (a, b, g, h))


def _joined(far: dict[Slot, Slot], *pairs: tuple[Slot, Slot]) -> dict[Slot, Slot]:
    return far | {one: other for pair in pairs for one, other in (pair, pair[::-1])}


def _closed(tangle: Tangle) -> Diagram:
    """Return the tangle closed above and below."""
    a, b, c, d = tangle.ends
    far = _joined(tangle.far, (a, b), (c, d))
    begins: list[Slot | None] = []
    unseen = dict.fromkeys((b, c, *sorted(far)))
    while unseen:
        begins.append(slot := next(iter(unseen)))
        while slot in unseen:
            del unseen[slot], unseen[far[slot]]
            slot = across(far[slot])
    return Diagram(far, begins)
