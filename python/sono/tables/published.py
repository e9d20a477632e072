"""Ropelengths from the literature, beside ours, and what ours would be on ever finer edges.

L_p and L_c of a tight rope meet in the limit of its edges dl -> 0, and L_a is near it, but mostly below.
Measured in L_c - L_p it is so by 0.013 for half of the atlas, where dl is 0.2 radii, by -0.01 to 0.04 for
19 knots of 20, and by 0.07 at most; for the links by 0.1 at most, of L8n8, and by 0.2 for the Hopf link. For
most ropes the shares go to zero with dl. But beads of symmetric ropes find grooves all along, on edges of any
length: L6a4 keeps its 0.05 and the Hopf link its 0.2. What a rope's own edges do not tell is in doubt. Where
L_c is known at two dl its error, proportional to dl^2, is extrapolated to zero, of which a tenth is in doubt.
"""

import os
from collections.abc import Iterator, Mapping, Sequence
from contextlib import suppress

from sono import formats, starts, tables
from sono.formats import FormatError
from sono.starts.likeness import may_be_alike
from sono.tables import Row, Value, reference
from sono.tables.base import plain

BELOW, GROOVED = 0.015, 0.1
"""How far L_a is below the limit, in shares of L_c - L_p; on edges below `GROOVED` in proportion to dl."""

COARSE = (0.03, 0.2)
"""The error of that in the same shares on coarse edges: at dl = 0, and for each radius of dl."""

GROOVES, RINGS = 0.1, 0.22
"""The error at least, on edges of any length: by how much grooves make L_a less, and those of round rings,
which the Hopf link and chains are made of."""

REMAINS = 0.1
"""The share of an extrapolation that is in doubt."""

SHOWN = 12
"""Knots that a message names at most."""

VALUE = ("source", "kind", "printed", "per")
"""What there is to say of a published value."""

ROUNDING = 1e-6
"""By how much less than a bound L_c may be computed."""

FAR_BELOW = 0.02
"""No published ropelength of a prime knot to 10 crossings is longer than ours by half as much."""


def table() -> Mapping[str, Row]:
    """Return what ropes are compared with, by any name of a knot or link: see `reference`."""
    return reference.Compared()


def from_file(path: str) -> dict[str, Row]:
    """Return the rows of another table: its column published, or else its L_a. Raises `FormatError`."""
    rows = tables.read(path)
    if not any(row.get("published") or row.get("l_a") for row in rows):
        raise FormatError(f"{path}: has no column published, nor L_a, with a value in it")
    return {
        type_of(row["knot"]): {
            "published": row.get("published") or row.get("l_a"),
            "source": row.get("source") or path,
            "kind": row.get("kind"),
        }
        for row in rows
    }


def type_of(knot: Value) -> str:
    """Return the one name of a knot and its mirror image, without what files add to it."""
    return starts.canonical(name_of(knot))


def name_of(knot: Value) -> str:
    """Return the name of a knot without what files add to it."""
    return plain(str(knot))


def beside(row: Row, published: Mapping[str, Row], told: Sequence[str] = ("source",)) -> Row:
    """Add to a row what is published on its knot, or on its mirror image, and the differences.

    What is `told` of it is some of `VALUE`. The difference of L_c is that of the finer level, where the row
    has one; a limit has a difference too.
    """
    return _compared(row, published.get(type_of(row["knot"]), {}), told)


def beside_all(row: Row) -> list[Row]:
    """Return a row for each published value, likewise, or one without any."""
    return [_compared(row, value, VALUE) for value in reference.values(type_of(row["knot"])) or [{}]]


def _compared(row: Row, value: Row, told: Sequence[str]) -> Row:
    ours = {"l_a": row.get("l_a"), "l_c": row.get("l_c_fine") or row.get("l_c")}
    ours |= {"limit": row["limit"]} if "limit" in row else {}
    bound = value.get("published")
    differences = {f"{key}_difference": _difference(length, bound) for key, length in ours.items()}
    return {**row, "published": bound, **{key: value.get(key) for key in told}, **differences}


def claims(rows: Sequence[Row]) -> Iterator[str]:
    """Say what was checked of what reached us at second hand, where ropes, after `beside`, are shorter.

    Only L_c is a rope's length; a limit below what is published is an estimate.
    """
    for key, source in reference.sources().items():
        ours = [row for row in rows if row["source"] == key]
        shorter = [row for row in ours if below(row["l_c_difference"], -_rounding(row))]
        beyond = [row for row in ours if row not in shorter and below(_beyond(row), -_rounding(row))]
        for claim, these in (("shorter", shorter), ("the estimate of the limit is below", beyond)):
            if these and source.at_second_hand:
                than = f"than {key}" if these is shorter else key
                yield f"{claim} {than}: {listed(_names(these))}; {source.place}; {source.checked}"


def _rounding(row: Row) -> float:
    """Return half a unit of the last digit that the source of a row, after `beside`, has printed."""
    values = reference.values(type_of(row["knot"]))
    return next((float(value["rounding"] or 0) for value in values if value["source"] == row["source"]), 0.0)


def _beyond(row: Row) -> float | None:
    """Return by how much a limit exceeds what is published, if its error is not in its favour."""
    difference, error = row.get("limit_difference"), row.get("limit_error")
    return difference + error if isinstance(difference, float) and isinstance(error, float) else None


def _names(rows: Sequence[Row]) -> list[str]:
    """Return the names that rows have, once each."""
    return list(dict.fromkeys(str(row["knot"]) for row in rows))


def below(difference: Value, bound: float) -> bool:
    """Tell whether there is a difference and it is below this."""
    return isinstance(difference, float) and difference < bound


def listed(names: Sequence[str]) -> str:
    """Name some knots, but no more than `SHOWN`."""
    return ", ".join(names[:SHOWN]) + (", ..." if len(names) > SHOWN else "")


def extrapolated(row: Row) -> Row:
    """Add to the row of a tight rope its limit on ever finer edges, and the error of that."""
    limit, error = _limit(row)
    return {**row, "limit": limit, "limit_error": error}


def is_too_coarse(row: Row) -> bool:
    """Tell whether a row, after `beside`, cannot say which is shorter, ours or the published."""
    difference, error = row.get("limit_difference"), row.get("limit_error")
    return isinstance(difference, float) and isinstance(error, float) and abs(difference) <= error


def doubt(row: Row) -> str | None:
    """Say why the rope of a row, after `beside`, is of another knot than its name says, if it seems so."""
    name, file = name_of(row["knot"]), row.get("file")
    if isinstance(file, str) and os.path.isfile(file):
        with suppress(ValueError):  # a name of no known knot, or a file of no curve
            if may_be_alike(formats.read(file).components, starts.start(name)):
                return None
            return f"{row['knot']}: the curve in {file} is of another type than {name}"
    if row.get("kind") == "exact" and below(row.get("l_c_difference"), -ROUNDING):
        return f"{row['knot']}: is shorter than any rope of this type can be: is it of this type?"
    difference, bound = row.get("l_a_difference"), row.get("published")
    if isinstance(difference, float) and isinstance(bound, float) and -difference > FAR_BELOW * bound:
        return f"{row['knot']}: is {-difference / bound:.0%} shorter than published: is it of this type?"
    return None


def _limit(row: Row) -> tuple[float | None, float | None]:
    """Estimate the ropelength in the limit of fine edges, and the error of that."""
    l_a, l_c, n = (row.get(key) for key in ("l_a", "l_c", "n"))
    fine, n_fine = row.get("l_c_fine"), row.get("n_fine")
    if not (isinstance(l_a, float) and isinstance(l_c, float) and isinstance(n, int) and n > 0):
        return None, None
    if isinstance(fine, float) and isinstance(n_fine, int) and n_fine > n:
        beyond = (l_c - fine) / ((n_fine / n) ** 2 - 1)
        return fine - beyond, REMAINS * abs(beyond)
    l_p = (5 * l_a - l_c) / 4
    edge, gap = l_p / n, l_c - l_p
    least = RINGS if reference.has_rings(type_of(row["knot"])) else GROOVES
    error = max(least, COARSE[0] + COARSE[1] * edge) * abs(gap)
    return l_a + BELOW * min(edge / GROOVED, 1) * gap, error


def _difference(ours: Value, bound: Value) -> float | None:
    if isinstance(ours, int | float) and isinstance(bound, int | float):
        return ours - bound
    return None
