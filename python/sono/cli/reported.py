"""What `sono report` is given: folders of results, families of the atlas, files and names."""

import os
import re
import shlex
from collections.abc import Sequence
from functools import cache
from typing import TYPE_CHECKING, Any

from sono.cli.streams import complain

if TYPE_CHECKING:
    from sono.formats import Close
    from sono.jobs.sources import Source

ATLAS = "atlas"


def gathered(given: Sequence[str], close: "Close | None", quiet: bool) -> "tuple[list[Source], int]":
    """Return the curves of what is given, and the exit code; a folder without any is told."""
    from sono.jobs.sources import Source, curves
    from sono.starts.shapes import FAMILIES

    found: list[Source] = []
    code = 0
    for one in given:
        if one in (ATLAS, *FAMILIES):
            if os.path.isdir(one) and not quiet:
                complain(f"{one}: is of the atlas, and not the folder of this name, which is {one}/")
            found += [Source(knot) for knot, (family, _) in atlas().items() if one in (ATLAS, family)]
        elif os.path.isdir(one):
            files = _files(one)
            if not files:
                cure = f"`sono tighten NAME -o {shlex.quote(one)}` writes some"
                complain(f"{one}: no file of a curve is in this folder; {cure}")
                code = 1
            found += [curve for file in files for curve in curves(file, close)]
        else:
            found += curves(one, close)
    return found, code


def _files(folder: str) -> list[str]:
    """Return the files in a folder that may be of curves by their names, and are no tables, in order."""
    from sono import formats

    files = (entry.path for entry in os.scandir(folder) if entry.is_file() and not entry.name.startswith("."))
    suffixes = tuple(suffix for suffix in formats.SUFFIXES if suffix)
    named = [path for path in files if formats.unpacked(path.lower()).endswith(suffixes)]
    return sorted((path for path in named if not _is_other(path)), key=_by_number)


def _is_other(path: str) -> bool:
    """Tell whether this is a certificate or a table. What cannot be read is told when its turn comes."""
    from sono import formats, tables

    if not path.lower().endswith((".json", ".csv")):
        return False
    try:
        return path.endswith(".certificate.json") or tables.recognises(formats.load(path)[1])
    except formats.FormatError:
        return False


def _by_number(name: str) -> list[tuple[bool, int, str]]:
    parts = re.findall(r"\d+|\D+", name)
    return [(not part.isdecimal(), int(part) if part.isdecimal() else 0, part) for part in parts]


@cache
def atlas() -> dict[str, tuple[str, dict[str, Any]]]:
    """Return the family and the row of each knot of the atlas that the package carries."""
    from sono.figures.plot.atlas import rows
    from sono.starts.shapes import place

    return {str(row["knot"]): (place(str(row["knot"])).family, dict(row)) for row in rows()}
