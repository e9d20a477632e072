"""Geomview VECT (ASCII): counts first, then all the vertices.

    VECT
    polylines vertices colours
    vertices of each polyline, negative when it is closed
    colours of each polyline
    x y z of every vertex
    r g b a of every colour

A `#` starts a comment anywhere. Colours are read over. Source: the Geomview manual, section "VECT Files".
"""

from collections.abc import Iterable, Sequence

import numpy as np
from numpy.typing import NDArray

from sono.formats.vertices import Chain, FormatError, Raw, not_a_number, numbers, shown


def recognises(text: str) -> bool:
    """Tell whether the first word is a VECT header of any kind, also of a kind that `read` refuses."""
    words = (word for line in text.split("\n") for word in line.partition("#")[0].split())
    return next(words, "").endswith("VECT")


def read(text: str, name: str) -> list[Raw]:
    """Parse a whole file; lengths keep its unit. Raises `FormatError`."""
    words = _Words(text, name)
    words.header()
    polylines, vertices, colours = (
        words.count(f"the number of {things}") for things in ("polylines", "vertices", "colours")
    )
    if polylines < 1:
        raise words.error("the file holds no polylines; give at least one")
    sizes, lines = [], []
    for _ in range(polylines):
        sizes.append(words.integer("the vertex count of a polyline"))
        lines.append(words.line)
    words.agree(sum(map(abs, sizes)), vertices, "vertices")
    words.agree(sum(words.count("the colour count of a polyline") for _ in sizes), colours, "colours")
    chains = [words.chain(size, line) for size, line in zip(sizes, lines, strict=True)]
    words.numbers(4 * colours, "a colour")
    words.end()
    comments = [line.partition("#")[2].strip() for line in text.split("\n") if line.lstrip().startswith("#")]
    return [Raw(chains, comments=comments)]


def write(components: Iterable[NDArray[np.float64]], comments: Sequence[str]) -> str:
    """Give the whole file, without colours; every coordinate reads back to the same bits."""
    parts = list(components)
    return "\n".join(
        [
            "VECT",  # first, ahead of the comments: programs look for it there
            *(f"# {line}".rstrip() for comment in comments for line in comment.splitlines()),
            f"{len(parts)} {sum(map(len, parts))} 0",
            " ".join(str(-len(vertices)) for vertices in parts),
            " ".join("0" for _ in parts),
            *(f"{x!r} {y!r} {z!r}" for vertices in parts for x, y, z in vertices.tolist()),
            "",
        ]
    )


class _Words:
    """The words of a file, taken one after the other; each knows its line."""

    def __init__(self, text: str, name: str) -> None:
        self._name = name
        self._words: list[str] = []
        self._lines: list[int] = []
        self._next = 0
        for number, line in enumerate(text.split("\n"), 1):
            words = line.partition("#")[0].split()
            self._words += words
            self._lines += [number] * len(words)

    @property
    def line(self) -> int:
        """The line of the word taken last."""
        return self._lines[self._next - 1] if self._next else 1

    def error(self, message: str) -> FormatError:
        return FormatError.at(self._name, self.line, message)

    def _take(self, count: int, what: str) -> list[str]:
        taken = self._words[self._next : self._next + count]
        self._next += len(taken)
        if len(taken) < count:
            raise self.error(f"the file ends where {what} should follow; complete it or correct its counts")
        return taken

    def header(self) -> None:
        (word,) = self._take(1, "the header VECT")
        if word != "VECT":
            raise self.error(f"the header is {shown(word)}; only three-dimensional VECT is read")
        if self._words[self._next : self._next + 1] == ["BINARY"]:
            raise self.error("the file is binary VECT; save it as ASCII VECT")

    def integer(self, what: str) -> int:
        (word,) = self._take(1, what)
        try:
            return int(word)
        except ValueError:
            raise self.error(f"{shown(word)} is not {what}; give a whole number") from None

    def count(self, what: str) -> int:
        value = self.integer(what)
        if value < 0:
            raise self.error(f"{value} cannot be {what}; give zero or more")
        return value

    def agree(self, found: int, promised: int, things: str) -> None:
        if found != promised:
            raise self.error(
                f"the polylines have {found} {things}, the header says {promised}; correct the counts"
            )

    def numbers(self, count: int, what: str) -> list[float]:
        words = self._take(count, what)
        try:
            return numbers(words)
        except ValueError:
            bad = not_a_number(words) or 0
            self._next += bad + 1 - count
            raise self.error(f"{shown(words[bad])} is not a number; {what} should stand here") from None

    def chain(self, size: int, line: int) -> Chain:
        """Take the vertices of a polyline whose count stands on `line`."""
        if size == 0:
            raise FormatError.at(self._name, line, "a polyline has no vertices; give at least 3")
        first = self._next
        flat = self.numbers(3 * abs(size), "a vertex")
        rows = [flat[i : i + 3] for i in range(0, len(flat), 3)]
        return Chain(rows, self._lines[first : self._next : 3], closed=size < 0)

    def end(self) -> None:
        if self._next < len(self._words):
            self._next += 1
            raise self.error(f"{shown(self._words[self._next - 1])} is left over; correct the counts")
