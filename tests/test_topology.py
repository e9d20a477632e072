"""No step lets strands pass: the knot type before and after tightening, on all shipped starts."""

from pathlib import Path

import numpy as np
import pytest
from conftest import some

from sono import Tight, formats, starts, tighten
from sono.invariants import fingerprint
from sono.starts.scramble import scramble

KNOTS = Path(__file__).parent.parent / "knots"
NAMES = sorted(path.stem for path in KNOTS.glob("*.txt"))
LONG = "t_2_59"
QUICK = {"anneal_sweeps": 30_000, "settle_sweeps": 100}

# Two radii or less between the vertices, so that the beads rearrange as freely as they ever do.
COARSE = {"3_1": 60, "4_1": 84, "5_1": 90, "7_1": 120, "8_19": 120, "9_1": 150, "t_2_59": 1000}
COARSE |= {"hopf": 56, "chain3": 90}


def assert_valid(tight: Tight) -> None:
    assert tight.converged
    assert tight.measures.dispersion <= 1e-6
    assert tight.measures.r_s == pytest.approx(1, abs=1e-6)


@pytest.mark.parametrize("seed", range(5))
@pytest.mark.parametrize("name", sorted(set(NAMES) - {LONG}))
def test_a_loose_start_keeps_its_type(name: str, seed: int) -> None:
    keeps_its_type(name, seed)


@pytest.mark.slow
@pytest.mark.parametrize("seed", some(range(10), 1))
def test_a_long_loose_start_keeps_its_type(seed: int) -> None:
    keeps_its_type(LONG, seed)


def keeps_its_type(name: str, seed: int) -> None:
    start = formats.read(KNOTS / f"{name}.txt").components
    tight = tighten(start, COARSE[name], method="sono", seed=seed, settings=QUICK)
    assert_valid(tight)
    assert fingerprint(tight.curve) == fingerprint(start)


@pytest.mark.parametrize("name", sorted(set(NAMES) - {LONG}))
def test_trials_and_polish_keep_the_type(name: str) -> None:
    start = formats.read(KNOTS / f"{name}.txt").components
    tight = tighten(start, COARSE[name], trials=6)
    assert_valid(tight)
    assert fingerprint(tight.curve) == fingerprint(start)


@pytest.mark.parametrize("name", ["3_1", "4_1", "8_19", "chain3"])
def test_the_polish_alone_keeps_the_type(name: str) -> None:
    start = formats.read(KNOTS / f"{name}.txt").components
    tight = tighten(start, 2 * COARSE[name], method="polish")
    assert_valid(tight)
    assert fingerprint(tight.curve) == fingerprint(start)


@pytest.mark.slow
@pytest.mark.parametrize("seed", range(2))
def test_an_entangled_unknot_unties_itself(seed: int) -> None:
    entangled = scramble(starts.start("unknot"), seed)
    tight = tighten(entangled, 60, method="sono", seed=seed, settings=QUICK)
    assert_valid(tight)
    assert tight.measures.l_p == pytest.approx(2 * np.pi, rel=0.01)


@pytest.mark.slow
@pytest.mark.parametrize("name", ["3_1", "4_1", "chain3"])
def test_a_scrambled_knot_finds_its_way_back(name: str) -> None:
    start = starts.start(name)
    entangled = scramble(start, 1)
    tight = tighten(entangled, COARSE[name], trials=2)
    assert_valid(tight)
    assert fingerprint(tight.curve) == fingerprint(start)
