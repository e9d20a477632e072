"""JSON: a row a line, or one array."""

import json
import math

from sono.tables.base import TableWriter
from sono.tables.columns import Row


class JsonLines(TableWriter):
    """An object a line."""

    def _head(self) -> str:
        return ""

    def _line(self, row: Row) -> str:
        values = {column.key: row.get(column.key) for column in self._columns}
        # JSON has no infinity: the SR of a curve without distant vertices becomes null.
        finite = {k: None if isinstance(v, float) and not math.isfinite(v) else v for k, v in values.items()}
        return json.dumps(finite) + "\n"


class Json(JsonLines):
    """An array, complete as soon as its end is written."""

    _between = ""

    def _head(self) -> str:
        return "[\n"

    def _line(self, row: Row) -> str:
        line, self._between = self._between + super()._line(row), ","
        return line

    def _foot(self) -> str:
        return "]\n"
