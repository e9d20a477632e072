"""Flypes: they keep a diagram's type, writhe and planarity, and lead to diagrams that are not the same."""

import pytest

from sono.invariants import fingerprint
from sono.starts import start, table
from sono.starts.codes import diagram
from sono.starts.diagrams import Diagram, codes, faces, pieces
from sono.starts.flypes import flyped
from sono.starts.planar import lifted

DIAGRAMS = {row["knot"]: diagram("pd", row["pd"]) for row in table("knots")}
FLYPED = [seed for seed in range(24) if flyped(DIAGRAMS["8_1"], seed) != DIAGRAMS["8_1"]]


def face_sizes(diagram: Diagram) -> tuple[tuple[int, ...], ...]:
    """Return the sizes of the four faces at each crossing, sorted: equal for equal diagrams."""
    size = {slot: len(face) for face in faces(diagram.far) for slot in face}
    around = (tuple(sorted(size[crossing, k] for k in range(4))) for crossing, _ in sorted(diagram.far))
    return tuple(sorted(around))


@pytest.mark.parametrize("knot", ["7_6", "8_20", "9_48", "10_37", "10_71", "10_135", "10_148"])
def test_the_type_is_kept(knot: str) -> None:
    expected = fingerprint(start(knot))
    for seed in FLYPED[:5]:
        assert fingerprint(lifted(flyped(DIAGRAMS[knot], seed), seed)) == expected


def test_every_diagram_stays_planar() -> None:
    for knot, before in DIAGRAMS.items():
        after = flyped(before, FLYPED[len(knot) % 3])
        assert before.far.keys() == after.far.keys() == set(after.far.values())
        assert len(faces(after.far)) == len(after.far) // 4 + 2  # Euler's formula
        assert len(pieces(after.far)) == len(after.begins) == 1


def test_the_writhe_of_an_alternating_diagram_is_kept() -> None:
    """P. Tait's conjecture, proved by M. Thistlethwaite; it can change where a diagram does not alternate."""

    def writhe(diagram: Diagram) -> int:
        # The upper strand of a right-handed crossing comes from the left of the lower one.
        return sum(-1 if d == b % (len(diagram.far) // 2) + 1 else 1 for _, b, _, d in codes(diagram))

    for knot in ("7_6", "9_15", "10_71"):
        assert {writhe(flyped(DIAGRAMS[knot], seed)) for seed in FLYPED[:5]} == {writhe(DIAGRAMS[knot])}


def test_other_diagrams_are_reached() -> None:
    found = {
        knot: {face_sizes(flyped(DIAGRAMS[knot], s)) for s in range(24)} for knot in ("7_6", "10_71", "7_1")
    }
    assert len(found["7_6"]) > 1
    assert len(found["10_71"]) >= 6
    assert len(found["7_1"]) == 1  # one reduced alternating diagram


def test_without_a_tangle_to_turn_over() -> None:
    assert all(flyped(DIAGRAMS["8_18"], seed) == DIAGRAMS["8_18"] for seed in range(24))
