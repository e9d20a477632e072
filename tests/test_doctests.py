"""The examples in docstrings run."""

import doctest
import pkgutil
from importlib import import_module

import pytest

import sono

MODULES = ["sono", *(module.name for module in pkgutil.walk_packages(sono.__path__, "sono."))]


@pytest.mark.parametrize("name", [name for name in MODULES if name != "sono._core"])
def test_examples(name: str) -> None:
    assert doctest.testmod(import_module(name)).failed == 0


@pytest.mark.parametrize("name", ["sono", "sono.calls", "sono.curve", "sono.model", "sono.starts.torus"])
def test_there_are_examples(name: str) -> None:
    assert doctest.testmod(import_module(name)).attempted > 0
