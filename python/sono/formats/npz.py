"""NumPy's NPZ: a ZIP archive of NPY arrays, the components in their order, and `comments`, as texts.

Arrays of other shapes, and the edges of a box, may stand beside them. `run.npz:coords` is one array.
"""

import io
import zipfile
import zlib
from collections.abc import Iterable, Mapping, Sequence

import numpy as np
from numpy.typing import NDArray

from sono.formats import npy
from sono.formats.vertices import SHOWN, FormatError, Raw, shown

MAGIC = b"PK\x03\x04"

COMMENTS = "comments"

COMPONENT = "component_"
"""Begins the names of the arrays that are written."""

BOXES = frozenset(("box", "cell", "lattice", "unitcell"))
"""Names of arrays (3, 3) that are no triangles."""

MOST = 1 << 32
"""Bytes that an archive may hold when it is unpacked."""


def read(data: bytes, name: str) -> list[Raw]:
    """Parse a whole file; lengths keep its unit. Raises `FormatError`."""
    arrays = {key: npy.array(content, f"{name}[{key}]") for key, content in _unpacked(data, name).items()}
    texts = arrays.pop(COMMENTS, np.array([], str))
    if not arrays:
        raise FormatError.at(name, 1, "the archive holds no arrays; give one (n, 3) for each component")
    comments = [str(text) for text in texts.ravel()] if texts.dtype.kind == "U" else []
    curves = {key: found for key, found in arrays.items() if _is_curve(key, found)} or arrays
    parts = [Raw(npy.chains_of(found, f"{name}[{key}]"), key) for key, found in curves.items()]
    chains = [chain for part in parts for chain in part.chains]
    return [Raw(chains, "", _notes(name, arrays, parts), comments, parts)]


def _is_curve(key: str, found: NDArray[np.generic]) -> bool:
    """Tell whether an array among others holds components."""
    *_, rows, columns = (0, 0, *found.shape)
    box = found.shape == (3, 3) and key.lower() in BOXES
    return found.dtype.kind in "fiu" and found.ndim in (2, 3) and rows > 2 and columns == 3 and not box


def _notes(name: str, arrays: Mapping[str, object], parts: Sequence[Raw]) -> list[str]:
    """Tell what the components are, and what is none, unless the file is as it is written here."""
    keys = [part.key for part in parts]
    count = sum(len(part.chains) for part in parts)
    left = [key for key in arrays if key not in keys]
    notes = []
    if count > 1 and not all(key.startswith(COMPONENT) for key in keys):
        more = f"; {name}:{keys[0]} is one of them" if len(keys) > 1 else ""
        notes = [f"{name}: was read as a link of {count} components, the arrays {_listed(keys)}{more}"]
    return notes + ([f"{name}: left out the arrays {_listed(left)}, which are no curves"] if left else [])


def _listed(keys: Sequence[str]) -> str:
    return ", ".join(keys[:SHOWN]) + (" and so on" if len(keys) > SHOWN else "")


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
    arrays: dict[str, NDArray[np.generic]] = {f"{COMPONENT}{k}": part for k, part in enumerate(components)}
    if lines := [line for comment in comments for line in comment.splitlines()]:
        arrays[COMMENTS] = np.array(lines)
    stream = io.BytesIO()
    with zipfile.ZipFile(stream, "w") as archive:
        for key, found in arrays.items():
            archive.writestr(zipfile.ZipInfo(f"{key}.npy"), npy.packed(found))
    return stream.getvalue()
