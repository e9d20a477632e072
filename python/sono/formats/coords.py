"""What KnotPlot's command `coords` prints: rows of x y z, and a line ahead of each component of a link.

    Component 1 of 2:
    1.5 0 0
    ...

Without such lines it is plain text.
"""

import re

from sono.formats import text as rows
from sono.formats.vertices import Raw

_AHEAD = re.compile(r"^[ \t]*Component +\d+ +of +\d+ *:?[ \t]*$", re.MULTILINE | re.IGNORECASE)


def recognises(text: str) -> bool:
    """Tell whether a line ahead of a component is among the first."""
    return _AHEAD.search(text, 0, 2_000) is not None


def read(text: str, name: str) -> list[Raw]:
    """Parse a whole file; lengths keep its unit. Raises `FormatError`."""
    return list(rows.read(_AHEAD.sub("", text), name))  # an empty line separates components too
