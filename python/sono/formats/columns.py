"""Rows with more columns than x y z: an index, an element, or whatever a header line names.

    index x y z              A header names the columns, here with the units that many write, and others are
    1  1.5  0  0             read over. Names may be quoted, and the cells stand between spaces, tabs, commas
    2  -0.5 1  0             or semicolons. A column called chain, component, molecule, ring or strand tells
                             the components apart; the one called id or index must go up.

Without a header, even one behind a #, the last three columns are the coordinates, and what is before them
must be an index that goes up by one, or a word such as an element. An index may start again after a blank
line only, which here too begins a new component.
"""

from collections.abc import Sequence
from dataclasses import dataclass, field
from itertools import groupby

from sono.formats.layouts import HEADER, Layout, cells_of, wrong
from sono.formats.vertices import Chain, FormatError, Raw, numbers, shown


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
        self._parts: dict[tuple[int, *tuple[str, ...]], Rows] = {}
        self._block = 0

    def separate(self) -> None:
        """Have the next row begin a component."""
        self._block += 1

    def add(self, layout: Layout, cells: Sequence[str], line: int) -> None:
        """Take a row. Raises `ValueError` that says what is wrong."""
        self._parts.setdefault((self._block, *layout.part(cells)), Rows(layout)).add(cells, line)

    def chains(self, closed: bool | None) -> list[Chain]:
        """Give the components."""
        return [Chain(part.rows, part.lines, closed, said=False) for part in self._parts.values()]

    def refuse_runs(self, name: str) -> None:
        """Refuse words that change where elements would not. Raises `FormatError`."""
        for part in self._parts.values():
            _refuse_runs(name, part)


def read(text: str, name: str) -> list[Raw]:
    """Parse a whole file; lengths keep its unit. Raises `FormatError`."""
    layout: Layout | None = None
    header = ""
    parts = Parts()
    comments = list[str]()
    for number, line in enumerate(text.split("\n"), 1):
        data, mark, comment = line.partition("#")
        if not (data := data.strip()):
            comments += [comment.strip()] if mark else []
            if not mark:
                parts.separate()
            continue
        try:
            if layout is None and (layout := Layout.of_header(data)):
                header = data
                continue
            if data == header:  # again, as where tables are joined
                parts.separate()
                continue
            cells = cells_of(data)
            layout = layout or Layout.of_comment(comments, cells) or Layout.of_row(cells)
            if not layout:
                raise ValueError(wrong(data))
            parts.add(layout, cells, number)
        except ValueError as error:
            raise FormatError.at(name, number, str(error)) from None
    parts.refuse_runs(name)
    if not (chains := parts.chains(True)):
        raise FormatError.at(name, 1, "there are no rows under the header; give numbers x y z")
    return [Raw(chains, comments=comments)]


def _refuse_runs(name: str, part: Rows) -> None:
    """Refuse words that change where elements would not: they may be the names of components."""
    runs = [(word, len(list(same))) for word, same in groupby(part.words)]
    if len(runs) > 1 and len({word for word, _ in runs}) == len(runs) and min(n for _, n in runs) > 2:
        line = part.lines[runs[0][1]]
        change = f"the first column changes from {shown(runs[0][0])} to {shown(runs[1][0])}"
        cure = "a header line says what it is: `component x y z` or `element x y z`"
        raise FormatError.at(name, line, f"{change}, which may be another component; {cure}")
