"""The ground floor: what a curve is, what it measures, and the forces in it.

Lengths are in the unit of the vertices, but for the ropelengths L_p, L_c and L_a, which are lengths over the
RADIUS of the rope. May import nothing of sono but the core, and what results have in common.
"""

import base64
import hashlib
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import TypeAlias, cast, overload

import numpy as np
from numpy.typing import ArrayLike, NDArray

from sono import _core
from sono.records import Drawn, Record

Floats: TypeAlias = NDArray[np.float64]

Components: TypeAlias = Sequence[Floats]
"""One (n_i, 3) array a component: the vertices of a closed polygon, the first not repeated at the end."""


@dataclass(frozen=True, eq=False, repr=False)
class Curve(Record, Drawn, Sequence[Floats]):
    """A closed polygon of one or more components: `components` are arrays (n_i, 3) that cannot be written to.

    It is made of an (n, 3) array, or of one such array for each component; a component's last vertex does not
    repeat its first. Raises `ValueError` for other shapes, fewer than 3 vertices, and numbers that are not
    finite. A curve can be used like the list of its components.

    >>> curve = Curve([[1, 0, 0], [0, 1, 0], [0, 0, 1]])
    >>> curve
    Curve(3 vertices)
    >>> [component.shape for component in curve], curve == Curve(curve)
    ([(3, 3)], True)
    """

    components: tuple[Floats, ...]

    def __init__(self, vertices: "CurveLike") -> None:
        """Copy the vertices."""
        components = tuple(as_components(vertices))
        for c, component in enumerate(components):
            if len(component) < 3:
                raise ValueError(
                    f"component {c} has {len(component)} vertices; a closed curve has 3 at least"
                )
            if len(wrong := np.flatnonzero(~np.isfinite(component).all(axis=1))):
                raise ValueError(f"vertex {wrong[0]} of component {c} is not finite")
            component.setflags(write=False)
        object.__setattr__(self, "components", components)

    @property
    def n(self) -> int:
        """The number of vertices, all components together."""
        return sum(map(len, self.components))

    def __len__(self) -> int:
        """Return the number of components."""
        return len(self.components)

    @overload
    def __getitem__(self, index: int) -> Floats: ...

    @overload
    def __getitem__(self, index: slice) -> tuple[Floats, ...]: ...

    def __getitem__(self, index: int | slice) -> Floats | tuple[Floats, ...]:
        """Return a component, (n_i, 3), or several."""
        return self.components[index]

    def __iter__(self) -> Iterator[Floats]:
        """Iterate over the components."""
        return iter(self.components)

    def __reduce__(self) -> tuple[type["Curve"], tuple[list[Floats]]]:
        """Be copied and pickled by the vertices."""
        return type(self), (list(self.components),)

    def _shown(self) -> list[tuple[str, str]]:
        sizes = " + ".join(map(str, map(len, self.components)))
        return [("vertices", sizes)]

    def __repr__(self) -> str:
        """Show how many vertices there are, by component."""
        return f"Curve({self._shown()[0][1]} vertices)"


CurveLike: TypeAlias = ArrayLike | Sequence[ArrayLike] | Curve
"""What a curve is made of: an (n, 3) array, a sequence of such arrays, or a curve."""


@dataclass(frozen=True, repr=False)
class Measures(Record):
    """What a curve of `n` vertices and so many `components` measures, at the scale it has.

    `dl` is the mean length of its edges and `dispersion` their largest deviation from it, in shares of it;
    `min_rad`, `sr` and `r_s` are MinRad, the sphere radius SR and R_s, the smaller of the two; `r_c`, None
    where R_s <= dl/sqrt 2, is the radius of the smooth tube round the inscribed knot K_P; `length` and
    `inscribed_length` are those of the polygon and of K_P. The ropelengths are `l_p` = length/r_s, `l_c` =
    inscribed_length/r_c, which bounds that of the smooth knot, and the weighted `l_a` = (4 l_p + l_c)/5.

    Source: J. Baranska, P. Pieranski, E. J. Rawdon, "Ropelength of tight polygonal knots", section 2.

    >>> import sono
    >>> m = sono.tighten("3_1", 120).measures
    >>> m.n, round(m.r_s, 9), m.l_p < m.l_a < m.l_c
    (120, 1.0, True)
    """

    n: int
    components: int
    dl: float
    dispersion: float
    min_rad: float
    sr: float
    r_s: float
    r_c: float | None
    length: float
    inscribed_length: float
    l_p: float
    l_c: float | None
    l_a: float | None

    @property
    def l_a_or_l_p(self) -> float:
        """L_a, or L_p where there is none: what ropes of one edge length are compared by."""
        return self.l_a or self.l_p


@dataclass(frozen=True, eq=False, repr=False)
class Forces(Record):
    """The forces in a rope of n beads and radius 1, in units of its mean tension.

    `tension` (n,) is that of the edge after each bead, `couple` (n,) that with which each bead withstands
    bending beyond the radius. The beads `contacts` (m, 2), counted through all components, press against each
    other with the forces `pressing` (m,). `sizes` are the numbers of beads of the components. `residual` is
    the largest coordinate of a force that is left over on a bead.

    >>> import sono
    >>> forces = sono.tighten("Hopf", 60).forces
    >>> len(forces.tension), forces.contacts.shape == forces.places.shape[:2], forces.residual < 1e-8
    (60, True, True)
    """

    tension: Floats
    couple: Floats
    contacts: NDArray[np.int64]
    pressing: Floats
    residual: float
    sizes: tuple[int, ...]

    @property
    def places(self) -> NDArray[np.int64]:
        """The contacts (m, 2, 2): for each of the two beads its component, and its place in that, from 0."""
        first = np.cumsum([0, *self.sizes])
        component = np.searchsorted(first, self.contacts, side="right") - 1
        return np.stack([component, self.contacts - first[component]], axis=-1)


def as_components(vertices: CurveLike) -> list[Floats]:
    """Return copies of the components, (n_i, 3) each, of what a curve is made of. Raises `ValueError`."""
    vertices = getattr(vertices, "curve", vertices)  # of what a tightening or a search gave
    if isinstance(vertices, Curve):
        vertices = list(vertices.components)
    try:
        whole = [np.array(vertices, dtype=np.float64)]
    except ValueError:  # components of unequal length
        whole = []
    if not whole or whole[0].ndim == 3:
        whole = [np.array(component, dtype=np.float64) for component in cast("Sequence[ArrayLike]", vertices)]
    for component in whole:
        if component.ndim != 2 or component.shape[1] != 3:
            raise ValueError(f"vertices must have the shape (n, 3), not {component.shape}")
    return whole


def measure(vertices: CurveLike) -> Measures:
    """Measure a curve at the scale it has.

    Raises `CurveError` for one that is no embedded closed curve. Definitions: Baranska, Pieranski, Rawdon,
    "Ropelength of tight polygonal knots", section 2; for unequal edges L_c stays an upper bound.

    >>> square = [[1, 1, 0], [-1, 1, 0], [-1, -1, 0], [1, -1, 0]]
    >>> m = measure(square)
    >>> m.n, m.dl, round(m.min_rad, 6), round(m.l_p, 6)
    (4, 2.0, 1.0, 8.0)
    """
    return Measures(**_core.measure(as_components(vertices)))


def forces(vertices: CurveLike) -> Forces:
    """Find the forces that come nearest to balance on a curve, scaled to R_s = 1.

    Beads at most 2.0001 apart may press against each other, those whose radius is within 0.1 % of R may
    withstand bending, and edges within 1 % of the longest may be in tension: a bead rope's edges are equal.
    Raises `CurveError` for a curve that is not embedded.
    """
    components = as_components(vertices)
    return forces_of(_core.balance(components), components)


def forces_of(found: tuple[Floats, Floats, NDArray[np.int64], Floats, float], curve: Components) -> Forces:
    """Take over the forces that the core has found in a curve."""
    for array in found[:4]:
        array.setflags(write=False)
    return Forces(*found, tuple(map(len, curve)))


def polygon(curve: Components) -> str:
    """Return what tells these vertices from others: the SHA-256 of them as little-endian doubles."""
    found = hashlib.sha256()
    for component in curve:
        found.update(component.astype("<f8").tobytes() + b"end of component")
    return found.hexdigest()


def packed(curve: Components | None) -> list[str] | None:
    """Return a curve as text, every bit kept, which takes a tenth of the time that digits would."""
    if curve is None:
        return None
    return [base64.b64encode(component.astype("<f8").tobytes()).decode() for component in curve]


def unpacked(texts: list[str] | None) -> list[Floats] | None:
    """Return the curve of `packed`. Raises `ValueError` for any other text."""
    if texts is None:
        return None
    flat = [np.frombuffer(base64.b64decode(text, validate=True), "<f8") for text in texts]
    return [component.reshape(-1, 3).astype(np.float64) for component in flat]
