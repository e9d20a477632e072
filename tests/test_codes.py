"""Codes of diagrams: what is written in them is drawn, with its handedness and orientation."""

import json
import re
from collections.abc import Sequence
from contextlib import suppress
from itertools import product

import numpy as np
import pytest

from sono.curve import Components
from sono.invariants import fingerprint, homfly
from sono.invariants.crossings import crossings, diagram, planar_diagram
from sono.starts import has_variants, knows, start, table
from sono.starts.codes import diagram as read
from sono.starts.diagrams import Diagram, codes, faces, from_codes, reduced
from sono.starts.drawing import mirror
from sono.starts.embedding import embedded
from sono.starts.planar import lifted

TREFOIL = [(1, 5, 2, 4), (3, 1, 4, 6), (5, 3, 6, 2)]
UNKNOT = fingerprint(start("unknot"))
KNOTS = ("3_1", "m3_1", "4_1", "8_19", "m8_19", "10_125", "m10_125", "3_1#m5_2")
LINKS = ("Hopf", "mHopf", "L2a1{0}", "L5a1{0}", "L5a1{1}", "mL5a1{1}", "L6n1{0,1}", "6^3_2", "Hopf#3_1")


def polynomial(drawn: Diagram) -> str:
    """HOMFLY polynomial of a diagram, without drawing it."""
    regina = pytest.importorskip("regina")
    link = regina.Link.fromPD(codes(drawn))
    link.insertLink(regina.Link(sum(begin is None for begin in drawn.begins)))
    return str(link.homflyAZ())


def written(curve: Components) -> str:
    """Return the PD code of a curve."""
    return f"pd:{planar_diagram(diagram(curve))}"


@pytest.mark.parametrize(
    "code",
    [
        "[(1,5,2,4), (3,1,4,6), (5,3,6,2)]",
        "[[1, 5, 2, 4], [3, 1, 4, 6], [5, 3, 6, 2]]",
        "{{1, 5, 2, 4}, {3, 1, 4, 6}, {5, 3, 6, 2}}",
        "PD[X[1,5,2,4], X[3,1,4,6], X[5,3,6,2]]",
        "PD(X(1,5,2,4), X(3,1,4,6), X(5,3,6,2))",
        "X[1,5,2,4] X[3,1,4,6] X[5,3,6,2]",
        "X[1,5,2,4]X[3,1,4,6]X[5,3,6,2]",
        "Xp[1,5,2,4] Xp[3,1,4,6] Xp[5,3,6,2]",
        "X1524 X3146 X5362",
        "X_{1524} X_{3146} X_{5362}",
        "1,5,2,4 3,1,4,6 5,3,6,2",
        "1,5,2,4; 3,1,4,6; 5,3,6,2",
        "1, 5, 2, 4, 3, 1, 4, 6, 5, 3, 6, 2",
        "1 5 2 4\n3 1 4 6\n5 3 6 2\n",
        "[(0,4,1,3), (2,0,3,5), (4,2,5,1)]",
        "(-7,50,20,40) (30,-7,40,60) (50,30,60,20)",
        "X[1,5,2,4] X[3,1,4,6] X[5,3,6,7] P[7,2]",
    ],
)
def test_a_pd_code_may_be_written_in_many_ways(code: str) -> None:
    assert codes(read("pd", code)) == TREFOIL


@pytest.mark.parametrize(
    "code", ["4 6 2", "[4, 6, 2]", "[(4,6,2)]", "4,6,2", "(4 6 2)", "cacbca", "[cacbca]", "−4 −6 −2"]
)
def test_a_dt_code_may_be_written_in_many_ways(code: str) -> None:
    assert fingerprint(start(f"dt:{code}")) == fingerprint(start("3_1"))


@pytest.mark.parametrize(
    "code",
    [
        "1 -2 3 -1 2 -3",
        "-1, 2, -3, 1, -2, 3",
        "[1,-2,3,-1,2,-3]",
        "[[7,-2,9,-7,2,-9]]",
        "O1U2O3U1O2U3",
        "O1+U2+O3+U1+O2+U3+",
        "u1+ o2+ u3+ o1+ u2+ o3+",
    ],
)
def test_a_gauss_code_may_be_written_in_many_ways(code: str) -> None:
    assert fingerprint(start(f"gauss:{code}")) == fingerprint(start("3_1"))


def test_links_are_lists_of_codes() -> None:
    for code in ("[[6,8],[2,4]]", "(6,8)(2,4)", "[{6, 8}, {2, 4}]", "6 8 | 2 4", "dbbbcdab"):
        assert polynomial(read("dt", code)) == polynomial(read("dt", "6 8; 2 4"))
    for code in ("[[1,-2],[2,-1]]", "{{1, -2}, {2, -1}}", "(1,-2)(2,-1)", "1 -2 | 2 -1", "O1+U2+|O2+U1+"):
        assert fingerprint(start(f"gauss:{code}")) == fingerprint(start("Hopf"))
    assert fingerprint(start("gauss:O1-U2-|O2-U1-")) == fingerprint(start("L2a1{0}"))


def test_the_orientation_of_a_link_is_that_of_its_lower_strands() -> None:
    assert fingerprint(start("pd:[(4,1,3,2),(2,3,1,4)]")) == fingerprint(start("L2a1{0}"))
    assert fingerprint(start("pd:[(4,2,3,1),(2,4,1,3)]")) == fingerprint(start("L2a1{1}"))
    # Whatever the labels, (3,2,4,1) has the same two strands as (4,2,3,1), but one runs the other way.
    assert fingerprint(start("pd:[(3,1,4,2),(2,4,1,3)]")) == fingerprint(start("L2a1{0}"))


@pytest.mark.parametrize("name", [*KNOTS, *LINKS])
def test_what_a_curve_is_written_as_is_read_as_the_same_oriented_link(name: str) -> None:
    for variant in (0, 3):
        curve = start(name, variant)
        again = start(written(curve))
        assert homfly(again) == homfly(curve)
        assert fingerprint(again) == fingerprint(curve)


@pytest.mark.slow
def test_a_third_of_the_tables_is_read_as_it_is_written() -> None:
    names = [row["knot"] for row in table("knots")] + [row["link"] for row in table("links")]
    for number, name in enumerate(names[::3]):
        curve = start(f"m{name}" if number % 2 else name)
        again = read("pd", written(curve)[3:])
        assert polynomial(again) == homfly(curve), name
        if number % 9 == 0:
            assert fingerprint(lifted(again, 0)) == fingerprint(curve), name


@pytest.mark.parametrize("seed", range(12))
def test_random_polygons_are_read_as_they_are_written(seed: int) -> None:
    random = np.random.default_rng(seed)
    curve = [random.normal(size=(int(n), 3)) for n in random.integers(4, 7, size=int(random.integers(1, 4)))]
    found = crossings(curve, np.array([0.1, 0.2, 1.0]))  # as they are seen, kinks and all
    passed = {int(found.component(place)) for place in np.concatenate([found.over, found.under])}
    code = f"{planar_diagram(found)} {' '.join('Loop[0]' for _ in range(len(curve) - len(passed)))}"
    if found.sign.size:
        assert homfly(start(f"pd:{code}")) == homfly(curve)


def test_kinks_and_circles_are_drawn_as_what_they_are() -> None:
    for code in (
        "X[1,2,2,1]",
        "X[1,1,2,2]",
        "X[2,1,1,2]",
        "X[2,2,1,1]",
        "Loop[1]",
        "P[1,2] P[2,1]",
        "P[1,1]",
        "[]",
        "PD[]",
    ):
        assert fingerprint(start(f"pd:{code}")) == UNKNOT
    for kinks in product((1, -1), repeat=3):
        words = [(k + 1, over) for k, kink in enumerate(kinks) for over in (kink > 0, kink < 0)]
        assert reduced(embedded([words])).begins == [None]
    curve = start("pd:X[1,5,2,4] X[3,1,4,6] X[5,3,6,2] Loop[9] Loop[10]")
    assert len(curve) == 3
    assert homfly(curve[:1]) == homfly(start("3_1"))
    assert homfly(curve) == polynomial(read("gauss", "O1+U2+O3+U1+O2+U3+ | |"))


def test_nugatory_crossings_go_and_nothing_else_does() -> None:
    # A trefoil and a figure-eight knot on both sides of a crossing that holds nothing.
    code = "gauss:O1+ O2+U3+O4+U2+O3+U4+ U1+ O5-U6-O7+U8+O6-U5-O8+U7+"
    assert len(reduced(read("gauss", code[6:])).far) == 4 * 7
    assert homfly(start(code)) == homfly(start("3_1#4_1"))
    for row in table("knots")[::12]:
        assert len(reduced(read("pd", row["pd"])).far) == 4 * len(row["pd"].split())


def test_split_pieces_are_drawn_apart() -> None:
    code = "pd:X[1,5,2,4] X[3,1,4,6] X[5,3,6,2] X[14,11,13,12] X[12,13,11,14]"
    curve = start(code)
    assert [len(curve), fingerprint(curve[:1])] == [3, fingerprint(start("3_1"))]
    assert fingerprint(curve[1:]) == fingerprint(start("L2a1{0}"))
    assert curve[0][:, 0].max() + 2 < min(component[:, 0].min() for component in curve[1:])


def test_a_component_above_all_others() -> None:
    # It comes off, so that its orientation does not matter.
    curve = start("pd:[(1,3,2,4),(2,3,1,4)]")
    apart = [component + shift for shift in (0, 99) for component in start("unknot")]
    assert homfly(curve) == homfly(apart)


@pytest.mark.parametrize("row", table("knots")[::6], ids=lambda row: str(row["knot"]))
def test_the_first_crossing_of_dt_and_gauss_codes_is_right_handed(row: dict[str, str]) -> None:
    drawn = read("pd", row["pd"])
    word = [(slot[0] + 1) * (1 if slot[1] % 2 else -1) for slot in drawn.circuits()[0]]
    again = embedded([[(abs(passed), passed > 0) for passed in word]])
    signs, others = handedness(drawn), handedness(again)
    assert others[0] == 1
    assert others == [sign * signs[0] for sign in signs]


def handedness(drawn: Diagram) -> list[int]:
    """Tell for each crossing, in the order in which a knot passes them, whether it is right-handed."""
    entered = set(drawn.circuits()[0])
    order = dict.fromkeys(slot[0] for slot in drawn.circuits()[0])
    signs = {x: (1 if ((x, 3) in entered) == ((x, 0) in entered) else -1) for x in order}
    return list(signs.values())


def knotinfo() -> list[dict[str, str]]:
    rows: list[dict[str, str]] = pytest.importorskip("database_knotinfo").link_list()
    return [row for row in rows[2:] if int(row["crossing_number"]) <= 10]


def linkinfo() -> list[dict[str, str]]:
    rows: list[dict[str, str]] = pytest.importorskip("database_knotinfo").link_list(proper_links=True)
    return [row for row in rows[1:] if int(row["crossing_number"]) <= 9]


@pytest.mark.slow
def test_all_codes_of_knotinfo_are_those_of_its_braids() -> None:
    for row in knotinfo()[::4]:
        braid = homfly(start(row["name"]))
        assert polynomial(read("pd", row["pd_notation"])) == braid
        assert polynomial(read("dt", row["dt_notation"])) == braid
        both = {braid, homfly(mirror(start(row["name"])))}
        assert polynomial(read("gauss", row["gauss_notation"])) in both


@pytest.mark.slow
def test_all_codes_of_linkinfo_are_those_of_its_braids() -> None:
    for row in linkinfo()[::3]:
        braid = homfly(start(row["name"]))
        for code in (row["pd_notation_vector"], row["pd_notation_math"]):
            assert polynomial(read("pd", code)) == braid
        for kind, code in (("dt", row["dt_code"]), ("gauss", row["gauss_notation"])):
            drawn = read(kind, code)
            assert sorted(map(len, faces(drawn.far))) == sorted(
                map(len, faces(read("pd", row["pd_notation_vector"]).far))
            )


@pytest.mark.parametrize(
    ("code", "message"),
    [
        ("pd:", "not readable; write it like"),
        ("pd:[[]]", "not readable"),
        ("pd:[] x", "not readable"),
        ("pd:P[1,2]", "edge 1 occurs once"),
        ("pd:P[1,2] P[2,3]", "occurs once"),
        ("pd:P[1,2] P[1,2] P[1,2]", "occurs 3 times"),
        ("pd:X[1,5,2,4] X[3,1,4,6] X[5,3,6,2] P[7,8]", "occurs once"),
        ("pd:X[1,5,2,4] X[3,1,4,6] X[5,3,6,2] P[1,2]", "occurs 3 times"),
        ("pd:X[1,2,1,2]", "cannot be drawn in the plane"),
        ("pd:X[2,1,3,1] X[2,4,3,4]", "cannot be drawn in the plane"),
        ("pd:[(4,2,7,4),(6,3,6,3),(2,1,7,1),(5,8,5,8)]", "cannot be drawn in the plane"),
        ("pd:1,5,2", "no crossing, which has four edges"),
        ("pd:[(1,5,2,4),(3,1,4,6),(5,3,6)]", "[5,3,6] is no crossing"),
        ("pd:Y[1,2,3,4]", "Y[1,2,3,4] is no crossing"),
        ("pd:[(1,5,2,4),(3,1,4,6),(5,3,6,7)]", "edge 2 occurs once"),
        ("pd:[(1,2,1,2),(1,2,3,3)]", "edge 1 occurs 3 times"),
        ("pd:[(1.5,3,2,4)]", "not readable"),
        ("pd:[(2,4,1,5),(3,1,4,6),(5,3,6,2)]", "crossing 1 of the PD code, (2, 4, 1, 5), is passed below"),
        ("pd:[(3,2,4,1),(4,3,1,2)]", "cannot be drawn in the plane"),
        ("pd:hello", "not readable"),
        ("pd:[(2 1\n2)]", "[2 1 2] is no crossing"),
        ("dt:", "not readable"),
        ("dt:4 6", "it has 2 numbers, so these are 2 to 4, even, each once"),
        ("dt:4 5 2", "even"),
        ("dt:4 4 2", "each once"),
        ("dt:6 2 4 x", "not readable"),
        ("dt:4 6 8 10 2", "cannot be drawn in the plane"),
        ("dt:zazbc", "the first letter counts crossings"),
        ("gauss:", "not readable"),
        ("gauss:1 -2 -1 2", "cannot be drawn in the plane"),
        ("gauss:O1+O2+U1+U2+", "cannot be drawn in the plane"),
        ("gauss:O1+U2-O3+U1+O2-U3+", "cannot be drawn in the plane"),
        ("gauss:1 2 -1", "crossing 2 is passed 1 times above and 0 times below"),
        ("gauss:1 1", "no minus tells what is below"),
        ("gauss:1 1 -2", "crossing 1 is passed 2 times above"),
        ("gauss:O1+U2O3U1O2U3", "has no sign, or two"),
        ("gauss:O1+U1-", "has no sign, or two"),
        ("gauss:O1+ 2 -2 U1+", "not readable"),
        ("gauss:O1+U1+ 2 -2", "not readable"),
        ("dt:" + " ".join(str(2 * k) for k in range(1, 400)), "too many to draw"),
    ],
)
def test_bad_codes(code: str, message: str) -> None:
    with pytest.raises(ValueError, match=re.escape(message)) as error:
        start(code)
    assert len(str(error.value).splitlines()) == 1


@pytest.mark.parametrize("seed", range(20))
def test_a_random_code_is_a_diagram_or_an_error(seed: int) -> None:
    random = np.random.default_rng(seed)
    drawn = 0
    for _ in range(100):
        labels = random.permutation(np.repeat(np.arange(2 * random.integers(1, 6)), 2)).reshape(-1, 4)
        pairs = "".join(f" P{pair.tolist()}" for pair in random.integers(0, 12, (random.integers(4) // 3, 2)))
        with suppress(ValueError):
            assert len(reduced(read("pd", f"{labels.tolist()}{pairs}")).far) <= labels.size
            drawn += 1
    assert drawn > 5


def test_codes_have_variants_of_both_kinds() -> None:
    name = "pd:" + json.dumps(from_codes_of("7_6"))
    assert knows(name)
    assert has_variants(name)
    curves = [start(name, variant) for variant in (-3, -2, -1, 0, 1)]
    assert len({curve[0].tobytes() for curve in curves}) == 5
    assert {homfly(curve) for curve in curves} == {homfly(start("7_6"))}
    assert homfly(start(f"m{name}#3_1")) == homfly(start("m7_6#3_1"))


def from_codes_of(name: str) -> Sequence[tuple[int, ...]]:
    return codes(from_codes(planar_diagram(diagram(start(name)))))
