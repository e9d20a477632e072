"""Knots and links of the tables: their rows, and the conformations drawn from a row.

A row has a closed braid, an arc presentation and a planar diagram, as text.

>>> row = table_row("5^2_1")
>>> row["link"], len(conformation(row, -1))
('L5a1{0}', 2)
"""

import re
from functools import cache

from sono.curve import Components
from sono.starts import knotinfo
from sono.starts.arcs import Strokes, grid, shuffled
from sono.starts.braids import braid
from sono.starts.codes import diagram
from sono.starts.flypes import flyped
from sono.starts.links import link_row, ordered_like, oriented_like
from sono.starts.planar import lifted
from sono.starts.spelling import spelled
from sono.starts.tables import table
from sono.starts.torus import chain, torus

SAME_SIZE = 16
SIZES = 4
"""Variants drawn from arc presentations: so many have as few columns as possible, so many one more, ..."""

_TORI = {"3_1": (2, 3), "5_1": (2, 5), "7_1": (2, 7), "8_19": (3, 4), "9_1": (2, 9)}
"""Knots that are drawn shorter so than as the braids of their rows."""


class NoTableError(ValueError):
    """A name of a table that is not installed."""


_LARGE = re.compile(r"(1[123][an]_|L1[01][an])\d{1,9}(\{[01](,[01])*\})?", re.IGNORECASE)


@cache
def knot_rows() -> dict[str, dict[str, str]]:
    """Return the rows of the knots to 10 crossings by KnotInfo's names, and by those of Thistlethwaite."""
    rows = table("knots")
    return {row["knot"]: row for row in rows} | {row["thistlethwaite"]: row for row in rows}


def table_row(name: str) -> dict[str, str] | None:
    """Return the row of a knot or link, if the tables have it.

    Raises `NoTableError` where its table is in the extra sono[knotinfo], and that is not installed.
    """
    if row := knot_rows().get(name.casefold()) or link_row(name):
        return row
    if not _LARGE.fullmatch(name):
        return None
    try:
        return knotinfo.link_row(name) if name[0] in "lL" else knotinfo.knot_row(name.casefold())
    except ImportError:
        what, most = ("links", 9) if name[0] in "lL" else ("knots", 10)
        raise NoTableError(
            f"{name!r}: the table of {what} of more than {most} crossings is an extra; "
            "pip install 'sono[knotinfo]'"
        ) from None
    except KeyError:
        return None


def tabled_name(name: str) -> str:
    """Return the name by which the tables have a knot to 10 crossings, or else as it is spelled here.

    >>> tabled_name("K8n1"), tabled_name("8.20"), tabled_name("K11n34"), tabled_name("T(2,5)")
    ('8_20', '8_20', '11n_34', 'T(2,5)')
    """
    row = knot_rows().get(spelled(name).casefold())
    return row["knot"] if row else spelled(name)


def is_tabled(name: str) -> bool:
    """Tell whether this is the name of a knot or link of the tables, or looks like one of the extra's."""
    return bool(knot_rows().get(name.casefold()) or link_row(name) or _LARGE.fullmatch(name))


def conformation(row: dict[str, str], variant: int) -> Components:
    """Return a conformation of a row's knot or link; see `start`."""
    plain = _plain(row)
    if variant == 0:
        return plain
    if variant > 0:
        curve = grid(shuffled(_strokes(row["grid"]), variant, variant // SAME_SIZE % SIZES))
        return oriented_like(curve, plain) if len(plain) > 1 else curve
    curve = lifted(flyped(diagram("pd", row["pd"]), -variant), -variant)
    return ordered_like(curve, plain) if len(plain) > 1 else curve


def _plain(row: dict[str, str]) -> Components:
    """Return the torus knot, chain or closed braid of a row, or what its diagram gives where it has none."""
    if torus_type := _TORI.get(row.get("knot", "")):
        return torus(*torus_type)
    if row.get("link") == "L2a1{1}":
        return chain(2)
    if not row["braid"]:
        return lifted(diagram("pd", row["pd"]), 0)
    return braid([int(generator) for generator in re.findall(r"-?\d+", row["braid"])])


def _strokes(text: str) -> Strokes:
    """Read an arc presentation such as "1-3 2-4 3-5 1-4 2-5", whose rows count from 1."""
    ends = (column.split("-") for column in text.split())
    return [(int(low) - 1, int(high) - 1) for low, high in ends]
