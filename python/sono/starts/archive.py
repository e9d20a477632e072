"""Many ropes in one file, each of them in a few bytes a vertex.

The file is a zip archive with a member for each rope. Coordinates are whole numbers of `PARTS` parts of the
radius; along a smooth curve their third differences are small. A member has the number of components, the
vertices of each, and the differences, as unsigned numbers whose lowest bytes come first, all of them, then
the next ones; deflated.

>>> import numpy as np
>>> square = [np.array([[0.0, 0, 0], [2, 0, 0], [2, 2, 0], [0, 2, 0.5]])]
>>> [rope.tolist() for rope in unpacked(packed(square))] == [square[0].tolist()]
True
"""

import io
import zipfile
import zlib
from collections.abc import Mapping
from typing import IO

import numpy as np
from numpy.typing import NDArray

from sono.curve import Components

PARTS = 10**8
"""Lengths are measured alike, to 1e-7 of them, before and after rounding to such a part of the radius."""

ORDER = 3
"""The order of the differences."""

BYTES = 8
"""Of each number; most of them are zero, and cost nothing."""


def packed(curve: Components) -> bytes:
    """Return the bytes of a rope, of R_s = 1 or about that."""
    folded = [differences(np.rint(PARTS * component).astype(np.int64)).ravel() for component in curve]
    numbers = np.concatenate([[len(curve)], [len(c) for c in curve], *folded])
    return zlib.compress(numbers.astype("<u8").view(np.uint8).reshape(-1, BYTES).T.tobytes(), 9)


def unpacked(data: bytes) -> Components:
    """Return the rope of some bytes. Raises `ValueError` or `zlib.error` for others."""
    planes = np.frombuffer(zlib.decompress(data), np.uint8).reshape(BYTES, -1)
    numbers = np.ascontiguousarray(planes.T).view("<u8").ravel().astype(np.int64)
    sizes = numbers[1 : 1 + numbers[0]]
    coded = numbers[1 + numbers[0] :].reshape(-1, 3)
    whole = np.where(coded % 2, -(coded // 2) - 1, coded // 2)
    components = np.split(whole, np.cumsum(sizes[:-1]))
    for _ in range(ORDER):
        components = [component.cumsum(axis=0) for component in components]
    return [component / PARTS for component in components]


def differences(whole: NDArray[np.int64]) -> NDArray[np.int64]:
    """Return the third differences (n, 3) of whole numbers (n, 3), 0, -1, 1, -2, ... as 0, 1, 2, 3, ...

    >>> differences(np.array([[0, 5, 0], [1, 5, 0], [2, 5, 0]])).tolist()
    [[0, 10, 0], [2, 19, 0], [1, 10, 0]]
    """
    signed = np.diff(whole, n=ORDER, axis=0, prepend=np.zeros((ORDER, 3), np.int64))
    return np.where(signed < 0, -1 - 2 * signed, 2 * signed)


def written(ropes: Mapping[str, bytes]) -> bytes:
    """Return the bytes of an archive; the same ropes are the same bytes."""
    data = io.BytesIO()
    with zipfile.ZipFile(data, "w", zipfile.ZIP_STORED) as archive:
        for name, rope in ropes.items():
            archive.writestr(zipfile.ZipInfo(name), rope)  # with no time of writing
    return data.getvalue()


def one(file: IO[bytes], name: str) -> bytes | None:
    """Return one rope of the archive in a file, if it is there; no other one is read."""
    with zipfile.ZipFile(file) as archive:
        return archive.read(name) if name in archive.NameToInfo else None


def read(data: bytes) -> dict[str, bytes]:
    """Return the ropes of an archive by their names. Raises `zipfile.BadZipFile` for another file."""
    with zipfile.ZipFile(io.BytesIO(data)) as archive:
        return {name: archive.read(name) for name in archive.namelist()}
