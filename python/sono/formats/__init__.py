"""Curve files in and out: one module a format, each with `read(text, name)` or `write`, or both.

A new format is one module and a line in `READERS`, or in `BINARY` if it is no text, or in `WRITERS`, with its
suffixes in `SUFFIXES`. A file that is read is recognised by its content unless the suffix tells, and is plain
text when nothing else fits; one that is written needs a suffix that is known, or none.

A file may hold several curves, such as the frames of a simulation: `traj.xyz:12` is the one with the key 12.

May import `curve`, `printing` and `starts`.
"""

import os
import re
from collections.abc import Iterable, Sequence
from pathlib import PurePath
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from sono.formats import (
    brackets,
    codes,
    commas,
    coords,
    fseries,
    gro,
    ideal,
    jsons,
    knotplot,
    lammps,
    lammpstrj,
    mmcif,
    npy,
    npz,
    obj,
    pdb,
    pkf,
    text,
    vect,
    xyz,
)
from sono.formats.closing import Close, Ends
from sono.formats.files import atomic, decoded, head, is_stream, load, part_of, save, unpacked
from sono.formats.refused import refuse_trajectory
from sono.formats.vertices import SHOWN, FormatError, Raw, VertexFile, shown

__all__ = [
    "FRAMED",
    "READERS",
    "SUFFIXES",
    "WRITERS",
    "Close",
    "Ends",
    "FormatError",
    "Raw",
    "VertexFile",
    "atomic",
    "by_suffix",
    "decoded",
    "is_stream",
    "load",
    "may_hold_several",
    "parse",
    "part_of",
    "raws",
    "read",
    "read_all",
    "save",
    "split",
    "unpacked",
    "write",
    "write_all",
]


class Reader(Protocol):
    """What the module of a format that is read offers."""

    def recognises(self, text: str) -> bool:
        """Tell whether a text looks like a file of this format; the first that does is taken."""

    def read(self, text: str, name: str) -> Sequence[Raw]:
        """Parse a whole file into its curves, at least one; `name` is for messages."""


class BinaryReader(Protocol):
    """What the module of a format that is no text offers."""

    MAGIC: bytes
    """What its files begin with."""

    def read(self, data: bytes, name: str) -> Sequence[Raw]:
        """Parse a whole file into its curves, at least one; `name` is for messages."""


class Writer(Protocol):
    """What the module of a format that is written offers."""

    def write(self, components: Iterable[NDArray[np.float64]], comments: Sequence[str]) -> str | bytes:
        """Give the whole file."""


READERS: dict[str, Reader] = {
    "vect": vect,
    "xyz": xyz,
    "obj": obj,
    "codes": codes,  # ahead of JSON, whose brackets they may have
    "brackets": brackets,
    "json": jsons,
    "lammpstrj": lammpstrj,
    "lammps": lammps,
    "pdb": pdb,
    "gro": gro,
    "mmcif": mmcif,
    "ideal": ideal,
    "fseries": fseries,
    "pkf": pkf,
    "coords": coords,
    "text": text,  # the last one, as it takes any text for its own
}

BINARY: dict[str, BinaryReader] = {"npy": npy, "npz": npz, "knotplot": knotplot}

SINGLE = {*BINARY, "text", "brackets", "vect", "obj", "json", "lammps", "fseries", "pkf", "coords"}
"""The formats whose files hold one curve; into others a batch looks before it begins."""

WRITERS: dict[str, Writer] = {
    "vect": vect,
    "xyz": xyz,
    "obj": obj,
    "json": jsons,
    "npy": npy,
    "npz": npz,
    "lammps": lammps,
    "pdb": pdb,
    "csv": commas,
    "text": text,
}

FRAMED = {"xyz"}
"""The formats of which several files, one after the other, are a file of several curves."""

PLAIN = "text"
"""The format of what has no suffix."""

SUFFIXES = {
    "": "text",
    ".txt": "text",
    ".dat": "text",
    ".csv": "csv",
    ".xyz": "xyz",
    ".vect": "vect",
    ".obj": "obj",
    ".json": "json",
    ".npy": "npy",
    ".npz": "npz",
    ".lammpstrj": "lammpstrj",
    ".dump": "lammpstrj",
    ".data": "lammps",
    ".pdb": "pdb",
    ".ent": "pdb",
    ".gro": "gro",
    **dict.fromkeys((".cif", ".mmcif"), "mmcif"),
    ".fseries": "fseries",
    ".pkf": "pkf",
    **dict.fromkeys((".pd", ".dt", ".gauss"), "codes"),
}
"""The format of a file by its suffix."""

SOLID, SOLIDS = (b"glTF", b"ply\n", b"ply\r", b"solid "), (".stl", ".3mf")
"""What begins a file of triangles, and suffixes of such files that begin otherwise, and are no text."""

LOOSE = {PLAIN, "xyz", "csv"}
"""The formats whose suffixes say little of what is in a file: plain rows are called .xyz and .csv as well."""


def read(source: str | os.PathLike[str], close: Ends | None = None) -> VertexFile:
    """Read a curve of one or more components from a file, or from standard input when `source` is "-".

    Of a file that holds several curves, "FILE:KEY" reads one. Every component has at least three vertices,
    finite coordinates and no two equal neighbours; a last vertex that repeats the first is dropped, and an
    open chain is an error unless `close` says how it is closed. Lengths keep the file's unit. Raises
    `FormatError`.
    """
    name, (raw, *others) = raws(source)
    if others:
        keys = _listed([raw, *others])
        raise FormatError(f"{name}: holds {1 + len(others)} curves; {name}:{raw.key} is one, of: {keys}")
    return VertexFile.checked(name, raw, close)


def read_all(source: str | os.PathLike[str], close: Close | None = None) -> list[VertexFile]:
    """Read all curves of a file, or the one of "FILE:KEY", likewise."""
    name, found = raws(source)
    return [VertexFile.checked(name, raw, close) for raw in found]


def raws(source: str | os.PathLike[str]) -> tuple[str, Sequence[Raw]]:
    """Give a file's name for messages, and its curves, or that of "FILE:KEY", not yet checked.

    Raises `FormatError`.
    """
    path, key = split(os.fspath(source))
    name, data = load(path)
    found = _unchecked(name, data)
    if key is None:
        return name, found
    found = found[0].parts or found
    if chosen := [raw for raw in found if raw.key == key]:
        return name, chosen
    keys = _listed([raw for raw in found if raw.key])
    cure = f"there are: {keys}" if keys else "it holds one, which has none: give the file without a key"
    raise FormatError(f"{name}: holds no curve {shown(key)}; {cure}")


def _listed(curves: Sequence[Raw]) -> str:
    return ", ".join(raw.key for raw in curves[:SHOWN]) + (" and so on" if len(curves) > SHOWN else "")


def split(source: str) -> tuple[str, str | None]:
    """Split "FILE:KEY" into the file and the key of one of its curves; without a key it is None."""
    colons = [] if os.path.exists(source) else [match.start() for match in re.finditer(":", source)][::-1]
    cut = next((at for at in colons if os.path.isfile(source[:at]) or source[:at] == "-"), None)
    return (source, None) if cut is None else (source[:cut], source[cut + 1 :])


def may_hold_several(path: str) -> bool:
    """Tell by the first of its bytes whether a file is of a format that may hold several curves.

    What cannot be read twice may, and what cannot be read.
    """
    try:
        return is_stream(path) or _format_of(path, head(path)) not in SINGLE
    except FormatError:
        return True


def _format_of(name: str, data: bytes) -> str:
    """Tell which format a file of this name has that begins like this. Raises `FormatError`."""
    refuse_trajectory(name, _suffix(name), data)
    if data.startswith(SOLID) or (_suffix(name) in SOLIDS and b"\0" in data[:80]):
        raise FormatError.at(
            name, 1, "this is a solid, not a curve; give the curve, or the knot's name, that it was made of"
        )
    if binary := next((key for key, reader in BINARY.items() if data.startswith(reader.MAGIC)), None):
        return binary
    own = SUFFIXES.get(_suffix(name), PLAIN)
    if own not in LOOSE:
        return own
    content = decoded(name, data)
    return next(key for key in READERS if READERS[key].recognises(content))


def parse(name: str, data: bytes, close: Close | None = None) -> list[VertexFile]:
    """Read all curves in the bytes of a file, likewise; `name` is for messages, and its suffix counts."""
    return [VertexFile.checked(name, raw, close) for raw in _unchecked(name, data)]


def _unchecked(name: str, data: bytes) -> Sequence[Raw]:
    format = _format_of(name, data)
    if format in BINARY:
        return BINARY[format].read(data, name)
    return READERS[format].read(decoded(name, data), name)


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
    write_all(target, [(components, comments)], format)


def write_all(
    target: str | os.PathLike[str],
    curves: Iterable[tuple[Iterable[NDArray[np.float64]], Sequence[str]]],
    format: str | None = None,
) -> None:
    """Write curves, each with its comments, to one file, likewise; several need a format with frames."""
    name = os.fspath(target)
    format = format or by_suffix(name)
    if format not in WRITERS:
        raise ValueError(f"unknown format {format!r}; the formats are: {', '.join(sorted(WRITERS))}")
    try:
        contents = [WRITERS[format].write(components, comments) for components, comments in curves]
    except FormatError as error:
        raise FormatError(f"{name}: {error}") from error
    save(name, contents[0] if len(contents) == 1 else "".join(map(str, contents)))


def by_suffix(name: str) -> str:
    """Return the format in which a file of this name is written. Raises `FormatError` for another suffix."""
    suffix = _suffix(name)
    format = SUFFIXES.get(suffix, PLAIN if is_stream(name) else "")
    if format not in WRITERS:
        known = ", ".join(suffix for suffix, format in SUFFIXES.items() if suffix and format in WRITERS)
        raise FormatError(f"{name}: {suffix} is no format for vertices; the suffixes are: {known}, or none")
    return format


def _suffix(name: str) -> str:
    return PurePath(unpacked(name.lower())).suffix
