"""What knot or link a curve is.

>>> from sono.starts import start
>>> identify(start("3_1#m4_1")).name, identify(start("12n_725")).proven
('3_1#4_1', True)
"""

import re
import sys
from dataclasses import dataclass
from itertools import islice, product
from typing import Literal

from sono.curve import Components
from sono.invariants.crossings import linking_numbers, planar_diagram
from sono.invariants.diagrams import (
    Polynomial,
    alexander_polynomial,
    as_crossings,
    times,
    written,
)
from sono.invariants.polynomials import alexander
from sono.invariants.signatures import signature
from sono.naming import tori
from sono.naming.primes import Prime, pieces_of
from sono.records import Record

MOST_NAMES = 100
"""Names of a sum, each of whose parts may have several."""


@dataclass(frozen=True, repr=False)
class Identity(Record):
    """What knot or link a curve is, and what tells it.

    `names` are those of all types in the table, prime knots to 13 crossings, prime links to 9 and their
    sums, that it can be, or T(p,q) if it is a larger torus knot or link; "m" is a mirror image, "#" a
    connected sum, "+" stands between parts that are not linked, "?" is a part without a name, if others have
    one. A sum of links does not say which of their components are joined. `known` tells how: "proven" where
    moves make the table's diagrams of the curve's, or its diagram is a closed braid that is proven to be that
    of a torus link, and there is one name; "invariants" where these agree, and its diagram has so few
    crossings that the table has its type; "not in the table"; or "undecided" where the HOMFLY polynomial
    takes too long, or where a type in the table shares the invariants, but a larger one may as well: `may_be`
    has the names with such types. Only a proof rules out that a diagram hides a sum.

    `pd` is the PD code of the curve's simplified diagram: each crossing's four edges, counter-clockwise from
    the incoming lower one. It has so many `crossings`, and no trace of the `circles` that have none.

    `linking` has the linking numbers of all pairs of components; `homfly`, in Regina's alpha and z, and
    `alexander`, of a single variable, are None where they would take too long.

    >>> import sono
    >>> found = sono.identify(sono.start("3_1", variant=7))
    >>> found.name, found.proven, found.crossings, found.homfly
    ('3_1', True, 3, 'x^-2 y^2 + 2 x^-2 - x^-4')
    """

    names: tuple[str, ...]
    known: Literal["proven", "invariants", "not in the table", "undecided"]
    may_be: tuple[str, ...]
    components: int
    crossings: int
    circles: int
    determinant: int
    signature: int
    linking: tuple[int, ...]
    homfly: str | None
    alexander: str | None
    pd: tuple[tuple[int, int, int, int], ...]

    @property
    def name(self) -> str | None:
        """The name, or all of them, with "or" between; None where no part has one."""
        return " or ".join(self.names) or None

    @property
    def proven(self) -> bool:
        """Whether the name is proven."""
        return self.known == "proven"


def identify(curve: Components) -> Identity:
    """Return what knot or link a curve is. Raises `TooEntangledError`, and `CurveError` if it crosses itself.

    The prime parts of its diagram are looked up by their HOMFLY polynomials; then moves are sought that make
    the table's diagrams of them. What is a closed braid is a torus link if its powers say so.
    """
    gauss = tori.shown(curve)
    pieces = pieces_of(gauss)
    # The table's diagram may have the components in another order.
    linking = linking_numbers(as_crossings(gauss))
    if [len(piece) for piece in pieces] == [1]:
        gauss = pieces[0][0].diagram
    found = as_crossings(gauss)
    primes = [prime for piece in pieces for prime in piece]
    torus = primes[0].torus if len(primes) == 1 else None
    may_be = [[prime.names or prime.may_be for prime in piece] for piece in pieces]
    polynomial = polynomial_of(pieces)
    return Identity(
        names=names_of([[prime.names for prime in piece] for piece in pieces]),
        known=_how(primes),
        may_be=names_of(may_be) if any(prime.may_be for prime in primes) else (),
        components=len(curve),
        crossings=len(found.sign),
        circles=gauss[0].count([]),
        determinant=tori.determinant(*torus) if torus else round(alexander(found, -1)),
        signature=tori.signature(*torus) if torus else signature(found, -1),
        linking=linking,
        homfly=None if polynomial is None else written(polynomial),
        alexander=None if polynomial is None else alexander_polynomial(polynomial),
        pd=tuple(planar_diagram(found)),
    )


def _how(primes: list[Prime]) -> Literal["proven", "invariants", "not in the table", "undecided"]:
    """Tell how these parts are known."""
    if all(prime.proven for prime in primes):
        return "proven"
    if all(prime.names for prime in primes):
        return "invariants"
    return "not in the table" if any(prime.is_new for prime in primes) else "undecided"


def names_of(pieces: list[list[list[str]]]) -> tuple[str, ...]:
    """Return the names of what is made of parts that may have these names, if any has one."""
    names: dict[str, None] = {}
    for way in islice(product(*(choices or ["?"] for piece in pieces for choices in piece)), MOST_NAMES):
        parts = iter(way)
        sums = ["#".join(sorted((next(parts) for _ in piece), key=_order)) or "0_1" for piece in pieces]
        names["+".join(sorted(sums, key=_order))] = None
    return tuple(name for name in names if not set(name) <= set("?#+"))


def polynomial_of(pieces: list[list[Prime]]) -> Polynomial | None:
    """Return the HOMFLY polynomial of the whole, if it is known."""
    factors = [prime.polynomial for piece in pieces for prime in piece]
    factors += [{(1, -1): 1, (-1, -1): -1}] * (len(pieces) - 1)
    found: Polynomial = {(0, 0): 1}
    for factor in factors:
        if factor is None:
            return None
        found = times(found, factor)
    return found


def _order(name: str) -> tuple[list[int], str]:
    """Return by what names are sorted: crossings and numbers first, what has no name last."""
    return [int(number) for number in re.findall(r"\d+", name)] or [sys.maxsize], name
