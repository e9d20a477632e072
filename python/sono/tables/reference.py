"""The published ropelengths, each with its kind, its source, and what the source printed.

A ropelength over the diameter of the rope is doubled here, and nowhere else. The kinds are kept apart:

- exact: proven to be the least;
- bound: that of a curve, which its source gives as an upper bound;
- numerical: what a program gave for a polygon, of which its source says no more;
- critical: that of a curve in balance, which need not be the shortest;
- estimate: what the least is expected to be. No curve need have it, and no rope is compared with it.

>>> [(row["published"], row["kind"], row["source"]) for row in values("Hopf#Hopf")]
[(41.69911184307752, 'exact', 'CKS 2002')]
>>> [(row["kind"], row["printed"], row["per"], row["published"]) for row in values("3_1")][2]
('numerical', 16.372861, 'diameter', 32.745722)
"""

import math
import re
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from functools import cache

from sono import starts
from sono.tables.columns import Row

FACTORS = {"radius": 1, "diameter": 2}
"""By what a printed length is multiplied that is over this."""

RANKS = {"exact": 0, "bound": 1, "numerical": 2, "critical": 2, "estimate": 3}
"""The kinds: a rope is compared with the shortest of the first rank there is."""

CHAINS = "CKS 2002"

RINGS = {"0_1": 1, "L2a1": 2}
"""Chains that have other names, and their rings."""


@dataclass(frozen=True)
class Source:
    """A paper or a table: its short name, over what it prints ropelengths, and what was checked of these."""

    source: str
    per: str
    citation: str
    place: str
    checked: str

    @property
    def at_second_hand(self) -> bool:
        """Whether nobody here has read it."""
        return self.checked.startswith("second hand")


class Compared(Mapping[str, Row]):
    """The rows that ropes are compared with, by any names; chains of any length too."""

    def __getitem__(self, name: str) -> Row:
        """Return the first row of `values` that is no estimate."""
        row = next(iter(values(name)), None)
        if row is None or row["kind"] == "estimate":
            raise KeyError(name)
        return row

    def __iter__(self) -> Iterator[str]:
        """Give the names that the table has, those of `starts.canonical`, without chains."""
        return (name for name in _printed() if name in self)

    def __len__(self) -> int:
        """Count them."""
        return sum(1 for _ in self)


@cache
def sources() -> dict[str, Source]:
    """Return the sources by their short names."""
    return {row["source"]: Source(**row) for row in starts.table("sources")}


def values(name: str) -> list[Row]:
    """Return what is published on what has this name, in the order of rank and length.

    The rows have `knot`, `published`, over the radius, `kind`, `source`, and `printed` over what `per` says;
    `rounding` is half a unit of the last digit printed, over the radius.
    """
    name = starts.canonical(name)
    rings = RINGS.get(name) or int((re.fullmatch(r"chain(\d{1,9})", name) or [0, 0])[1])
    rows = [_row(name, _chain(rings), "exact", CHAINS)] if rings else []
    rows += [
        _row(name, float(row["printed"]), row["kind"], row["source"], _half_a_unit(row["printed"]))
        for row in _printed().get(name, [])
    ]
    return sorted(rows, key=lambda row: (RANKS[str(row["kind"])], row["published"]))


@cache
def _printed() -> dict[str, list[dict[str, str]]]:
    found: dict[str, list[dict[str, str]]] = {}
    for row in starts.table("published"):
        found.setdefault(row["knot"], []).append(row)
    return found


def _row(knot: str, printed: float, kind: str, source: str, rounding: float = 0.0) -> Row:
    per = sources()[source].per
    length = printed * FACTORS[per]
    return {
        **{"knot": knot, "published": length, "kind": kind, "source": source, "printed": printed, "per": per},
        "rounding": rounding * FACTORS[per],
    }


def _half_a_unit(printed: str) -> float:
    """Return half a unit of the last digit.

    >>> _half_a_unit("58.0060"), _half_a_unit("91")
    (5e-05, 0.5)
    """
    return 0.5 * 10.0 ** -len(printed.partition(".")[2])


def has_rings(name: str) -> bool:
    """Tell whether the name, that of `starts.canonical`, is of a Hopf link or chain, or a sum with one."""
    return any(part in RINGS or part.startswith("chain") for part in name.split("#"))


def _chain(rings: int) -> float:
    """Return the ropelength of a simple chain: two round rings at the ends, stadiums between them."""
    return (4 * math.pi + 4) * rings - 8 if rings > 1 else 2 * math.pi
