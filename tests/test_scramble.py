"""Scrambles: entangled, and of the same type."""

import numpy as np
import pytest

from sono.invariants import fingerprint
from sono.invariants.crossings import crossings
from sono.starts import start
from sono.starts.scramble import scramble
from sono.starts.torus import chain

UNKNOT = fingerprint(chain(1))


@pytest.mark.parametrize("seed", range(20))
def test_scrambled_circle_stays_unknotted(seed: int) -> None:
    assert fingerprint(scramble(chain(1), seed, swirls=10)) == UNKNOT


def test_scrambled_circle_is_entangled() -> None:
    assert len(crossings(scramble(chain(1), seed=1, swirls=20)).sign) > 5


def test_scramble_follows_the_seed() -> None:
    one, same, other = (scramble(start("3_1"), seed, swirls=5)[0] for seed in (1, 1, 2))
    np.testing.assert_array_equal(one, same)
    assert one.shape != other.shape or not np.allclose(one, other)


def test_scramble_refuses_a_curve_that_touches_itself() -> None:
    eight = np.array([[0.0, 0, 0], [1, 1, 0], [1, -1, 0], [0, 0, 0], [-1, 1, 0], [-1, -1, 0]])
    with pytest.raises(ValueError, match="touches itself"):
        scramble([eight], seed=0)


def test_scramble_refuses_what_would_take_all_memory() -> None:
    with pytest.raises(ValueError, match=r"20,002 vertices are too many to scramble; 5,000 are the most"):
        scramble([np.random.default_rng(0).normal(size=(20_002, 3))], seed=0)
