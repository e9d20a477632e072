"""What results have in common: equality by value, plain dictionaries, and a look for notebooks."""

from dataclasses import fields, is_dataclass
from decimal import Decimal
from html import escape
from typing import Any, cast

import numpy as np

DIGITS = 9
"""Significant digits of a float that is shown to a reader."""


class Drawn:
    """A rope among results, which can be drawn."""

    def plot(self, *, axes: Any = None, beads: bool = False) -> Any:
        """Draw the rope as `sono.plot.knot` does, and return the axes. Needs the extra sono[plot]."""
        from sono import plot  # here, since results need no pictures

        return plot.knot(cast(Any, self), axes=axes, beads=beads)


class Record:
    """A frozen dataclass whose fields may be arrays, or other records.

    Records are equal if all their fields are, arrays by value. They can be copied and pickled, and are shown
    without their arrays, of which the shape must do.
    """

    def to_dict(self) -> dict[str, Any]:
        """Return the fields as plain values: numbers, texts, None, and lists and dictionaries of these."""
        return {field.name: _plain(getattr(self, field.name)) for field in fields(self)}  # type: ignore[arg-type]

    def __eq__(self, other: object) -> bool:
        """Compare all fields."""
        if type(other) is not type(self):
            return NotImplemented
        names = [field.name for field in fields(self)]  # type: ignore[arg-type]
        return all(_equal(getattr(self, name), getattr(other, name)) for name in names)

    __hash__ = None  # type: ignore[assignment]

    def __repr__(self) -> str:
        """Show the fields, each on a line of its own if there are many."""
        shown = [f"{name}={text}" for name, text in self._shown()]
        line = f"{type(self).__name__}({', '.join(shown)})"
        if len(line) <= 100:
            return line
        lines = "".join(f"\n{field}," for field in shown).replace("\n", "\n    ")
        return f"{type(self).__name__}({lines}\n)"

    def _repr_html_(self) -> str:
        """Show the fields as a table."""
        rows = "".join(
            f"<tr><th style='text-align:left'>{escape(name)}</th><td>{escape(text)}</td></tr>"
            for name, text in self._shown()
        )
        return f"<table><caption>{type(self).__name__}</caption>{rows}</table>"

    def _shown(self) -> list[tuple[str, str]]:
        return [(field.name, _short(getattr(self, field.name))) for field in fields(self)]  # type: ignore[arg-type]


def _plain(value: Any) -> Any:
    if isinstance(value, Record):
        return value.to_dict()
    if isinstance(value, np.ndarray | np.generic):
        return value.tolist()
    if isinstance(value, list | tuple):
        return [_plain(item) for item in value]
    return f"{value:f}" if isinstance(value, Decimal) else value


def _equal(one: Any, other: Any) -> bool:
    if isinstance(one, np.ndarray) or isinstance(other, np.ndarray):
        return np.array_equal(one, other)
    if isinstance(one, list | tuple) and type(one) is type(other):
        return len(one) == len(other) and all(map(_equal, one, other))
    return bool(one == other)


def _short(value: Any) -> str:
    if isinstance(value, float):
        return f"{value:.{DIGITS}g}"
    if isinstance(value, Decimal):
        return str(value)
    if isinstance(value, np.ndarray):
        return f"<array {' x '.join(map(str, value.shape))}>"
    if isinstance(value, list | tuple):
        return f"[{', '.join(map(_short, value))}]"
    return repr(value) if isinstance(value, Record) or not is_dataclass(value) else str(value)
