"""What a tightening may be told: its method, and the settings of both engines."""

import json
import sys
from collections.abc import Mapping
from dataclasses import dataclass, fields
from functools import cache
from operator import index
from typing import Any, Literal

import numpy as np

from sono import _core
from sono._core import Polish, Tightener
from sono.records import Record

Method = Literal["both", "sono", "polish"]

MOST = 500_000
"""The largest n; the polish then takes 1 GB or more."""

LEAST_DL, MOST_DL = 0.01, 1.0
"""Edge lengths that may be asked for, in radii."""

TRIALS = 8
"""Trials of a run, unless the first few agree."""


@dataclass(frozen=True, eq=False, repr=False)
class Settings(Record):
    """Parameters of both engines; R = 1, and tension is 1. Raises `ValueError` for values out of range.

    SONO's: `c_1` and `c_2`, in (0, 0.5], are the shares of a correction that EqualizeEdges and RemoveOverlaps
    make. The anneal has `anneal_sweeps`, and tolerates violations of `anneal_tolerance`, in (0, 0.5], at its
    start; the settling has `settle_sweeps` for each vertex, and ends at a dispersion and overlap of
    `tolerance`, in [1e-12, 0.01]. The `seed` is that of the small displacements before the anneal.

    The polish's: its barrier parameter mu begins at `first_mu` dl^3, in [1e-6, 10], and ends at `last_mu`, in
    [1e-14, 1e-4], or on a level that only leads to the next at `passing_mu` dl^3, in [1e-9, 10]. Where the
    perturbed conditions hold to `centred` mu, in [0.1, 100], and forces balance to `balanced` mu, in
    [0.001, 100], mu falls to `mu_factor` mu, in [0.01, 0.9], or to mu^`mu_power`, in [1, 2]. Contacts repel
    within `contact_range` sqrt mu, in [0.1, 100], of |v_i - v_j|^2 - 4, but at least `least_contact_range`
    dl^2, in [0.001, 1]. A step is at most `longest_way` long, in [0.001, 0.1], uses up `most_used` of a
    constraint at most, in [0.5, 0.999], and lowers the barrier function by `least_descent` of what its slope
    promises at least, in [1e-8, 0.4]; multipliers stay within the factor `multiplier_range`, in [2, 1e10]. A
    rope that glides at its first mu for `patience`
    steps, but for one that falls below `gliding_share` of its length, in [0, 1], begins anew with
    `restart_factor` times that, in [1, 1000], up to `most_restarts` times, at most 100. After
    `most_iterations` it is stuck; it is tight where digits end below `tight_residual`, in [1e-12, 1e-4].

    >>> Settings(last_mu=1e-9).changes()
    {'last_mu': 1e-09}
    >>> Settings(c_1=2)
    Traceback (most recent call last):
    ValueError: setting c_1 = 2 is out of range: in (0, 0.5]
    """

    c_1: float = 0.5
    c_2: float = 0.5
    anneal_tolerance: float = 0.3
    tolerance: float = 1e-6
    anneal_sweeps: int = 200_000
    settle_sweeps: int = 400
    seed: int = 0
    first_mu: float = 0.01
    passing_mu: float = 3e-3
    last_mu: float = 1e-11
    mu_factor: float = 0.2
    mu_power: float = 1.2
    centred: float = 10.0
    balanced: float = 0.1
    contact_range: float = 3.0
    least_contact_range: float = 0.1
    longest_way: float = 0.1
    most_used: float = 0.99
    least_descent: float = 1e-4
    multiplier_range: float = 1000.0
    patience: int = 200
    gliding_share: float = 0.9
    restart_factor: float = 10.0
    most_restarts: int = 3
    most_iterations: int = 2000
    tight_residual: float = 1e-8

    def __post_init__(self) -> None:
        """Check all values."""
        check_settings({field.name: getattr(self, field.name) for field in fields(self)})

    def changes(self) -> dict[str, Any]:
        """Return those that are not what they are by default."""
        values = {field.name: (getattr(self, field.name), field.default) for field in fields(self)}
        return {name: value for name, (value, default) in values.items() if value != default}


Changes = Mapping[str, Any]
"""Settings by name that are not what they are by default."""


@cache
def _defaults() -> tuple[dict[str, Any], dict[str, Any]]:
    """Return SONO's settings and the polish's."""
    return json.loads(_core.default_settings()), json.loads(_core.default_polish_settings())


def default_settings() -> dict[str, Any]:
    """Return all settings by name: see `Settings` for what they mean."""
    sono, polish = _defaults()
    return sono | polish


def of_sono(changes: Changes) -> dict[str, Any]:
    """Return the changed settings that are SONO's."""
    return {name: value for name, value in changes.items() if name in _defaults()[0]}


def of_polish(changes: Changes) -> str:
    """Return the changed settings that are the polish's, as JSON."""
    return json.dumps({name: value for name, value in changes.items() if name in _defaults()[1]})


def check_settings(changes: Changes) -> None:
    """Raise `ValueError` for an unknown setting or a value that is of no use."""
    defaults = default_settings()
    for name, value in changes.items():
        if name not in defaults:
            raise ValueError(f"unknown setting {name!r}; the settings are: {', '.join(defaults)}")
        most = None if isinstance(defaults[name], float) else 2**64 - 1 if name == "seed" else 2**32 - 1
        if not _is_number(value, most):
            kind = "a finite number" if most is None else f"a whole number from 0 to {most}"
            raise ValueError(f"setting {name} = {value!r} is not {kind}")
    # The core checks the ranges when an engine begins, on a triangle in no time.
    if sono := of_sono(changes):
        Tightener([np.eye(3)], "settle", 60, json.dumps(sono))
    if len(sono) < len(changes):
        Polish([np.eye(3)], 60, False, 0, of_polish(changes))


def whole(name: str, value: Any, least: int | None = None, most: int | None = None) -> int:
    """Return a whole number, in a range if there is one. Raises `ValueError`, which names the argument."""
    try:
        number = index(value)
    except TypeError:
        number = None
    if number is None or isinstance(value, bool):
        raise ValueError(f"{name} = {value!r} is no whole number")
    if (least is not None and number < least) or (most is not None and number > most):
        ends = f"of {least} at least" if most is None else f"from {least} to {most}"
        raise ValueError(f"{name} = {number} is no whole number {ends}")
    return number


def _is_number(value: object, most: int | None) -> bool:
    """Tell whether this is a finite number, or a whole one up to `most`."""
    if most is None:
        return isinstance(value, int | float) and abs(value) <= sys.float_info.max
    return isinstance(value, int) and not isinstance(value, bool) and 0 <= value <= most
