"""A table in Markdown."""

import re
from collections.abc import Sequence

from sono.tables.base import CAPTION, TableWriter, rounded
from sono.tables.columns import Row


class Markdown(TableWriter):
    """Bars between the cells."""

    def _head(self) -> str:
        rule = ["---:" if column.spec else ":---" for column in self._columns]
        return f"{CAPTION}\n\n{self._bars([column.header for column in self._columns])}{self._bars(rule)}"

    def _line(self, row: Row) -> str:
        return self._bars([re.sub(r"([\\|`*<])", r"\\\1", rounded(row, column)) for column in self._columns])

    def _bars(self, cells: Sequence[str]) -> str:
        return f"| {' | '.join(cells)} |\n"
