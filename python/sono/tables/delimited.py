"""TSV and CSV: every digit, the keys of the columns as head."""

import csv
import io
from collections.abc import Sequence

from sono.tables.base import TableWriter, exact
from sono.tables.columns import Row, Value


class _Delimited(TableWriter):
    delimiter: str
    unknown = "-"

    def _head(self) -> str:
        return self._joined([column.key for column in self._columns])

    def _line(self, row: Row) -> str:
        return self._joined([self._cell(row.get(column.key)) for column in self._columns])

    def _cell(self, value: Value) -> str:
        return self.unknown if value is None else exact(value)

    def _joined(self, cells: Sequence[str]) -> str:
        line = io.StringIO()
        csv.writer(line, delimiter=self.delimiter, lineterminator="\n").writerow(cells)
        return line.getvalue()


class Tsv(_Delimited):
    """Tabs between the cells."""

    delimiter = "\t"


class Csv(_Delimited):
    """Commas between the cells, and quotes where they are needed; what is not known is empty."""

    delimiter = ","
    unknown = ""
