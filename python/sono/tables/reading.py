"""Tables that sono wrote, read again."""

import csv
import io
import json
import math
import re
from collections.abc import Iterator, Mapping
from contextlib import suppress
from typing import Any

from sono.tables.columns import Column, Row, Value, column_of

READ = "give a table that sono wrote as tsv, csv, jsonl or json"


def read(source: str) -> list[Row]:
    """Read a table in TSV, CSV or JSON, "-" for standard input; columns that are not ours are left out.

    Raises `FormatError` naming file and line.
    """
    from sono.formats import load  # here, since numpy would make --help wait

    return parse(*load(source))


def parse(name: str, data: bytes) -> list[Row]:
    """Read a table from the bytes of a file, likewise."""
    from sono.formats import decoded

    text = decoded(name, data)
    return list(_of_json(name, text) if text.lstrip()[:1] in ("{", "[") else _of_cells(name, text))


def recognises(data: bytes) -> bool:
    """Tell whether the bytes of a file begin like a table, and not like a curve."""
    text = data.decode(errors="replace").lstrip("\ufeff \r\n")
    if text[:1] in ("{", "["):
        return '"knot"' in text.split("}")[0]
    return "knot" in map(str.strip, re.split("[\t,]", (text.splitlines() or [""])[0]))


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
                wrong = f"it has {len(cells)} cells for {len(header)} columns; a - or nothing stands for none"
                raise FormatError(f"{where}: does not fit the header: {wrong}")
            row = dict(zip(header, cells, strict=True))
            yield _row(where, {key: None if cell in ("-", "") else cell for key, cell in row.items()})
    except csv.Error as error:
        raise FormatError.at(name, lines.line_num, f"is no row: {error}; {READ}") from error


def _row(where: str, values: Mapping[str, object]) -> Row:
    """Give the values of our columns. Raises `FormatError` for one of a wrong kind."""
    return {
        column.key: _value(where, column, value)
        for name, value in values.items()
        if (column := column_of(name))
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
