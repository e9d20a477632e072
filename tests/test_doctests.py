"""The examples in docstrings run."""

import doctest
import pkgutil
from importlib import import_module

import pytest

import sono
from sono import Progress

MODULES = ["sono", *(module.name for module in pkgutil.walk_packages(sono.__path__, "sono."))]


@pytest.mark.parametrize("name", [name for name in MODULES if name != "sono._core"])
def test_examples(name: str) -> None:
    assert doctest.testmod(import_module(name)).failed == 0


@pytest.mark.parametrize("name", sorted({*sono.__all__} - {"__version__"}))
def test_each_public_name_has_an_example(name: str) -> None:
    public = getattr(sono, name)
    if isinstance(public, type) and issubclass(public, Exception | Progress):
        return  # what is raised, and what is shown
    assert ">>> " in (public.__doc__ or "")
