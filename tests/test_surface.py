"""What 1.x keeps: who changes a name, an option, a column or a field sees it here, and in `surface.txt`."""

import click
import make_surface
import pytest


def test_the_surface_is_what_it_was() -> None:
    before, now = (set(text.splitlines()) for text in (make_surface.PAGE.read_text(), make_surface.surface()))
    told = "if that is meant, and docs/stability.md allows it: python -m tests.make_surface"
    assert (sorted(before - now), sorted(now - before)) == ([], []), told


def test_no_line_is_there_twice() -> None:
    lines = [line for line in make_surface.surface().splitlines() if line]
    assert len(lines) == len({*lines})


@pytest.mark.parametrize(
    ("param", "line"),
    [
        (click.Option(["-n", "--number"], type=int), "-n/--number <integer>"),
        (click.Option(["--way"], type=click.Choice(["a", "b"]), required=True), "--way <a|b> required"),
        (click.Option(["--all"], is_flag=True), "--all"),
        (click.Option(["--gap"], default=0.5), "--gap <float> [0.5]"),
        (click.Option(["--set"], multiple=True), "--set <text> repeatable"),
    ],
)
def test_options(param: click.Option, line: str) -> None:
    assert make_surface.parameter(param) == line


def test_fields_of_json() -> None:
    node = {
        "properties": {"a": {"type": "array", "items": {"properties": {"b": {"const": 1}}}}},
        "required": ["a"],
    }
    assert list(make_surface.fields("x", node)) == ['x.a: "array"', "x.a[].b?: 1"]


def test_members_of_a_class() -> None:
    class Thing:
        size: int = 3
        _hidden: int = 4

        @property
        def half(self) -> float:
            return self.size / 2

        @classmethod
        def of(cls) -> "Thing":
            return cls()

        def grow(self, by: int = 1) -> None:
            self.size += by

    lines = [line for _, line in make_surface.members(Thing)]
    assert lines == ["size: int = ...", "half: float", "grow(self, by: int=1) -> None"]
