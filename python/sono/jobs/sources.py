"""Where a curve comes from: a file, one curve of a file, standard input, or the name of a knot."""

import os
import re
import zlib
from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import PurePath
from typing import Self

import numpy as np

from sono import formats
from sono.curve import Components
from sono.formats import Ends, FormatError, Raw, VertexFile

_OF_FILES = "./\\"
"""What looks like a file, but for names of knots such as 5.2.1 and 5/2."""

_UNSAFE = re.compile(r"[^\w+-]")
"""What of a key is not taken into the name of a file."""

_UNLIKE_FILES = str.maketrans('/\\:|*?"<>', "--_;_____")
"""What of a knot's name is changed in the name of a file, since Windows or others cannot have it."""

LONGEST_NAME = 80
"""Letters of a knot's name in tables and names of files; a longer one, which is a code, is cut and marked."""


def is_name(source: str) -> bool:
    """Tell whether this is no file, nor looks like one, but may be the name of a knot."""
    file = formats.split(source)[0]
    is_file = os.path.exists(file) and not os.path.isdir(file)
    return file != "-" and not is_file and (not set(_OF_FILES) & set(source) or _knows(source))


def shadowed(source: str) -> bool:
    """Tell whether this is a file here that is called like a knot, which it takes the place of."""
    return os.path.isfile(source) and not set(_OF_FILES) & set(source) and _knows(source)


@dataclass(frozen=True, eq=False)
class Source:
    """A curve to work on, as it was `given`: a file, "FILE:KEY", "-" for standard input, or a knot's name.

    `close` says how open chains are closed. `found` is the curve, not yet checked and with the name of its
    file, or checked, or what is wrong with it, if its file has been looked at already.
    """

    given: str
    close: Ends | None = None
    found: tuple[str, Raw] | VertexFile | FormatError | None = None

    def __str__(self) -> str:
        """Give it as the user does."""
        return self.given

    @property
    def name(self) -> str:
        """What the curve is called in tables: its file's name without folder and suffix, and its key."""
        if self.knot:
            return _shortened(self.knot)
        stem, key = self._parts()
        return stem if key is None else f"{stem}:{key}"

    @property
    def stem(self) -> str:
        """What the names of its files begin with: a colon, and much else that a key may have, cannot be."""
        if self.knot:
            return self.name.translate(_UNLIKE_FILES)
        stem, key = self._parts()
        return stem if key is None else f"{stem}.{_UNSAFE.sub('_', key)}"

    def _parts(self) -> tuple[str, str | None]:
        path, key = formats.split(self.given)
        return ("stdin" if path == "-" else PurePath(formats.unpacked(path)).stem), key

    @property
    def piped(self) -> bool:
        """Whether it comes from standard input."""
        return formats.split(self.given)[0] == "-"

    @property
    def knot(self) -> str | None:
        """The name of the knot, if it is one."""
        return self.given if is_name(self.given) else None

    def read(self) -> VertexFile:
        """Read the curve, or draw the knot. Raises `FormatError`."""
        if isinstance(self.found, FormatError):
            raise self.found
        if isinstance(self.found, VertexFile):
            return self.found
        if self.found:
            return VertexFile.checked(*self.found, self.close)
        return _drawn(self.given) if is_name(self.given) else formats.read(self.given, self.close)

    def looked_at(self) -> Self:
        """Return it with its curve, which then need not be read again, or with what is wrong with it."""
        try:
            return replace(self, found=self.read())
        except FormatError as error:
            return replace(self, found=error)


def curves(given: str, close: Ends | None = None) -> list[Source]:
    """Give the curves of a source: several, each called FILE:KEY, if it is a file that holds several.

    Only such files are read here, and standard input.
    """
    if is_name(given) or not formats.may_hold_several(formats.split(given)[0]):
        return [Source(given, close)]
    try:
        name, found = formats.raws(given)
    except FormatError as error:
        return [Source(given, close, error)]
    several = len(found) > 1
    return [Source(f"{given}:{raw.key}" if several else given, close, (name, raw)) for raw in found]


def _shortened(knot: str) -> str:
    """Return the name of a knot as tables have it."""
    name = " ".join(knot.split())
    return name if len(name) <= LONGEST_NAME else f"{name[:LONGEST_NAME]}~{zlib.crc32(name.encode()):08x}"


def _knows(name: str) -> bool:
    from sono import starts  # here, since most sources are files, which need none of them

    return starts.knows(name)


def _drawn(knot: str) -> VertexFile:
    from sono import starts

    try:
        curve = starts.drawn(knot)
    except ValueError as error:
        raise FormatError(f"{knot}: no such file, nor a knot: {error}") from error
    doubt = starts.doubt(knot)
    return as_file(knot, curve, knot, [doubt] if doubt else [])


def as_file(name: str, curve: Components, title: str, notes: Sequence[str] = ()) -> VertexFile:
    """Return a curve of no file as one that was read, its title a comment, and its vertices a line each."""
    lines = [np.arange(len(component)) + 1 for component in curve]
    return VertexFile(name, list(curve), lines, notes=notes, comments=[title])
