"""A table in LaTeX that looks like the paper's."""

import re
from collections.abc import Sequence

from sono.tables.base import CAPTION, TableWriter, rounded
from sono.tables.columns import Row


class Latex(TableWriter):
    """The look of the paper's tables."""

    def _head(self) -> str:
        shape = "|" + "c|" * len(self._columns)
        return (
            f"% {CAPTION}\n\\begin{{tabular}}{{{shape}}}\n\\hline\n"
            f"{self._ampersands([column.latex for column in self._columns])}\\hline\n"
        )

    def _line(self, row: Row) -> str:
        return self._ampersands([_latex(rounded(row, column)) for column in self._columns])

    def _foot(self) -> str:
        return "\\hline\n\\end{tabular}\n"

    def _ampersands(self, cells: Sequence[str]) -> str:
        return f"{' & '.join(cells)} \\\\\n"


def _latex(text: str) -> str:
    commands = {"\\": r"\textbackslash{}", "~": r"\textasciitilde{}", "^": r"\textasciicircum{}"}
    return re.sub(r"[\\~^&%$#_{}]", lambda found: commands.get(found[0], "\\" + found[0]), text)
