"""Aligned text, for a terminal."""

from collections.abc import Sequence

from sono.tables.base import CAPTION, TableWriter, rounded
from sono.tables.columns import Row


class Text(TableWriter):
    """Spaces between the cells, each as wide as its column."""

    def _head(self) -> str:
        return f"{CAPTION}\n{self._aligned([column.header for column in self._columns])}"

    def _line(self, row: Row) -> str:
        return self._aligned([rounded(row, column) for column in self._columns])

    def _aligned(self, cells: Sequence[str]) -> str:
        padded = (
            cell.rjust(column.width) if column.spec else cell.ljust(column.width)
            for cell, column in zip(cells, self._columns, strict=True)
        )
        return "  ".join(padded).rstrip() + "\n"
