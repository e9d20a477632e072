"""The prime parts that a link is the sum of, and what they are called.

>>> trefoil_and_circle = ([[-1, 2, -3, 1, -2, 3], []], [True, True, True])
>>> [[prime.names for prime in piece] for piece in pieces_of(trefoil_and_circle)]
[[], [['3_1']]]
"""

import cmath
import math
from dataclasses import dataclass, replace

from sono import _core
from sono.invariants.braids import torus_type
from sono.invariants.diagrams import Gauss, Polynomial, as_crossings, homfly_polynomial
from sono.invariants.identify import ORDERS
from sono.invariants.signatures import signature
from sono.naming import tori
from sono.naming.known import Type, mirrored, mirrored_polynomial, must_be_known, sharing

MOST_SIMPLER, MOST_PROOF = 1_000, 10_000
"""Diagrams that are looked at, for one with fewer crossings and for a proof; 10,000 take some 0.3 s."""

MOST_UNKNOWN = 20
"""Crossings of a part up to which one that has no name gets a second look."""


@dataclass(frozen=True)
class Prime:
    """A prime part of a link: its smallest diagram that was met, and its HOMFLY polynomial, if it is known.

    `names` are those of types of which it must be one; if it is `proven`, there is one name. `may_be` has
    those that its invariants allow where it may be a larger type as well. It `is_new` where the table does
    not have it: where they allow none, and where it is proven to be the torus knot or link T(p,q) of `torus`.
    """

    diagram: Gauss
    is_new: bool
    polynomial: Polynomial | None
    names: list[str]
    may_be: list[str]
    proven: bool
    torus: tuple[int, int] | None = None


def pieces_of(gauss: Gauss) -> list[list[Prime]]:
    """Return the prime parts of each piece that is apart."""
    if torus := _torus(gauss):
        return [[torus]]
    pieces = [list(map(_known, piece)) for piece in _core.pieces(gauss, MOST_SIMPLER)]
    unknown = [len(prime.diagram[1]) for piece in pieces for prime in piece if not prime.names]
    if unknown and max(unknown) <= MOST_UNKNOWN:
        pieces = [list(map(_known, piece)) for piece in _core.pieces(gauss, MOST_PROOF)]
    return pieces


def mirror_of(prime: Prime) -> Prime:
    """Return the mirror image of a prime part."""
    image = mirrored(prime.diagram)
    if prime.names or prime.may_be:
        return _known(image)
    polynomial = prime.polynomial
    return replace(prime, diagram=image, polynomial=polynomial and mirrored_polynomial(polynomial))


def _known(prime: Gauss) -> Prime:
    if torus := _torus(prime):
        return torus
    polynomial = homfly_polynomial(prime)
    types = sharing(polynomial) if polynomial else []
    at = _core.meeting(prime, [type.diagram for type in types], MOST_PROOF) if types else None
    if at is not None:
        smallest = min(prime, types[at].diagram, key=lambda gauss: len(gauss[1]))
        return Prime(smallest, False, polynomial, [types[at].name], [], True)
    possible = [type.name for type in types if _may_be(prime, type)]
    is_new = not possible and (polynomial is not None or _is_alternating(prime))
    names, may_be = (possible, []) if must_be_known(prime) else ([], possible)
    return Prime(prime, is_new, polynomial, names, may_be, False)


def _torus(gauss: Gauss) -> Prime | None:
    """Return the torus knot or link that a diagram is by proof, if the table has it not."""
    type = torus_type(gauss)
    if type is None or tori.is_tabled(*type):
        return None
    return Prime(gauss, True, homfly_polynomial(gauss), [tori.name(*type)], [], True, type)


def _may_be(prime: Gauss, type: Type) -> bool:
    """Tell whether crossing numbers and signatures agree.

    A reduced alternating diagram has as few crossings as there can be (L. Kauffman, K. Murasugi,
    M. Thistlethwaite, 1987).
    """
    crossings = len(prime[1])
    alternating = _is_alternating(prime)
    if type.crossings > crossings or alternating != (
        _is_alternating(type.diagram) and type.crossings == crossings
    ):
        return False
    one, other = as_crossings(prime), as_crossings(type.diagram)
    roots = [cmath.exp(2j * math.pi / k) for k in ORDERS]
    return all(signature(one, t) == signature(other, t) for t in roots)


def _is_alternating(gauss: Gauss) -> bool:
    def alternates(along: list[int]) -> bool:
        return all((one > 0) != (other > 0) for one, other in zip(along, along[1:] + along[:1], strict=True))

    return all(map(alternates, gauss[0]))
