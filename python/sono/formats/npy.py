"""NumPy's NPY: an array (n, 3), or (k, n, 3) for k components of as many vertices. It has no comments.

Vertices count from 1 where messages name lines. Pickled objects are refused, since reading them runs them.
"""

import io
from collections.abc import Iterable, Sequence

import numpy as np
from numpy.typing import NDArray

from sono.formats.vertices import Chain, FormatError, Raw

MAGIC = b"\x93NUMPY"


def read(data: bytes, name: str) -> list[Raw]:
    """Parse a whole file; lengths keep its unit. Raises `FormatError`."""
    chains = chains_of(array(data, name), name)
    told = f"{name}: was read as a link of {len(chains)} components"
    return [Raw(chains, notes=[told] if len(chains) > 1 else [])]


def array(data: bytes, name: str) -> NDArray[np.generic]:
    """Load an array of numbers or texts. Raises `FormatError`."""
    try:
        found = np.lib.format.read_array(io.BytesIO(data), allow_pickle=False)
    except Exception as error:  # the header is parsed as Python is, and fails in as many ways
        why = "holds Python objects" if "Object arrays" in str(error) else "is no whole NPY file"
        raise FormatError.at(name, 1, f"{why}; save the vertices as an array of numbers") from error
    return np.asarray(found)


def chains_of(found: NDArray[np.generic], name: str) -> list[Chain]:
    """Give the components in an array. Raises `FormatError`."""
    if found.dtype.kind not in "fiu":
        raise FormatError.at(name, 1, f"the array holds {found.dtype}; save the vertices as float64")
    if found.ndim not in (2, 3) or found.shape[-1] != 3 or found.size == 0:
        cure = "give (n, 3), or (k, n, 3) for k components"
        raise FormatError.at(name, 1, f"the array has the shape {found.shape}; {cure}")
    with np.errstate(over="ignore"):
        parts = found.astype(np.float64).reshape(-1, *found.shape[-2:])
    return [Chain(part, range(1, len(part) + 1), said=False) for part in parts]


def write(components: Iterable[NDArray[np.float64]], comments: Sequence[str]) -> bytes:
    """Give the whole file. Raises `FormatError` for components of different sizes."""
    parts = list(components)
    sizes = sorted({len(part) for part in parts})
    if len(sizes) > 1:
        raise FormatError(
            f"NPY holds components of one size, these have {sizes[0]} to {sizes[-1]}; write .npz"
        )
    return packed(parts[0] if len(parts) == 1 else np.stack(parts))


def packed(found: NDArray[np.generic]) -> bytes:
    """Give the bytes of an array's file."""
    stream = io.BytesIO()
    np.lib.format.write_array(stream, np.ascontiguousarray(found), version=(1, 0), allow_pickle=False)
    return stream.getvalue()
