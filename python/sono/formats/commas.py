"""Comma-separated values with a header line, for spreadsheets and data frames; `columns` reads them.

    x,y,z                   component,x,y,z
    1.5,0.0,0.0             1,1.5,0.0,0.0
    ...                     ...

The components of a link have numbers. Comments are lines that begin with a # ahead of the header.
"""

from collections.abc import Iterable, Sequence

import numpy as np
from numpy.typing import NDArray

from sono.formats.text import head


def write(components: Iterable[NDArray[np.float64]], comments: Sequence[str]) -> str:
    """Give the whole file; every coordinate reads back to the same bits."""
    parts = list(components)
    numbers = [f"{number}," if len(parts) > 1 else "" for number in range(1, len(parts) + 1)]
    rows = (
        f"{number}{x!r},{y!r},{z!r}\n"
        for number, part in zip(numbers, parts, strict=True)
        for x, y, z in part.tolist()
    )
    return "".join([head(comments), "component," if len(parts) > 1 else "", "x,y,z\n", *rows])
