"""Wavefront OBJ: `v x y z` are vertices, `l 1 2 3 1` joins them by their numbers, which may count backwards.

Pieces of lines that meet are joined, so that a curve may be given edge by edge. One that comes back to its
first vertex is closed, any other is open; without lines all vertices are one chain, whose ends decide.
Source: the Advanced Visualizer manual, appendix B1, "Object Files".
"""

import re
from collections.abc import Iterable, Iterator, Sequence
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from sono.formats.vertices import Chain, FormatError, Raw, not_a_number, numbers, shown

_FIRST = re.compile(r"(?:[^\S\n]*(?:#[^\n]*)?\n)*[^\S\n]*([a-z]+)\s")
_VERTICES = re.compile(r"^[^\S\n]*v\s", re.MULTILINE)

WORDS = frozenset(("v", "vn", "vt", "vp", "l", "f", "p", "o", "g", "s", "mtllib", "usemtl"))
"""What lines begin with."""


def recognises(text: str) -> bool:
    """Tell whether the first word is one of OBJ's, and a line of vertices follows."""
    first = _FIRST.match(text)
    return first is not None and first[1] in WORDS and _VERTICES.search(text) is not None


def read(text: str, name: str) -> list[Raw]:
    """Parse a whole file; lengths keep its unit. Raises `FormatError`."""
    rows: list[list[float]] = []
    lines: list[int] = []
    net = _Net()
    faces = False
    begun = ""
    for number, line in enumerate(text.split("\n"), 1):
        line = begun + line.partition("#")[0].rstrip()
        begun = line[:-1] + " " if line.endswith("\\") else ""  # it goes on
        word, *cells = ("" if begun else line).split() or [""]
        try:
            if word == "v":
                rows.append(_vertex(cells))
                lines.append(number)
            elif word == "l":
                net.add([_index(cell, len(rows)) for cell in cells])
            elif word in ("f", "curv"):
                faces = True
            elif word and not word.isalpha():
                raise ValueError(
                    f"{shown(word)} begins no line of OBJ; give v x y z, and l with their numbers"
                )
        except ValueError as error:
            raise FormatError.at(name, number, str(error)) from None
    if not rows or (faces and not net.ways):
        what = "a surface and no line" if rows else "no vertices"
        raise FormatError.at(name, 1, f"the file holds {what}; give v x y z, and l with their numbers")
    chains = [
        Chain([rows[i] for i in path], [lines[i] for i in path], closed) for path, closed in net.paths()
    ] or [Chain(rows, lines, None)]
    comments = [line.partition("#")[2].strip() for line in text.split("\n") if line.lstrip().startswith("#")]
    return [Raw(chains, comments=comments)]


def _vertex(cells: Sequence[str]) -> list[float]:
    if len(cells) < 3:
        raise ValueError(f"a vertex of {len(cells)} numbers; give v x y z")
    try:
        return numbers(cells[:3])
    except ValueError:
        bad = not_a_number(cells[:3]) or 0
        raise ValueError(f"{shown(cells[bad])} is not a number; give v x y z") from None


def _index(cell: str, count: int) -> int:
    """Give the vertex, from 0, that a line names: 1 is the first, -1 the one before."""
    try:
        index = int(cell.partition("/")[0])
    except ValueError:
        raise ValueError(f"{shown(cell)} is no vertex; give l with the numbers of vertices") from None
    if not 1 <= abs(index) <= count:
        raise ValueError(f"there is no vertex {shown(cell)} among the {count} so far; correct the number")
    return index - 1 if index > 0 else count + index


class _Net:
    """Vertices and their neighbours, two at most."""

    def __init__(self) -> None:
        self.ways: dict[int, list[int]] = {}

    def add(self, path: Sequence[int]) -> None:
        """Join the vertices of a line. Raises `ValueError`."""
        if len(path) < 2:
            raise ValueError(f"a line of {len(path)} vertices; give l with two numbers at least")
        for start, end in pairwise(path):
            if start == end:
                raise ValueError(f"the vertex {start + 1} is joined to itself; leave out one of the two")
            for one, other in ((start, end), (end, start)):
                ways = self.ways.setdefault(one, [])
                if other not in ways:
                    ways.append(other)
                if len(ways) > 2:
                    raise ValueError(
                        f"the vertex {one + 1} joins three edges; a curve does not branch: part it"
                    )

    def paths(self) -> Iterator[tuple[list[int], bool]]:
        """Give each curve as its vertices in order, and whether it is closed: open ones from their ends."""
        seen: set[int] = set()
        ends = [vertex for vertex, ways in self.ways.items() if len(ways) == 1]
        for first in (*ends, *self.ways):
            path, here = list[int](), first
            while here not in seen:
                seen.add(here)
                path.append(here)
                here = next((way for way in self.ways[here] if way not in seen), here)
            if path:
                yield path, len(self.ways[first]) == 2


def write(components: Iterable[NDArray[np.float64]], comments: Sequence[str]) -> str:
    """Give the whole file, a closed line a component; every coordinate reads back to the same bits."""
    head = "".join(f"# {line}".rstrip() + "\n" for comment in comments for line in comment.splitlines())
    count, blocks = 0, []
    for part in components:
        blocks.append("".join(f"v {x!r} {y!r} {z!r}\n" for x, y, z in part.tolist()))
        line = " ".join(map(str, [*range(count + 1, count + len(part) + 1), count + 1]))
        blocks.append(f"l {line}\n")
        count += len(part)
    return head + "".join(blocks)
