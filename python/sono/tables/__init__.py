"""Rows of results as a table: aligned text, TSV, CSV, JSON lines, a JSON array, Markdown or LaTeX.

Each row is written and flushed as soon as it is finished, so that a later failure loses nothing. Text,
Markdown and LaTeX are for readers: they round, and head their columns with the paper's symbols, L_p. TSV, CSV
and JSON are for the next program: they keep every digit, and call a column by its key, l_p. Wherever a column
is named, either will do. May import `formats`, `printing`, and for what is
published `starts`.
"""

from collections.abc import Sequence
from typing import TextIO

from sono.tables.base import CAPTION, TableWriter
from sono.tables.columns import COLUMNS, DEFAULT, SHAPE, Row, Value, key_of
from sono.tables.delimited import Csv, Tsv
from sono.tables.jsons import Json, JsonLines
from sono.tables.latex import Latex
from sono.tables.markdown import Markdown
from sono.tables.reading import parse, read, recognises
from sono.tables.text import Text

__all__ = [
    "CAPTION",
    "COLUMNS",
    "DEFAULT",
    "FORMATS",
    "SHAPE",
    "Row",
    "TableWriter",
    "Value",
    "key_of",
    "parse",
    "read",
    "recognises",
    "writer",
]

FORMATS: dict[str, type[TableWriter]] = {
    "table": Text,
    "tsv": Tsv,
    "csv": Csv,
    "jsonl": JsonLines,
    "json": Json,
    "md": Markdown,
    "latex": Latex,
}


def writer(format: str, columns: Sequence[str], stream: TextIO) -> TableWriter:
    """Make the writer of a format in `FORMATS` for some `COLUMNS`. Raises `ValueError` for others."""
    if format not in FORMATS:
        raise ValueError(f"unknown table format {format!r}; the formats are: {', '.join(FORMATS)}")
    return FORMATS[format]([COLUMNS[key_of(name)] for name in columns], stream)
