"""What shows ropes in the round: `sono.view` on a page, `sono.export` as a print. Plots are in `plot`."""

from __future__ import annotations

import os
from collections.abc import Iterator, Mapping

from sono.calls import Rope, rope_of
from sono.curve import CurveLike
from sono.figures import solidfiles
from sono.figures.lengths import GAP, TOLERANCE, Lengths
from sono.figures.solids import Solid, solid
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


def export(
    path: str | os.PathLike[str],
    rope: Rope,
    *,
    rope_diameter: float | None = None,
    size: float | None = None,
    gap: float = GAP,
    tolerance: float = TOLERANCE,
) -> Solid:
    """Write a rope as closed tubes, to be printed: .stl, .obj, .ply, .glb or .3mf; return them.

    A name stands for the atlas's rope of the knot. Lengths are in millimetres. The rope is laid along the
    inscribed knot K_P of the curve, so that strands of `rope_diameter` just touch, 6 mm if nothing else is
    said, or so that the longest side of the print is its `size`. It is printed thinner by the `gap`, which
    strands then keep, and lies flat. No facet is further than the `tolerance` from the smooth tube.

    Raises `FormatError`, a `ValueError`, for another suffix, where the file cannot be written, and where
    trimesh is missing, which comes with sono[mesh]; `CurveError` for a curve that is not embedded;
    `ValueError` for other lengths, for both a diameter and a size, and for a name of which the atlas has no
    rope.

    >>> import tempfile, pathlib
    >>> path = pathlib.Path(tempfile.mkdtemp(), "hopf.3mf")
    >>> solid = export(path, "Hopf", rope_diameter=5)
    >>> path.exists(), len(solid.components), round(solid.radius, 3)
    (True, 2, 2.3)
    >>> round(max(export(path, "Hopf", size=80).size), 1)
    80.0
    """
    format = solidfiles.by_suffix(os.fspath(path))
    lengths = Lengths(rope_diameter, size, gap, tolerance)
    made = solid(rope_of(rope), lengths)
    solidfiles.write(os.fspath(path), made, format)
    return made


def _named(rope: Rope | Mapping[str, Rope]) -> Iterator[tuple[str, CurveLike]]:
    """Give ropes and their names, which may be empty."""
    if isinstance(rope, Mapping):
        for name, one in rope.items():
            yield name, next(_named(one))[1]
    else:
        yield rope if isinstance(rope, str) else "", rope_of(rope)
