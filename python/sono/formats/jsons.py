"""JSON: a curve with all that is known of it, as `data/curve.schema.json` says; written a vertex a line.

Plain lists are read as well: of vertices, or of components, alone or as the `components` or the `vertices` of
an object. Other members are read over.
"""

import json
import math
import re
from collections.abc import Iterable, Sequence
from dataclasses import asdict
from typing import Any

import numpy as np
from numpy.typing import NDArray

from sono._core import CurveError
from sono.curve import measure
from sono.formats import brackets, ropefile
from sono.formats.vertices import Chain, FormatError, Raw

FORMAT, VERSION = "sono curve", 1

UNIT = "rope radius"

_VERTEX = re.compile(r"\[[^\[\]{}\"]*\]")
"""A list that holds no other."""


def recognises(text: str) -> bool:
    """Tell whether the first sign opens a list or an object."""
    return text.lstrip()[:1] in ("[", "{")


def read(text: str, name: str) -> list[Raw]:
    """Parse a whole file; lengths keep its unit. Raises `FormatError`."""
    try:
        document = json.loads(text)
    except json.JSONDecodeError as error:
        if brackets.recognises(text):
            return brackets.read(text, name)
        raise FormatError.at(name, error.lineno, f"is no JSON: {error.msg}; complete or correct it") from None
    except (ValueError, RecursionError):
        raise FormatError.at(
            name, 1, "is no JSON of a curve: too many digits, or lists; correct it"
        ) from None
    members = document if isinstance(document, dict) else {"components": document}
    if members.get("format", FORMAT) == FORMAT and members.get("version", VERSION) != VERSION:
        raise FormatError.at(name, 1, f"the version is not {VERSION}; a newer sono may read this file")
    found = members.get("components", members.get("vertices"))
    parts = [_rows(part, name) for part in _parts(found, name)]
    comments = members.get("comments")
    said = [line for line in comments if isinstance(line, str)] if isinstance(comments, list) else []
    return [Raw(_placed(parts, text), comments=said)]


def _parts(found: Any, name: str) -> list[Any]:
    """Give the components, of a list of them or of vertices."""
    cure = "give [[x, y, z], ...], or a list of such lists as `components`"
    if not isinstance(found, list) or not found or not isinstance(found[0], list):
        raise FormatError.at(name, 1, f"there is no list of vertices; {cure}")
    return found if found[0] and isinstance(found[0][0], list) else [found]


def _rows(part: Any, name: str) -> list[list[float]]:
    rows = part if isinstance(part, list) else [part]
    for row in rows:
        numeric = isinstance(row, list) and all(type(cell) in (int, float) for cell in row)
        if not numeric or len(row) != 3:
            shown = json.dumps(row)
            shown = shown if len(shown) <= 30 else shown[:27] + "..."
            raise FormatError.at(name, 1, f"{shown} is no vertex; give [x, y, z], three numbers, for each")
    try:
        return [[float(cell) for cell in row] for row in rows]
    except OverflowError:
        raise FormatError.at(name, 1, "a coordinate is not finite; give a number in its place") from None


def _placed(parts: Sequence[list[list[float]]], text: str) -> list[Chain]:
    """Tell on which lines the vertices stand, if no other lists of numbers are among them."""
    total = sum(map(len, parts))
    lines, line, place = list[int](), 1, 0
    for match in _VERTEX.finditer(text):
        line += text.count("\n", place, match.start())
        place = match.start()
        lines.append(line)
    lines = lines if len(lines) == total else [1] * total
    chains = []
    for part in parts:
        chains.append(Chain(np.array(part).reshape(-1, 3), lines[: len(part)]))
        lines = lines[len(part) :]
    return chains


def write(components: Iterable[NDArray[np.float64]], comments: Sequence[str]) -> str:
    """Give the whole file; every coordinate reads back to the same bits."""
    parts = list(components)
    lines = [line for comment in comments for line in comment.splitlines()]
    rows = [",\n".join(f"   {json.dumps(vertex)}" for vertex in part.tolist()) for part in parts]
    body = ",\n".join(f"  [\n{row}\n  ]" for row in rows)
    members = {"format": FORMAT, "version": VERSION, **_known(parts, lines), "comments": lines}
    head = "".join(f" {json.dumps(key)}: {json.dumps(value)},\n" for key, value in members.items())
    return f'{{\n{head} "components": [\n{body}\n ]\n}}\n'


def _known(parts: list[NDArray[np.float64]], comments: Sequence[str]) -> dict[str, Any]:
    """Give what the header of a rope says, and what its vertices measure."""
    header = ropefile.parse("".join(f"# {line}\n" for line in comments))
    if not header.figures:
        return {}
    made = header.made or header.searched
    provenance = {"status": header.status, "origin": header.origin} | (asdict(made) if made else {})
    try:
        found = measure(parts).to_dict()
    except CurveError:
        found = {}
    measures = {key: value if math.isfinite(value or 0) else None for key, value in found.items()}
    return {"name": header.name, "unit": UNIT, "measures": measures, "provenance": provenance}
