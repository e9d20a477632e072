"""Molecular XYZ: a count, a comment, and so many rows of an element and x y z; then the next frame.

    3
    components="3" comment="a triangle"
    C 1.5 0 0
    C -0.5 1 0
    C -0.5 -1 0

Each frame is a curve, with the number of the frame as its key. Columns beyond x y z are read over, unless the
comment is that of extended XYZ: `Properties=id:I:1:species:S:1:pos:R:3` says where the coordinates are, and
where an index or a component. A periodic box, `Lattice="9 0 0 0 9 0 0 0 9" pbc="T T T"`, unwraps the chains
that it has wrapped. Without components the ends of a chain decide whether it is closed. What is
written here says how many vertices each component has. Source of the extension: the ASE and OVITO manuals.
"""

import re
from collections.abc import Iterable, Sequence
from dataclasses import replace
from functools import partial
from itertools import accumulate

import numpy as np
from numpy.typing import NDArray

from sono.formats.boxes import Box, rejoined
from sono.formats.columns import Parts
from sono.formats.doubts import gaps
from sono.formats.images import together
from sono.formats.layouts import Layout
from sono.formats.refused import attempted
from sono.formats.simulated import BY_NEAREST
from sono.formats.vertices import Chain, FormatError, Raw, alone, numbers, shown

_COUNT = re.compile(r"\s*\d+\s*(\n|$)")
_SIZES = re.compile(r'(?:^|\s)components="([\d ]*)"')
_COMMENT = re.compile(r'(?:^|\s)comment="((?:[^"\\]|\\.)*)"')
_PROPERTIES = re.compile(r'(?:^|\s)Properties="?([^\s"]+)', re.IGNORECASE)
_LATTICE = re.compile(r'(?:^|\s)Lattice="([^"]*)"', re.IGNORECASE)
_PERIODIC = re.compile(r'(?:^|\s)pbc="([^"]*)"', re.IGNORECASE)

BETWEEN = " | "
"""Stands between the comments, which share a line."""


def recognises(text: str) -> bool:
    """Tell whether the first line is a count alone."""
    return bool(_COUNT.match(text)) and "\n" in text.strip()


def read(text: str, name: str) -> list[Raw]:
    """Parse all frames; lengths keep the file's unit. Raises `FormatError`.

    A frame that is wrong spoils no other: its error is raised by its chains.
    """
    lines = text.rstrip().split("\n")
    starts = _starts(lines)
    found = [
        attempted(partial(_frame, lines[first:after], name, first + 1, str(key)), str(key))
        for key, (first, after) in enumerate(zip(starts, [*starts[1:], len(lines)], strict=True), 1)
    ]
    return found if len(found) > 1 else alone(found[0], "1")


def _starts(lines: Sequence[str]) -> list[int]:
    """Find where frames begin: at a number alone, since no row is one, or at the first line with anything."""
    starts = [next(place for place, line in enumerate(lines) if line.strip() or place == len(lines) - 1)]
    for place, line in enumerate(lines):
        if place > starts[-1] + 1 and line.strip().isdecimal():  # a comment may be a number, too
            starts.append(place)
    return starts


def _rows(lines: Sequence[str], name: str, first: int) -> Sequence[str]:
    """Give the rows of a frame, as many as it says. Raises `FormatError`."""
    count = _count(lines[0], name, first)
    there = len("\n".join(lines).rstrip().split("\n")) - 2
    if there < count:
        message = f"{count} rows should follow, there are {max(0, there)}; correct the count"
        raise FormatError.at(name, first, f"{message}, or complete the file")
    if there > count:
        number = next(number for number in range(2 + count, len(lines)) if lines[number].strip())
        _count(lines[number], name, first + number)
    return lines[2 : 2 + count]


def _count(line: str, name: str, number: int) -> int:
    if line.strip().isdecimal() and (count := int(line[:19])) > 0:
        return count
    raise FormatError.at(
        name, number, f"{shown(line.strip())} is no count of rows; each frame begins with one, then a comment"
    )


def _frame(lines: Sequence[str], name: str, first: int, key: str) -> Raw:
    """Read a frame whose count stands on the line `first`."""
    rows = _rows(lines, name, first)
    ours = _COMMENT.search(lines[1])
    comment = _COMMENT.sub("", lines[1])
    parts = Parts()
    layout: Layout | None = None
    for number, line in enumerate(rows, first + 2):
        try:
            layout = layout or _layout(comment, line.split())
            parts.add(layout, line.split(), number)
        except ValueError as error:
            raise FormatError.at(name, number, str(error)) from None
    chains, notes = parts.chains(None), list[str]()
    if box := _box(comment, name, first + 1):
        chains, notes = _whole(chains, box, name)
    if len(chains) == 1 and (sizes := _SIZES.search(comment)):
        chains = _apart(chains, [int(size[:18]) for size in sizes[1].split()], name, first + 1)
    else:
        notes += [_doubt(chain, place, name) for chain in chains for place in gaps(np.array(chain.rows))]
    said = re.sub(r"\\(.)", r"\1", ours[1]).split(BETWEEN) if ours else [comment.strip()]
    return Raw(chains, key, notes, [line for line in said if line])


def _box(comment: str, name: str, line: int) -> Box | None:
    """Give the periodic box, if the comment tells one."""
    lattice, marks = _LATTICE.search(comment), _PERIODIC.search(comment)
    periodic = np.array([mark[0] in "Tt1" for mark in marks[1].split()] if marks else [True] * 3)
    if not lattice or not periodic.any():
        return None
    try:
        edges = np.array(numbers(lattice[1].split())).reshape(3, 3)
        if not edges.any():  # as it is written where there is no box
            return None
        if not np.isfinite(edges).all() or np.linalg.det(edges) == 0 or len(periodic) != 3:
            raise ValueError
    except ValueError:
        cure = 'give nine numbers, and pbc="T T T" or which of the three are not periodic'
        raise FormatError.at(name, line, f"{shown(lattice[1])} is no periodic box; {cure}") from None
    return Box(np.zeros(3), edges, periodic)


def _whole(chains: Sequence[Chain], box: Box, name: str) -> tuple[list[Chain], list[str]]:
    """Put together the chains that the box has wrapped, and tell of it."""
    rows = [np.array(chain.rows) for chain in chains]
    moved = [rejoined(box, part, name, chain.lines) for part, chain in zip(rows, chains, strict=True)]
    told = any(a is not b for a, b in zip(rows, moved, strict=True))
    whole = [replace(chain, rows=part) for chain, part in zip(chains, moved, strict=True)]
    whole, notes = together(box, whole)
    return whole, [f"{name}: {note}" for note in ([BY_NEAREST] if told else []) + notes]


def _doubt(chain: Chain, place: int, name: str) -> str:
    """Tell of an edge that hardly is one."""
    cure = 'the comment can say `components="60 60"` or `Properties=molecule:I:1:pos:R:3`'
    return (
        f"{name}:{chain.lines[place]}: a far longer edge follows; if another component begins there, {cure}"
    )


def _layout(comment: str, cells: Sequence[str]) -> Layout:
    """Tell where in a row the coordinates are. Raises `ValueError`."""
    if properties := _PROPERTIES.search(comment):
        return _of_properties(properties[1].split(":"))
    if len(cells) < 3:
        raise ValueError(f"{len(cells)} columns; give an element and x y z")
    return Layout(len(cells), (0, 1, 2) if len(cells) == 3 else (1, 2, 3))


def _of_properties(words: Sequence[str]) -> Layout:
    wrong = "the comment's Properties are not name:type:columns, again and again, with pos:R:3 among them"
    names: list[str] = []
    try:
        for name, _, columns in zip(words[::3], words[1::3], words[2::3], strict=True):
            vector = "xyz" if name.lower() in ("pos", "position") and int(columns) == 3 else ""
            names += vector or [name] * min(int(columns), 100)
    except ValueError:
        raise ValueError(f"{wrong}; correct them") from None
    layout = Layout.of_names(names)
    if layout is None:
        raise ValueError(f"{wrong}; add those")
    return layout


def _apart(chains: list[Chain], sizes: Sequence[int], name: str, line: int) -> list[Chain]:
    """Cut a frame into the components that its comment tells, which are closed."""
    (chain,) = chains
    if sum(sizes) != len(chain.rows) or 0 in sizes:
        message = f"the comment's components have {sum(sizes)} rows, the count says {len(chain.rows)}"
        raise FormatError.at(name, line, f"{message}; correct one of them")
    ends = [*accumulate(sizes)]
    return [
        Chain(chain.rows[end - size : end], chain.lines[end - size : end])
        for size, end in zip(sizes, ends, strict=True)
    ]


def write(components: Iterable[NDArray[np.float64]], comments: Sequence[str]) -> str:
    """Give the whole file, a frame; every coordinate reads back to the same bits."""
    parts = list(components)
    said = BETWEEN.join(line.strip() for comment in comments for line in comment.splitlines())
    quoted = re.sub(r'(["\\])', r"\\\1", said)
    rows = "".join(f"C {x!r} {y!r} {z!r}\n" for part in parts for x, y, z in part.tolist())
    sizes = " ".join(str(len(part)) for part in parts)
    return f'{sum(map(len, parts))}\ncomponents="{sizes}" comment="{quoted}"\n{rows}'
