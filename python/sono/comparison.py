"""A rope beside the shortest published one of its knot."""

from dataclasses import dataclass, fields
from typing import Any

from sono import starts
from sono.calls import Rope, measure
from sono.records import Record
from sono.tables import published


@dataclass(frozen=True, eq=False, repr=False)
class Comparison(Record):
    """A rope's lengths beside the shortest published ropelength of its knot, and where that is from.

    Differences are ours less the published; `limit`, with its error, estimates L_a on ever finer edges. The
    `kind` of what is published is "exact", "bound", "numerical" or "critical". What is not known is None.

    >>> import sono
    >>> found = compare(sono.tighten("4_1", 210), "4_1")
    >>> found.source, abs(found.limit_difference) < 0.05
    ('ACPR 2011', True)
    """

    knot: str
    l_a: float | None
    l_c: float | None
    limit: float | None
    limit_error: float | None
    published: float | None
    source: str | None
    kind: str | None
    l_a_difference: float | None
    l_c_difference: float | None
    limit_difference: float | None


def compare(rope: Rope, /, knot: str) -> Comparison:
    """Compare a rope's lengths with the shortest published ropelength of a knot.

    Raises `CurveError` for a curve that is not embedded, `ValueError` for a name that is not known. The
    rope's type is taken as said; any name of the knot, or of its mirror image, will do.

    >>> import sono
    >>> compare(sono.tighten("3_1", 240), "T(2,-3)").published
    32.7436
    >>> found = compare("Hopf", "2^2_1")
    >>> found.kind, found.source, round(found.published, 4)
    ('exact', 'CKS 2002', 25.1327)
    """
    if not isinstance(knot, str) or not starts.knows(knot):
        raise ValueError(f"{knot!r} is no name of a knot")
    measures = measure(rope)
    row = published.extrapolated({"knot": knot, "n": measures.n, "l_a": measures.l_a, "l_c": measures.l_c})
    found: Any = published.beside(row, published.table(), published.VALUE)
    return Comparison(*(found.get(field.name) for field in fields(Comparison)))
