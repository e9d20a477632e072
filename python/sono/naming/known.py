"""The table of types: prime knots to 13 crossings and prime links to 9, found by their HOMFLY polynomials.

>>> [type.name for type in sharing({(-4, 0): -1, (-2, 0): 2, (-2, 2): 1})]
['3_1']
"""

import re
from base64 import urlsafe_b64encode
from collections.abc import Iterator
from dataclasses import dataclass
from functools import cache
from hashlib import blake2b
from importlib import resources

from sono.invariants.diagrams import Gauss, Polynomial, homfly_polynomial
from sono.naming.letters import unpacked

MOST_OF_KNOTS, MOST_OF_LINKS = 13, 9
"""Crossings up to which the table has all prime knots and all prime links."""

SAME_AS_MIRROR = "="
"""Ends the letters of a type that is its own mirror image, or whose mirror image has a name without m."""


@dataclass(frozen=True)
class Type:
    """A prime knot or link of the table, or the mirror image of one, and a diagram of it."""

    name: str
    diagram: Gauss

    @property
    def crossings(self) -> int:
        """The crossing number: the table's diagrams have no more."""
        return len(self.diagram[1])


def sharing(polynomial: Polynomial) -> list[Type]:
    """Return all types of the table with this HOMFLY polynomial, those of fewest crossings first."""
    types = (type for name, letters in _rows(key(polynomial)) for type in _with_mirror(name, letters))
    return [type for type in types if homfly_polynomial(type.diagram) == polynomial]


def must_be_known(prime: Gauss) -> bool:
    """Tell whether the table has the type of a prime link for certain: it has all of so few crossings."""
    passages, right = prime
    return len(right) <= (MOST_OF_KNOTS if len(passages) == 1 else MOST_OF_LINKS)


@cache
def is_amphichiral(name: str) -> bool:
    """Tell whether a type of the table is its own mirror image.

    >>> is_amphichiral("4_1"), is_amphichiral("3_1"), is_amphichiral("T(2,99)")
    (True, False, False)
    """
    return re.search(rf"^{re.escape(name)}\t.*{SAME_AS_MIRROR}$", _text(), re.MULTILINE) is not None


def key(polynomial: Polynomial) -> str:
    """Return three letters that a polynomial shares with its mirror image, and hardly with another."""
    both = sorted(sorted(p.items()) for p in (polynomial, mirrored_polynomial(polynomial)))
    return urlsafe_b64encode(blake2b(repr(both[0]).encode(), digest_size=3).digest()).decode()[:3]


def mirrored_polynomial(polynomial: Polynomial) -> Polynomial:
    """Return the HOMFLY polynomial of the mirror image."""
    return {(-alpha, z): value * (-1) ** (z % 2) for (alpha, z), value in polynomial.items()}


def mirrored(gauss: Gauss) -> Gauss:
    """Return the mirror image of a diagram, in its plane."""
    passages, right = gauss
    return [[-passage for passage in along] for along in passages], [not hand for hand in right]


def _with_mirror(name: str, letters: str) -> Iterator[Type]:
    diagram = unpacked(letters.rstrip(SAME_AS_MIRROR))
    yield Type(name, diagram)
    if not letters.endswith(SAME_AS_MIRROR):
        yield Type(f"m{name}", mirrored(diagram))


def _rows(key: str) -> list[tuple[str, str]]:
    """Return the names and letters of the rows with this key."""
    return re.findall(rf"^(\S+)\t{re.escape(key)}\t(\S+)$", _text(), re.MULTILINE)


@cache
def _text() -> str:
    return resources.files("sono").joinpath("data", "types.tsv").read_text(encoding="utf-8")
