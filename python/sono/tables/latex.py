"""A table in LaTeX: names of knots as they are typeset, numbers to the right; it needs no package.

>>> [typeset(name) for name in ("m8_20.n480", "11n_34", "3_1#m3_1", "T(2,-5)", "my rope")]
['$m8_{20}$', '$11n_{34}$', '$3_1\\\\#m3_1$', '$T(2,-5)$', 'my rope']
"""

import re
from collections.abc import Sequence

from sono.tables.base import CAPTION, TableWriter, plain, rounded
from sono.tables.columns import Row

KNOTS = ("knot", "other_knot")
"""Columns of names that are typeset."""

BOUNDS = ("certified", "sharp")
"""Columns of numbers that are texts, for their rounding."""

_PRIME = r"m?(?:\d+[an]?(?:\^\d+)?_\d+|L\d+[an]\d+(?:\{[\d,]+\})?|T\(-?\d+,-?\d+\))"


class Latex(TableWriter):
    """The look of the paper's tables; nothing is written of a table without rows."""

    _begun = False

    def header(self) -> None:
        """Wait for a row."""

    def row(self, row: Row) -> None:
        """Write one row, and before the first the head."""
        if not self._begun:
            self._begun = True
            super().header()
        super().row(row)

    def close(self) -> None:
        """Write the end of what was begun."""
        if self._begun:
            super().close()

    def _head(self) -> str:
        shape = "".join("r" if column.spec or column.key in BOUNDS else "l" for column in self._columns)
        return (
            f"% {CAPTION}\n\\begin{{tabular}}{{{shape}}}\n\\hline\n"
            f"{self._ampersands([column.latex for column in self._columns])}\\hline\n"
        )

    def _line(self, row: Row) -> str:
        cells = [rounded(row, column) for column in self._columns]
        return self._ampersands(
            [
                typeset(cell) if column.key in KNOTS else _latex(cell)
                for cell, column in zip(cells, self._columns, strict=True)
            ]
        )

    def _foot(self) -> str:
        return "\\hline\n\\end{tabular}\n"

    def _ampersands(self, cells: Sequence[str]) -> str:
        return f"{' & '.join(cells)} \\\\\n"


def typeset(name: str) -> str:
    """Return a name without what files add to it, as mathematics if it is of a table, a torus or a sum."""
    name = plain(name)
    if not re.fullmatch(rf"{_PRIME}(?:#{_PRIME})*", name):
        return _latex(name)
    indexed = re.sub(r"([_^])(\d{2,})", r"\1{\2}", name.replace("{", r"\{").replace("}", r"\}"))
    return f"${indexed}$".replace("#", r"\#")


def _latex(text: str) -> str:
    commands = {"\\": r"\textbackslash{}", "~": r"\textasciitilde{}", "^": r"\textasciicircum{}"}
    return re.sub(r"[\\~^&%$#_{}]", lambda found: commands.get(found[0], "\\" + found[0]), text)
