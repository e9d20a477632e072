"""Rows of results as a table: aligned text, TSV, CSV, JSON lines, a JSON array, Markdown or LaTeX.

Each row is written and flushed as soon as it is finished, so that a later failure loses nothing. Text,
Markdown and LaTeX are for readers: they round, and head their columns with the paper's symbols, L_p. TSV, CSV
and JSON are for the next program: they keep every digit, and call a column by its key, l_p. Wherever a column
is named, either will do.
"""

import csv
import io
import json
import math
import re
from collections.abc import Iterator, Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass
from types import TracebackType
from typing import Any, Self, TextIO

Value = str | int | float | None
Row = Mapping[str, Value]

_CONTROL = re.compile("[\x00-\x1f\x7f-\x9f\u2028-\u202e\u2066-\u2069]")

CAPTION = "Ropelength is length over the RADIUS of the rope (R = 1)."


@dataclass(frozen=True)
class Column:
    """One column: its `key` in a row, its headers, the `spec` that rounds it, its `width` in a text table.

    A column without a `spec` holds text and is aligned to the left.
    """

    key: str
    header: str
    latex: str
    spec: str
    width: int

    @property
    def kind(self) -> type[str] | type[int] | type[float]:
        """The type of its values."""
        return int if self.spec == "d" else float if self.spec else str


COLUMNS = {
    column.key: column
    for column in (
        Column("knot", "knot", "knot", "", 12),
        Column("n", "n", "$n$", "d", 6),
        Column("components", "components", "components", "d", 10),
        Column("dl", "dl", "$dl$", ".8f", 10),
        Column("l_p", "L_p", "$L_p$", ".6f", 11),
        Column("l_c", "L_c", "$L_c$", ".6f", 11),
        Column("l_a", "L_a", "$L_a=(4 L_p+L_c)/5$", ".6f", 11),
        Column("dispersion", "dispersion", "dispersion", ".1e", 10),
        Column("min_rad", "MinRad", "$MinRad$", ".9f", 12),
        Column("sr", "SR", "$SR$", ".9f", 12),
        Column("r_s", "R_s", "$R_s$", ".9f", 12),
        Column("r_c", "R_c", "$R_c$", ".9f", 12),
        Column("length", "Length(P)", "$Length(P)$", ".6f", 12),
        Column("inscribed_length", "Length(K_P)", "$Length(K_P)$", ".6f", 12),
        Column("overlap", "overlap", "overlap", ".1e", 8),
        Column("residual", "residual", "residual", ".1e", 8),
        Column("mu", "mu", "$\\mu$", ".1e", 8),
        Column("excess", "excess", "excess", ".1e", 8),
        Column("trials", "trials", "trials", "d", 6),
        Column("hits", "hits", "hits", "d", 5),
        Column("variant", "variant", "variant", "d", 8),
        Column("sweeps", "sweeps", "sweeps", "d", 9),
        Column("factorisations", "factorisations", "factorisations", "d", 14),
        Column("published", "published", "published", ".4f", 10),
        Column("source", "source", "source", "", 18),
        Column("l_a_difference", "L_a-published", "$L_a-$published", "+.4f", 13),
        Column("l_c_difference", "L_c-published", "$L_c-$published", "+.4f", 13),
        Column("limit", "limit", "limit", ".5f", 10),
        Column("limit_error", "error", "error", ".1e", 8),
        Column("limit_difference", "limit-published", "limit$-$published", "+.4f", 15),
        Column("n_fine", "n(fine)", "$n$ (fine)", "d", 7),
        Column("l_c_fine", "L_c(fine)", "$L_c$ (fine)", ".6f", 11),
        Column("seed", "seed", "seed", "d", 6),
        Column("type", "type", "type", "", 9),
        Column("seconds", "seconds", "seconds", ".2f", 9),
        Column("status", "status", "status", "", 12),
        Column("file", "file", "file", "", 12),
    )
}

_KEYS = {name.casefold(): column.key for column in COLUMNS.values() for name in (column.header, column.key)}

DEFAULT = ("knot", "n", "dl", "l_p", "l_c", "l_a")


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


class _Text(TableWriter):
    def _head(self) -> str:
        return f"{CAPTION}\n{self._aligned([column.header for column in self._columns])}"

    def _line(self, row: Row) -> str:
        return self._aligned([_rounded(row, column) for column in self._columns])

    def _aligned(self, cells: Sequence[str]) -> str:
        padded = (
            cell.rjust(column.width) if column.spec else cell.ljust(column.width)
            for cell, column in zip(cells, self._columns, strict=True)
        )
        return "  ".join(padded).rstrip() + "\n"


class _Delimited(TableWriter):
    delimiter: str

    def _head(self) -> str:
        return self._joined([column.key for column in self._columns])

    def _line(self, row: Row) -> str:
        return self._joined([_exact(row.get(column.key)) for column in self._columns])

    def _joined(self, cells: Sequence[str]) -> str:
        line = io.StringIO()
        csv.writer(line, delimiter=self.delimiter, lineterminator="\n").writerow(cells)
        return line.getvalue()


class _Tsv(_Delimited):
    delimiter = "\t"


class _Csv(_Delimited):
    delimiter = ","


class _JsonLines(TableWriter):
    def _head(self) -> str:
        return ""

    def _line(self, row: Row) -> str:
        values = {column.key: row.get(column.key) for column in self._columns}
        # JSON has no infinity: the SR of a curve without distant vertices becomes null.
        finite = {k: None if isinstance(v, float) and not math.isfinite(v) else v for k, v in values.items()}
        return json.dumps(finite) + "\n"


class _Json(_JsonLines):
    """An array, complete as soon as its end is written."""

    _between = ""

    def _head(self) -> str:
        return "[\n"

    def _line(self, row: Row) -> str:
        line, self._between = self._between + super()._line(row), ","
        return line

    def _foot(self) -> str:
        return "]\n"


class _Markdown(TableWriter):
    def _head(self) -> str:
        rule = ["---:" if column.spec else ":---" for column in self._columns]
        return f"{CAPTION}\n\n{self._bars([column.header for column in self._columns])}{self._bars(rule)}"

    def _line(self, row: Row) -> str:
        return self._bars([re.sub(r"([\\|`*<])", r"\\\1", _rounded(row, column)) for column in self._columns])

    def _bars(self, cells: Sequence[str]) -> str:
        return f"| {' | '.join(cells)} |\n"


class _Latex(TableWriter):
    """The look of the paper's tables."""

    def _head(self) -> str:
        shape = "|" + "c|" * len(self._columns)
        return (
            f"% {CAPTION}\n\\begin{{tabular}}{{{shape}}}\n\\hline\n"
            f"{self._ampersands([column.latex for column in self._columns])}\\hline\n"
        )

    def _line(self, row: Row) -> str:
        return self._ampersands([_latex(_rounded(row, column)) for column in self._columns])

    def _foot(self) -> str:
        return "\\hline\n\\end{tabular}\n"

    def _ampersands(self, cells: Sequence[str]) -> str:
        return f"{' & '.join(cells)} \\\\\n"


FORMATS: dict[str, type[TableWriter]] = {
    "table": _Text,
    "tsv": _Tsv,
    "csv": _Csv,
    "jsonl": _JsonLines,
    "json": _Json,
    "md": _Markdown,
    "latex": _Latex,
}


def key_of(name: str) -> str:
    """Return the key of the column of this name: its key or its header, in any case. Raises `ValueError`."""
    try:
        return _KEYS[name.strip().casefold()]
    except KeyError:
        raise ValueError(f"unknown column {name!r}; the columns are: {', '.join(COLUMNS)}") from None


def writer(format: str, columns: Sequence[str], stream: TextIO) -> TableWriter:
    """Make the writer of a format in `FORMATS` for some `COLUMNS`. Raises `ValueError` for others."""
    if format not in FORMATS:
        raise ValueError(f"unknown table format {format!r}; the formats are: {', '.join(FORMATS)}")
    return FORMATS[format]([COLUMNS[key_of(name)] for name in columns], stream)


READ = "give a table that sono wrote as tsv, csv, jsonl or json"


def read(source: str) -> list[Row]:
    """Read a table in TSV, CSV or JSON, "-" for standard input; columns that are not ours are left out.

    Raises `FormatError` naming file and line.
    """
    from sono.formats import load  # here, since numpy would make --help wait

    name, text = load(source)
    return list(_of_json(name, text) if text.lstrip()[:1] in ("{", "[") else _of_cells(name, text))


def _of_json(name: str, text: str) -> Iterator[Row]:
    """Read an array of rows, or a row a line."""
    from sono.formats import FormatError

    if text.lstrip().startswith("["):
        rows = [(f"{name}: row {number}", row) for number, row in enumerate(_parsed(name, 1, text), 1)]
    else:
        lines = enumerate(text.splitlines(), 1)
        rows = [(f"{name}:{number}", _parsed(name, number, line)) for number, line in lines if line.strip()]
    for where, row in rows:
        if not isinstance(row, dict) or not isinstance(row.get("knot"), str):
            raise FormatError(f"{where}: is no row with a knot; {READ}")
        yield _row(where, row)


def _parsed(name: str, line: int, text: str) -> Any:
    """Read JSON that begins on this line."""
    from sono.formats import FormatError

    try:
        return json.loads(text)
    except (ValueError, RecursionError) as error:
        raise FormatError.at(name, line + getattr(error, "lineno", 1) - 1, f"is no JSON; {READ}") from error


def _of_cells(name: str, text: str) -> Iterator[Row]:
    """Read TSV or CSV."""
    from sono.formats import FormatError

    csv.field_size_limit(2**31 - 1)  # a cell may be longer than csv expects
    first, *_ = text.splitlines() or [""]
    lines = csv.reader(io.StringIO(text), delimiter="\t" if "\t" in first else ",")
    try:
        header = next(lines, [])
        if "knot" not in map(str.strip, header):
            raise FormatError.at(name, 1, f"has no column knot; {READ}")
        for cells in filter(None, lines):
            where = f"{name}:{lines.line_num}"
            if len(cells) != len(header):
                wrong = f"it has {len(cells)} cells for {len(header)} columns; a - stands for none"
                raise FormatError(f"{where}: does not fit the header: {wrong}")
            row = dict(zip(header, cells, strict=True))
            yield _row(where, {key: None if cell == "-" else cell for key, cell in row.items()})
    except csv.Error as error:
        raise FormatError.at(name, lines.line_num, f"is no row: {error}; {READ}") from error


def _row(where: str, values: Mapping[str, object]) -> Row:
    """Give the values of our columns. Raises `FormatError` for one of a wrong kind."""
    return {
        column.key: _value(where, column, value)
        for name, value in values.items()
        if (column := COLUMNS.get(_KEYS.get(name.strip().casefold(), "")))
    }


def _value(where: str, column: Column, value: object) -> Value:
    from sono.formats import FormatError

    if value is None or (not column.spec and isinstance(value, str)):
        return value
    if column.spec and isinstance(value, str | int | float):
        with suppress(ValueError, OverflowError):
            number = int(value) if column.spec == "d" else float(value)
            # Only the SR of a curve without distant vertices is infinite.
            finite = math.isfinite(number) or (column.key == "sr" and number > 0)
            if finite and (number == value or isinstance(value, str)):
                return number
    what = {int: "whole number", float: "number", str: "text"}[column.kind]
    shown = repr(value) if len(repr(value)) <= 30 else f"{repr(value)[:27]}..."
    raise FormatError(f"{where}: {shown} in the column {column.key} is no {what}")


def _rounded(row: Row, column: Column) -> str:
    value = row.get(column.key)
    return _exact(value) if value is None or isinstance(value, str) else format(value, column.spec)


def _exact(value: Value) -> str:
    if isinstance(value, str):
        # A row stays one line, and a file name that is not UTF-8 does not stop the table. JSON keeps both.
        return printable(re.sub(r"[\t\n\v\f\r]", " ", value).encode(errors="replace").decode())
    return "-" if value is None else str(value)


def printable(text: str, kept: str = "") -> str:
    """Escape what would move the cursor of a terminal, colour it or turn its text round, but for `kept`."""
    return _CONTROL.sub(lambda c: c[0] if c[0] in kept else c[0].encode("unicode_escape").decode(), text)


def _latex(text: str) -> str:
    commands = {"\\": r"\textbackslash{}", "~": r"\textasciitilde{}", "^": r"\textasciicircum{}"}
    return re.sub(r"[\\~^&%$#_{}]", lambda found: commands.get(found[0], "\\" + found[0]), text)
