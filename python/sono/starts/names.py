"""Starting conformations by name: the loose knots and links that a tightening begins with.

Prime knots have the names of KnotInfo: Rolfsen's up to 10 crossings, but with 10_83 and 10_86 as in the
corrected editions of his book (older files have them the other way round), and 10_161 to 10_165 without the
Perko pair: his 10_161 and 10_162 are one knot, so his 10_163 to 10_166 are 10_162 to 10_165 here. "m8_20" is
the mirror image of 8_20. With the extra sono[knotinfo] there are also all knots to 13 crossings, "11a_1" to
"13n_5110", and all links to 11. A knot has the handedness of its braid word in KnotInfo, where a positive
generator is a right-handed crossing, so 3_1 is the right-handed trefoil.

>>> len(start("3_1")), len(start("m8_18")), len(start("10_165", variant=3)), len(start("chain3"))
(1, 1, 1, 3)
>>> len(start("P(-2,3,7)")), len(start("5/2")), len(start("dt:4 6 2")), len(start("5.2.1", variant=-1))
(1, 1, 1, 2)
"""

import re
from collections.abc import Callable, Iterable, Sequence
from contextlib import suppress

from sono.curve import Components
from sono.starts import codes
from sono.starts.braids import braid
from sono.starts.bundles import bundle
from sono.starts.diagrams import Diagram, reduced
from sono.starts.drawing import mirror
from sono.starts.flypes import flyped
from sono.starts.links import link_names
from sono.starts.planar import lifted
from sono.starts.scramble import scramble
from sono.starts.spelling import Part, spelled, summands, unknown
from sono.starts.sums import EnclosedError, joined
from sono.starts.tabled import conformation, is_tabled, table_row
from sono.starts.tables import table
from sono.starts.tangles import conway, conway_terms, pretzel, two_bridge
from sono.starts.torus import chain, torus

OUTSIDES = 20
"""Variants that are tried of a sum whose parts cannot be joined as they are drawn first."""

_INTEGER = r"-?\d{1,999}"
_INTEGERS = rf"[(\[]({_INTEGER}(?:[\s,]+{_INTEGER})*)[)\]]"

TORUS = rf"T(?:orus\s*(?:Knot|Link))?\s*_?[(\[{{]({_INTEGER})[\s,]+({_INTEGER})[)\]}}]"
CHAIN = r"chain\s*(\d{1,999})"
BRAID = rf"{_INTEGER}(?:[\s,]+{_INTEGER})+"
TURKS_HEAD = r"(?:THK|Turk['’]?s[\s_-]*head)(?:[\s_-]*knot)?[\s_-]*[(\[]?(\d{1,3})\s*[x×,]\s*(\d{1,3})[)\]]?"
"""Patterns of torus types, chains of rings, braid words, and Turk's heads of so many leads and bights."""

_WORDS: dict[str, Callable[[re.Match[str]], list[int]]] = {
    BRAID: lambda match: _integers(match[0]),
    rf"\(({BRAID})\)\s*\^?\s*(\d{{1,3}})": lambda match: _integers(match[1]) * int(match[2]),
    TURKS_HEAD: lambda match: [k if k % 2 else -k for k in range(1, int(match[1]))] * int(match[2]),
}
"""What is a closed braid, and its word: that itself, the power of one, (1 -2 3 -4 ...)^bights."""

_CURVES: dict[str, Callable[[re.Match[str]], Components]] = {
    **{pattern: (lambda match: braid(_word(match[0]))) for pattern in _WORDS},
    "unknot|0_1": lambda match: chain(1),
    TORUS: lambda match: torus(int(match[1]), int(match[2])),
    CHAIN: lambda match: chain(int(match[1])),
}
"""What is drawn as a curve: patterns, without spaces round commas and brackets, and what draws it."""

_DIAGRAMS: dict[str, Callable[[re.Match[str]], Diagram]] = {
    rf"({'|'.join(codes.KINDS)})\s*(?:code\s*)?(?::|(?=[\[({{]))(.*)": lambda match: codes.diagram(
        match[1].casefold(), match[2]
    ),
    r"X[pm]?_?[\[({\d].*|\[(?:[\[({].*)?\]": lambda match: codes.diagram("pd", match[0]),
    rf"P(?:retzel)?\s*{_INTEGERS}": lambda match: pretzel(_integers(match[1])),
    rf"C\s*{_INTEGERS}": lambda match: conway(_integers(match[1])),
    rf"\[({_INTEGER}(?:\s+{_INTEGER})*)\]": lambda match: conway(conway_terms(match[1])),
    rf"({_INTEGER})/({_INTEGER})": lambda match: two_bridge(int(match[1]), int(match[2])),
}
"""What is drawn from a planar diagram."""


def names() -> list[str]:
    """Return the names that are built in, besides torus types such as "T(2,5)", pretzels, codes, ..."""
    return [
        *dict.fromkeys([*(row["knot"] for row in table("knots")), "unknot", "0_1", *link_names(), "chain3"])
    ]


def has_variants(name: str) -> bool:
    """Tell whether further variants of this name are more than scrambles of the plain one."""
    return all(_is_drawn(part) or _is_torus(part) for part in summands(name))


def knows(name: str) -> bool:
    """Tell whether this looks like the name of a knot, without drawing it."""
    return all(_is_drawn(part) or matched(part.name, _CURVES) for part in summands(name))


def doubt(name: str) -> str | None:
    """Say what is odd about a braid word, if it has pieces that nothing links, as one has that is mistyped.

    >>> doubt("3 1")
    "'3 1' is read as a closed braid, and falls into pieces; did you mean '3_1'?"
    >>> doubt("1 -2 1 -2")
    """
    generators = _word(name)
    if set(map(abs, generators)) >= set(range(1, max(map(abs, generators), default=0) + 1)):
        return None
    meant = re.sub(r"\W+", "_", name.strip())
    cure = f"did you mean {meant!r}?" if is_tabled(meant) else "give every generator up to the largest one"
    return f"{name!r} is read as a closed braid, and falls into pieces; {cure}"


def crossings(name: str) -> int:
    """Return how many crossings a name has itself: a code, a pretzel, a braid word, or so; 0 for others."""
    if found := matched(name, _DIAGRAMS):
        pattern, match = found
        return len(_DIAGRAMS[pattern](match).far) // 4
    return len(_word(name))


def _word(name: str) -> list[int]:
    """Return the braid word that a name stands for, or none."""
    found = matched(name, _WORDS)
    return _WORDS[found[0]](found[1]) if found else []


def start(name: str, variant: int = 0) -> Components:
    """Return a starting conformation of the knot called `name`, in units of about one rope radius.

    `name` is one of `names()`, such a name with an m before it for the mirror image, a knot to 13 crossings
    or link to 11 where sono[knotinfo] is installed, a torus type "T(p,q)", a chain of rings "chain3", a braid
    word "1 -2 1 -2" of two generators or more, a pretzel "P(-2,3,7)", a two-bridge link "5/2" or "C(3,2)"
    (see `tangles`), or a code, "pd:...", "dt:..." or "gauss:..." (see `codes`); letter case and surrounding
    space do not matter. Other spellings are understood, see `spelling`. A sum such as "3_1#m3_1" joins the
    first components of its parts.

    Variant 0 is a closed braid or a torus knot, ready to be tightened, or drawn from a diagram. Each further
    `variant` is another conformation of the same type. Those of knots and links in the tables are random arc
    presentations, some of them with more columns than needed, and the negative ones are drawn from a planar
    diagram after random flypes. Pretzels, two-bridge links and codes are always drawn from a diagram, which
    the negative variants flype first. Torus types are bundles (see `bundles`), and their negative variants,
    and all of others, isotopic scrambles. Raises ValueError, with the nearest known name, for anything else.
    """
    parts = summands(name)
    if not all(part.name for part in parts):
        raise ValueError(f"unknown knot {name!r}: a part has no name; write it like m3_1 or 3_1#m4_1")
    return _sum(parts, variant)


def _sum(parts: Sequence[Part], variant: int) -> Components:
    """Return a connected sum, of other variants where the first component of a part is inside of others."""
    first, *others = parts
    if not others:
        curve = _drawn(first, variant)
        return mirror(curve) if first.mirrored else curve
    variants = [variant]
    if all(map(_is_drawn, parts)):
        # Each is drawn from a diagram with another face outside.
        variants += range(-abs(variant) - 1, -abs(variant) - OUTSIDES, -1)
    for drawn in variants:
        with suppress(EnclosedError):
            return joined(_sum([first], drawn), _sum(others, drawn), abs(variant))
    raise EnclosedError(
        f"{'#'.join(map(str, parts))}: the first component of a part is inside of others, so nothing joins it"
    )


def _drawn(part: Part, variant: int) -> Components:
    """Return a conformation of what has a part's name, not yet mirrored."""
    name = part.name
    if row := table_row(spelled(name)):
        return conformation(row, variant)
    if found := matched(name, _DIAGRAMS):
        pattern, match = found
        diagram = reduced(_DIAGRAMS[pattern](match))
        return lifted(flyped(diagram, -variant) if variant < 0 else diagram, abs(variant))
    found = matched(name, _CURVES)
    if not found:
        raise unknown(part, names())
    pattern, match = found
    if pattern == TORUS and variant > 0:
        return bundle(int(match[1]), int(match[2]), variant)
    if pattern != TORUS and variant < 0:
        raise ValueError(f"variant = {variant}: {name} has no planar diagram to draw it from; give 0 or more")
    curve = _CURVES[pattern](match)
    return scramble(curve, abs(variant)) if variant else curve


def matched(name: str, patterns: Iterable[str]) -> tuple[str, re.Match[str]] | None:
    """Return the pattern that a name fits, and how."""
    name = "0_1" if spelled(name) == "0_1" else re.sub(r"\s*([()\[\]{},/])\s*", r"\1", name)
    matches = ((pattern, re.fullmatch(pattern, name, re.IGNORECASE | re.DOTALL)) for pattern in patterns)
    return next(((pattern, match) for pattern, match in matches if match), None)


def _is_drawn(part: Part) -> bool:
    """Tell whether this looks like the name of something that has a planar diagram."""
    return bool(is_tabled(spelled(part.name)) or matched(part.name, _DIAGRAMS))


def _is_torus(part: Part) -> bool:
    """Tell whether this is the name of a torus type, which has bundles."""
    found = matched(part.name, _CURVES)
    return found is not None and found[0] == TORUS


def _integers(text: str) -> list[int]:
    return [int(number) for number in re.findall(r"-?\d+", text)]
