"""One name for all names of a knot or link, of its mirror image and of its orientations: ropes are as long.

>>> [canonical(name) for name in ("K8n1", "T(3,-2)", "5/2", "T(24,19)", "2^2_1", "T(3,3)", "Hopf#Hopf")]
['8_20', '3_1', '4_1', 'T(19,24)', 'L2a1', 'L6n1', 'chain3']
>>> canonical("m4_1#m3_1") == canonical("3_1#4_1"), canonical("granny") == canonical("square")
(True, False)
"""

import re
from contextlib import suppress
from functools import cache

from sono.naming import identify
from sono.naming.known import MOST_OF_KNOTS, is_amphichiral
from sono.naming.tori import is_tabled as is_tabled_torus
from sono.starts.links import link_row
from sono.starts.names import CHAIN, TORUS, crossings, matched, start
from sono.starts.spelling import Part, spelled, summands
from sono.starts.tabled import is_tabled, tabled_name

HOPF = "L2a1"

MOST_DRAWN = 2 * MOST_OF_KNOTS
"""Crossings of a diagram that is drawn to see whether the tables have it."""


LONGEST = 1000
"""Letters of a name that is looked at."""


def canonical(name: str) -> str:
    """Return one name for all names of a knot or link, for its mirror image, and for all orientations.

    It is that of the tables, without m and braces, "chain3", or "T(19,24)" for a torus type they do not have.
    The parts of a sum that is no chain are in one order, and as few as can be have an m. What is no name
    comes back as `spelled` has it. What is known only by what is drawn is identified, which takes 0.03 s.

    >>> [canonical(name) for name in ("L6a4{0,1}", "P(-2,3,7)", "3_1#0_1", "1 -2 1 -2", "foo")]
    ['L6a4', '12n_242', '3_1', '4_1', 'foo']
    """
    return handed(name)[0]


@cache
def handed(name: str) -> tuple[str, bool]:
    """Return the one name, and whether what has this name is the mirror image of what that draws.

    >>> handed("m3_1#4_1"), handed("square"), handed("T(2,-99)")
    (('3_1#4_1', True), ('3_1#m3_1', False), ('T(2,99)', True))
    """
    if len(name) > LONGEST:
        return name, False
    parts = [one for part in summands(name) for one in _parts(part) if one.name != "0_1"]
    if not parts:
        return "0_1", False
    if [part.name for part in parts] == [HOPF, HOPF]:
        return "chain3", False
    either = [
        sorted((_unhanded(part, turned, len(parts)) for part in parts), key=_order) for turned in (0, 1)
    ]
    names = ["#".join(map(str, each)) for each in either]
    turned = min((0, 1), key=lambda turned: (names[turned].count("m"), names[turned]))
    return names[turned], bool(turned)


def _parts(part: Part) -> list[Part]:
    """Return the parts, by their names in the tables if they have any, that one of a name is the sum of."""
    name = spelled(part.name)
    if row := link_row(name):
        return [Part(row["link"].split("{")[0], part.mirrored)]
    if is_tabled(name):
        return [Part(re.sub("^l", "L", tabled_name(name).casefold().split("{")[0]), part.mirrored)]
    if name.casefold() in ("unknot", "0_1"):
        return []
    pattern, match = matched(part.name, (CHAIN, TORUS)) or ("", None)
    numbers = [int(number) for number in match.groups()] if match else []
    if pattern == CHAIN and numbers[0] > 3:
        return [Part(f"chain{numbers[0]}", part.mirrored)]
    if pattern == TORUS and 1 in map(abs, numbers):
        return []
    if pattern == TORUS and not is_tabled_torus(*numbers):
        p, q = sorted(map(abs, numbers))
        return [Part(f"T({p},{q})", part.mirrored != (numbers[0] * numbers[1] < 0))]
    with suppress(ValueError):  # no knot's name after all, or a curve too entangled
        if pattern or 0 < crossings(part.name) <= MOST_DRAWN:
            return _identified(part)
    return [Part(name, part.mirrored)]


def _identified(part: Part) -> list[Part]:
    """Return what a part is the sum of by what is drawn of it. Raises `ValueError` if that has no name."""
    names = identify(start(part.name)).names
    if len(names) != 1 or set(names[0]) & set("?+"):
        raise ValueError(f"{part.name} is none of the tables")
    return [Part(one.name.split("{")[0], one.mirrored != part.mirrored) for one in summands(names[0])]


def _unhanded(part: Part, turned: int, parts: int) -> Part:
    """Return one of so many parts, or its mirror image, without an m where that makes no difference."""
    same = part.name == HOPF or (parts > 1 and is_amphichiral(part.name))
    return Part(part.name, part.mirrored != bool(turned) and not same)


def _order(part: Part) -> tuple[list[int], str]:
    """Return by what parts are sorted: crossings and numbers first."""
    return [int(number) for number in re.findall(r"\d+", part.name)], str(part)
