"""What shows ropes in the round: `sono.view`."""

from __future__ import annotations

from collections.abc import Iterator, Mapping

from sono.calls import Rope, rope_of
from sono.curve import CurveLike
from sono.figures.view import View, shown


def view(*ropes: Rope | Mapping[str, Rope], title: str | None = None) -> View:
    """Show ropes in the round, on a page of their own or in a notebook.

    A name stands for the atlas's rope of the knot. Of several ropes, each by itself or by its name in a
    dictionary, such as `read_all` gives, one is shown at a time. Raises `CurveError` for a curve that is not
    embedded, `ValueError` for a name of which the atlas has no rope.

    >>> import tempfile, pathlib
    >>> path = pathlib.Path(tempfile.mkdtemp(), "trefoil.html")
    >>> view("3_1").save(path)
    >>> path.stat().st_size < 60_000
    True
    """
    pairs = [pair for rope in ropes for pair in _named(rope)]
    if not pairs:
        raise ValueError("give a rope to be shown")
    return shown(pairs, title)


def _named(rope: Rope | Mapping[str, Rope]) -> Iterator[tuple[str, CurveLike]]:
    """Give ropes and their names, which may be empty."""
    if isinstance(rope, Mapping):
        for name, one in rope.items():
            yield name, next(_named(one))[1]
    else:
        yield rope if isinstance(rope, str) else "", rope_of(rope)
