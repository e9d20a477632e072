"""Whether two curves are the same knot or link, as far as moves and invariants tell.

>>> from sono.starts import start
>>> verify(start("8_20"), start("8_20", 7)).verdict, verify(start("3_1"), start("m3_1")).verdict
('same', 'mirror images')
"""

from dataclasses import dataclass
from itertools import chain
from typing import Literal, Self

from sono import _core
from sono.curve import Components
from sono.invariants.crossings import MOST_CROSSINGS, linking_numbers
from sono.invariants.diagrams import Gauss, as_crossings
from sono.invariants.identify import fingerprint_of
from sono.naming import tori
from sono.naming.identity import MOST_NAMES, names_of, polynomial_of
from sono.naming.known import mirrored
from sono.naming.primes import MOST_PROOF, Prime, mirror_of, pieces_of
from sono.records import Record

PROVEN: Literal["proven"] = "proven"
INVARIANTS: Literal["invariants"] = "invariants"
UNDECIDED: Literal["undecided"] = "undecided"

INVERTIBLE = 7
"""Crossings up to which all prime knots are what they are when reversed; 8_17 is not (H. Trotter, 1963)."""


@dataclass(frozen=True, repr=False)
class Verdict(Record):
    """Whether two curves are the same knot or link.

    The `verdict` "same" does not mind in which order components come, nor whether all of them are reversed;
    where only some are, a link may be another one.
    `known` tells how: "proven" where moves make one diagram of the other, or both of them diagrams of the
    table, or both are proven to be torus links; "invariants" where all of these agree, which is evidence and
    no proof, or where one of them differs, which is decisive: `differs` names it. "mirror images" are not
    known to be the same as well. What is "undecided" shares its invariants with several types, or takes too
    long for HOMFLY. `name` and `other_name` are the names as `identify` gives them, or None.

    >>> import sono
    >>> found = sono.verify("3_1", "4_1")
    >>> found.verdict, found.known, found.differs
    ('different', 'proven', 'signatures')
    """

    verdict: Literal["same", "mirror images", "different", "undecided"]
    known: Literal["proven", "invariants", "undecided"]
    differs: str | None
    name: str | None
    other_name: str | None


def verify(one: Components, other: Components) -> Verdict:
    """Compare the types of two curves. Raises `TooEntangledError`, and `CurveError` if one crosses itself."""
    here, there = (_Type.of(tori.shown(curve)) for curve in (one, other))
    names = here.name, there.name
    as_is = here.relation(there)
    image = as_is if as_is == PROVEN else here.relation(there.image())
    if PROVEN in (as_is, image):
        return Verdict("same" if as_is == PROVEN else "mirror images", PROVEN, None, *names)
    if as_is == UNDECIDED:
        return Verdict("undecided", UNDECIDED, None, *names)
    if INVARIANTS in (as_is, image):
        return Verdict("same" if as_is == INVARIANTS else "mirror images", INVARIANTS, None, *names)
    proven = here.is_proven and there.is_proven
    return Verdict("different", PROVEN if proven else INVARIANTS, as_is, *names)


@dataclass(frozen=True)
class _Type:
    """The type of a curve: a diagram, and the prime parts of each piece that is apart."""

    gauss: Gauss
    pieces: list[list[Prime]]

    @classmethod
    def of(cls, gauss: Gauss) -> Self:
        """Take a diagram apart."""
        return cls(gauss, pieces_of(gauss))

    def image(self) -> "_Type":
        """Return the mirror image."""
        return _Type(mirrored(self.gauss), [list(map(mirror_of, piece)) for piece in self.pieces])

    def invariants(self) -> dict[str, object]:
        """Return invariants that mind neither the order of components nor whether all are reversed.

        One that would take too long is None.
        """
        found = as_crossings(self.gauss)
        small = len(found.sign) <= MOST_CROSSINGS
        linking, signatures, alexander = (
            fingerprint_of(found) if small else (linking_numbers(found), None, None)
        )
        return {
            "components": len(self.gauss[0]),
            "linking numbers": sorted(linking),
            "signatures": signatures,
            "Alexander polynomials": alexander,
            "HOMFLY polynomials": polynomial_of(self.pieces),
        }

    @property
    def primes(self) -> list[Prime]:
        """All prime parts."""
        return list(chain.from_iterable(self.pieces))

    @property
    def names(self) -> tuple[str, ...]:
        """All names that it may have."""
        return names_of([[prime.names for prime in piece] for piece in self.pieces])

    @property
    def name(self) -> str | None:
        """The name as `identify` gives it."""
        return " or ".join(self.names) or None

    @property
    def is_proven(self) -> bool:
        """Whether the table has all its parts, by proof."""
        return all(prime.proven for prime in self.primes)

    @property
    def is_in_table(self) -> bool:
        """Whether the table has all its parts, one of those that share their invariants."""
        return all(prime.names and not prime.is_new for prime in self.primes) and len(self.names) < MOST_NAMES

    def relation(self, other: "_Type") -> str:
        """Tell how it is known that another type is the same; if it is not, in what they differ."""
        if self.is_proven and other.is_proven and _is_one(self, other):
            return PROVEN
        mine, theirs = self.invariants(), other.invariants()
        for key, value in mine.items():
            if None not in (value, theirs[key]) and value != theirs[key]:
                return key
        if self._is_named_unlike(other):
            return "names in the table"
        if _is_one(self, other):
            return PROVEN
        several = any(prime.may_be or len(prime.names) > 1 for prime in self.primes + other.primes)
        return UNDECIDED if several or None in (*mine.values(), *theirs.values()) else INVARIANTS

    def _is_named_unlike(self, other: "_Type") -> bool:
        """Tell whether they have other names, or the table has one of them, and none for the other."""
        if (self.is_proven and other.is_proven) or (self.is_in_table and other.is_in_table):
            return not {*self.names} & {*other.names}
        named, less = (self, other) if self.is_in_table else (other, self)
        return named.is_in_table and any(prime.is_new for prime in less.primes)


def _is_one(here: _Type, there: _Type) -> bool:
    """Tell whether moves make the parts of a type of those of another, and parts tell the whole."""
    mates = list(there.pieces)
    for piece in here.pieces:
        mate = next((mate for mate in mates if _are_mates(piece, mate)), None)
        if mate is None:
            return False
        mates.remove(mate)
    if mates or _tells_the_whole(here.pieces):
        return not mates
    return len(here.pieces) == 1 and _meets(here.gauss, there.gauss)


def _are_mates(piece: list[Prime], mate: list[Prime]) -> bool:
    """Tell whether moves make the prime parts of a piece of those of another."""
    left = list(mate)
    for prime in piece:
        found = next((other for other in left if _is_same(prime, other)), None)
        if found is None:
            return False
        left.remove(found)
    return not left


def _is_same(prime: Prime, other: Prime) -> bool:
    if prime.proven and other.proven:
        return prime.names == other.names
    if None not in (prime.polynomial, other.polynomial) and prime.polynomial != other.polynomial:
        return False
    return _meets(prime.diagram, other.diagram)


def _meets(gauss: Gauss, other: Gauss) -> bool:
    return _core.meeting(gauss, [other], MOST_PROOF) is not None


def _tells_the_whole(pieces: list[list[Prime]]) -> bool:
    """Tell whether there is one way only to put such parts together.

    Moves do not mind whether a part is reversed, and a sum may: not if it is invertible, or the only one. A
    sum of links is another one for other components.
    """
    if any(len(piece) > 1 and any(len(prime.diagram[0]) > 1 for prime in piece) for piece in pieces):
        return False
    return [_is_invertible(prime) for prime in chain(*pieces)].count(False) <= 1


def _is_invertible(prime: Prime) -> bool:
    """Tell whether a part is known to be a knot that is the same when it is reversed; torus knots are."""
    knot, crossings = len(prime.diagram[0]) == 1, len(prime.diagram[1])
    return knot and (crossings <= INVERTIBLE or prime.torus is not None)
