"""Curve files in and out: one module a format, each with `read(text, name)` and `write`.

A new format is one module and one line in `FORMATS`. Its key is also the suffix that selects it; a file with
another suffix is recognised by its content, and is plain text when nothing else fits.
"""

import os
from collections.abc import Iterable, Sequence
from pathlib import PurePath
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from sono.formats import text, vect
from sono.formats.files import atomic_text, load, save
from sono.formats.vertices import FormatError, VertexFile

__all__ = ["FORMATS", "FormatError", "VertexFile", "atomic_text", "load", "read", "save", "write"]


class Format(Protocol):
    """What a format module offers."""

    def read(self, text: str, name: str) -> VertexFile:
        """Parse a whole file; `name` is for messages."""

    def write(self, components: Iterable[NDArray[np.float64]], comments: Sequence[str]) -> str:
        """Give the whole file."""


FORMATS: dict[str, Format] = {
    "text": text,
    "vect": vect,
}


def read(source: str | os.PathLike[str]) -> VertexFile:
    """Read a curve of one or more components from a file, or from standard input when `source` is "-".

    Every component has at least three vertices, finite coordinates and no two equal neighbours; a last vertex
    that repeats the first is dropped. Lengths keep the file's unit. Raises `FormatError`.
    """
    name, content = load(source)
    format = _by_suffix(name) or ("vect" if vect.recognises(content) else "text")
    return FORMATS[format].read(content, name)


def write(
    target: str | os.PathLike[str],
    components: Iterable[NDArray[np.float64]],
    comments: Sequence[str] = (),
    format: str | None = None,
) -> None:
    """Write components, each (n_i, 3), to a file, or to standard output when `target` is "-".

    The format follows the suffix unless `format` names it. Coordinates keep every digit, and a file appears
    whole or not at all. Raises `FormatError` if it cannot be written, `ValueError` for an unknown format.
    """
    name = os.fspath(target)
    format = format or _by_suffix(name) or "text"
    if format not in FORMATS:
        raise ValueError(f"unknown format {format!r}; the formats are: {', '.join(FORMATS)}")
    content = FORMATS[format].write(components, comments)
    save(name, content)


def _by_suffix(name: str) -> str | None:
    suffix = PurePath(name).suffix.removeprefix(".").lower()
    return suffix if suffix in FORMATS else None
