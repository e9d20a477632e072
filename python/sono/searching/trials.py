"""What the workers of a search do: make a trial, refine a shape, finish a minimum, seat its beads anew.

All are pure functions of a source and the number of its variant, so they may run in threads or on other
machines.
"""

import math
from collections.abc import Callable
from contextlib import suppress
from dataclasses import dataclass, replace
from typing import Self, TypeAlias

from sono import starts
from sono._core import Collapse, PanicError, Polish
from sono.curve import Components, Curve
from sono.invariants import Fingerprint, TooEntangledError, fingerprint
from sono.searching.minima import Minimum, Shape, has_edges, radii_of_gyration, rank
from sono.starts.scramble import scramble
from sono.tightening import polished
from sono.tightening.engines import done, status_of
from sono.tightening.trial import Recipe, Trial

FINE_EDGE = 0.2
"""Edge length at which minima are compared."""

SEATINGS = ((1.5, 1), (2, 2))
"""Ways to seat the beads of a minimum anew: on so many times its vertices, from such an offset, and back."""

POLISHES = 3
"""Attempts to polish a shape on edges of that length, as its own length changes meanwhile."""

GENTLE_ANNEAL = {"anneal_sweeps": 4_000, "anneal_tolerance": 0.1}

WARM_ANNEAL = {"anneal_sweeps": 12_000, "anneal_tolerance": 0.3}

WARM = 4
"""The anneals of trials, of which one in so many is warm. A gentle one leaves a shape that is near the start,
a warm one crosses barriers. One of 100,000 sweeps at 0.5 leads to the shortest shape half again as often as a
gentle one, but costs as much as five whole trials."""

ANNEAL_EDGES = (0.8, 1.2)
"""Edges of the anneal, of other lengths each time: the coarser, the higher the barriers that it crosses."""

MOST_BEADS = 10_000
"""Beads up to which a trial goes on. A thin start may jam at once; the rest is hours."""

FAILURES = (ValueError, PanicError)
"""What ends a trial, or the refining of a shape, and nothing else: a `CurveError`, a curve that no scramble
can be made of, a bug in the core."""


Watch: TypeAlias = Callable[[], None]
"""Called about ten times a second; whatever it raises stops the work."""


def unwatched() -> None:
    """Let the work go on."""


@dataclass(frozen=True, eq=False)
class Source:
    """A knot to search: its `type`, a `curve` of it, and its `name` if the library has variants of that."""

    name: str | None
    curve: Components
    type: Fingerprint

    @classmethod
    def of(cls, curve: Components, name: str | None = None, watch: Watch = unwatched) -> Self:
        """Return the source of a curve, which is what the library draws if there is a name.

        A nameless curve is collapsed first, as a long and thin one cannot be scrambled. Raises `ValueError`.
        """
        if name and starts.has_variants(name):
            return cls(name, curve, fingerprint(curve))
        type = None
        with suppress(TooEntangledError):  # the collapsed rope is less so, as a rule
            type = fingerprint(curve)
        collapsed = done(Collapse(curve, False, "{}"), watch).best()
        return cls(None, collapsed, type or fingerprint(collapsed))

    def start(self, variant: int, watch: Watch = unwatched) -> Components:
        """Return a starting conformation; variant 0 is the curve itself."""
        if not variant:
            return self.curve
        return starts.start(self.name, variant) if self.name else scramble(self.curve, variant, watch=watch)


def attempt(source: Source, variant: int, watch: Watch = unwatched) -> Shape:
    """Make one trial. A start that cannot be drawn or collapsed gives a shape without a curve."""
    seed = abs(variant)
    anneal = GENTLE_ANNEAL if (seed + 2) % WARM else WARM_ANNEAL
    recipe = Recipe({}, anneal | {"seed": seed}, seed, _spread(*ANNEAL_EDGES, variant))
    try:
        trial = Trial(recipe, source.start(variant, watch))
        engine = done(trial.begin(), watch)
        while trial.take(engine):
            if trial.n > MOST_BEADS:
                return Shape(variant)
            engine = done(trial.begin(), watch)
    except FAILURES:
        return Shape(variant)
    curve = engine.best()
    if fingerprint(curve) != source.type:
        return Shape(variant, changed=True)
    return Shape(variant, status_of(engine).best.l_a_or_l_p, radii_of_gyration(curve), curve)


def refine(shape: Shape, watch: Watch = unwatched) -> Minimum | None:
    """Polish a shape to the end on edges of `FINE_EDGE`. Returns None for one that cannot be refined."""
    curve, length = shape.curve, shape.length
    for _ in range(POLISHES):
        n = round(length / FINE_EDGE)
        polish = curve and _polished(curve, n, watch)
        if not polish:
            return None
        curve, length = polish.best(), status_of(polish).best.l_a_or_l_p
        if has_edges(n, length, FINE_EDGE):
            return _replaced(Minimum.of(shape), polish)
    return None


def finish(minimum: Minimum, n: int, watch: Watch = unwatched) -> Minimum | None:
    """Polish a minimum on n vertices, doubling the vertices on the way there; None if that fails."""
    try:
        tight = polished(minimum.curve, n, watch)
    except FAILURES:
        return None
    assert tight.residual is not None
    return replace(
        minimum,
        length=tight.measures.l_a_or_l_p,
        converged=tight.converged,
        residual=tight.residual,
        curve=tight.curve,
    )


def reseat(minimum: Minimum, watch: Watch = unwatched) -> Minimum:
    """Polish a minimum on more vertices and then on its own number again; the shortest one counts.

    Beads lie in grooves between those that they touch; among more beads these are shallow, and a rope may
    leave one that held it up, by a thousandth of its length at most.
    """
    n = sum(map(len, minimum.curve))
    for more, offset in SEATINGS:
        fine = _polished(minimum.curve, round(more * n), watch, offset)
        if polish := fine and _polished(fine.best(), n, watch, offset):
            minimum = min(minimum, _replaced(minimum, polish), key=rank)
    return minimum


def _spread(least: float, most: float, number: int) -> float:
    """Spread numbers evenly over a range by multiples of the golden ratio."""
    return least + (most - least) * ((0.5 + number * (math.sqrt(5) - 1) / 2) % 1)


def _polished(curve: Components, n: int, watch: Watch, offset: int = 0) -> Polish | None:
    """Polish a rope on n vertices, from an offset along it, unless that fails."""
    with suppress(*FAILURES):
        return done(Polish(curve, n, False, offset), watch)
    return None


def _replaced(minimum: Minimum, polish: Polish) -> Minimum:
    """Return the minimum with what the polish made of its rope."""
    status = status_of(polish)
    return replace(
        minimum,
        length=status_of(polish).best.l_a_or_l_p,
        converged=_is_tight(polish),
        residual=status.residual,
        curve=Curve(polish.best()),
    )


def _is_tight(polish: Polish) -> bool:
    return status_of(polish).outcome == "tight"
