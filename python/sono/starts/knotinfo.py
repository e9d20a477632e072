"""The tables of KnotInfo and LinkInfo, which come with the extra sono[knotinfo], row by row."""

import json
import re
from functools import cache
from typing import Any

MISFIT = "L10n99{0,0,0}"
"""The link whose braid has another orientation than its diagram and LinkInfo's linking matrix."""


@cache  # it takes a second to read
def knots() -> dict[str, dict[str, str]]:
    """Return KnotInfo's rows by their names. Raises ImportError without the extra."""
    from database_knotinfo import link_list

    return {row["name"]: row for row in link_list()}


@cache
def links() -> dict[str, dict[str, str]]:
    """Return LinkInfo's rows by their names in lower case, and for names without orientation the first row.

    Raises ImportError without the extra.
    """
    from database_knotinfo import link_list

    rows = {row["name"].casefold(): row for row in link_list(proper_links=True)}
    return {name.split("{")[0]: row for name, row in reversed(rows.items())} | rows


def knot_row(name: str) -> dict[str, str]:
    """Return the row of a knot as the table knots.tsv would have it. Raises KeyError and ImportError."""
    row = knots()[name]
    points = json.loads(row["grid_notation"])
    columns = [[y for x, y in points if x == column] for column in range(1, len(points) // 2 + 1)]
    # "[1,-2]", or several words "[[1,-2],[1,2]]".
    word = re.search(r"[-\d, ]+", row["braid_notation"])
    return {
        "knot": name,
        "braid": word[0] if word else "",
        "grid": _grid(columns),
        "pd": _pd(json.loads(row["pd_notation"])),
    }


def link_row(name: str) -> dict[str, str]:
    """Return the row of a link as the table links.tsv would have it, but for the braid of `MISFIT`.

    Raises KeyError and ImportError.
    """
    row = links()[name.casefold()]
    _, *word = re.findall(
        r"-?\d+", row["braid_notation"]
    )  # strands and generators; a bracket is missing once
    return {
        "link": row["name"],
        "braid": ",".join(word) if row["name"] != MISFIT else "",
        # LinkInfo's arc presentations are the mirror images of its braids.
        "grid": _grid(_numbers(row["arc_notation"])[::-1]),
        "pd": _pd(_numbers(row["pd_notation_vector"])),
    }


def _numbers(text: str) -> Any:
    return json.loads(text.replace("{", "[").replace("}", "]"))


def _grid(columns: list[list[int]]) -> str:
    return " ".join(f"{min(ends)}-{max(ends)}" for ends in columns)


def _pd(codes: list[list[int]]) -> str:
    return " ".join(",".join(map(str, code)) for code in codes)
