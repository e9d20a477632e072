"""What the writers of all formats share, and how values are shown."""

import re
from collections.abc import Sequence
from types import TracebackType
from typing import Self, TextIO

from sono.printing import printable
from sono.tables.columns import Column, Row, Value

CAPTION = "Ropelength is length over the RADIUS of the rope (R = 1)."


class TableWriter:
    """Writes a table to a stream row by row; as a context manager it also writes header and end.

    A row may hold more keys than the table has columns; what it lacks, or holds as None, prints as a dash.
    """

    def __init__(self, columns: Sequence[Column], stream: TextIO) -> None:
        """Write `columns` to `stream`, which stays open."""
        self._columns = columns
        self._stream = stream

    def header(self) -> None:
        """Write what comes before the rows."""
        self._put(self._head())

    def row(self, row: Row) -> None:
        """Write one row, in full, now."""
        self._put(self._line(row))

    def close(self) -> None:
        """Write what comes after the rows."""
        self._put(self._foot())

    def __enter__(self) -> Self:
        """Write the header."""
        self.header()
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        """Write the end, after a failure too: the rows so far make a complete table."""
        self.close()

    def _put(self, text: str) -> None:
        self._stream.write(text)
        self._stream.flush()

    def _head(self) -> str:
        raise NotImplementedError

    def _line(self, row: Row) -> str:
        raise NotImplementedError

    def _foot(self) -> str:
        return ""


def plain(name: str) -> str:
    """Return the name of a knot without what files add to it.

    >>> plain("8_20.n480.best2"), plain("m3_1.dl0.05")
    ('8_20', 'm3_1')
    """
    return re.sub(r"(\.tight|\.n\d+|\.dl\d*\.?\d+|\.best\d*)+$", "", name)


def rounded(row: Row, column: Column) -> str:
    """Show a value to a reader."""
    value = row.get(column.key)
    return exact(value) if value is None or isinstance(value, str) else format(value, column.spec)


def exact(value: Value) -> str:
    """Show a value with every digit, on one line."""
    if isinstance(value, str):
        # A row stays one line, and a file name that is not UTF-8 does not stop the table. JSON keeps both.
        return printable(re.sub(r"[\t\n\v\f\r]", " ", value).encode(errors="replace").decode())
    return "-" if value is None else str(value)
