"""How people write the names of knots and links, and what a wrong name might have meant.

>>> [str(part) for part in summands("!3_1 # mirror image of (m3_1 ♯ T(2,5))")]
['m3_1', '3_1', 'mT(2,5)']
>>> [spelled(name) for name in ("3.1", "4₁", "K11n34", "4_{1}^{2}", "5.2.1", "5:2:1", "8:1:20", "L5a1{ 1 }")]
['3_1', '4_1', '11n_34', '4^2_1', '5^2_1', '5^2_1', '8_20', 'L5a1{1}']
"""

import difflib
import re
import unicodedata
from collections.abc import Sequence
from dataclasses import dataclass, field

_SIGNS = str.maketrans("−‐–♯", "---#", "$")
"""Signs as they are typeset."""

_MIRRORED = re.compile(
    r"(?:mirror(?: image)?(?: of)?(?=[\s(])|m|!|\*)(?P<after>.*)|(?P<before>.*?)\^?[!*]",
    re.IGNORECASE | re.DOTALL,
)

_KIND = r"(?<=[a-z])((?<!s)['’]?s)?[\s_-]+(knot|link|rings)$"
"""What kind of thing a name in words says it is."""

_WORDS = {
    **{"trivial": "unknot", "trefoil": "3_1", "righthandedtrefoil": "3_1", "lefthandedtrefoil": "m3_1"},
    **{"figureeight": "4_1", "figure8": "4_1", "cinquefoil": "5_1", "threetwist": "5_2", "stevedore": "6_1"},
    **{"overhand": "3_1", "pentafoil": "5_1", "septafoil": "7_1", "endless": "7_4", "carrickmat": "8_18"},
    **{"granny": "3_1#3_1", "square": "3_1#m3_1", "reef": "3_1#m3_1"},
    **{"conway": "11n_34", "kinoshitaterasaka": "11n_42", "kt": "11n_42"},
}
"""Names in words, without spaces and hyphens."""

_SPELLINGS = [
    (r"([_^])\{([an]|[an]?\d+)\}", r"\1\2"),  # as in TeX
    (r"^Knot\[(\d+),(\d+)\]$", r"\1_\2"),  # KnotTheory
    (r"^Knot\[(\d+),([AN])\w*,(\d+)\]$", r"\1\2_\3"),
    (r"^Link\[(\d+),([AN])\w*,(\d+)\]$", r"L\1\2\3"),
    (r"(?<!\d)0+(?=\d)", ""),
    (r"^K?(\d+)[_^:]?([an])[_:]?(\d+)$", r"\1\2_\3"),  # Knot Atlas, Thistlethwaite's table
    (r"^0a_1$", "0_1"),
    (r"^K(\d+_\d+)$", r"\1"),
    (r"^(\d+)_(\d+)\^(\d+)$", r"\1^\3_\2"),
    (r"^(\d+)[.:^](\d+)[.:_](\d+)$", r"\1^\2_\3"),  # crossings, components, number
    (r"^(\d+)\^1_(\d+)$", r"\1_\2"),
    (r"^(\d+)\.(\d+)$", r"\1_\2"),
]

MOST = {
    **{"11a_": 367, "11n_": 185, "12a_": 1288, "12n_": 888, "13a_": 4878, "13n_": 5110},
    **{"L10a": 174, "L10n": 113, "L11a": 548, "L11n": 459},
}
"""How many knots of 11 to 13 crossings and links of 10 and 11 there are, by how their names begin."""

KNOWN = (
    "3_1 to 10_165, L2a1 to L9n28, 2^2_1 to 9^4_1, Hopf, chain3, T(p,q), P(p,q,r), C(p,q), 5/2, braid words, "
    "codes pd:, dt: and gauss:, and with sono[knotinfo] knots to 13n_5110 and links to L11n459"
)


@dataclass(frozen=True)
class Part:
    """A summand: its name, without what marks it as a mirror image, whether it is one, and what was typed."""

    name: str
    mirrored: bool
    typed: str = field(default="", compare=False)

    def __str__(self) -> str:
        """Give it as the tables do, with an m for a mirror image."""
        return "m" * self.mirrored + self.name


def summands(name: str, mirrored: bool = False) -> list[Part]:
    """Return the parts of a sum, or of its mirror image; a name that is no sum has one."""
    texts: list[str] = []
    for text in name.translate(_SIGNS).replace("\\#", "#").split("#"):
        if texts and texts[-1].count("(") > texts[-1].count(")"):
            texts[-1] += "#" + text
        else:
            texts.append(text)
    if len(texts) > 1:
        return [part for text in texts for part in summands(text, mirrored)]
    typed = text = texts[0].strip()
    while found := _MIRRORED.fullmatch(text):
        text, mirrored = (found["after"] or found["before"] or "").strip(), not mirrored
        if re.fullmatch(r"\([^#]*\)", text):
            text = text[1:-1].strip()
    if inner := re.fullmatch(r"\((.*#.*)\)", text, re.DOTALL):
        return summands(inner[1], mirrored)
    if word := _WORDS.get(_word(text)):
        return summands(word, mirrored)
    return [Part(text, mirrored, typed)]


def _word(name: str) -> str:
    """Return a name in words as `_WORDS` has it."""
    return re.sub(r"[\s_-]", "", re.sub(_KIND, "", name, flags=re.IGNORECASE)).casefold()


def spelled(name: str) -> str:
    """Return the name as the tables here have it, if it is one of theirs in another spelling."""
    name = re.sub(_KIND, "", name.translate(_SIGNS).strip(), flags=re.IGNORECASE)
    if word := _WORDS.get(_word(name)):
        return word
    plain = re.sub("[₀-₉]+", lambda digits: "_" + digits[0], name)
    plain = re.sub("[⁰¹²³⁴-⁹]+", lambda digits: "^" + digits[0], plain)
    plain = re.sub(r"\s", "", unicodedata.normalize("NFKC", plain))
    for pattern, spelling in _SPELLINGS:
        plain = re.sub(pattern, spelling, plain, flags=re.IGNORECASE)
    return plain


def unknown(part: Part, names: Sequence[str]) -> ValueError:
    """Return the error for a part whose name is none of these names, with what it might have meant."""
    name, m = spelled(part.name), "m" * part.mirrored
    if name == "10_166":
        hint = "Rolfsen's 10_166 is 10_165, as his 10_161 is his 10_162"
    elif large := re.fullmatch(r"(\d+)_(\d+)", name):
        either = f"{m}{large[1]}a_{large[2]} or {m}{large[1]}n_{large[2]}"
        hint = _series(name, names, m) or f"did you mean {either}?"
    elif re.fullmatch(r"(1[4-9]|[2-9]\d)[an]_\d+|L1[2-9][an]\d+", name, re.IGNORECASE):
        hint = (
            "the tables end with knots of 13 crossings and links of 11; give it as a code, pd:... or dt:..."
        )
    elif re.fullmatch(r"L\d+[an]\d+\{.*\}", name, re.IGNORECASE):
        hint = "braces have a 0 or 1 for each component after the first: L5a1{1}, L6a4{0,1}"
    else:
        hint = _series(name, names, m) or _near(name, names, m)
    return ValueError(f"unknown knot {part.typed or str(part)!r}: {hint}")


def _series(name: str, names: Sequence[str], m: str) -> str | None:
    """Say which names begin like this one, with an m for mirror images."""
    begin = re.sub(r"\d+$", "", name)
    many = MOST.get(begin) or sum(
        re.fullmatch(re.escape(begin) + r"\d+", known) is not None for known in names
    )
    if begin == name or not many:
        return None
    begin = m + begin
    return f"did you mean one of {begin}1 to {begin}{many}?" if many > 1 else f"there is only {begin + '1'!r}"


def _near(name: str, names: Sequence[str], m: str) -> str:
    """Return the name with the same numbers that is spelled nearest, or else what names there are."""
    if name[:1].isdigit():  # a letter there may have been read for a number
        name = name.translate(str.maketrans("lIoO", "1100"))
    digits = re.sub(r"\D", "", name)
    alike = {known.casefold(): known for known in (*names, *_WORDS) if re.sub(r"\D", "", known) == digits}
    near = difflib.get_close_matches(name.casefold(), alike, n=1, cutoff=0.6 if digits else 0.8)
    return (
        f"did you mean {m + alike[near[0]]!r}?"
        if near
        else f"known are {KNOWN}; `sono start --list` has what is built in"
    )
