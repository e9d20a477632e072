"""Which columns of a row are the coordinates: told by a header, or by what the first row holds."""

import csv
import re
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Self

from sono.formats.vertices import not_a_number, numbers, shown

LABELS = frozenset(
    ("chain", "component", "loop", "mol", "molecule", "molecule_identifier", "polymer", "ring", "strand")
)
"""Names of columns that tell components apart."""

INDICES = frozenset(("atom", "bead", "i", "id", "index", "nr", "particle_identifier", "serial", "vertex"))
"""Names of columns that must go up; so does a first column without a name, as data frames have it."""

FRAMES = frozenset(("frame", "model", "snapshot", "timestep"))
"""Names of columns that tell frames apart, which are not curves of one link."""

HEADER = "a header line such as `index x y z` or `component,x,y,z` names the columns"

_UNIT = re.compile(r"\s*(\[[^\]]*\]|\([^)]*\)|/\w+)|(?<=[xyzXYZ])_(nm|um|mm|cm|A|angstrom|px)\b")
_AXIS = re.compile(
    r"(?:(?:pos|position|coord|r)[ _.:]?)?([xyz])(?:[ _.-]?(?:pos|position|coord|coordinate))?"
)
_AXIS_NUMBER = re.compile(r"(?:points|position|pos|coords?)[:_ .]([012])")
_DECIMAL_COMMA = re.compile(r"[+-]?\d*,\d+([eE][+-]?\d+)?")
_WORD = re.compile(r"[A-Za-z_][\w'*+ -]*")


def cells_of(data: str) -> list[str]:
    """Split a row at its marks, or else at spaces, which fields may have that stand between marks.

    A comma beside another one leaves an empty cell, so that a missing number is noticed.
    """
    mark = next((mark for mark in ";,\t" if mark in data), "")
    cells = [cell.strip() for cell in _quoted(data, mark)] if mark else data.split()
    if (
        mark != ";"
        and len(cells) < 4
        and any(not_a_number(cell.split()[1:]) is None for cell in _spaced(cells))
    ):
        cells = re.split(r"\s*,\s*|\s+", data)  # C 1.0, 2.0, 3.0 has marks of both kinds
    cells = [cell.strip("\"'") for cell in cells]
    return cells[:-1] if len(cells) > 3 and not cells[-1] else cells  # a mark ends the row, too


def _spaced(cells: Sequence[str]) -> list[str]:
    return [cell for cell in cells if len(cell.split()) > 1]


def _quoted(data: str, mark: str) -> list[str]:
    """Split at a mark, but not within quotes."""
    try:
        return (
            next(csv.reader([data], delimiter=mark, skipinitialspace=True))
            if '"' in data
            else data.split(mark)
        )
    except csv.Error:  # a cell too long for the module
        return data.split(mark)


@dataclass(frozen=True)
class Layout:
    """Which columns of a row, of so many, are read: the coordinates, the index and the labels."""

    count: int
    xyz: tuple[int, int, int]
    index: int | None = None
    labels: tuple[int, ...] = ()
    word: int | None = None
    by_one: bool = False

    @classmethod
    def of_header(cls, line: str) -> Self | None:
        """Take a line for a header if it names x, y and z. Raises `ValueError` for frames."""
        return cls.of_names(cells_of(_UNIT.sub("", line)))

    @classmethod
    def of_comment(cls, comments: Sequence[str], cells: Sequence[str]) -> Self | None:
        """Take the last comment for a header if it names as many columns as there are, more than x y z."""
        layout = cls.of_header(comments[-1]) if comments and len(cells) > 3 else None
        return layout if layout and layout.count == len(cells) else None

    @classmethod
    def of_names(cls, columns: Sequence[str]) -> Self | None:
        """Find the columns by their names, likewise; None without x, y and z."""
        names = [name.lower() for name in columns]
        axes = [_axis(name) for name in names]
        if not {"x", "y", "z"} <= set(axes):
            return None
        if frame := next((name for name in names if name in FRAMES), None):
            raise ValueError(f"the column {shown(frame)} tells frames apart; give a file for each frame")
        if len(axes) - axes.count(None) > 3:
            raise ValueError("the header names x, y or z twice; name other columns otherwise")
        labels = tuple(column for column, name in enumerate(names) if name in LABELS)
        counts = (column for column, name in enumerate(names) if name in INDICES or not (column or name))
        x, y, z = map(axes.index, "xyz")
        return cls(len(names), (x, y, z), next(counts, None), labels)

    @classmethod
    def of_row(cls, cells: Sequence[str]) -> Self | None:
        """Tell what the columns before the last three are, if that can be told."""
        before = range(len(cells) - 3)
        words = [column for column in before if _WORD.fullmatch(cells[column])]
        counts = [column for column in before if column not in words]
        if len(cells) < 3 or len(words) > 1 or len(counts) > 1 or not_a_number(cells[-3:]) is not None:
            return None
        index, word = (next(iter(columns), None) for columns in (counts, words))
        n = len(cells)
        return cls(n, (n - 3, n - 2, n - 1), index, word=word, by_one=True)

    def part(self, cells: Sequence[str]) -> tuple[str, ...]:
        """Give the component that a row says it is of. Raises `ValueError` for too few columns, or more."""
        if len(cells) != self.count:
            raise ValueError(f"{len(cells)} columns, where the first row has {self.count}; give as many")
        return tuple(cells[column] for column in self.labels)

    def coordinates(self, cells: Sequence[str]) -> list[float]:
        """Read a row. Raises `ValueError` that says what is wrong."""
        try:
            return numbers(cells[column] for column in self.xyz)
        except ValueError:
            bad = next(column for column in self.xyz if not_a_number([cells[column]]) is not None)
            if _DECIMAL_COMMA.fullmatch(cells[bad]):
                raise ValueError(comma(cells[bad])) from None
            raise ValueError(f"{shown(cells[bad])} is not a number; give x, y and z in each row") from None


def _axis(name: str) -> str | None:
    if axis := _AXIS.fullmatch(name):
        return axis[1]
    number = _AXIS_NUMBER.fullmatch(name)
    return "xyz"[int(number[1])] if number else None


def comma(cell: str) -> str:
    """Say that a cell has a decimal comma."""
    return f"{shown(cell)} has a decimal comma; write a point in its place"


def wrong(data: str) -> str:
    """Say what is wrong with a row of a file without a header."""
    if data.startswith("<"):
        return "of XML only ideal knots, with Coeff in them, are read; give rows of three numbers x y z"
    words = data.split(";") if ";" in data else data.split()
    if len(words) > 2 and (cell := next(filter(_DECIMAL_COMMA.fullmatch, map(str.strip, words)), None)):
        return comma(cell)
    cells = cells_of(data)
    bad = not_a_number(cells)
    if len(cells) == 3 and bad is not None:
        return f"{shown(cells[bad])} is not a number; give three numbers x y z, and start other lines with #"
    if len(cells) == 3:
        return "this row is not written as those before it; put the same signs between all numbers"
    more = f"; {HEADER}" if len(cells) > 3 and bad is None else ", and start other lines with #"
    return f"{len(cells)} columns; give three numbers x y z{more}"
