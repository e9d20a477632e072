"""How large a rope is printed: lengths in millimetres."""

import math
from dataclasses import dataclass

import numpy as np

DIAMETER, GAP, TOLERANCE = 6.0, 0.4, 0.02
"""In millimetres, where nothing else is said: a nozzle is 0.4 wide, a layer 0.1 to 0.2 high."""


@dataclass(frozen=True)
class Lengths:
    """How large a print is, in millimetres: by the rope's diameter, or by its longest side, the size."""

    diameter: float | None = None
    size: float | None = None
    gap: float = GAP
    tolerance: float = TOLERANCE

    def __post_init__(self) -> None:
        """Refuse lengths that make no rope. Raises `ValueError`."""
        if self.diameter is not None and self.size is not None:
            raise ValueError("the rope's diameter and the size of the print tell the scale both; give one")
        scale = {"rope's diameter": self.diameter, "size": self.size, "tolerance": self.tolerance}
        for name, value in scale.items():
            if value is not None and not 0 < _number(name, value) < math.inf:
                raise ValueError(f"the {name} is {value:g} mm; give one above 0")
        if not 0 <= _number("gap", self.gap) < math.inf:
            raise ValueError(f"the gap is {self.gap:g} mm; give 0 or more")
        if self.size is None:
            self.of(1)

    def of(self, longest: float) -> float:
        """Return the rope's diameter on a line whose box has this longest edge, in R_c.

        The tube is wider than the line by its own diameter, that of the rope less the gap. Raises
        `ValueError` where the gap leaves nothing.

        >>> round(Lengths(size=80).of(8), 2), Lengths().of(8)
        (16.08, 6.0)
        """
        diameter = DIAMETER if self.diameter is None else self.diameter
        if self.size is not None:
            diameter = (self.size + self.gap) / (1 + longest / 2)
        if self.gap >= diameter:
            rope = f"a gap of {self.gap:g} mm leaves nothing of a rope of {diameter:.3g} mm"
            raise ValueError(f"{rope}; give a smaller one")
        return diameter


def _number(name: str, value: object) -> float:
    if isinstance(value, bool) or not isinstance(value, int | float | np.number):
        raise ValueError(f"the {name} is {value!r}; give a number of millimetres, such as 6")
    return float(value)
