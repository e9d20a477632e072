"""Ropelengths from the literature, beside ours."""

import re
from functools import cache

from sono import library, tables
from sono.formats import FormatError
from sono.tables import Row, Value


@cache
def table() -> dict[str, Row]:
    """Return the shortest published ropelengths of prime knots: rows with knot, published and source."""
    return {
        row["knot"]: {"knot": row["knot"], "published": float(row["ropelength"]), "source": row["source"]}
        for row in library.table("published")
    }


def from_file(path: str) -> dict[str, Row]:
    """Return the rows of another table: its column published, or else its L_a. Raises `FormatError`."""
    rows = tables.read(path)
    if not any(row.get("published") or row.get("l_a") for row in rows):
        raise FormatError(f"{path}: has no column published, nor L_a, with a value in it")
    return {
        _type(row["knot"]): {
            "published": row.get("published") or row.get("l_a"),
            "source": row.get("source") or path,
        }
        for row in rows
    }


def _type(knot: Value) -> str:
    """Return the name of a knot, as tables have it, without what files and mirror images add to it."""
    stem = re.sub(r"(\.tight|\.n\d+|\.best\d*)+$", "", str(knot))
    return re.sub("^m(?=.)", "", stem, flags=re.IGNORECASE)


def beside(row: Row, published: dict[str, Row]) -> Row:
    """Add to a row what is published on its knot, or on its mirror image, and the differences.

    The difference of L_c is that of the finer level, where the row has one.
    """
    other = published.get(_type(row["knot"]), {})
    bound, source = other.get("published"), other.get("source")
    ours = {"l_a": row.get("l_a"), "l_c": row.get("l_c_fine") or row.get("l_c")}
    differences = {f"{key}_difference": _difference(value, bound) for key, value in ours.items()}
    return {**row, "published": bound, "source": source, **differences}


def _difference(ours: Value, bound: Value) -> float | None:
    if isinstance(ours, int | float) and isinstance(bound, int | float):
        return ours - bound
    return None
