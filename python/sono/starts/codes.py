"""Codes of diagrams: PD, Dowker-Thistlethwaite and Gauss codes, as people write them.

A PD code ("pd:X[1,5,2,4] X[3,1,4,6] X[5,3,6,2]") has for each crossing its four edges, counter-clockwise from
the incoming lower one; so it tells the mirror images apart. Labels are any whole numbers, each at two places.
P[1,2] joins two edges, Loop[1] is a circle without crossings, and so is the empty code [].

A DT code ("dt:4 6 2") has the even number of the crossing that is passed first, third, fifth, ...; a minus
means that odd and even change places as upper and lower. A Gauss code ("gauss:1 -2 3 -1 2 -3") has
the crossings in the order in which they are passed, with a minus where that is below. Neither tells a diagram
from its mirror image. That is taken whose first crossing is right-handed, as KnotInfo's DT codes to 12
crossings mean it; in a connected sum the first one of each summand. With the signs of crossings, + for
right-handed ones, a Gauss code tells: "gauss:O1+U2+O3+U1+O2+U3+", over and under.

>>> len(diagram("pd", "[(1,5,2,4), (3,1,4,6), (5,3,6,2)]").far), len(diagram("dt", "[[6,8],[2,4]]").begins)
(12, 2)
"""

import re

from sono.starts.diagrams import Diagram, check_twice, from_codes
from sono.starts.embedding import embedded

KINDS = {"pd": "PD", "dt": "DT", "gauss": "Gauss"}
"""Codes by what stands before the colon, as they are called."""

_EXAMPLES = {
    "pd": "[(1,5,2,4), (3,1,4,6), (5,3,6,2)]",
    "dt": "4 6 2, or [[6,8],[2,4]] for a link",
    "gauss": "1 -2 3 -1 2 -3, or 1 -2 | 2 -1 for a link",
}

_GROUP = re.compile(r"([A-Za-z]*)_?[\[({]([^][(){}]*)[\])}]")
_NUMBER = r"[-+−]?\d{1,9}"
_NUMBERS = re.compile(rf"[\s,]*(?:{_NUMBER}(?:[\s,]+|$))*")
_PASSED = re.compile(r"([OU])(\d{1,9})([-+−]?)", re.IGNORECASE)


def diagram(kind: str, text: str) -> Diagram:
    """Return the diagram of a code of a kind, "pd", "dt" or "gauss".

    Raises ValueError for what is no such code, and for a code without a diagram in the plane.
    """
    read = {"pd": _pd, "dt": _dt, "gauss": _gauss}[kind]
    text = " ".join(text.split())
    try:
        return read(text)
    except ValueError as error:
        shown = text if len(text) < 80 else text[:75] + " ..."
        raise ValueError(f"{KINDS[kind]} code {shown!r}: {error}") from error


def _pd(text: str) -> Diagram:
    # Knot Atlas writes X1425 where all labels have one digit.
    text = re.sub(r"X_?\{?(\d)(\d)(\d)(\d)\}?(?!\d)", r"X[\1,\2,\3,\4]", text)
    text = re.sub(r"PD\s*[\[(]", "[", text, flags=re.IGNORECASE)
    circles = int(re.fullmatch(r"[\[({]\s*[\])}]", text) is not None)
    if not re.search(r"[\[({]", text):
        text = " ".join(f"({group})" for group in re.split(r"[;|]|(?<=\d)\s+(?=\S*,)", text))
    rest = _GROUP.sub("", text)
    crossings: list[list[int]] = []
    joined: list[list[int]] = []
    for letters, group in _GROUP.findall(text):
        numbers = _integers(group, "pd")
        letters = letters.casefold()
        if (letters, len(numbers)) == ("p", 2):
            joined.append(numbers)
        elif (letters, len(numbers)) == ("loop", 1):
            circles += 1
        elif letters in ("", "x", "xp", "xm") and len(numbers) % 4 == 0:
            crossings += [numbers[k : k + 4] for k in range(0, len(numbers), 4)]
        else:
            raise ValueError(f"{letters.upper()}[{group}] is no crossing, which has four edges")
    if not (crossings or joined or circles) or re.search(r"[^][(){},;\s]", rest):
        raise _malformed("pd")
    circles += _join(crossings, joined)
    return from_codes([(a, b, c, d) for a, b, c, d in crossings], circles)


def _join(crossings: list[list[int]], pairs: list[list[int]]) -> int:
    """Join edges in pairs, as P[1,2] says, and return how many circles that closes. Raises ValueError."""
    places = [edge for edges in (*crossings, *pairs) for edge in edges]
    check_twice({edge: [edge] * places.count(edge) for pair in pairs for edge in pair})
    circles = 0
    while pairs:
        one, other = pairs.pop()
        circles += one == other
        for edges in (*crossings, *pairs):
            edges[:] = [one if edge == other else edge for edge in edges]
    return circles


def _dt(text: str) -> Diagram:
    # KnotScape's letters, as SnapPy takes them: crossings, components, odd numbers of each, even numbers.
    if letters := re.fullmatch(r"\[?([a-zA-Z]{4,})\]?", text):
        crossings, many, *more = (
            ord(letter.lower()) - 96 if letter.islower() else 64 - ord(letter) for letter in letters[1]
        )
        sizes, evens = more[: max(many, 0)], [2 * number for number in more[max(many, 0) :]]
        if min([many, *sizes]) < 0 or not crossings == sum(sizes) == len(evens):
            raise ValueError("the first letter counts crossings, the second components, the next their sizes")
        words = [evens[sum(sizes[:k]) : sum(sizes[: k + 1])] for k in range(many)]
    else:
        words = _lists(text, "dt")
    evens = [even for word in words for even in word]
    if sorted(map(abs, evens)) != list(range(2, 2 * len(evens) + 1, 2)):
        raise ValueError(f"it has {len(evens)} numbers, so these are 2 to {2 * len(evens)}, even, each once")
    passed = {}
    for crossing, even in enumerate(evens):
        passed[2 * crossing + 1] = crossing + 1, even > 0
        passed[abs(even)] = crossing + 1, even < 0
    labels = iter(range(1, 2 * len(evens) + 1))
    return embedded([[passed[next(labels)] for _ in range(2 * len(word))] for word in words])


def _gauss(text: str) -> Diagram:
    if not _PASSED.search(text):
        words = _lists(text, "gauss")
        if any(words) and all(number > 0 for word in words for number in word):
            raise ValueError(f"no minus tells what is below; put one where it is, as in {_EXAMPLES['gauss']}")
        return embedded([[(abs(number), number > 0) for number in word] for word in words])
    if re.search(r"\d", _PASSED.sub("", text)):
        raise _malformed("gauss")
    signs: dict[int, set[str]] = {}

    def noted(passed: re.Match[str]) -> str:
        over, crossing, sign = passed[1] in "Oo", int(passed[2]), passed[3]
        signs.setdefault(crossing, set()).add(sign)
        return f" {crossing if over else -crossing} "

    words = _lists(_PASSED.sub(noted, text), "gauss")
    if any(len(given) > 1 for given in signs.values()) or len({"" in given for given in signs.values()}) > 1:
        raise ValueError(
            "a crossing has no sign, or two; give its sign, + or -, at both places, or none at all"
        )
    told = {crossing: 1 if "+" in given else -1 for crossing, given in signs.items() if "" not in given}
    return embedded([[(abs(n), n > 0) for n in word] for word in words], told or None)


def _lists(text: str, kind: str) -> list[list[int]]:
    """Return the numbers of each component: a list in brackets, or what | or ; divides."""
    if not re.search(r"[\[({]", text):
        parts = re.split(r"[|;]", text)
    else:
        parts = [group for _, group in _GROUP.findall(text)]
        if re.search(r"[^][(){},;\s]", _GROUP.sub("", text)):
            raise _malformed(kind)
        if len(parts) == 1:
            parts = re.split(r"[|;]", parts[0])
    words = [_integers(part, kind) for part in parts]
    if not any(words):
        raise _malformed(kind)
    return words


def _integers(text: str, kind: str) -> list[int]:
    if not _NUMBERS.fullmatch(text):
        raise _malformed(kind)
    return [int(number.replace("−", "-")) for number in re.findall(_NUMBER, text)]


def _malformed(kind: str) -> ValueError:
    return ValueError(f"not readable; write it like {_EXAMPLES[kind]}")
