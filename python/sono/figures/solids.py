"""Ropes as solids that can be printed: tubes in millimetres, whose strands keep a gap.

A rope is laid along its inscribed knot K_P, on edges that are short enough for the tolerance, and scaled to
R_c = half the rope's diameter. Strands of this diameter would just touch; they are printed thinner by the
gap, which all of them then keep: `figures/tube.py` says why no tube meets itself or another.
"""

import math
from dataclasses import dataclass

import numpy as np

from sono import _core
from sono.curve import Components, Floats, measure
from sono.figures.tube import Mesh, sides_within, spacing_within, tube
from sono.records import Record

MOST = 5_000_000
"""Triangles of a solid; a file .stl of them has 250 MB."""

LONGEST = 0.2
"""Of the edges, in R_c: for the edges' sake R_c is less than the thickness by an eighth of its square."""

SLACK = 1.03
"""Of the longest edges, for unequal shares of components; the tolerance has room for it."""


@dataclass(frozen=True, eq=False, repr=False)
class Solid(Record):
    """A rope to be printed, in millimetres: a tube of this `radius` for each component.

    `size` are the edges of its bounding box, which has a corner at the origin, and `length` that of the rope.

    >>> import sono, tempfile, pathlib
    >>> path = pathlib.Path(tempfile.mkdtemp(), "trefoil.stl")
    >>> solid = sono.export(path, "3_1", rope_diameter=10, gap=1)
    >>> solid.radius, 160 < solid.length < 165, solid.components[0].faces.shape[1]
    (4.5, True, 3)
    """

    components: tuple[Mesh, ...]
    size: tuple[float, float, float]
    length: float
    radius: float

    @property
    def triangles(self) -> int:
        """How many triangles there are."""
        return sum(len(mesh.faces) for mesh in self.components)


def solid(curve: Components, diameter: float, gap: float, tolerance: float) -> Solid:
    """Lay a rope of this diameter along an embedded curve of any scale, its strands a gap apart.

    All three are in millimetres; no facet is further than the `tolerance` from the smooth tube. Raises
    `CurveError` for a curve that is not embedded, `ValueError` for lengths that make no rope, and where there
    would be more than `MOST` triangles.
    """
    check(diameter, gap, tolerance)
    radius = (diameter - gap) / 2
    sides = sides_within(radius, tolerance)
    line, r_c = _laid(curve, 2 * radius / diameter, 2 * tolerance / diameter, MOST // (2 * sides))
    scale = diameter / (2 * r_c)
    meshes = [tube(component * scale, radius, sides) for component in line]
    low = np.min([mesh.vertices.min(axis=0) for mesh in meshes], axis=0)
    meshes = [Mesh(mesh.vertices - low, mesh.faces) for mesh in meshes]
    x, y, z = np.max([mesh.vertices.max(axis=0) for mesh in meshes], axis=0).tolist()
    return Solid(tuple(meshes), (x, y, z), measure(line).inscribed_length * scale, radius)


def check(diameter: float, gap: float, tolerance: float) -> None:
    """Refuse lengths that make no rope. Raises `ValueError`."""
    for name, value in (("rope's diameter", diameter), ("tolerance", tolerance)):
        if not 0 < value < math.inf:
            raise ValueError(f"the {name} is {value:g} mm; give one above 0")
    if not 0 <= gap < diameter:
        raise ValueError(
            f"a gap of {gap:g} mm leaves nothing of a rope of {diameter:g} mm; give a smaller one"
        )


def _laid(curve: Components, radius: float, tolerance: float, most: int) -> tuple[list[Floats], float]:
    """Return K_P on edges that are short enough, and its R_c; radius and tolerance are shares of R_c."""
    line, measures = list(curve), measure(curve)
    longest = 0.0
    while measures.r_c is None or longest == 0 or measures.dl > SLACK * longest:
        r_c = measures.r_c or measures.r_s
        longest = spacing_within(radius * r_c, max(measures.min_rad, r_c), tolerance * r_c)
        longest = min(longest, LONGEST * r_c)
        length = measures.length  # K_P of a coarse curve may be almost as long as that
        n = max(math.ceil(length / longest), 12 * len(line))
        if n > most:
            cure = "tighten the curve, or give a wider tolerance"
            raise ValueError(
                f"the rope is {length / r_c:.3g} radii long, and takes over {MOST} triangles; {cure}"
            )
        line = _core.refine(curve, n)
        measures = measure(line)
    return line, measures.r_c
