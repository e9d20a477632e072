"""What a tightening may be told: its method, and SONO's settings by name."""

import json
import sys
from typing import Any, Literal, cast

import numpy as np

from sono import _core
from sono._core import Tightener

Method = Literal["both", "sono", "polish"]

MOST = 500_000
"""The largest n; the polish then takes 1 GB or more."""

LEAST_DL, MOST_DL = 0.01, 1.0
"""Edge lengths that may be asked for, in radii."""

TRIALS = 8
"""Trials of a run, unless the first few agree."""


def default_settings() -> dict[str, Any]:
    """Return SONO's settings by name: see `rust/settings.rs` or the README for what they mean."""
    return cast("dict[str, Any]", json.loads(_core.default_settings()))


def check_settings(settings: dict[str, Any]) -> None:
    """Raise `ValueError` for an unknown setting or a value that is of no use."""
    defaults = default_settings()
    for name, value in settings.items():
        if name not in defaults:
            raise ValueError(f"unknown setting {name!r}; the settings are: {', '.join(defaults)}")
        most = None if isinstance(defaults[name], float) else 2**64 - 1 if name == "seed" else 2**32 - 1
        if not _is_number(value, most):
            kind = "a finite number" if most is None else f"a whole number from 0 to {most}"
            raise ValueError(f"setting {name} = {value!r} is not {kind}")
    # The core checks the ranges when a stage begins, which on a triangle costs nothing.
    Tightener([np.eye(3)], "settle", 60, json.dumps(settings))


def _is_number(value: object, most: int | None) -> bool:
    """Tell whether this is a finite number, or a whole one up to `most`."""
    if most is None:
        return isinstance(value, int | float) and abs(value) <= sys.float_info.max
    return isinstance(value, int) and not isinstance(value, bool) and 0 <= value <= most
