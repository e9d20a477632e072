"""What `sono plot` is given: ropes, or rows of tables."""

import sys
from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING, Any

from sono import tables
from sono.cli import options
from sono.cli.each import each, rope_of

if TYPE_CHECKING:
    from sono.formats import Close
    from sono.jobs.sources import Source
    from sono.tables import Row

MOST = 36
"""Ropes in one picture at most."""


class Pictured:
    """Reads what is `given`; what cannot be read is told and left out, and the exit `code` is then 1.

    Where nothing is left, the command ends there.
    """

    def __init__(self, given: Sequence[str], close: "Close | None", shown: options.Shown) -> None:
        """Read nothing yet."""
        self.given, self._close, self._shown, self.code = given, close, shown, 0

    def ropes(self) -> list[tuple[str, Any]]:
        """Return ropes, each with its name. Raises `FormatError` where there are too many."""
        from sono.formats import FormatError
        from sono.jobs.curvefiles import measures_of

        found: list[tuple[str, Any]] = []

        def take(source: "Source") -> None:
            curve = rope_of(source)
            measures_of(curve)  # which says in which line a curve is wrong
            for doubt in curve.doubts():
                self._shown.tell(doubt)
            found.append((source.name, curve.components))

        self.code = each(self.given, self._close, take)
        if not found:
            sys.exit(self.code)
        if len(found) > MOST:
            cure = "FILE:KEY is one curve of a file"
            raise FormatError(f"these are {len(found)} ropes, and a picture shows {MOST} at most; {cure}")
        return found

    def rows(self) -> "list[Row]":
        """Return the rows of tables. Raises `FormatError` where there are none."""
        return self._rows(tables.read)

    def points(self) -> "list[Row]":
        """Return rows of one knot, with n and L_p: those of tables, and what curves measure.

        Raises `FormatError` where there are none, or they are of several knots.
        """
        from sono import starts
        from sono.formats import FormatError
        from sono.tables import published

        rows = self._rows(self._measured)
        self._refuse_without(rows, "n", "L_p", "`sono measure` writes both")
        names = {published.name_of(row["knot"]): published.type_of(row["knot"]) for row in rows}
        types = {type: name for name, type in names.items() if starts.knows(name)}
        if len(types) > 1:
            raise FormatError(f"the rows are of {' and '.join(types.values())}; give those of one knot")
        return rows

    def searches(self) -> "dict[str, list[Row]]":
        """Return the rows of searches by their knots, likewise."""
        rows = self.rows()
        self._refuse_without(rows, "hits", "L_a", "`sono search` writes both")
        knots: dict[str, list[Row]] = {}
        for row in rows:
            knots.setdefault(str(row["knot"]), []).append(row)
        return knots

    def _refuse_without(self, rows: "list[Row]", one: str, other: str, cure: str) -> None:
        """Raise `FormatError` for a row that has not both columns."""
        from sono.formats import FormatError

        values = [row.get(tables.key_of(column)) for row in rows for column in (one, other)]
        if not all(isinstance(value, int | float) and value > 0 for value in values):
            raise FormatError(f"{' '.join(self.given)}: a row has no {one} or no {other}; {cure}")

    def _rows(self, read: "Callable[[str], list[Row]]") -> "list[Row]":
        from sono.formats import FormatError

        found: list[Row] = []
        for one in self.given:
            try:
                found += read(one)
            except FormatError as error:
                self.code = 1
                options.complain(str(error))
        if not found and self.code:
            sys.exit(self.code)
        if not found:
            raise FormatError(f"{' '.join(self.given)}: there is no row in it; nothing is drawn")
        return found

    def _measured(self, one: str) -> "list[Row]":
        """Return the rows of a table, or what the curves of a file, or a rope of the atlas, measure."""
        from sono import formats
        from sono.jobs.curvefiles import measures_of
        from sono.jobs.sources import Source, is_name

        if is_name(one) or formats.split(one)[1] is not None:
            curves = [rope_of(Source(one, self._close))]
        else:
            name, data = formats.load(one)
            if tables.recognises(data):
                return tables.parse(name, data)
            curves = formats.parse(name, data, self._close)
        return [{"knot": Source(one).name, **measures_of(curve).to_dict()} for curve in curves]
