"""The columns that a table may have, and the rows that fill them."""

import re
from collections.abc import Mapping
from dataclasses import dataclass
from difflib import get_close_matches

Value = str | int | float | None

Row = Mapping[str, Value]


@dataclass(frozen=True)
class Column:
    """One column: its `key` in a row, its headers, the `spec` that rounds it, its `width` in a text table.

    A column without a `spec` holds text and is aligned to the left.
    """

    key: str
    header: str
    latex: str
    spec: str
    width: int

    @property
    def kind(self) -> type[str] | type[int] | type[float]:
        """The type of its values."""
        return int if self.spec == "d" else float if self.spec else str


COLUMNS = {
    column.key: column
    for column in (
        Column("knot", "knot", "knot", "", 12),
        Column("n", "n", "$n$", "d", 6),
        Column("components", "components", "components", "d", 10),
        Column("dl", "dl", "$dl$", ".8f", 10),
        Column("l_p", "L_p", "$L_p$", ".6f", 11),
        Column("l_c", "L_c", "$L_c$", ".6f", 11),
        Column("l_a", "L_a", "$L_a=(4 L_p+L_c)/5$", ".6f", 11),
        Column("certified", "certified L_c", "certified $L_c$", "", 15),
        Column("sharp", "certified L_K", "certified $L_K$", "", 15),
        Column("decided_by", "decided by", "decided by", "", 18),
        Column("dispersion", "dispersion", "dispersion", ".1e", 10),
        Column("min_rad", "MinRad", "$MinRad$", ".9f", 12),
        Column("sr", "SR", "$SR$", ".9f", 12),
        Column("r_s", "R_s", "$R_s$", ".9f", 12),
        Column("r_c", "R_c", "$R_c$", ".9f", 12),
        Column("length", "Length(P)", "$Length(P)$", ".6f", 12),
        Column("inscribed_length", "Length(K_P)", "$Length(K_P)$", ".6f", 12),
        Column("writhe", "writhe", "$Wr$", ".6f", 11),
        Column("self_writhe", "self-writhe", "self-writhe", ".6f", 11),
        Column("acn", "ACN", "$ACN$", ".6f", 11),
        Column("radius_of_gyration", "R_g", "$R_g$", ".6f", 11),
        Column("gyration_1", "gyration 1", "$\\lambda_1$", ".6f", 11),
        Column("gyration_2", "gyration 2", "$\\lambda_2$", ".6f", 11),
        Column("gyration_3", "gyration 3", "$\\lambda_3$", ".6f", 11),
        Column("diameter", "diameter", "diameter", ".6f", 11),
        Column("total_curvature", "total curvature", "total curvature", ".6f", 15),
        Column("total_torsion", "total torsion", "total torsion", ".6f", 13),
        Column("max_curvature", "max. curvature", "max. curvature", ".6f", 14),
        Column("contacts", "contacts", "contacts", "d", 8),
        Column("overlap", "overlap", "overlap", ".1e", 8),
        Column("residual", "residual", "residual", ".1e", 8),
        Column("mu", "mu", "$\\mu$", ".1e", 8),
        Column("excess", "excess", "excess", ".1e", 8),
        Column("trials", "trials", "trials", "d", 6),
        Column("hits", "hits", "hits", "d", 5),
        Column("variant", "variant", "variant", "d", 8),
        Column("sweeps", "sweeps", "sweeps", "d", 9),
        Column("factorisations", "factorisations", "factorisations", "d", 14),
        Column("published", "published", "published", ".4f", 10),
        Column("source", "source", "source", "", 23),
        Column("kind", "kind", "kind", "", 9),
        Column("printed", "printed", "printed", ".4f", 10),
        Column("per", "per", "per", "", 8),
        Column("l_a_difference", "L_a-published", "$L_a-$published", "+.4f", 13),
        Column("l_c_difference", "L_c-published", "$L_c-$published", "+.4f", 13),
        Column("limit", "limit", "limit", ".5f", 10),
        Column("limit_error", "error", "error", ".1e", 8),
        Column("limit_difference", "limit-published", "limit$-$published", "+.4f", 15),
        Column("n_fine", "n(fine)", "$n$ (fine)", "d", 7),
        Column("l_c_fine", "L_c(fine)", "$L_c$ (fine)", ".6f", 11),
        Column("seed", "seed", "seed", "d", 6),
        Column("type", "type", "type", "", 9),
        Column("known", "known", "known", "", 16),
        Column("other", "other", "other", "", 12),
        Column("verdict", "verdict", "verdict", "", 13),
        Column("differs", "differs in", "differs in", "", 22),
        Column("other_knot", "other knot", "other knot", "", 12),
        Column("may_be", "may be", "may be", "", 24),
        Column("crossings", "crossings", "crossings", "d", 9),
        Column("determinant", "determinant", "determinant", "d", 11),
        Column("signature", "signature", "signature", "d", 9),
        Column("linking", "linking", "linking", "", 8),
        Column("alexander", "Alexander", "Alexander", "", 24),
        Column("homfly", "HOMFLY", "HOMFLY", "", 24),
        Column("seconds", "seconds", "seconds", ".2f", 9),
        Column("status", "status", "status", "", 12),
        Column("file", "file", "file", "", 12),
    )
}

_KEYS = {name.casefold(): column.key for column in COLUMNS.values() for name in (column.header, column.key)}

SHAPE = (
    *("writhe", "self_writhe", "acn", "radius_of_gyration", "gyration_1", "gyration_2", "gyration_3"),
    *("diameter", "total_curvature", "total_torsion", "max_curvature", "contacts"),
)
"""The descriptors of a shape."""

DEFAULT = ("knot", "n", "dl", "l_p", "l_c", "l_a")


def key_of(name: str) -> str:
    """Return the key of the column of this name: its key or its header, in any case. Raises `ValueError`."""
    try:
        return _KEYS[name.strip().casefold()]
    except KeyError:
        raise ValueError(f"unknown column {name!r}; {_nearest(name)}") from None


def _nearest(name: str) -> str:
    """Name the columns that may be meant, or all."""
    word = name.strip().casefold()
    letters = {re.sub(r"\W|_", "", known): key for known, key in _KEYS.items()}
    meant = [letters[near] for near in get_close_matches(re.sub(r"\W|_", "", word), letters, 3, 0.7)]
    keys = list(dict.fromkeys(meant or [_KEYS[near] for near in get_close_matches(word, _KEYS, 3, 0.65)]))
    return f"did you mean {' or '.join(keys)}?" if keys else f"the columns are: {', '.join(COLUMNS)}"


def column_of(name: str) -> Column | None:
    """Return the column of this name, likewise, if there is one."""
    return COLUMNS.get(_KEYS.get(name.strip().casefold(), ""))
