"""Spellings of names: the same curve however it is written, and a wrong name leads to the right one."""

import numpy as np
import pytest

from sono.starts import knows, start
from sono.starts.spelling import MOST, spelled


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
        *[(name, "11a_1") for name in ("K11a1", "11a1", "k11A_1")],
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
        ("L5a2", "did you mean 'L5a1'?"),
        ("L9a999", "one of L9a1 to L9a55?"),
        ("5^2_2", "did you mean '5^2_1'?"),
        ("8.3.11", "one of 8^3_1 to 8^3_10?"),
        ("Withehead", "did you mean 'Whitehead'?"),
        ("Boromean", "did you mean 'Borromean'?"),
        ("12_5", "did you mean 12a_5 or 12n_5?"),
        ("14n_1", "the tables end with knots of 13 crossings"),
        ("K15a1", "the tables end with knots of 13 crossings"),
        ("L12n1", "the tables end with knots of 13 crossings and links of 11"),
        ("L5a1{0,1}", "braces have a 0 or 1 for each component after the first"),
        ("L5a1{2}", "braces have a 0 or 1"),
        ("m3_2", "did you mean '3_1'?"),
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
