"""The shortest ropes known: those of the atlas that the package carries, in one archive for each family.

They are tight at R_s = 1, on edges of about 0.2 radii, and what a rope of any number of beads begins with.

>>> rope = known("m8_18")
>>> len(rope), 370 < len(rope[0]) < 380, known("T(2,103)") is None
(1, True, True)
"""

from contextlib import suppress
from dataclasses import dataclass
from importlib import resources
from importlib.resources.abc import Traversable

from sono.curve import Components
from sono.starts import archive
from sono.starts.canonical import handed
from sono.starts.drawing import mirror
from sono.starts.links import link_row, oriented_like
from sono.starts.names import TORUS, matched, start
from sono.starts.spelling import spelled, summands
from sono.starts.tabled import NoTableError, tabled_name

FAMILIES = ("knots", "links", "composites", "torus")
"""Prime knots and prime links by their names in the tables, connected sums, and torus knots and links."""

FOLDER: Traversable = resources.files("sono").joinpath("data", "atlas")


@dataclass(frozen=True)
class Place:
    """Where the atlas has the knot or link of a name, if it has it: its family, and its name there.

    >>> place("mT(5,2)"), place("5^2_1").knot, place("4_1#m3_1")
    (Place(family='torus', knot='T(2,5)', mirrored=True), 'L5a1', Place(family='composites', \
knot='3_1#4_1', mirrored=True))
    """

    family: str
    knot: str
    mirrored: bool = False


def place(name: str) -> Place:
    """Return the place of a knot or link, by a name in any spelling."""
    parts = summands(name)
    if len(parts) > 1:
        return Place("composites", *handed(name))
    plain, mirrored = parts[0].name, parts[0].mirrored
    if torus := matched(plain, [TORUS]):
        p, q = map(int, torus[1].groups())
        return Place("torus", f"T({min(abs(p), abs(q))},{max(abs(p), abs(q))})", mirrored != (p * q < 0))
    if row := link_row(spelled(plain)):
        return Place("links", row["link"].split("{")[0], mirrored)
    return Place("knots", tabled_name(plain).casefold(), mirrored)


def known(name: str) -> Components | None:
    """Return the shortest rope known of a knot or link, or None.

    A code, pretzel, braid or so is the knot or link of the tables that its diagram is identified as, which
    takes up to half a second. A link is oriented as `starts.start` has it.

    >>> known("P(-2,3,7)")[0].shape == known("12n_242")[0].shape, known("dt:4 6 2") is None
    (True, False)
    """
    where = place(name)
    if (rope := _rope(where)) is None:
        typed, turned = handed(name)
        found = place(typed)
        where = Place(found.family, found.knot, found.mirrored != turned)
        rope = _rope(where)
    if rope is None or where.family != "links":
        return rope
    with suppress(ValueError):  # another orientation may be that of the mirror image
        return oriented_like(rope, start(name))
    return None


def _rope(where: Place) -> Components | None:
    """Return the rope that the atlas has at a place, if it has one."""
    file = FOLDER.joinpath(f"{where.family}.zip")
    if not file.is_file():
        return None
    with file.open("rb") as opened:
        data = archive.one(opened, where.knot)
    if data is None:
        return None
    rope = archive.unpacked(data)
    return mirror(rope) if where.mirrored else rope


def drawn(name: str) -> Components:
    """Return what `starts.start` draws, or the rope known where its table is not installed.

    Raises `ValueError` for a name that is neither.
    """
    try:
        return start(name)
    except NoTableError:
        if (rope := known(name)) is None:
            raise
        return rope
