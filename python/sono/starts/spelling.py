"""How people write the names of knots and links, and what a wrong name might have meant.

>>> [spelled(name) for name in ("3.1", "4₁", "K11n34", "4_{1}^{2}", "5.2.1", "5:2:1", "8:1:20", "L5a1{ 1 }")]
['3_1', '4_1', '11n_34', '4^2_1', '5^2_1', '5^2_1', '8_20', 'L5a1{1}']
"""

import difflib
import re
import unicodedata
from collections.abc import Sequence

_SPELLINGS = [
    (r"([_^])\{(\d+)\}", r"\1\2"),  # as in TeX
    (r"^K?(\d+)([an])_?(\d+)$", r"\1\2_\3"),  # Knot Atlas, Thistlethwaite's table
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


def spelled(name: str) -> str:
    """Return the name as the tables here have it, if it is one of theirs in another spelling."""
    plain = re.sub("[₀-₉]+", lambda digits: "_" + digits[0], name.strip())
    plain = re.sub("[⁰¹²³⁴-⁹]+", lambda digits: "^" + digits[0], plain)
    plain = re.sub(r"\s", "", unicodedata.normalize("NFKC", plain))
    for pattern, spelling in _SPELLINGS:
        plain = re.sub(pattern, spelling, plain, flags=re.IGNORECASE)
    return plain


def unknown(name: str, names: Sequence[str]) -> ValueError:
    """Return the error for a name that none of these names is, with what it might have meant."""
    if name == "10_166":
        hint = "Rolfsen's 10_166 is 10_165, as his 10_161 is his 10_162"
    elif large := re.fullmatch(r"(\d+)_(\d+)", name):
        hint = _series(name, names) or f"did you mean {large[1]}a_{large[2]} or {large[1]}n_{large[2]}?"
    elif re.fullmatch(r"(1[4-9]|[2-9]\d)[an]_\d+|L1[2-9][an]\d+", name, re.IGNORECASE):
        hint = (
            "the tables end with knots of 13 crossings and links of 11; give it as a code, pd:... or dt:..."
        )
    elif re.fullmatch(r"L\d+[an]\d+\{.*\}", name, re.IGNORECASE):
        hint = "braces have a 0 or 1 for each component after the first: L5a1{1}, L6a4{0,1}"
    else:
        hint = _series(name, names) or _near(name, names)
    return ValueError(f"unknown knot {name!r}: {hint}")


def _series(name: str, names: Sequence[str]) -> str | None:
    """Say which names begin like this one."""
    begin = re.sub(r"\d+$", "", name)
    many = MOST.get(begin) or sum(
        re.fullmatch(re.escape(begin) + r"\d+", known) is not None for known in names
    )
    if begin == name or not many:
        return None
    return f"did you mean one of {begin}1 to {begin}{many}?" if many > 1 else f"did you mean {begin + '1'!r}?"


def _near(name: str, names: Sequence[str]) -> str:
    """Return the name that is spelled nearest, or else what names there are."""
    near = difflib.get_close_matches(name, names, n=1)
    return f"did you mean {near[0]!r}?" if near else f"known are {KNOWN}"
