"""Pretzels, two-bridge links and Conway's notation: those of the tables, as handed as these."""

import json
import re

import pytest

from sono.invariants import fingerprint, homfly
from sono.invariants.crossings import diagram, linking_matrix
from sono.starts import has_variants, knows, start
from sono.starts.diagrams import codes, reduced
from sono.starts.tangles import conway, conway_terms, pretzel, two_bridge


@pytest.mark.parametrize(
    ("name", "knot"),
    [
        ("P(-1,-1,-1)", "3_1"),
        ("P(1,1,1)", "m3_1"),
        ("P(-2,3,1)", "5_1"),
        ("P(-2,3,3)", "8_19"),
        ("P(3,-2,3)", "8_19"),
        ("P(-2,3,5)", "10_124"),
        ("P(2,-3,-5)", "m10_124"),
        ("P(-3,5,7)", "mP(3,-5,-7)"),
        ("P(3)", "unknot"),
        ("P(1,-1)", "gauss:|1 -1"),
        ("5/2", "4_1"),
        ("3/1", "3_1"),
        ("3/-1", "m3_1"),
        ("-3/1", "m3_1"),
        ("3/2", "m3_1"),
        ("3/4", "3_1"),
        ("7/3", "5_2"),
        ("7/5", "5_2"),
        ("7/-3", "m5_2"),
        ("1/1", "unknot"),
        ("-1/5", "unknot"),
        ("2/1", "Hopf"),
        ("-2/1", "mHopf"),
        ("2/3", "L2a1{0}"),
        ("4/1", "T(2,4)"),
        ("C(-6)", "T(2,-6)"),
        ("C(3)", "3_1"),
        ("C(-3)", "m3_1"),
        ("C(2,2)", "4_1"),
        ("C(3,2)", "7/3"),
        ("[3 2]", "5_2"),
        ("C(3,1,2)", "11/3"),
        (" p ( -2 , 3 , 3 ) ", "8_19"),
        (" 5 / 2 ", "4_1"),
        ("M5/2", "m4_1"),
        ("P(-2,3,3)#5/2#C(3)", "8_19#4_1#3_1"),
    ],
)
def test_names_and_what_they_are(name: str, knot: str) -> None:
    assert knows(name)
    for variant in (0, 2, -3):
        assert len(start(name, variant)) == len(start(knot))
        assert homfly(start(name, variant)) == homfly(start(knot))
    assert fingerprint(start(name)) == fingerprint(start(knot))
    assert has_variants(name)


def test_links_of_two_bridges_and_pretzels() -> None:
    whitehead = start("8/3")
    assert len(whitehead) == 2
    assert linking_matrix(diagram(whitehead))[0, 1] == 0
    assert homfly(whitehead) in {homfly(start(f"{m}L5a1{{{turn}}}")) for m in ("", "m") for turn in "01"}
    assert {abs(linking_matrix(diagram(start(f"{2 * k}/1")))[0, 1]) for k in range(1, 5)} == {1, 2, 3, 4}
    assert len(start("P(2,2,2)")) == 3
    assert len(start("P(2,-2,2,4)")) == 4


@pytest.mark.slow
def test_all_of_knotinfo_are_as_handed_as_its_diagrams() -> None:
    regina = pytest.importorskip("regina")
    rows = pytest.importorskip("database_knotinfo").link_list()[2:803]
    counts = {"pretzel": 0, "two-bridge": 0}
    for row in rows:
        drawn = []
        if re.match(r"P\(", row["pretzel_notation"]):
            drawn.append(pretzel([int(term) for term in re.findall(r"-?\d+", row["pretzel_notation"])]))
            counts["pretzel"] += 1
        if row["two_bridge_notation"]:
            drawn.append(two_bridge(*json.loads(row["two_bridge_notation"])))
            counts["two-bridge"] += 1
        known = str(regina.Link.fromPD(json.loads(row["pd_notation"])).homflyAZ()) if drawn else ""
        for one in drawn:
            assert str(regina.Link.fromPD(codes(reduced(one))).homflyAZ()) == known, row["name"]
    assert counts["pretzel"] > 50
    assert counts["two-bridge"] > 150


def test_conways_notation_of_knotinfo_is_that_of_its_diagrams_up_to_the_hand() -> None:
    regina = pytest.importorskip("regina")
    rows = pytest.importorskip("database_knotinfo").link_list()[2:]
    rows = [row for row in rows if re.fullmatch(r"\[[\d ]+\]", row["conway_notation"])]
    mirrored = []
    for row in rows:
        drawn = str(
            regina.Link.fromPD(codes(reduced(conway(conway_terms(row["conway_notation"][1:-1]))))).homflyAZ()
        )
        known = regina.Link.fromPD(json.loads(row["pd_notation"]))
        if drawn != str(known.homflyAZ()):
            known.reflect()
            assert drawn == str(known.homflyAZ()), row["name"]
            mirrored.append(row["name"])
    # Conway's notation does not tell the hand, of which KnotInfo has now one, now the other.
    assert len(rows) > 300
    assert len(mirrored) < len(rows) / 6
    assert {"7_3", "7_4"} <= set(mirrored)


def test_conways_notation_has_as_many_crossings_as_it_says() -> None:
    for turns in ([3], [2, 2], [3, 1, 2], [2, 1, 1, 2], [4, 1, 3], [-3, -2]):
        assert len(reduced(conway(turns)).far) == 4 * sum(map(abs, turns))


@pytest.mark.parametrize(
    ("name", "message"),
    [
        ("6/4", "6/4 is not in lowest terms; write 3/2"),
        ("-6/4", "write -3/2"),
        ("0/1", "neither number may be 0"),
        ("5/0", "neither number may be 0"),
        ("P(2,0)", "half turns must not be 0"),
        ("C(0)", "half turns must not be 0"),
        ("P(1000,3)", "too many crossings"),
        ("P(" + "9" * 500 + ")", "too many crossings"),
        ("C(1,999999999)", "too many crossings"),
        ("999999999/2", "too many crossings"),
        ("P()", "known are"),
        ("P(a,b)", "known are"),
    ],
)
def test_bad_names(name: str, message: str) -> None:
    with pytest.raises(ValueError, match=re.escape(message)) as error:
        start(name)
    assert len(str(error.value)) < 400
