"""Rows with more columns than x y z: an index, an element, or whatever a header line names.

    index x y z              A header names the columns, here with the units that many write, and others are
    1  1.5  0  0             read over. Names may be quoted, and the cells stand between spaces, tabs, commas
    2  -0.5 1  0             or semicolons. A column called chain, component, molecule, ring or strand tells
                             the components apart; the one called id or index must go up.

Without a header the last three columns are the coordinates, and what is before them must be an index that
goes up by one, or a word such as an element. An index may start again after a blank line only, which here too
begins a new component.
"""

import re
from collections.abc import Sequence
from dataclasses import dataclass, field
from itertools import groupby
from typing import Self

from sono.formats.vertices import Chain, FormatError, Raw, not_a_number, numbers, shown

LABELS = frozenset(
    ("chain", "component", "loop", "mol", "molecule", "molecule_identifier", "polymer", "ring", "strand")
)
"""Names of columns that tell components apart."""

INDICES = frozenset(("", "atom", "bead", "i", "id", "index", "nr", "particle_identifier", "serial", "vertex"))
"""Names of columns that must go up; a table of data frames leaves that name out."""

FRAMES = frozenset(("frame", "model", "snapshot", "timestep"))
"""Names of columns that tell frames apart, which are not curves of one link."""

HEADER = "a header line such as `index x y z` or `component,x,y,z` names the columns"

_UNIT = re.compile(r"\s*(\[[^\]]*\]|\([^)]*\)|/\w+)")
_AXIS = re.compile(r"(?:(?:pos|position|coord|r)[ _.:]?)?([xyz])(?:[ _.]?(?:pos|position|coord|coordinate))?")
_AXIS_NUMBER = re.compile(r"(?:points|position|pos|coords?)[:_ .]([012])")
_DECIMAL_COMMA = re.compile(r"[+-]?\d*,\d+([eE][+-]?\d+)?")
_WORD = re.compile(r"[A-Za-z_][\w'*+-]*")


def cells_of(data: str) -> list[str]:
    """Split a row; a comma beside another one leaves an empty cell, so that a missing number is noticed."""
    if ";" in data:
        cells = data.split(";")
    elif "," in data:
        cells = re.split(r"\s*,\s*|\s+", data)
    else:
        cells = [cell.strip() for cell in data.split("\t")]
        cells = data.split() if any(" " in cell for cell in cells) else cells
    return [cell.strip().strip("\"'") for cell in cells]


@dataclass(frozen=True)
class Layout:
    """Which columns of a row, of so many, are read: the coordinates, the index and the label."""

    count: int
    xyz: tuple[int, int, int]
    index: int | None = None
    label: int | None = None
    word: int | None = None
    by_one: bool = False

    @classmethod
    def of_header(cls, line: str) -> Self | None:
        """Take a line for a header if it names x, y and z. Raises `ValueError` for frames."""
        return cls.of_names(cells_of(_UNIT.sub("", line)))

    @classmethod
    def of_names(cls, columns: Sequence[str]) -> Self | None:
        """Find the columns by their names, likewise; None without x, y and z."""
        names = [name.lower() for name in columns]
        if frame := next((name for name in names if name in FRAMES), None):
            raise ValueError(f"the column {shown(frame)} tells frames apart; give a file for each frame")
        axes = [_axis(name) for name in names]
        if not {"x", "y", "z"} <= set(axes):
            return None
        if len(axes) - axes.count(None) > 3:
            raise ValueError("the header names x, y or z twice; name other columns otherwise")
        first = {name: column for column, name in reversed([*enumerate(names)])}
        label, index = (
            next((first[name] for name in names if name in known), None) for known in (LABELS, INDICES)
        )
        return cls(len(names), (axes.index("x"), axes.index("y"), axes.index("z")), index, label)

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

    def part(self, cells: Sequence[str]) -> str:
        """Give the component that a row says it is of. Raises `ValueError` for too few columns, or more."""
        if len(cells) != self.count:
            raise ValueError(f"{len(cells)} columns, where the first row has {self.count}; give as many")
        return "" if self.label is None else cells[self.label]

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


@dataclass
class Rows:
    """The rows of one component as they come."""

    layout: Layout
    rows: list[list[float]] = field(default_factory=list)
    lines: list[int] = field(default_factory=list)
    words: list[str] = field(default_factory=list)
    last: float | None = None

    def add(self, cells: Sequence[str], line: int) -> None:
        """Take a row. Raises `ValueError` that says what is wrong."""
        self.rows.append(self.layout.coordinates(cells))
        self.lines.append(line)
        if self.layout.index is not None:
            self._count(cells[self.layout.index])
        if self.layout.word is not None:
            self.words.append(cells[self.layout.word])

    def _count(self, cell: str) -> None:
        try:
            (index,) = numbers([cell])
        except ValueError:
            raise ValueError(f"{shown(cell)} is no index; give a whole number in its column") from None
        before, self.last = self.last, index
        if not index.is_integer():
            raise ValueError(f"{self.layout.count} columns, and {shown(cell)} is no index; {HEADER}")
        if before is not None and not (index == before + 1 if self.layout.by_one else index > before):
            step = "goes on" if self.layout.by_one else "must go up, but goes on"
            cure = (
                "sort the rows, put a blank line between two components, or name the columns in a header line"
            )
            raise ValueError(f"the index {step} from {before:.0f} to {index:.0f}; {cure}")


class Parts:
    """The components of a curve, as their rows come."""

    def __init__(self) -> None:
        """Begin."""
        self._parts: dict[tuple[int, str], Rows] = {}
        self._block = 0

    def separate(self) -> None:
        """Have the next row begin a component."""
        self._block += 1

    def add(self, layout: Layout, cells: Sequence[str], line: int) -> None:
        """Take a row. Raises `ValueError` that says what is wrong."""
        self._parts.setdefault((self._block, layout.part(cells)), Rows(layout)).add(cells, line)

    def chains(self, closed: bool | None) -> list[Chain]:
        """Give the components."""
        return [Chain(part.rows, part.lines, closed) for part in self._parts.values()]

    def refuse_runs(self, name: str) -> None:
        """Refuse words that change where elements would not. Raises `FormatError`."""
        for part in self._parts.values():
            _refuse_runs(name, part)


def read(text: str, name: str) -> list[Raw]:
    """Parse a whole file; lengths keep its unit. Raises `FormatError`."""
    layout: Layout | None = None
    parts = Parts()
    comments = []
    for number, line in enumerate(text.split("\n"), 1):
        data, mark, comment = line.partition("#")
        if not (data := data.strip()):
            comments += [comment.strip()] if mark else []
            if not mark:
                parts.separate()
            continue
        try:
            if layout is None and (layout := Layout.of_header(data)):
                continue
            cells = cells_of(data)
            layout = layout or Layout.of_row(cells)
            if not layout:
                raise ValueError(wrong(data))
            parts.add(layout, cells, number)
        except ValueError as error:
            raise FormatError.at(name, number, str(error)) from None
    parts.refuse_runs(name)
    if not (chains := parts.chains(True)):
        raise FormatError.at(name, 1, "there are no rows under the header; give numbers x y z")
    return [Raw(chains, comments=comments)]


def comma(cell: str) -> str:
    """Say that a cell has a decimal comma."""
    return f"{shown(cell)} has a decimal comma; write a point in its place"


def wrong(data: str) -> str:
    """Say what is wrong with a row of a file without a header."""
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


def _refuse_runs(name: str, part: Rows) -> None:
    """Refuse words that change where elements would not: they may be the names of components."""
    runs = [(word, len(list(same))) for word, same in groupby(part.words)]
    if len(runs) > 1 and len({word for word, _ in runs}) == len(runs) and min(n for _, n in runs) > 2:
        line = part.lines[runs[0][1]]
        change = f"the first column changes from {shown(runs[0][0])} to {shown(runs[1][0])}"
        cure = "a header line says what it is: `component x y z` or `element x y z`"
        raise FormatError.at(name, line, f"{change}, which may be another component; {cure}")
