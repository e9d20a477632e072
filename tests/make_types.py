"""Writes `python/sono/data/types.tsv` anew from KnotInfo: `python -m tests.make_types`, some minutes.

Names and diagrams are those of KnotInfo and LinkInfo, knots turned to the hand of their braid words. Links
that moves make of others, or of their mirror images, are left out.
"""

import json
import re
from collections.abc import Iterator
from pathlib import Path

import sono
from sono import _core
from sono.invariants.crossings import diagram
from sono.invariants.diagrams import Gauss, gauss_code, homfly_polynomial, shortened
from sono.naming.known import SAME_AS_MIRROR, key, mirrored
from sono.naming.letters import packed
from sono.starts import table
from sono.starts.braids import braid

TARGET = Path(sono.__file__).parent / "data" / "types.tsv"
HEAD = """\
# Prime knots up to 13 crossings, prime links up to 9: key of the HOMFLY polynomial, diagram in letters.
# Source: KnotInfo and LinkInfo 2026.11.2, "PD Notation", "Braid Notation", "Symmetry Type"
# (https://knotinfo.math.indiana.edu; C. Livingston, A. H. Moore). Written by tests/make_types.py; letters as
# in sono/naming/letters.py. "=" ends those of types whose mirror images are named without m.
name\tkey\tdiagram
"""
MOST = 20_000
"""Diagrams that are looked at to tell whether two links are the same."""


def gauss_of_pd(codes: list[list[int]]) -> Gauss:
    """Return the Gauss code of a PD code, each component followed from a crossing where it is below."""
    ends: dict[int, list[tuple[int, int]]] = {}
    for crossing, edges in enumerate(codes):
        for place, edge in enumerate(edges):
            ends.setdefault(edge, []).append((crossing, place))
    far = {slot: other for one, two in ends.values() for slot, other in ((one, two), (two, one))}
    passages, right = [], [False] * len(codes)
    seen = set()
    for start in range(len(codes)):
        slot, along = (start, 0), []
        while slot not in seen:
            seen.add(slot)
            crossing, place = slot
            along.append(crossing + 1 if place % 2 else -crossing - 1)
            right[crossing] = right[crossing] or place == 3
            slot = far[crossing, (place + 2) % 4]
        passages += [along] if along else []
    return passages, right


def meets(gauss: Gauss, other: Gauss) -> bool:
    return _core.meeting(gauss, [other], MOST) is not None


def knots() -> Iterator[tuple[str, Gauss, bool]]:
    """Give each knot's name, diagram, and whether it is its own mirror image."""
    from database_knotinfo import link_list

    for row in link_list():
        if not re.fullmatch(r"\d+[an]?_\d+", row["name"]) or row["name"] == "0_1":
            continue
        word = re.search(r"[-\d, ]+", row["braid_notation"])
        assert word
        model = shortened(gauss_code(diagram(braid([int(k) for k in word[0].split(",")]))))
        gauss = gauss_of_pd(json.loads(row["pd_notation"]))
        achiral = "amphicheiral" in row["symmetry_type"]
        yield (
            row["name"],
            gauss if achiral or same_hand(row["name"], gauss, model) else mirrored(gauss),
            achiral,
        )


def same_hand(name: str, gauss: Gauss, model: Gauss) -> bool:
    """Tell whether a knot or its mirror image has the model's hand."""
    polynomials = [homfly_polynomial(each) for each in (model, gauss, mirrored(gauss))]
    if polynomials[1] != polynomials[2]:
        assert polynomials[0] in polynomials[1:], name
        return polynomials[0] == polynomials[1]
    primes = [prime for piece in _core.pieces(model, 1000) for prime in piece]
    hand = _core.meeting(primes[0], [gauss, mirrored(gauss)], MOST)
    assert hand is not None, name
    return hand == 0


def links() -> Iterator[tuple[str, Gauss, bool]]:
    """Give each link likewise, but those that are others."""
    found: list[tuple[str, Gauss]] = []
    for row in table("links"):
        gauss = gauss_of_pd([[int(edge) for edge in code.split(",")] for code in row["pd"].split()])
        mine = homfly_polynomial(gauss)
        for name, other in found:
            if homfly_polynomial(other) == mine and meets(gauss, other):
                print(row["link"], "is", name)
                break
        else:
            found.append((row["link"], gauss))
    for name, gauss in found:
        image = mirrored(gauss)
        mine = homfly_polynomial(image)
        same = [other for other, one in found if homfly_polynomial(one) == mine and meets(image, one)]
        if same:
            print("mirror of", name, "is", same)
        yield name, gauss, bool(same)


def main() -> None:
    """Write the table."""
    lines = []
    for name, gauss, achiral in [*knots(), *links()]:
        polynomial = homfly_polynomial(gauss)
        assert polynomial, name
        lines.append(f"{name}\t{key(polynomial)}\t{packed(gauss)}{SAME_AS_MIRROR * achiral}\n")
    TARGET.write_text(HEAD + "".join(lines), encoding="utf-8")


if __name__ == "__main__":
    main()
