"""NumPy's NPZ: a ZIP archive of NPY arrays, the components in their order, and `comments`, as texts."""

import io
import zipfile
import zlib
from collections.abc import Iterable, Sequence
from itertools import chain

import numpy as np
from numpy.typing import NDArray

from sono.formats import npy
from sono.formats.vertices import FormatError, Raw, shown

MAGIC = b"PK\x03\x04"

COMMENTS = "comments"

MOST = 1 << 32
"""Bytes that an archive may hold when it is unpacked."""


def read(data: bytes, name: str) -> list[Raw]:
    """Parse a whole file; lengths keep its unit. Raises `FormatError`."""
    arrays = {key: npy.array(content, f"{name}[{key}]") for key, content in _unpacked(data, name).items()}
    texts = arrays.pop(COMMENTS, np.array([], str))
    if not arrays:
        raise FormatError.at(name, 1, "the archive holds no arrays; give one (n, 3) for each component")
    chains = chain.from_iterable(npy.chains_of(found, f"{name}[{key}]") for key, found in arrays.items())
    return [Raw([*chains], comments=[str(text) for text in texts.ravel()] if texts.dtype.kind == "U" else [])]


def _unpacked(data: bytes, name: str) -> dict[str, bytes]:
    try:
        with zipfile.ZipFile(io.BytesIO(data)) as archive:
            files = archive.infolist()
            if sum(file.file_size for file in files) > MOST:
                raise FormatError.at(
                    name, 1, f"the archive unpacks to more than {MOST} bytes; give a smaller one"
                )
            if other := next((file.filename for file in files if not file.filename.endswith(".npy")), None):
                raise FormatError.at(name, 1, f"the archive holds {shown(other)}; it should hold .npy arrays")
            return {file.filename.removesuffix(".npy"): archive.read(file) for file in files}
    except (zipfile.BadZipFile, zlib.error, OSError, EOFError, RuntimeError, ValueError) as error:
        if isinstance(error, FormatError):
            raise
        raise FormatError.at(name, 1, "is no whole NPZ archive; save it again with numpy.savez") from error


def write(components: Iterable[NDArray[np.float64]], comments: Sequence[str]) -> bytes:
    """Give the whole file; the same curve gives the same bytes."""
    arrays: dict[str, NDArray[np.generic]] = {f"component_{k}": part for k, part in enumerate(components)}
    if lines := [line for comment in comments for line in comment.splitlines()]:
        arrays[COMMENTS] = np.array(lines)
    stream = io.BytesIO()
    with zipfile.ZipFile(stream, "w") as archive:
        for key, found in arrays.items():
            archive.writestr(zipfile.ZipInfo(f"{key}.npy"), npy.packed(found))
    return stream.getvalue()
