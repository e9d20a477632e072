"""Settings of both engines: one object that knows its ranges, the core's own defaults, and what they do."""

import json
import pickle
from typing import Any

import pytest

import sono
from sono import Settings, _core


def test_defaults_are_the_cores() -> None:
    own = json.loads(_core.default_settings()) | json.loads(_core.default_polish_settings())
    assert Settings().to_dict() == own
    assert Settings().changes() == {}
    assert all(f"`{name}`" in (Settings.__doc__ or "") for name in own)


def test_settings_are_records() -> None:
    settings = Settings(seed=3, last_mu=1e-9)
    assert pickle.loads(pickle.dumps(settings)) == settings != Settings()
    assert settings.changes() == {"seed": 3, "last_mu": 1e-9}


@pytest.mark.parametrize(
    "wrong",
    [
        {"c_1": 2},
        {"last_mu": 1.0},
        {"patience": 0},
        {"mu_power": 0.5},
        {"seed": 1.5},
        {"most_used": float("nan")},
        {"most_iterations": -1},
        {"tight_residual": "x"},
    ],
)
def test_what_is_out_of_range_is_refused(wrong: dict[str, Any]) -> None:
    (name,) = wrong
    for make in (Settings, lambda **wrong: sono.tighten("3_1", 60, settings=wrong)):
        with pytest.raises(ValueError, match=f"setting {name} = "):
            make(**wrong)


def test_the_polish_follows_its_settings() -> None:
    fine, coarse = (sono.tighten("3_1", 60, settings=Settings(last_mu=mu)) for mu in (1e-11, 1e-6))
    assert (fine.mu, coarse.mu) == (1e-11, 1e-6)
    assert (fine.excess or 0) < 1e-8 < 1e-5 < (coarse.excess or 0)
    assert coarse.measures.l_p > fine.measures.l_p
    stuck = sono.tighten("3_1", 60, method="polish", settings={"most_iterations": 3})
    assert not stuck.converged


def test_both_ways_to_give_them_are_one() -> None:
    one = sono.tighten("4_1", 70, settings=Settings(anneal_sweeps=4000, seed=2))
    other = sono.tighten("4_1", 70, settings={"anneal_sweeps": 4000}, seed=2)
    assert one.curve == other.curve
    with pytest.raises(ValueError, match="given twice"):
        sono.tighten("4_1", 70, settings=Settings(seed=2), seed=3)
