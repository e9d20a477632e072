"""Where a curve comes from: a file, standard input, or the name of a knot."""

import os
from dataclasses import dataclass

import numpy as np

from sono import formats, starts
from sono.formats import FormatError, VertexFile

_OF_FILES = "./\\"
"""What no name of a knot has."""


def is_name(source: str) -> bool:
    """Tell whether this is no file, nor looks like one, but may be the name of a knot."""
    file = formats.split(source)[0]
    is_file = os.path.exists(file) and not os.path.isdir(file)
    return source != "-" and not is_file and not set(_OF_FILES) & set(source)


def shadowed(source: str) -> bool:
    """Tell whether this is a file here that is called like a knot, which it takes the place of."""
    return os.path.isfile(source) and not set(_OF_FILES) & set(source) and starts.knows(source)


@dataclass(frozen=True)
class Content:
    """What is in a file, whose curve has this key if it holds several."""

    name: str
    data: bytes
    key: str | None


def with_content(source: str) -> tuple[Content | None, VertexFile]:
    """Read a source, likewise, and if it is a file give what it holds. Raises `FormatError`."""
    if is_name(source):
        return None, read(source)
    path, key = formats.split(source)
    content = Content(*formats.load(path), key)
    return content, formats.chosen(content.name, formats.parse(content.name, content.data), key)


def read(source: str) -> VertexFile:
    """Read a curve file, or draw the knot of this name. Raises `FormatError`."""
    if not is_name(source):
        return formats.read(source)
    try:
        curve = starts.start(source)
    except ValueError as error:
        raise FormatError(f"{source}: no such file, nor a knot: {error}") from error
    return VertexFile(source, list(curve), [np.arange(len(component)) + 1 for component in curve])
