"""Spellings of names: the same curve however it is written, and a wrong name leads to the right one."""

import numpy as np
import pytest

from sono.starts import knows, start
from sono.starts.spelling import MOST, spelled

_PDS = [("PD[X[", "], X[", "]]"), ("X[", "] X[", "]"), ("[[", "],[", "]]"), ("[ (", "), (", ") ]")]


@pytest.mark.parametrize(
    ("name", "plain"),
    [
        *[
            (name, "3_1")
            for name in ("3.1", "3_{1}", "3₁", "K3_1", "3:1:1", "3.1.1", "3^1_1", "K3a1", "3a_1", "3a1")
        ],
        *[(name, "8_20") for name in ("8.20", "8n1", "K8n1", "8:1:20", "8₂₀")],
        *[(name, "10_123") for name in ("10.123", "10_{123}", "10₁₂₃", "K10a121")],
        *[
            (name, "5^2_1")
            for name in ("5.2.1", "5:2:1", "5^{2}_{1}", "5_1^2", "5_{1}^{2}", "5²₁", "L5a1", "l5a1{0}")
        ],
        *[(name, "9^2_57") for name in ("9.2.57", "9:2:57", "9_57^2")],
        *[(name, "L6a4{1,0}") for name in ("L6a4{1, 0}", " l6a4{ 1,0 }")],
        *[(name, "11a_1") for name in ("K11a1", "11a1", "k11A_1", "11a001", "Knot[11,Alternating,1]")],
        *[(name, "11n_34") for name in ("11^n_34", "11^{n}_{34}", "11_n34", "11_{n34}", "11n:34")],
        *[
            (name, "3_1")
            for name in ("003_1", "3_01", "$3_1$", "Knot[3,1]", "trefoil", "Right-handed Trefoil")
        ],
        *[
            (name, "m3_1")
            for name in ("3_1*", "3_1!", "!3_1", "*3_1", "m(3_1)", "mirror image of 3_1", "!m!3_1")
        ],
        *[(name, "4_1#m3_1") for name in ("m(m4_1#3_1)", "(4_1#m3_1)", "!m!(!4_1#3_1)", "(4_1#3_1*)")],
        *[(name, "m3_1#T(2,-3)") for name in ("m(3_1#T(2,3))", "!(3_1♯T(2,3))", "3_1!\\#m (T_{2,3})")],
        *[(name, "4_1") for name in ("figure eight", "figure-eight", "Figure-Eight Knot", "figure_eight")],
        *[(name, "0_1") for name in ("0.1", "K0a1", "0₁", "unknot", "trivial knot", "$0_1$")],
        *[(name, "4^2_1") for name in ("$4_1^2$", "Solomon's link", "Solomon link", "Link[4,Alternating,1]")],
        *[("granny knot", "3_1#3_1"), ("Square Knot", "3_1#m3_1"), ("mgranny", "m3_1#m3_1")],
        *[("overhand knot", "3_1"), ("Overhand", "3_1"), ("reef knot", "3_1#m3_1"), ("mreef", "m3_1#3_1")],
        *[("endless knot", "7_4"), ("pentafoil", "5_1"), ("septafoil", "7_1"), ("carrick mat", "8_18")],
        *[
            (name, "1 -2 1 -2 1 -2 1 -2")
            for name in ("(1 -2)^4", "(1, -2) ^ 4", "(1 -2)4", "Turk's head 3x4")
        ],
        *[(name, "1 -2 1 -2 1 -2") for name in ("TurksHead(3,3)", "THK[3, 3]", "Turk’s Head knot 3 × 3")],
        *[("Turks head 4x2", "1 -2 3 1 -2 3"), ("Turk's head 2x5", "1 1 1 1 1")],
        *[("pretzel(3,3,3)", "P(3,3,3)"), ("Pretzel[-2, 3, 7]", "P(-2,3,7)")],
        *[("Hopf link", "Hopf"), ("Borromean rings", "L6a4"), ("whitehead link", "L5a1")],
        *[
            ("T_{2,3}", "T(2,3)"),
            ("T[ 2 , 3 ]", "T(2,3)"),
            ("TorusKnot[5,3]", "T(5,3)"),
            ("T(2,−5)", "T(2,-5)"),
        ],
        *[(name, "C(2,3)") for name in ("C[2,3]", "C(2 3)", "[ 2 3 ]", "[23]")],
        *[("[10]", "C(10)"), ("[11]", "C(11)"), ("[112]", "C(1,1,2)"), ("P[−2 3, 7]", "P(-2,3,7)")],
        *[(name, "dt:4 6 2") for name in ("DT[cacbca]", "DT:[(4,6,2)]", "DTCode[4,6,2]", "DT code: 4 6 2")],
        *[("GaussCode[-1,2,-3,1,-2,3]", "gauss:-1 2 -3 1 -2 3"), ("[]", "pd:Loop[1]")],
        *[(f"{a}1,5,2,4{b}3,1,4,6{b}5,3,6,2{c}", "pd:1,5,2,4;3,1,4,6;5,3,6,2") for a, b, c in _PDS],
        ("X1524 X3146 X5362", "pd:1,5,2,4;3,1,4,6;5,3,6,2"),
        *[(name, "m11n_34") for name in ("mK11n34", "m11n34", "M 11n_34")],
    ],
)
def test_one_curve_by_many_names(name: str, plain: str) -> None:
    if plain[:2] == "11" or plain[1:3] == "11":
        pytest.importorskip("database_knotinfo")
    assert knows(name)
    assert all(map(np.array_equal, start(name), start(plain)))


def test_what_is_no_name_stays_as_it_is() -> None:
    for text in ("Hopf", "L6n1", "quipu", "1-1", "a.b", "5.2.1.1"):
        assert spelled(text) == text


@pytest.mark.parametrize(
    ("wrong", "message"),
    [
        ("8_22", "one of 8_1 to 8_21?"),
        ("8.22", "one of 8_1 to 8_21?"),
        ("L5a2", "there is only 'L5a1'"),
        ("L9a999", "one of L9a1 to L9a55?"),
        ("5^2_2", "there is only '5^2_1'"),
        ("8.3.11", "one of 8^3_1 to 8^3_10?"),
        ("Withehead", "did you mean 'Whitehead'?"),
        ("Boromean", "did you mean 'Borromean'?"),
        ("12_5", "did you mean 12a_5 or 12n_5?"),
        ("14n_1", "the tables end with knots of 13 crossings"),
        ("K15a1", "the tables end with knots of 13 crossings"),
        ("L12n1", "the tables end with knots of 13 crossings and links of 11"),
        ("L5a1{0,1}", "braces have a 0 or 1 for each component after the first"),
        ("L5a1{2}", "braces have a 0 or 1"),
        ("m3_2", "unknown knot 'm3_2': there is only 'm3_1'"),
        ("!8_22", "one of m8_1 to m8_21?"),
        ("m12_5", "did you mean m12a_5 or m12n_5?"),
        ("mhopff", "did you mean 'mHopf'?"),
        ("grany", "did you mean 'granny'?"),
        ("m31", "did you mean 'm3_1'?"),
        ("figure nine", "unknown knot 'figure nine': known are"),
        ("L0a1", "known are"),
        ("4_1_1", "known are"),
        ("5 2/3", "unknown knot '5 2/3': known are"),
        ("[4,6,2]", "known are"),
        ("m(3_1", "unknown knot 'm(3_1'"),
        ("mirror imag of (3_1#4_1)", "unknown knot"),
        ("T(2,3#4_1", "unknown knot 'T(2,3#4_1'"),
        ("(3_1)(4_1)", "unknown knot '(3_1)(4_1)'"),
        *[
            (name, f"unknown knot {name!r}: a part has no name")
            for name in ("m", "#3_1", "3_1#", "", "!", "m()")
        ],
        ("8*", "unknown knot '8*': known are"),
        ("3_1#!8_22", "unknown knot '!8_22'"),
        ("8_22 mirror", "unknown knot '8_22 mirror'"),
        ("quipu", "`sono start --list` has what is built in"),
        ("8-20", "did you mean '8_20'?"),
        ("3_1#8_22", "one of 8_1 to 8_21?"),
    ],
)
def test_a_wrong_name_leads_to_the_right_one(wrong: str, message: str) -> None:
    with pytest.raises(ValueError, match="unknown knot") as error:
        start(wrong)
    assert message in str(error.value)


def test_large_tables_say_how_many_they_have() -> None:
    rows = pytest.importorskip("database_knotinfo").link_list()
    links = pytest.importorskip("database_knotinfo").link_list(proper_links=True)
    names = {row["name"] for row in rows} | {row["name"].split("{")[0] for row in links}
    for begin, many in MOST.items():
        assert f"{begin}{many}" in names
        assert f"{begin}{many + 1}" not in names
        with pytest.raises(ValueError, match=f"one of {begin}1 to {begin}{many}"):
            start(f"{begin}{many + 1}")
