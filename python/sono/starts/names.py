"""Starting conformations by name: the loose knots and links that a tightening begins with.

Prime knots have the names of KnotInfo: Rolfsen's up to 10 crossings, but with 10_83 and 10_86 as in the
corrected editions of his book (older files have them the other way round), and 10_161 to 10_165 without the
Perko pair: his 10_161 and 10_162 are one knot, so his 10_163 to 10_166 are 10_162 to 10_165 here. "m8_20" is
the mirror image of 8_20. With the extra sono[knotinfo] there are also all knots to 13 crossings, "11a_1" to
"13n_5110". A knot has the handedness of its braid word in KnotInfo, where a positive generator is a
right-handed crossing, so 3_1 is the right-handed trefoil.

>>> len(start("3_1")), len(start("m8_18")), len(start("10_165", variant=3)), len(start("chain3"))
(1, 1, 1, 3)
"""

import difflib
import json
import re
from functools import cache

from sono.curve import Components
from sono.starts.arcs import Strokes, grid, shuffled
from sono.starts.braids import braid
from sono.starts.drawing import mirror
from sono.starts.flypes import flyped
from sono.starts.links import link_names, link_row, oriented_like
from sono.starts.planar import Diagram, lifted
from sono.starts.scramble import scramble
from sono.starts.sums import joined
from sono.starts.tables import table
from sono.starts.torus import chain, torus

# Those that are drawn best in another way than as the braids of the data file.
_DRAWN = {
    "unknot": "chain1",
    "0_1": "chain1",
    "3_1": "T(2,3)",
    "5_1": "T(2,5)",
    "7_1": "T(2,7)",
    "8_19": "T(3,4)",
    "9_1": "T(2,9)",
    "Hopf": "chain2",
    "2^2_1": "chain2",
    "L2a1": "chain2",
    "chain3": "chain3",
}

SAME_SIZE = 16
SIZES = 4
"""Variants drawn from arc presentations: so many have as few columns as possible, so many one more, ..."""

_TORUS = re.compile(r"t\s*\(\s*(-?\d{1,999})\s*,\s*(-?\d{1,999})\s*\)", re.IGNORECASE)
_CHAIN = re.compile(r"chain\s*(\d{1,999})", re.IGNORECASE)
_BRAID = re.compile(r"-?\d{1,999}([\s,]+-?\d{1,999})+")
_KNOTINFO = re.compile(r"1[123][an]_\d+")


@cache
def _knots() -> dict[str, dict[str, str]]:
    return {row["knot"]: row for row in table("knots")}


def names() -> list[str]:
    """Return the names that are built in, besides torus types such as "T(2,5)" and braid words."""
    return [*dict.fromkeys([*_knots(), *_DRAWN, *link_names()])]


def has_variants(name: str) -> bool:
    """Tell whether further variants of this name are more than scrambles of the plain one."""
    if "#" in name:
        return all(map(has_variants, name.split("#")))
    plain = re.sub("^m", "", name.strip(), flags=re.IGNORECASE)
    return plain in _knots() or _KNOTINFO.fullmatch(plain) is not None


def knows(name: str) -> bool:
    """Tell whether this looks like the name of a knot, without drawing it."""
    if "#" in name:
        return all(map(knows, name.split("#")))
    plain = re.sub("^m", "", name.strip(), flags=re.IGNORECASE)
    patterns = (_TORUS, _CHAIN, _BRAID, _KNOTINFO)
    known = plain.casefold() in map(str.casefold, names()) or link_row(plain) is not None
    return known or any(p.fullmatch(plain) for p in patterns)


def start(name: str, variant: int = 0) -> Components:
    """Return a starting conformation of the knot called `name`, in units of about one rope radius.

    `name` is one of `names()`, such a name with an m before it for the mirror image, a knot to 13 crossings
    where sono[knotinfo] is installed, a torus type "T(p,q)", a chain of rings "chain3", or a braid word
    "1 -2 1 -2" of two generators or more; letter case and surrounding space do not matter. Prime links to 9
    crossings are called as Thistlethwaite, L5a1 or L5a1{1}, or Rolfsen, 5^2_1, calls them: see `links`. A sum
    such as "3_1#m3_1" joins the first components of its parts.

    Variant 0 is a closed braid or a torus knot, ready to be tightened. Each further `variant` is another
    conformation of the same type. Those of a knot in the tables are random arc presentations, some of them
    with more columns than it needs; the negative ones are drawn from its planar diagram after random flypes.
    Those of other knots are isotopic scrambles. Raises ValueError, with the nearest known name, for anything
    else.
    """
    first, *others = name.split("#")
    if others:
        return joined(start(first, variant), start("#".join(others), variant), abs(variant))
    plain = name.strip()
    if plain[:1].casefold() == "m":
        return mirror(start(plain[1:], variant))
    plain = {known.casefold(): known for known in names()}.get(plain.casefold(), plain)
    if plain not in _DRAWN and (link := link_row(plain)):
        return _link(link, variant)
    row = _from_knotinfo(plain) if _KNOTINFO.fullmatch(plain) else _knots().get(plain)
    if row and variant > 0:
        return grid(shuffled(_strokes(row["grid"]), variant, variant // SAME_SIZE % SIZES))
    if row and variant < 0:
        return lifted(flyped(_diagram(row["pd"]), -variant), -variant)
    if variant < 0:
        raise ValueError(f"variant = {variant}: only the knots of the tables have negative variants")
    curve = _drawn(_DRAWN.get(plain) or (row["braid"] if row else plain))
    return scramble(curve, variant) if variant else curve


def _link(row: dict[str, str], variant: int) -> Components:
    """Return a conformation of a link of the table. Raises `ValueError` for a negative variant."""
    if variant < 0:
        raise ValueError(f"variant = {variant}: links have no negative variants")
    drawn = braid([int(generator) for generator in row["braid"].split(",")])
    if not variant:
        return drawn
    strokes = shuffled(_strokes(row["grid"]), variant, variant // SAME_SIZE % SIZES)
    return oriented_like(grid(strokes), drawn)


def _drawn(name: str) -> Components:
    """Return the curve of a torus type, a chain or a braid word."""
    if match := _TORUS.fullmatch(name):
        return torus(int(match[1]), int(match[2]))
    if match := _CHAIN.fullmatch(name):
        return chain(int(match[1]))
    if _BRAID.fullmatch(name):
        return braid([int(generator) for generator in re.findall(r"-?\d+", name)])
    if name == "10_166":
        raise ValueError("unknown knot '10_166': Rolfsen's 10_166 is 10_165, as his 10_161 is his 10_162")
    near = difflib.get_close_matches(name, names(), n=1)
    hint = f"did you mean {near[0]!r}? " if near else ""
    known = "3_1 to 10_165, L2a1 to L9n28, 2^2_1 to 9^4_1, Hopf, chain3, T(p,q) and braid words"
    raise ValueError(f"unknown knot {name!r}: {hint}Known are {known}")


def _strokes(text: str) -> Strokes:
    """Read an arc presentation such as "1-3 2-4 3-5 1-4 2-5", whose rows count from 1."""
    ends = (column.split("-") for column in text.split())
    return [(int(low) - 1, int(high) - 1) for low, high in ends]


def _diagram(text: str) -> Diagram:
    """Read a planar diagram such as "1,5,2,4 3,1,4,6 5,3,6,2"."""
    codes = (map(int, code.split(",")) for code in text.split())
    return [(a, b, c, d) for a, b, c, d in codes]


@cache  # its table takes a second to read
def _from_knotinfo(name: str) -> dict[str, str]:
    """Return the row of a knot of 11 to 13 crossings. Raises ValueError if there is none, or no KnotInfo."""
    try:
        from database_knotinfo import link_list
    except ImportError:
        raise ValueError(
            f"{name!r} has more than 10 crossings: its table is an extra; pip install 'sono[knotinfo]'"
        ) from None
    found = next((row for row in link_list() if row["name"] == name), None)
    if not found:
        raise ValueError(f"unknown knot {name!r}: KnotInfo has no such name")
    # "[1,-2]", or several words "[[1,-2],[1,2]]".
    word = re.search(r"[-\d, ]+", found["braid_notation"])
    points = json.loads(found["grid_notation"])
    columns = [[y for x, y in points if x == column] for column in range(1, len(points) // 2 + 1)]
    grid_text = " ".join(f"{low}-{high}" for low, high in columns)
    pd = " ".join(",".join(map(str, code)) for code in json.loads(found["pd_notation"]))
    return {"knot": name, "braid": word[0] if word else "", "grid": grid_text, "pd": pd}
