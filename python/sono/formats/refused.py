"""What cannot be read: curves beside others, where one spoils nothing but itself, and trajectories."""

from collections.abc import Callable, Sequence
from typing import NoReturn

from sono.formats.vertices import Chain, FormatError, Raw

TRAJECTORIES = {".xtc", ".trr", ".dcd"}
"""Suffixes of binary trajectories."""

MAGIC = (
    b"\x00\x00\x07\xcb",
    b"\x00\x00\x07\xe7",
    b"\x00\x00\x07\xc9",
    b"T\x00\x00\x00CORD",
    b"\x00\x00\x00TCORD",
)
"""What these begin with: XTC, XTC of large systems, TRR, DCD of either order of bytes."""


def refuse_trajectory(name: str, suffix: str, data: bytes) -> None:
    """Refuse a binary trajectory, by its name or by what it begins with. Raises `FormatError`."""
    if suffix in TRAJECTORIES or data.startswith(MAGIC):
        raise FormatError(
            f"{name}: XTC, TRR and DCD are not read; write frames that are: "
            f"`gmx trjconv -f {name} -s topol.tpr -pbc whole -o frames.gro`, or .xyz by MDAnalysis or VMD"
        )


class Refused(Sequence[Chain]):
    """The chains of a curve that cannot be read: whoever wants to know of them gets the error."""

    def __init__(self, error: FormatError) -> None:
        """Keep the error."""
        self._error = error

    def __len__(self) -> int:
        """Raise the error."""
        raise self._error

    def __getitem__(self, index: int | slice) -> NoReturn:
        """Raise the error."""
        raise self._error


def attempted(read: Callable[[], Raw], key: str) -> Raw:
    """Read one curve of a file of several; if that fails, so will every look at it."""
    try:
        return read()
    except FormatError as error:
        return Raw(Refused(error), key)
