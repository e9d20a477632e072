"""Where a curve comes from: a file, standard input, or the name of a knot."""

import os

import numpy as np

from sono import formats, starts
from sono.formats import FormatError, VertexFile

_OF_FILES = "./\\"
"""What looks like a file, but for names of knots such as 5.2.1 and 5/2."""


def is_name(source: str) -> bool:
    """Tell whether this is no file, nor looks like one, but may be the name of a knot."""
    is_file = os.path.exists(source) and not os.path.isdir(source)
    return source != "-" and not is_file and (not set(_OF_FILES) & set(source) or starts.knows(source))


def shadowed(source: str) -> bool:
    """Tell whether this is a file here that is called like a knot, which it takes the place of."""
    return os.path.isfile(source) and not set(_OF_FILES) & set(source) and starts.knows(source)


def read(source: str) -> VertexFile:
    """Read a curve file, or draw the knot of this name. Raises `FormatError`."""
    if not is_name(source):
        return formats.read(source)
    try:
        curve = starts.start(source)
    except ValueError as error:
        raise FormatError(f"{source}: no such file, nor a knot: {error}") from error
    return VertexFile(source, list(curve), [np.arange(len(component)) + 1 for component in curve])
