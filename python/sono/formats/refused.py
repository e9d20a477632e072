"""Curves of a file that cannot be read, beside others that can: one of them spoils nothing but itself."""

from collections.abc import Callable, Sequence
from typing import NoReturn

from sono.formats.vertices import Chain, FormatError, Raw


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
