"""Vertices in brackets as programs print them, which is no JSON: a row each, or lists as of Mathematica.

    [1.5, 0.0, 0.0]         {{1.5, 0., 0.}, {-0.5, 1.*^-3, 0.},
    [-0.5, 1.0, 0.0]         {-0.5, -1., 0.}}
    ...

The brackets may be of any kind, with commas or spaces between numbers. A list of lists, or a blank line,
separates components; a `#` starts a comment.
"""

import re

from sono.formats.vertices import Chain, FormatError, Raw, not_a_number, numbers, shown

_ROW = r"[-+]?\.?\d[^\[\](){}]*"
_FIRST = re.compile(
    rf"(?:\s|#.*\n)*(?:\[{_ROW}\][,;]?\s*(?:#.*)?(?:\n|$)|\[\[\s*[-+.\de]+\s+[-+.\d]|[({{][\s({{]*{_ROW}[)}}])"
)
_VERTEX = re.compile(r"[\[({]([^\[\](){}]*)[\])}]")
_APART = re.compile(r"[\])}][^\[({]*[\[({]|\n[ \t]*\n")
_PRECISION = re.compile(r"`[\d.]*")


def recognises(text: str) -> bool:
    """Tell whether numbers in brackets come first, and not as JSON has them."""
    return _FIRST.match(text) is not None


def read(text: str, name: str) -> list[Raw]:
    """Parse a whole file; lengths keep its unit. Raises `FormatError`."""
    text = re.sub("#.*", ",", text)  # so that its line is not blank, which would separate
    parts: list[tuple[list[list[float]], list[int]]] = [([], [])]
    place, line = 0, 1
    for match in _VERTEX.finditer(text):
        between = text[place : match.start()]
        _refuse_more(between, name, line)
        line += text.count("\n", place, match.start())
        if place and _APART.search(between):
            parts.append(([], []))
        parts[-1][0].append(_vertex(match[1], name, line))
        parts[-1][1].append(line)
        line += match[0].count("\n")
        place = match.end()
    _refuse_more(text[place:], name, line)
    if any(text.count(one) != text.count(other) for one, other in ("[]", "()", "{}")):
        raise FormatError.at(name, line, "brackets are opened that are not closed; complete the file")
    return [Raw([Chain(rows, lines, said=False) for rows, lines in parts])]


def _vertex(content: str, name: str, line: int) -> list[float]:
    cells = re.split(r"\s*[,;]\s*|\s+", _PRECISION.sub("", content).replace("*^", "e").strip())
    if len(cells) != 3 or not_a_number(cells) is not None:
        raise FormatError.at(
            name, line, f"{shown(content)} is no vertex; give three numbers x, y, z in brackets"
        )
    return numbers(cells)


def _refuse_more(between: str, name: str, line: int) -> None:
    if more := between.strip(" \t\n,;[](){}"):
        line += between.count("\n", 0, between.index(more))
        raise FormatError.at(
            name, line, f"{shown(more)} is in no brackets; give three numbers in them a vertex"
        )
