"""Curve files in and out: one module a format, each with `read(text, name)` and `write`.

A new format is one module and a line in `FORMATS`, with its suffixes in `SUFFIXES`. A file that is read is
recognised by its content unless the suffix tells, and is plain text when nothing else fits; one that is
written needs a suffix that is known, or none.

May import `curve` and `printing`.
"""

import os
from collections.abc import Iterable, Sequence
from pathlib import PurePath
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from sono.formats import text, vect
from sono.formats.files import atomic_text, is_stream, load, part_of, save
from sono.formats.vertices import FormatError, VertexFile

__all__ = [
    "FORMATS",
    "SUFFIXES",
    "FormatError",
    "VertexFile",
    "atomic_text",
    "by_suffix",
    "is_stream",
    "load",
    "parse",
    "part_of",
    "read",
    "save",
    "write",
]


class Format(Protocol):
    """What a format module offers."""

    def recognises(self, text: str) -> bool:
        """Tell whether a text looks like a file of this format; the first that does is taken."""

    def read(self, text: str, name: str) -> VertexFile:
        """Parse a whole file; `name` is for messages."""

    def write(self, components: Iterable[NDArray[np.float64]], comments: Sequence[str]) -> str:
        """Give the whole file."""


FORMATS: dict[str, Format] = {
    "vect": vect,
    "text": text,  # the last one, as it takes any text for its own
}

PLAIN = "text"
"""The format whose suffixes say nothing."""

SUFFIXES = {"": "text", ".txt": "text", ".xyz": "text", ".dat": "text", ".vect": "vect"}
"""The format of a file that is written, by its suffix."""


def read(source: str | os.PathLike[str]) -> VertexFile:
    """Read a curve of one or more components from a file, or from standard input when `source` is "-".

    Every component has at least three vertices, finite coordinates and no two equal neighbours; a last vertex
    that repeats the first is dropped. Lengths keep the file's unit. Raises `FormatError`.
    """
    return parse(*load(source))


def parse(name: str, content: str) -> VertexFile:
    """Read the text of a curve file, likewise; `name` is for messages, and its suffix counts."""
    own = SUFFIXES.get(_suffix(name), PLAIN)
    known = own if own != PLAIN else next(key for key in FORMATS if FORMATS[key].recognises(content))
    return FORMATS[known].read(content, name)


def write(
    target: str | os.PathLike[str],
    components: Iterable[NDArray[np.float64]],
    comments: Sequence[str] = (),
    format: str | None = None,
) -> None:
    """Write components, each (n_i, 3), to a file, or to standard output when `target` is "-".

    The format follows the suffix unless `format` names it. Coordinates keep every digit, and a file appears
    whole or not at all. Raises `FormatError` if it cannot be written or its suffix is that of no format,
    `ValueError` for an unknown format.
    """
    name = os.fspath(target)
    format = format or by_suffix(name)
    if format not in FORMATS:
        raise ValueError(f"unknown format {format!r}; the formats are: {', '.join(sorted(FORMATS))}")
    content = FORMATS[format].write(components, comments)
    save(name, content)


def by_suffix(name: str) -> str:
    """Return the format in which a file of this name is written. Raises `FormatError` for another suffix."""
    suffix = _suffix(name)
    if suffix not in SUFFIXES and not is_stream(name):
        known = ", ".join(filter(None, SUFFIXES))
        raise FormatError(f"{name}: {suffix} is no format for vertices; the suffixes are: {known}, or none")
    return SUFFIXES.get(suffix, "text")


def _suffix(name: str) -> str:
    return PurePath(name).suffix.lower()
