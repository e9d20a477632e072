"""Ropelengths from the literature, beside ours, and what ours would be on ever finer edges.

L_p and L_c of a tight rope meet in the limit of its edges dl -> 0, and L_a is near it, but mostly below.
Measured in L_c - L_p it is so by 0.013 for half of the atlas, where dl is 0.2 radii, by -0.01 to 0.04 for
19 knots of 20, and by 0.07 at most; the most is 0.06 at 0.1, 0.09 at 0.3 and 0.12 at 0.5, always for one of
the symmetric knots 4_1, 8_18 and 9_40, whose beads find grooves all along. On edges below 0.1 the shares go
to zero with dl. Where L_c is known at two dl its error, proportional to dl^2, is extrapolated to zero, of
which a tenth is in doubt.
"""

import os
import re
from collections.abc import Iterator, Mapping, Sequence
from contextlib import suppress

from sono import formats, starts, tables
from sono.formats import FormatError
from sono.starts.likeness import may_be_alike
from sono.tables import Row, Value, reference

BELOW = 0.015
IN_DOUBT = (0.03, 0.2)
GROOVED = 0.1
"""How far L_a is below the limit, and the error of that, at dl = 0 and for each radius of dl, in shares of
L_c - L_p; below dl = GROOVED both are less, in proportion to dl."""

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
    return re.sub(r"(\.tight|\.n\d+|\.best\d*)+$", "", str(knot))


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
    """Say what was checked of what reached us at second hand, where ropes, after `beside`, are shorter."""
    shorter = [row for row in rows if below(row["l_a_difference"], 0) and not is_too_coarse(row)]
    for key, source in reference.sources().items():
        names = [str(row["knot"]) for row in shorter if row["source"] == key]
        if names and source.at_second_hand:
            yield f"shorter than {key}: {listed(names)}; {source.place}; {source.checked}"


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
    edge = l_p / n
    share = min(edge / GROOVED, 1) * (l_c - l_p)
    return l_a + BELOW * share, (IN_DOUBT[0] + IN_DOUBT[1] * edge) * abs(share)


def _difference(ours: Value, bound: Value) -> float | None:
    if isinstance(ours, int | float) and isinstance(bound, int | float):
        return ours - bound
    return None
