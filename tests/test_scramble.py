"""Scrambles: entangled, and of the same type."""

import numpy as np
import pytest

from sono.invariants import fingerprint
from sono.invariants.crossings import crossings
from sono.naming import verify
from sono.starts import start
from sono.starts.scramble import scramble
from sono.starts.torus import chain

UNKNOT = fingerprint(chain(1))


@pytest.mark.parametrize("seed", range(10))
def test_scrambled_circle_stays_unknotted(seed: int) -> None:
    assert fingerprint(scramble(chain(1), seed, swirls=10)) == UNKNOT


def test_scrambled_circle_is_entangled() -> None:
    assert len(crossings(scramble(chain(1), seed=1, swirls=20)).sign) > 5


def test_scramble_follows_the_seed() -> None:
    one, same, other = (scramble(start("3_1"), seed, swirls=5)[0] for seed in (1, 1, 2))
    np.testing.assert_array_equal(one, same)
    assert one.shape != other.shape or not np.allclose(one, other)


@pytest.mark.slow
@pytest.mark.parametrize(
    "name", ["7_4", "8_1", "9_42", "m10_97", "10_123", "11n_34", "12a_803", "L9a5", "3_1#8_1"]
)
def test_what_is_drawn_thin_is_scrambled_too(name: str) -> None:
    drawn = start(name)
    scrambled = scramble(drawn, seed=3, swirls=6)
    assert verify(drawn, scrambled).verdict == "same"
    assert len(crossings(scrambled).sign) > 8


def test_scramble_refuses_a_curve_that_touches_itself() -> None:
    eight = np.array([[0.0, 0, 0], [1, 1, 0], [1, -1, 0], [0, 0, 0], [-1, 1, 0], [-1, -1, 0]])
    with pytest.raises(ValueError, match="touches itself"):
        scramble([eight], seed=0)


def test_scramble_refuses_what_would_take_all_memory() -> None:
    with pytest.raises(ValueError, match=r"20,002 vertices are too many to scramble; 5,000 are the most"):
        scramble([np.random.default_rng(0).normal(size=(20_002, 3))], seed=0)
