"""Connected sums: they are what their parts are, wherever these are joined."""

from itertools import combinations_with_replacement

import numpy as np
import pytest

import sono
from sono.invariants import fingerprint, homfly
from sono.invariants.crossings import diagram, linking_matrix
from sono.invariants.polynomials import PRIME
from sono.starts import has_variants, knows, start

KNOTS = ("3_1", "m3_1", "4_1", "8_19")


@pytest.mark.parametrize(("one", "other"), list(combinations_with_replacement(KNOTS, 2)))
def test_signatures_add_up_and_polynomials_multiply(one: str, other: str) -> None:
    _, signatures, polynomials = fingerprint(start(f"{one}#{other}"))
    (_, s, p), (_, t, q) = fingerprint(start(one)), fingerprint(start(other))
    assert signatures == tuple(a + b for a, b in zip(s, t, strict=True))
    assert polynomials == tuple(a * b % PRIME for a, b in zip(p, q, strict=True))


@pytest.mark.parametrize("name", ["3_1#3_1", "3_1#m3_1", "4_1#8_20#m5_2"])
def test_knots_may_be_joined_anywhere(name: str) -> None:
    whole = homfly(start(name))
    assert len(start(name)) == 1
    assert all(homfly(start(name, variant)) == whole for variant in (-9, -2, 1, 2, 3, 40))
    assert has_variants(name)
    assert homfly(start("#".join(reversed(name.split("#"))))) == whole


def test_granny_and_square_knot_are_two() -> None:
    assert homfly(start("3_1#3_1")) != homfly(start("3_1#m3_1")) != homfly(start("m3_1#m3_1"))


def test_links_are_joined_at_their_first_components() -> None:
    chain = start("Hopf#Hopf")
    assert sorted(linking_matrix(diagram(chain))[0].tolist()) == [0, 1, 1]
    assert homfly(chain) == homfly(start("Hopf#Hopf", 3))
    assert len(start("Borromean#4_1#Whitehead")) == 4
    assert has_variants("Hopf#3_1")
    assert has_variants("T(2,5)#3_1")
    assert not has_variants("chain3#3_1")


@pytest.mark.parametrize("name", ["L9a54#3_1", "L8n7#L8n8", "P(2,2,2)#L7a7", "5/2#dt:4 6 2#Hopf"])
def test_a_part_whose_first_component_is_inside_is_drawn_another_way(name: str) -> None:
    one, other = name.split("#", 1)
    whole = start(name)
    assert len(whole) == len(start(one)) + len(start(other)) - 1
    lengths = [int(number) for number in np.abs(fingerprint(whole)[0])]
    assert sum(lengths) == sum(abs(number) for part in (one, other) for number in fingerprint(start(part))[0])
    assert homfly(whole) == homfly(start(name, 2))


def test_sums_tighten_by_name() -> None:
    tight = sono.tighten(" 3_1 # M3_1 ", 120, trials=1)
    assert tight.converged
    assert fingerprint(tight.curve) == fingerprint(start("3_1#m3_1"))
    assert 56 < tight.measures.l_p < 60


@pytest.mark.parametrize("name", ["3_1#", "#", "3_1#nonsense"])
def test_parts_must_be_known(name: str) -> None:
    assert not knows(name)
    with pytest.raises(ValueError, match="unknown knot"):
        start(name)
