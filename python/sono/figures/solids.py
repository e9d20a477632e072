"""Ropes as solids that can be printed: tubes in millimetres, whose strands keep a gap.

A rope is laid along its inscribed knot K_P, on edges that are short enough for the tolerance, flat on the
bed (see `figures/bed.py`), and scaled to R_c = half the rope's diameter. Strands of this diameter would just
touch; they are printed thinner by the gap, which all of them then keep: `figures/tube.py` says why no tube
meets itself or another.
"""

import math
from dataclasses import dataclass

import numpy as np

from sono import _core
from sono.curve import Components, Floats, measure
from sono.figures.bed import flat
from sono.figures.lengths import Lengths
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

    `size` are the edges of its bounding box, the longest one first, but for the tolerance; the box has a
    corner at the origin. `diameter` is that of the rope, of which the gap is taken off, and `length` what it
    takes of such a rope: its ropelength L_a times half the diameter.

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
    diameter: float

    @property
    def triangles(self) -> int:
        """How many triangles there are."""
        return sum(len(mesh.faces) for mesh in self.components)


def solid(curve: Components, lengths: Lengths) -> Solid:
    """Lay a rope along an embedded curve of any scale, its strands a gap apart.

    No facet is further than the tolerance from the smooth tube. Raises `CurveError` for a curve that is not
    embedded, `ValueError` where the gap leaves nothing of the rope, and where there would be more than `MOST`
    triangles.
    """
    measures = measure(curve)
    about = lengths.of(_longest(curve, measures.r_c or measures.r_s)[1])
    line, r_c = _laid(curve, about, lengths)
    line, longest = _longest(line, r_c)
    diameter = lengths.of(longest)
    radius, scale = (diameter - lengths.gap) / 2, diameter / (2 * r_c)
    sides = sides_within(radius, lengths.tolerance)
    meshes = [tube(component * scale, radius, sides) for component in line]
    low = np.min([mesh.vertices.min(axis=0) for mesh in meshes], axis=0)
    meshes = [Mesh(mesh.vertices - low, mesh.faces) for mesh in meshes]
    x, y, z = np.max([mesh.vertices.max(axis=0) for mesh in meshes], axis=0).tolist()
    return Solid(tuple(meshes), (x, y, z), measure(line).l_a_or_l_p * diameter / 2, radius, diameter)


def _longest(line: Components, r_c: float) -> tuple[list[Floats], float]:
    """Lay a line flat; return it, and the longest edge of its box in R_c."""
    line = flat(line, r_c)
    return line, float(np.ptp(np.vstack(line), axis=0).max()) / r_c


def _laid(curve: Components, diameter: float, lengths: Lengths) -> tuple[list[Floats], float]:
    """Return K_P on edges that are short enough for a rope of about this diameter, and its R_c."""
    radius, tolerance = 1 - lengths.gap / diameter, 2 * lengths.tolerance / diameter  # in R_c
    most = MOST // (2 * sides_within(radius, tolerance))
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
