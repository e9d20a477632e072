"""The compiled core: arrays in, arrays and plain values out, the interpreter released while it works.

Components are a list of (n_i, 3) float64 arrays, one for each closed component, vertex after vertex.
Lengths are in the unit of the vertices, unless R = 1 is said: then the rope has radius 1. Ropelength is
length over radius. A curve that cannot be used raises `CurveError`, any other bad argument `ValueError`,
a bug of the core `PanicError`.
"""

from collections.abc import Sequence
from typing import Any, Literal, TypeAlias, TypedDict, final

import numpy as np
from numpy.typing import NDArray

__all__ = [
    "Collapse",
    "CurveError",
    "PanicError",
    "Polish",
    "Tightener",
    "about",
    "balance",
    "certify",
    "crossings",
    "default_polish_settings",
    "default_settings",
    "determinant",
    "homfly",
    "loosen",
    "measure",
    "meeting",
    "pieces",
    "refine",
    "shortened",
    "simplify",
    "writhe",
]

_Curve: TypeAlias = Sequence[NDArray[np.float64]]
_Components: TypeAlias = list[NDArray[np.float64]]
_Gauss: TypeAlias = tuple[list[list[int]], list[bool]]
"""A diagram: for each component the crossings that it passes, from 1, negative where it does so below, and
for each crossing whether it is right-handed. Any other code raises `ValueError`."""

_Outcome: TypeAlias = Literal["running", "tight", "stuck"]
_Stage: TypeAlias = Literal["loosen", "collapse", "anneal", "reanneal", "settle"]
_Forces: TypeAlias = tuple[
    NDArray[np.float64], NDArray[np.float64], NDArray[np.int64], NDArray[np.float64], float
]
"""Of a rope of radius 1 and n beads with k contacts, in units of its mean tension.

Tension of the edge after each bead (n,), couple of each bead (n,), beads in contact (k, 2), with which
force each pair presses (k,), and the largest coordinate of what is left over on a bead.
"""

_Measures: TypeAlias = dict[str, Any]
"""What a curve measures, in its own unit: the fields of `sono.curve.Measures`, which says what they are."""

class _Bound(TypedDict):
    """What is proven of a curve, in the unit of its vertices; the type has no class at run time."""

    longest_edge: float
    """At least S."""
    min_rad: float
    """At most the least M_c."""
    r: float
    """At most the largest R that has the theorem's first two conditions; it has all three."""
    r_c: float
    """At most sqrt(R^2 - S^2/4)."""
    inscribed_length: float
    """At least Length(K_P)."""
    l_c: float
    """At least Length(K_P)/R_c."""
    condition: Literal["bend", "pair"]
    """What decides R: the bend at one vertex, or the distance of two."""
    vertices: list[tuple[int, int]]
    """These, as (component, vertex), both counted from 0."""

class CurveError(ValueError):
    """A curve that cannot be used, and the places: (component, vertex), vertex None for a whole component.

    Both count from 0. `needed` is the least n that will do, None where no n will.
    """

    places: Sequence[tuple[int, int | None]]
    needed: int | None

class PanicError(RuntimeError):
    """The core came upon a bug of its own. What it worked on is lost, and nothing else."""

class _Status(TypedDict):
    """Where SONO stands; the type has no class at run time."""

    outcome: _Outcome
    stage: _Stage
    progress: float
    """Share of the planned sweeps done; 0 while loosening and collapsing."""
    sweeps: int
    lost: int
    """Sweeps that were undone because a strand might have passed another."""
    moves: int
    """Moves, each of many sweeps, that were shown to let no strand pass."""
    undone: int
    """Those that were not, and were undone."""
    margin: float | None
    """The least ratio of the distance of beads that count to the longest edge over sqrt 2, of those shown."""
    epsilon: float
    """Overshoot of RO at this moment, R = 1."""
    overlap: float
    """Largest overlap of two beads that the last sweep met, R = 1."""
    dispersion: float
    """Largest |dl/s_i - 1| that it met."""
    best: _Measures
    """Of the best state so far, R_s = 1."""

class _PolishStatus(TypedDict):
    """Where a `Polish` stands; the type has no class at run time."""

    outcome: _Outcome
    progress: float
    """From 0 to 1 with the logarithm of mu."""
    iterations: int
    """Newton steps."""
    factorisations: int
    moves: int
    """Steps that were shown to let no strand pass."""
    undone: int
    """Those that were not, and were not made."""
    margin: float | None
    """As SONO's."""
    residual: float
    """Largest force left over on a bead or, on average, on an edge; tension is about 1."""
    mu: float
    """Barrier parameter: each constraint's product of multiplier and slack."""
    excess: float
    """Sum of these products: in balance, at most by so much the length exceeds the local minimum, R = 1."""
    best: _Measures
    """Of the best state so far, R_s = 1."""

@final
class Collapse:
    """From any embedded curve to a jammed rope; a thin one is loosened first, unless it was before."""

    def __new__(cls, components: _Curve, loosened: bool, settings: str) -> Collapse:
        """Begin; `loosened` says that the curve was loosened before, `settings` is JSON.

        Raises `CurveError` where edges meet or, if `loosened`, strands are too close for a rope.
        """

    def advance(self, seconds: float) -> _Status:
        """Work for about so long, unless done before. Raises `CurveError` where it cannot be loosened."""

    def status(self) -> _Status:
        """Return where it stands."""

    def loosened(self) -> _Components | None:
        """Return the loosened curve, None unless it had to be loosened."""

    def loosening(self) -> dict[str, Any] | None:
        """Return how many vertices loosening `moved` and `removed`, None unless it had to be loosened.

        Other counts are those of the collapse before, which had jammed far too long, if there was one.
        """

    def best(self) -> _Components:
        """Return the shortest rope so far, its R_s = 1, its centre at the origin."""

    def state(self) -> str:
        """Return all that is needed to go on later, as JSON."""

    @staticmethod
    def restore(state: str) -> Collapse:
        """Go on from a state. Raises `ValueError` if it is none."""

@final
class Tightener:
    """One stage of SONO on a rope."""

    def __new__(
        cls,
        components: _Curve,
        stage: Literal["anneal", "reanneal", "settle"],
        n: int,
        settings: str,
    ) -> Tightener:
        """Begin with a rope, of any unit, on `n` vertices in all; `settings` is JSON.

        Raises `CurveError` where `n` is too small.
        """

    def advance(self, seconds: float) -> _Status:
        """Work for about so long, unless done before."""

    def status(self) -> _Status:
        """Return where it stands."""

    def best(self) -> _Components:
        """Return the best rope so far, its R_s = 1, its centre at the origin."""

    def state(self) -> str:
        """Return all that is needed to go on later, as JSON."""

    @staticmethod
    def restore(state: str) -> Tightener:
        """Go on from a state. Raises `ValueError` if it is none."""

@final
class Polish:
    """The polish of a rope."""

    def __new__(cls, components: _Curve, n: int, passing: bool, seed: int, settings: str = "{}") -> Polish:
        """Begin with any embedded curve, on `n` vertices in all.

        If it is only `passing` this n, it ends when the rope is worth refining; `seed` places the first
        vertex, `settings` is JSON. Raises `CurveError` where edges meet, strands are too close, or `n` is
        too small.
        """

    def advance(self, seconds: float) -> _PolishStatus:
        """Work for about so long, unless done before."""

    def status(self) -> _PolishStatus:
        """Return where it stands."""

    def best(self) -> _Components:
        """Return the best rope so far, its R_s = 1, its centre at the origin."""

    def forces(self) -> _Forces:
        """Return the forces in the rope as it is."""

    def state(self) -> str:
        """Return all that is needed to go on later, as JSON."""

    @staticmethod
    def restore(state: str) -> Polish:
        """Go on from a state. Raises `ValueError` if it is none."""

def about() -> tuple[str, str, str, list[str]]:
    """Return the version, release or debug, the kind of processor, and which wide arithmetic it has."""

def balance(components: _Curve) -> _Forces:
    """Return the forces that come nearest to balance on a curve, by non-negative least squares.

    The curve is scaled to R_s = 1; the residual is 0 for a critical point of length. Raises `CurveError`
    where edges meet.
    """

def certify(components: _Curve) -> _Bound:
    """Bound the ropelength of a curve's type from above, however numbers are rounded.

    Raises `CurveError` where nothing is proven.
    """

def measure(components: _Curve) -> _Measures:
    """Return what a curve measures. Raises `CurveError` where edges meet."""

def meeting(gauss: _Gauss, others: Sequence[_Gauss], most: int) -> int | None:
    """Return which of others moves make of a connected diagram, of at most 62 crossings.

    None if this is not seen on `most` diagrams on either side. All components may be reversed together.
    """

def pieces(gauss: _Gauss, most: int) -> list[list[_Gauss]]:
    """Return the prime summands of each piece of a link that is apart; an unknot has none.

    Some may not be prime: up to `most` diagrams of the same size are looked through for fewer crossings.
    """

def refine(components: _Curve, n: int) -> _Components:
    """Return the inscribed knot at `n` vertices, all chords of a component equal.

    Raises `CurveError` where edges meet, and for fewer than 3 vertices a component.
    """

def default_settings() -> str:
    """Return the settings that SONO has unless told otherwise, as JSON."""

def default_polish_settings() -> str:
    """Return the settings that the polish has unless told otherwise, as JSON."""

def crossings(
    components: _Curve, most: int
) -> tuple[NDArray[np.float64], NDArray[np.float64], NDArray[np.bool_]]:
    """Return the k crossings seen along the z axis from above; of more than `most`, only some.

    Three arrays (k,): the places of the upper and of the lower strand, in edges from the first vertex,
    and whether the crossing is right-handed. No two vertices may be seen in one place, as after
    `simplify`.
    """

def determinant(n: int, entries: list[tuple[int, int, int]]) -> int:
    """Return the determinant of an n x n matrix modulo the prime 2147482951.

    Entries are (row, column, value >= 0); those in one place add up. Raises `ValueError` for one outside.
    """

def homfly(gauss: _Gauss, most: int) -> list[tuple[int, int, int]] | None:
    """Return the HOMFLY polynomial: powers of alpha and z, and the coefficients that are not 0.

    None if it takes over `most` diagrams. alpha P(right-handed) - P(left-handed)/alpha = z P(smoothed).
    """

def loosen(components: _Curve) -> _Components:
    """Return a curve of the same type that holds a thick rope, by exact isotopy.

    Raises `CurveError` where edges meet, or over 20,000 crossings are left.
    """

def shortened(gauss: _Gauss) -> _Gauss:
    """Return the diagram after strands above all others, or below, have been laid as short as they get.

    Components stay in order and oriented as they were.
    """

def simplify(components: _Curve) -> _Components:
    """Return the same curve with as few vertices as triangle moves leave, by exact isotopy.

    Raises `CurveError` where edges meet.
    """

def writhe(components: _Curve) -> tuple[float, float, float]:
    """Return means over all directions of what is seen, in a time that grows with n^2.

    The sum of the signs of the crossings of components with themselves, with each other, and the number of
    all crossings. Raises `CurveError` where edges meet.
    """
