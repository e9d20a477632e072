"""Plain text: a vertex x y z a row, with spaces, tabs or commas between; a blank line starts a component.

A `#` starts a comment anywhere. A line that holds only a comment separates nothing:

    # a Hopf link begins
    1.5  0  0      # first vertex
    -0.5, 1, 0
    ...

    0 0 1.5        # first vertex of the second component

A header, or more columns, are left to `columns`.
"""

from collections.abc import Iterable, Sequence

import numpy as np
from numpy.typing import NDArray

from sono.formats import columns, layouts
from sono.formats.vertices import Chain, FormatError, Raw, numbers


def recognises(text: str) -> bool:
    """Take any text for a list of vertices; what is wrong with it is told when it is read."""
    return True


def read(text: str, name: str) -> list[Raw]:
    """Parse a whole file; lengths keep its unit. Raises `FormatError`."""
    chains: list[Chain] = []
    rows: list[tuple[float, float, float]] = []
    lines: list[int] = []
    comments: list[str] = []
    for number, line in enumerate((*text.split("\n"), ""), 1):  # the empty line ends the last component
        data = line.partition("#")[0].strip()
        if data:
            try:
                x, y, z = numbers(_cells(data))
            except ValueError:
                if not rows and not chains:
                    return columns.read(text, name)
                raise FormatError.at(name, number, layouts.wrong(data)) from None
            rows.append((x, y, z))
            lines.append(number)
        elif "#" in line:
            comments.append(line.partition("#")[2].strip())
        elif rows:
            chains.append(Chain(rows, lines, said=False))
            rows, lines = [], []
    if not chains:
        raise FormatError.at(name, 1, "the file holds no vertices; give rows of three numbers x y z")
    return [Raw(chains, comments=comments)]


def write(components: Iterable[NDArray[np.float64]], comments: Sequence[str]) -> str:
    """Give the whole file; every coordinate reads back to the same bits."""
    return head(comments) + "\n".join(
        "".join(f"{x!r} {y!r} {z!r}\n" for x, y, z in vertices.tolist()) for vertices in components
    )


def head(comments: Sequence[str]) -> str:
    """Give the lines of comments ahead of the rows."""
    return "".join(f"# {line}".rstrip() + "\n" for comment in comments for line in comment.splitlines())


def _cells(data: str) -> list[str]:
    if "," not in data:
        return data.split()
    if data.count(",") == 2:  # twice as fast as the general way, for the common case; float() strips
        return data.split(",")
    return layouts.cells_of(data)
