"""What every job gives: rows, and what the user should hear."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any, TypeAlias

from sono.curve import Components, Measures
from sono.shape import descriptors
from sono.tables import Row

Show: TypeAlias = Callable[[float, str], None]
"""Is told how far a job is, from 0 to 1, and what it does; it may raise `Stopped`."""


@dataclass(frozen=True)
class Result:
    """A row of the table, if there is one, and what the user should hear: `trouble`, or else a `note`.

    `trouble` is None if all that was asked for was done.
    """

    row: Row | None
    trouble: str | None = None
    note: str | None = None


def as_row(name: str, file: str | None, measures: Measures, **more: Any) -> Row:
    """Make a row of the table."""
    return {"knot": name, "file": file, **measures.to_dict(), **more}


def shape_of(curve: Components, rings: bool | Sequence[bool] = True) -> dict[str, Any]:
    """Return the descriptors of a curve as a row has them; not all need be `rings`. Raises `CurveError`."""
    found = descriptors(curve, rings).to_dict()
    eigenvalues = enumerate(found.pop("gyration"), 1)
    return found | {f"gyration_{k}": value for k, value in eigenvalues}
