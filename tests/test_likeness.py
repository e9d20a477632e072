"""Whether two curves may be of one type, whatever the order and orientation of their components."""

import random

import pytest

from sono.starts import start
from sono.starts.drawing import mirror
from sono.starts.likeness import may_be_alike

LINKS = ("Hopf", "4^2_1", "5^2_1", "6^3_1", "6^3_2", "6^3_3", "8^4_1", "chain3", "chain4", "T(4,4)")


@pytest.mark.parametrize("name", [*LINKS, "chain6", "T(5,5)", "8_19", "3_1#Hopf"])
def test_order_orientation_and_mirror_image_make_no_difference(name: str) -> None:
    shaken = random.Random(name)
    curve = start(name, variant=1) if name in LINKS[:7] else start(name)
    curve = [component[:: shaken.choice((1, -1))] for component in shaken.sample(curve, len(curve))]
    assert may_be_alike(curve, start(name))
    assert may_be_alike(mirror(curve), start(name))


@pytest.mark.parametrize(
    ("one", "other"),
    [
        *[(one, other) for one in LINKS for other in LINKS if one < other],
        *[("3_1", "4_1"), ("3_1", "Hopf"), ("granny", "square"), ("chain4", "Hopf#Hopf#Hopf")],
        *[("chain6", "T(6,6)"), ("Hopf#3_1", "Hopf#4_1"), ("Hopf#3_1#4_1", "Hopf#3_1#5_2")],
    ],
)
def test_others_are_told_apart(one: str, other: str) -> None:
    assert not may_be_alike(start(one), start(other))
