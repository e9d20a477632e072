"""Libraries of codes: a PD, DT or Gauss code a line, each a curve that is drawn when it is wanted.

    # knots to four crossings
    3_1: X[1,5,2,4] X[3,1,4,6] X[5,3,6,2]
    dt: 4 6 8 2

A `#`, first or after a space, starts a comment. A label may come before a code, with a colon or a tab
between: it is the key, else the line's number is. What kind of code it is the suffix tells, `.pd`, `.dt` or
`.gauss`, or a word before it, "dt: 4 6 2"; brackets in fours need neither, they are PD codes. The conventions
are those of `starts.codes`.
"""

import re
from collections import Counter
from collections.abc import Sequence
from functools import cached_property
from pathlib import PurePath

from sono.formats.vertices import Chain, FormatError, Raw, alone

_KIND = r"(?P<kind>pd|dt|gauss)\s*:"
_LINE = re.compile(rf"(?:(?P<label>[^:\t]*?)\s*[:\t]\s*)?{_KIND}(?P<code>.*)", re.IGNORECASE)
_LABELLED = re.compile(r"(?:(?P<label>[^:\t]*?)\s*[:\t])?(?P<code>[^:]*)")

_NUMBER = r"\s*\d+\s*"
_CROSSING = rf"[XY]?[pm]?[\[({{]{_NUMBER}(?:,{_NUMBER}){{3}}[\])}}]"
_PD = re.compile(rf"(?:[^:\t]*[:\t])?\s*(?:PD)?[\[({{\s]*(?:{_CROSSING}|\[\]$)")
"""How a line with a PD code begins."""


class Drawn(Sequence[Chain]):
    """The components of a code, drawn when they are looked at, since a library may have thousands."""

    def __init__(self, file: str, line: int, code: str) -> None:
        """Keep where the code stands, and the code with its kind before it."""
        self._file, self._line, self._code = file, line, code

    def __len__(self) -> int:
        """Count the components. Raises `FormatError`."""
        return len(self._chains)

    def __getitem__(self, index: int | slice) -> "Chain | Sequence[Chain]":  # type: ignore[override]
        """Give a component, or some. Raises `FormatError`."""
        return self._chains[index]

    @cached_property
    def _chains(self) -> list[Chain]:
        from sono import starts  # here, since no other format needs them

        try:
            curve = starts.start(self._code)
        except ValueError as error:
            raise FormatError.at(self._file, self._line, str(error)) from error
        return [Chain(component, [self._line] * len(component)) for component in curve]


def recognises(text: str) -> bool:
    """Tell whether the first line that is no comment is a code that is named so, or a PD code."""
    first = next((line for line in map(_stripped, text.split("\n")) if line), "")
    return bool(_LINE.fullmatch(first) or _PD.match(first))


def read(text: str, name: str) -> list[Raw]:
    """Parse a whole file into the curves of its codes. Raises `FormatError` if it has none."""
    suffix = PurePath(name.lower().removesuffix(".gz")).suffix[1:]
    kind = suffix if suffix in ("pd", "dt", "gauss") else "pd"
    lines = [(number, line) for number, line in enumerate(map(_stripped, text.split("\n")), 1) if line]
    if not lines:
        raise FormatError.at(name, 1, "the file holds no codes; give one a line")
    codes = [_split(line, kind) for _, line in lines]
    times = Counter(label for label, _ in codes)
    found = [
        Raw(Drawn(name, number, code), _key(label, number, times[label]), comments=[label] * bool(label))
        for (number, _), (label, code) in zip(lines, codes, strict=True)
    ]
    return found if len(found) > 1 else alone(found[0], found[0].key)


def _split(line: str, kind: str) -> tuple[str, str]:
    """Give a line's label, or an empty one, and its code with the kind before it."""
    if found := _LINE.fullmatch(line):
        kind = found["kind"].lower()
    else:
        found = _LABELLED.fullmatch(line)
    if not found:
        return "", f"{kind}:{line}"
    return (found["label"] or "").strip(), f"{kind}:{found['code'].strip()}"


def _key(label: str, number: int, times: int) -> str:
    """Return what tells a curve from the others of its file: its label if no other has it."""
    if not label:
        return str(number)
    return label if times == 1 else f"{label}.{number}"


def _stripped(line: str) -> str:
    return re.split(r"(?:^|\s)#", line, maxsplit=1)[0].strip()  # not that of a sum, as in 3_1#4_1
