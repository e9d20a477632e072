"""Plots of ropes and of tables, drawn on axes of matplotlib; an extra, `pip install 'sono[plot]'`.

Each takes the `axes` to draw on, or makes new ones with pyplot, and returns them. Colours are those of
matplotlib's settings; `with sono.plot.style("light"):` has those of a paper's column, "dark" of a black page.
Lengths are in radii of the rope, ropelengths are lengths over the RADIUS. A curve may have any scale; a name
stands for the atlas's rope of the knot, and raises `ValueError` where there is none. A curve that is not
embedded raises `CurveError`. Without matplotlib all raise `ImportError`.

>>> import sono
>>> with sono.plot.style("light"):
...     axes = sono.plot.curvature("3_1")
>>> axes.get_xlabel(), axes.get_ylabel()
('arclength / R', 'curvature, torsion · R')
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any, TypeAlias, cast

from sono.calls import Rope, measure, rope_of
from sono.curve import Components, Forces, Measures
from sono.curve import forces as fitted
from sono.figures.plot import atlas as _atlas
from sono.figures.plot import contacts as _contacts
from sono.figures.plot import convergence as _convergence
from sono.figures.plot import curvature as _curvature
from sono.figures.plot import knot as _knot
from sono.figures.plot import minima as _minima
from sono.figures.plot import toroidal
from sono.figures.plot.sheet import given, style
from sono.searching.minima import Minimum
from sono.tables import Row

if TYPE_CHECKING:
    from matplotlib.axes import Axes

__all__ = ["atlas", "contacts", "convergence", "curvature", "knot", "minima", "model", "style"]

Point: TypeAlias = "Rope | Measures | Row"
"""A rope, what it measures, or a row of a table."""


def knot(*ropes: Rope, axes: Axes | None = None, beads: bool = False, labels: Sequence[str] = ()) -> Axes:
    """Draw ropes side by side on one scale, with their `labels`: smooth tubes, or their `beads`.

    A tube has the inscribed knot K_P as its axis and the radius R_c, so that it fits into the bead rope. One
    looks at it along its shortest principal axis. Raises `ValueError` for labels that are not as many.

    >>> import sono
    >>> axes = sono.plot.knot("Hopf", labels=["Hopf link"])
    >>> len(axes.images), axes.texts[0].get_text()
    (1, 'Hopf link')
    """
    if not ropes or len(labels) not in (0, len(ropes)):
        raise ValueError("give one rope at least, and as many labels, or none")
    axes = given(axes)
    _knot.draw([_scaled(rope) for rope in ropes], labels or [""] * len(ropes), beads, axes)
    return axes


def convergence(points: Sequence[Point], /, *, axes: Axes | None = None) -> Axes:
    """Draw L_p, L_c and L_a of one knot against dl/R, with fits L_infinity + b dl + c dl^2.

    The points are ropes, their measures, or rows with n, l_p, l_c and l_a. The legend has L_infinity of each
    with its standard error. Raises `ValueError` for less than three lengths of edges. Source: J. Baranska,
    P. Pieranski, E. J. Rawdon, "Ropelength of tight polygonal knots", where the trefoil is so drawn.

    >>> import sono
    >>> axes = sono.plot.convergence([sono.tighten("3_1", n) for n in (60, 90, 120)])
    >>> axes.get_xlabel(), len(axes.get_legend().get_texts())
    ('edge length $dl$ / R', 3)
    """
    axes = given(axes)
    _convergence.draw([_row(point) for point in points], axes)
    return axes


def contacts(rope: Rope, /, *, axes: Axes | None = None) -> Axes:
    """Draw a map of the contact forces in a rope, arclength against arclength, both from 0 and in radii.

    Forces, in units of the mean tension, are colours and sizes. They are those of a tightened rope, or fitted
    to the curve. Lines tell the components apart.

    >>> import sono
    >>> axes = sono.plot.contacts(sono.tighten("Hopf", 60))
    >>> [round(float(end)) for end in axes.get_xlim()]
    [0, 25]
    """
    axes = given(axes)
    components = _scaled(rope)
    forces: Forces | None = getattr(rope, "forces", None)
    _contacts.draw(components, forces or fitted(components), axes)
    return axes


def curvature(rope: Rope, /, *, axes: Axes | None = None) -> Axes:
    """Draw curvature and torsion along a rope, both times R, against arclength in radii.

    Curvature is 1/Rad, that of the arcs inscribed into the corners, and has a line at 1, the most that a
    rope can have. Torsion is the angle from one corner's plane to the next one's over the edge between them,
    positive for right-handed helices, and left out where the rope is straight.

    >>> import sono
    >>> axes = sono.plot.curvature("Hopf")
    >>> [line.get_label() for line in axes.get_lines()][1:4]
    ['1/R', 'torsion', 'curvature']
    """
    axes = given(axes)
    _curvature.draw(_scaled(rope), axes)
    return axes


def model(*, axes: Sequence[Axes] | None = None) -> Sequence[Axes]:
    """Draw the toroidal model on two axes: deviations of dL_p, dL_c and dL_a from dL, and the weight a.

    Source: J. Baranska, P. Pieranski, E. J. Rawdon, "Ropelength of tight polygonal knots"; see `sono.model`.

    >>> import sono
    >>> deviations, weight = sono.plot.model()
    >>> weight.get_ylabel()
    'weight $a$'
    """
    pair: Sequence[Axes] = given(axes, 2)
    toroidal.deviations(pair[0])
    toroidal.weight(pair[1])
    return pair


def minima(found: Sequence[Minimum | Row], /, knot: str | None = None, *, axes: Axes | None = None) -> Axes:
    """Draw the minima of a search: L_a, and in how many trials each was met.

    They are what `sono.search` gave, or rows with l_a and hits. With the name of the `knot` the shortest
    published ropelength is a line.

    >>> import sono
    >>> axes = sono.plot.minima(sono.search("3_1", trials=1), "3_1")
    >>> axes.get_ylabel()
    'trials that met it'
    """
    from sono.tables import published

    axes = given(axes)
    bound = published.beside({"knot": knot}, published.table())["published"] if knot else None
    _minima.draw([_row(minimum) for minimum in found], cast("float | None", bound), axes)
    return axes


def atlas(rows: Sequence[Row] | None = None, *, axes: Sequence[Axes] | None = None) -> Sequence[Axes]:
    """Draw the atlas's rows, or others, on two axes: L_a against crossing number, and less what is published.

    >>> import sono
    >>> lengths, differences = sono.plot.atlas()
    >>> lengths.get_ylabel()
    '$L_a$ (length / radius)'
    """
    pair: Sequence[Axes] = given(axes, 2)
    rows = _atlas.rows() if rows is None else rows
    _atlas.lengths(rows, pair[0])
    _atlas.differences(rows, pair[1])
    return pair


def _row(point: Any) -> Row:
    """Return what a rope measures as a row, or a row as it is."""
    if isinstance(point, Mapping):
        return point
    plain = point.to_dict() if isinstance(point, Minimum | Measures) else measure(rope_of(point)).to_dict()
    return cast("Row", plain)


def _scaled(rope: Rope) -> Components:
    """Return the components of a rope at R_s = 1, likewise."""
    components = rope_of(rope)
    r_s = measure(components).r_s
    return [component / r_s for component in components]
