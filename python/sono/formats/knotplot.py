"""KnotPlot's own files, which are binary: a header, then fields, each of a name of four letters and its data.

Of a name the first letters tell the data: two small ones none, a large and a small one four bytes, two large
ones as many as the four bytes ahead of them count. `comp` begins a component, `Attr` says whether it is
closed, LOCD, LOCF and LOCS are coordinates as doubles, floats, or whole numbers to be scaled, and `endf` is
the end. Numbers have their high bytes first. Source: the KnotPlot manual, "KnotPlot File Formats", and what
Regina's `SpatialLink.fromKnotPlot` knows of LOCS.
"""

from collections.abc import Iterator, Sequence

import numpy as np
from numpy.typing import NDArray

from sono.formats.vertices import Chain, FormatError, Raw, shown

MAGIC = b"KnotPlot 1.0"

Floats = NDArray[np.float64]


def read(data: bytes, name: str) -> list[Raw]:
    """Parse a whole file; lengths keep its unit. Raises `FormatError`."""
    parts: list[list[Floats]] = []
    closed: list[bool] = []
    comments: list[str] = []
    for field, content in _fields(data, name):
        if field == b"comp" or (not parts and field.startswith(b"LOC")):
            parts.append([])
            closed.append(True)
        if field == b"NAME":
            comments.append(content.decode("utf-8", "replace").strip())
        if field == b"Attr" and closed:
            closed[-1] = bool(content[-1] & 1)
        if field.startswith(b"LOC"):
            parts[-1].append(_rows(field, content, name))
    chains = [
        Chain(rows := np.vstack(part), range(1, len(rows) + 1), is_closed)
        for part, is_closed in zip(parts, closed, strict=True)
        if part
    ]
    if not chains:
        raise FormatError.at(name, 1, "the file holds no coordinates; save the knot in KnotPlot once more")
    return [Raw(chains, comments=comments)]


def _fields(data: bytes, name: str) -> Iterator[tuple[bytes, bytes]]:
    """Give the names of the fields up to the last, with their data."""
    at = data.find(b"\f") + 2
    while at > 1 and at + 4 <= len(data):
        field, size, at = data[at : at + 4], 0, at + 4
        if field == b"endf":
            return
        if not field.isalpha():
            raise FormatError.at(
                name, 1, f"{shown(field.decode('latin-1'))} is no field of KnotPlot; save the knot once more"
            )
        if field[:1].isupper():
            size = 4
            if field[1:2].isupper():
                size, at = int.from_bytes(data[at : at + 4]), at + 4
        if at + size > len(data):
            break
        yield field, data[at : at + size]
        at += size
    raise FormatError.at(name, 1, "the file ends within a field; copy it once more, as binary")


def _rows(field: bytes, content: bytes, name: str) -> Floats:
    kind: Sequence[str] = {b"LOCD": (">f8",), b"LOCF": (">f4",), b"LOCS": (">u2", "scaled")}.get(field, ())
    if not kind:
        raise FormatError.at(
            name, 1, f"coordinates as {field.decode()} are not read; save them as LOCF or LOCD"
        )
    head, flat = (content[:16], content[16:]) if len(kind) > 1 else (b"", content)
    if len(flat) % (3 * np.dtype(kind[0]).itemsize) or (len(kind) > 1 and len(head) < 16):
        raise FormatError.at(
            name, 1, f"a field {field.decode()} is {len(content)} bytes long; save the knot once more"
        )
    rows = np.frombuffer(flat, kind[0]).reshape(-1, 3).astype(np.float64)
    if not head:
        return rows
    scale, *offset = np.frombuffer(head, ">f4").astype(np.float64)
    return np.asarray(scale * rows + offset)
