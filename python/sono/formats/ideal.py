"""Fourier series of knots and links in the files of B. Gilbert's "Database of Ideal Knots".

    <AB Id="3:1:1" Conway="3" L="16.371637" D=" 1.000000">
      <Coeff I="  1" A=" 0.374139, 0.000000, 0.000000" B=" 0.000000, 0.373928, 0.000000" />
      ...
    </AB>

The row I has the vectors A and B of A cos(It) + B sin(It), but of A[0] half is taken. A link holds a <STRING>
or <Component> for each component. Every knot of a file is a curve with its Id as the key. L is its length and
D the diameter of the rope, so that the ropelength over the radius is 2 L/D; nothing is scaled. How finely the
series is sampled is said in `sampling`. Source: the Knot Atlas, "Ideal knots".
"""

import re
from bisect import bisect
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from functools import partial

import numpy as np

from sono.formats.fourier import Floats, Series, polygons
from sono.formats.refused import attempted
from sono.formats.vertices import Chain, FormatError, Raw, numbers, shown

HIGHEST = 4096
"""The highest harmonic that is read."""

_TAG = re.compile(
    r"""<(?:!--.*?-->|\?.*?\?>|(?P<end>/?)(?P<name>\w+)(?P<more>(?:[^<>"']|"[^<>"]*"|'[^<>']*')*)>)?""",
    re.DOTALL,
)
_PAIR = re.compile(r"""(\w+)\s*=\s*(?:"([^"]*)"|'([^']*)'|([^\s"'/]+))""")


def recognises(text: str) -> bool:
    """Tell whether the text is one of tags, with coefficients among them."""
    tags = re.match(r"\s*<", text)
    return tags is not None and re.search(r"<Coeff\b", text[:20_000], re.IGNORECASE) is not None


def read(text: str, name: str) -> list[Raw]:
    """Parse a whole file; lengths keep its unit. Raises `FormatError`."""
    knots: list[_Knot] = []
    knot: _Knot | None = None
    for tag in _tags(text, name):
        if tag.ends:
            knot = None if knot and tag.name == knot.tag.name else knot
        elif "id" in tag.values:
            if knot:
                raise tag.error(f"the {knot.tag.name} on line {knot.tag.line} is still open; end it first")
            knots.append(knot := _Knot(tag))
        elif tag.name == "coeff":
            if not knot:
                raise tag.error("this Coeff is in no knot with an Id; put one around it")
            knot.add(tag)
        elif knot:
            knot.parts.append((tag, {}))
    if knot:
        raise knot.tag.error(f"this {knot.tag.name} is not ended; complete the file")
    if not knots:
        raise FormatError.at(name, 1, "the file holds no knot with an Id; give one such as <AB Id=...>")
    keys = _keys(knots)
    return [attempted(partial(knot.curve, key), key) for key, knot in zip(keys, knots, strict=True)]


@dataclass(frozen=True)
class _Tag:
    """A tag, with the line that it begins on; its name and those of its values in lower case."""

    file: str
    line: int
    name: str
    ends: bool
    values: Mapping[str, str]

    def error(self, message: str) -> FormatError:
        return FormatError.at(self.file, self.line, message)

    def vector(self, name: str) -> list[float]:
        """Read one of its values, three numbers."""
        value = self.values.get(name, "")
        try:
            x, y, z = numbers(value.replace(",", " ").split())
        except ValueError:
            raise self.error(
                f"{name.upper()} is {shown(value)}, but should be three numbers: x,y,z"
            ) from None
        return [x, y, z]

    def harmonic(self) -> int:
        value = self.values.get("i", "").strip()
        if not (value.isascii() and value.isdigit() and len(value) < 6 and int(value) <= HIGHEST):
            raise self.error(f"I is {shown(value)}, but should be a whole number up to {HIGHEST}")
        return int(value)

    def number(self, name: str) -> float | None:
        """Read one of its values, a number above zero, if there is one."""
        try:
            (value,) = numbers([self.values.get(name, "")])
        except ValueError:
            return None
        return value if 0 < value < np.inf else None


def _tags(text: str, name: str) -> Iterator[_Tag]:
    ends = [match.start() for match in re.finditer("\n", text)]
    for match in _TAG.finditer(text):
        line = bisect(ends, match.start()) + 1
        if match[0] == "<":
            raise FormatError.at(
                name, line, "a tag begins here that is not ended by >, or has an odd quote; correct it"
            )
        if match["name"]:
            pairs = {key.lower(): "".join(values) for key, *values in _PAIR.findall(match["more"])}
            yield _Tag(name, line, match["name"].lower(), bool(match["end"]), pairs)


@dataclass
class _Knot:
    """A knot or link as it is read: its tag, and of each component the tag and the harmonics, (2, 3)."""

    tag: _Tag
    parts: list[tuple[_Tag, dict[int, Floats]]] = field(default_factory=list)

    def add(self, tag: _Tag) -> None:
        if not self.parts:
            self.parts.append((self.tag, {}))
        harmonics, i = self.parts[-1][1], tag.harmonic()
        if i in harmonics:
            raise tag.error(f"the harmonic {i} comes twice; leave one out")
        harmonics[i] = np.array([tag.vector("a"), tag.vector("b")])

    def curve(self, key: str) -> Raw:
        """Sample it. Raises `FormatError`."""
        for tag, harmonics in self.parts or [(self.tag, {})]:
            if not harmonics.keys() - {0}:
                raise tag.error(f"this {tag.name} has no Coeff above 0; a closed curve needs one")
        try:
            curves = polygons([_series(harmonics) for _, harmonics in self.parts])
        except ValueError as error:
            raise self.tag.error(f"{error}; correct the series of this {self.tag.name}") from None
        lines = [tag.line for tag, _ in self.parts]
        chains = [Chain(rows, [line] * len(rows)) for rows, line in zip(curves, lines, strict=True)]
        notes = [f"{self.tag.file}:{self.tag.line}: {note}" for note in self._notes(len(curves[0]))]
        return Raw(chains, key, notes, [self.tag.values["id"].strip()])

    def _notes(self, n: int) -> list[str]:
        lengths = [tag.number("l") for tag, _ in self.parts]
        lengths = [self.tag.number("l")] if None in lengths else lengths
        diameter = self.tag.number("d")
        notes = [f"the Fourier series was sampled at {n} points for each component"]
        if diameter is not None and None not in lengths:
            length = sum(filter(None, lengths))
            over = f"{2 * length / diameter:.6g} over the radius"
            notes.append(f"the file says L = {length:.6g} at the diameter {diameter:.6g}: {over}")
        return notes


def _series(harmonics: Mapping[int, Floats]) -> Series:
    table = np.zeros((2, max(harmonics) + 1, 3))
    for i, pair in harmonics.items():
        table[:, i] = pair
    table[0, 0] /= 2
    return table[0], table[1]


def _keys(knots: list[_Knot]) -> list[str]:
    """Name knots by their Ids, and further ones of the same Id with a number; one alone needs none."""
    if len(knots) == 1:
        return [""]
    ids = [knot.tag.values["id"].strip() for knot in knots]
    before = [ids[:i].count(key) for i, key in enumerate(ids)]
    return [f"{key}.{count + 1}" if count else key for key, count in zip(ids, before, strict=True)]
