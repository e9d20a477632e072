"""One name for all names of a knot or link, its mirror image and its orientations."""

import random

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from sono import starts
from sono.starts import canonical


@pytest.mark.parametrize(
    ("one", "names"),
    [
        ("8_20", ("K8n1", "m8.20", "8₂₀", "P(3,-3,2)", "!8_20")),
        (
            "3_1",
            ("trefoil", "T(2,3)", "T(-3,2)", "1 1 1", "3/1", "pd:[[1,5,2,4],[3,1,4,6],[5,3,6,2]]", "3_1#0_1"),
        ),
        ("10_124", ("T(3,5)", "T(5,-3)", "m10.124")),
        ("L4a1", ("Solomon", "4^2_1", "T(2,4)", "T(-4,2)", "L4a1{1}", "4/1")),
        ("L6n1", ("T(3,3)", "6^3_3", "6:3:3", "mL6n1{0,1}", "l6N1{1,1}")),
        ("T(4,6)", ("T(6,4)", "T(-4,6)", "torus link(6,-4)")),
        ("chain3", ("Hopf#Hopf", "chain 3", "mL2a1#2^2_1", "T(2,2)#T(2,-2)")),
        ("chain12", ("chain 12", "mchain12")),
        ("3_1#4_1", ("4_1#m3_1", "m4_1#3_1", "m(3_1#4_1)", "5/2#trefoil")),
        ("3_1#3_1#m3_1", ("m3_1#3_1#m3_1", "square#3_1", "m3_1#granny")),
        ("0_1", ("unknot", "chain1", "T(1,7)", "0_1#0_1", "trivial knot")),
        ("L10a5", ("L10a5{1}", "mL10a5", "l10a5")),
        ("12n_888", ("K12n888", "m12n_888", "Knot[12,NonAlternating,888]")),
    ],
)
def test_names_of_one(one: str, names: tuple[str, ...]) -> None:
    assert {canonical(name) for name in (one, *names)} == {one}


def test_names_of_others() -> None:
    names = (
        "3_1",
        "4_1",
        "granny",
        "square",
        "chain2",
        "chain3",
        "chain4",
        "Hopf#Hopf#Hopf",
        "6^3_1",
        "6^3_2",
    )
    more = ("6^3_3", "T(4,4)", "T(4,5)", "T(4,6)", "T(3,7)", "3_1#3_1#3_1", "3_1#3_1#m3_1", "Hopf#3_1", "foo")
    assert len({canonical(name) for name in names + more}) == len(names + more)


@given(st.integers(1, 40), st.integers(1, 40), st.sampled_from([1, -1]))
def test_torus_types_have_one_name(p: int, q: int, sign: int) -> None:
    assert canonical(f"T({p},{q})") == canonical(f"T({q},{sign * p})") == canonical(f"mT({p},{q})")


@settings(max_examples=30)
@given(st.randoms(use_true_random=False))
def test_sums_in_any_order(random: random.Random) -> None:
    parts = random.choices(["3_1", "m3_1", "4_1", "5_2", "m6_2", "Hopf"], k=random.randint(2, 4))
    mirrored = [part[1:] if part[0] == "m" else f"m{part}" for part in parts]
    one = canonical("#".join(parts))
    for same in (parts, mirrored):
        random.shuffle(same)
        assert canonical("#".join(same)) == one
    assert starts.knows(one)


@pytest.mark.parametrize(
    "name", ["", "#", "m", "chain0", "T(0,3)", "P(99,99,99)", "foo bar", "pd:[[", 999 * "x"]
)
def test_what_is_no_name_or_too_large_does_no_harm(name: str) -> None:
    assert canonical(name) == canonical(canonical(name))
