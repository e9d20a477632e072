"""The atlas: the shortest known tight rope of every knot and link, with its bounds and where it came from.

A folder has for each family, such as the prime knots, a table and an archive of ropes with edges of about 0.2
radii. The figures of a row are what its rope measures as it is in the archive. L_c is an upper bound on the
ropelength of the smooth knot, and certified: rounded outward all the way. Where what is published is below
it, or nothing is, it is given once more on finer edges, on which it is nearer to the ropelength. A knot's
type is checked before its row is written.
"""

import math
import threading
from collections import defaultdict
from dataclasses import dataclass, field
from functools import cached_property
from pathlib import Path

import numpy as np

from sono import _core, starts
from sono.curve import Components, forces, measure
from sono.formats import FormatError
from sono.formats.ropefile import TIGHT, Searched
from sono.invariants import fingerprint
from sono.jobs.curvefiles import rope_in
from sono.jobs.family import Family
from sono.naming import identify
from sono.searching.minima import same_edges
from sono.searching.trials import FINE_EDGE, Watch, unwatched
from sono.starts import archive
from sono.starts.shapes import FAMILIES, place
from sono.tables import Row, Value, published
from sono.tightening import Tight, polished

FINER_EDGES = (0.1, 0.03)
"""Edge lengths at which L_c is given once more, in radii, the first where it is at most what is published."""

FINEST = 6000
"""Vertices at which L_c is given once more, at most."""

BALANCED = 1e-4
"""Residual up to which a rope that its file calls tight is taken as it is; forces fitted to ten thousand
vertices seldom leave less."""

SHORTER = 1e-7
"""A rope is shorter than another if its L_a is by so much, relatively."""


@dataclass(frozen=True)
class Atlas:
    """An atlas in a folder, which one process at a time may change."""

    folder: Path
    locks: dict[str, threading.Lock] = field(default_factory=lambda: defaultdict(threading.Lock))

    @cached_property
    def families(self) -> dict[str, Family]:
        """The families, by their names."""
        return {name: Family(self.folder, name) for name in FAMILIES}

    def rows(self) -> dict[str, Row]:
        """Return the rows there are, by knot. Raises `FormatError`."""
        return {knot: row for family in self.families.values() for knot, row in family.rows.items()}

    def rope(self, knot: str) -> Components:
        """Return the rope of a knot. Raises `FormatError` if there is none."""
        family = self._family(knot)
        if knot not in family.ropes:
            raise FormatError(f"{knot}: is not in {family.files[1]}; --update adds a knot by its name")
        return archive.unpacked(family.ropes[knot])

    def take(self, knot: str, file: str, watch: Watch = unwatched) -> Row:
        """Take a rope for a knot if it is shorter than the one there is; return the knot's row.

        A rope of other edges, or one that is not tight, is polished first. Raises `FormatError` for a file
        that cannot be read or written, `ValueError` for a rope that does not get tight, or of another type
        than its name says.
        """
        with self.locks[knot]:
            curve, searched = _fit(file, watch)
            confirmed_type(knot, curve, file)
            there = self._family(knot).rows.get(knot)
            if there and not _shorter(curve, self.rope(knot)):
                return self.checked(knot)
            curve, finer = _finer(knot, curve, watch)
            type = confirmed_type(knot, curve, file)
            origin = (searched.variant, searched.seed) if searched else (None, None)
            r_s = measure(curve).r_s
            residual = forces([component / r_s for component in curve]).residual
            row = {
                **_measured(knot, curve),
                "residual": residual,
                **finer,
                "variant": origin[0],
                "seed": origin[1],
                "type": type,
            }
            row = dict(published.beside(row, published.table()))
            self._family(knot).put(row, archive.packed(curve))
            return row

    def checked(self, knot: str) -> Row:
        """Measure the rope of a knot and compare it with its row. Raises `FormatError` and `ValueError`."""
        family = self._family(knot)
        row = family.rows.get(knot)
        if not row:
            raise FormatError(
                f"{knot}: is no file and not in {family.files[0]}; --update adds a knot by its name"
            )
        curve = self.rope(knot)
        again = _measured(knot, curve)
        if not all(_agree(row.get(key), again[key]) for key in ("n", "dl", "l_p", "l_c", "l_a")):
            raise ValueError(
                f"{knot}: its row is not that of its rope; take both from one version of the atlas"
            )
        return {**row, "type": confirmed_type(knot, curve, family.files[1])}

    def _family(self, knot: str) -> Family:
        return self.families[place(knot).family]


def confirmed_type(knot: str, curve: Components, file: str) -> str:
    """Return how it is known that a curve is the knot of this name: "proven", "invariants" or less.

    A torus type whose diagram is no closed braid is told by its "fingerprint", see `invariants`. Raises
    `ValueError` if the curve is another knot, and `TooEntangledError`.
    """
    found, family = identify(curve), place(knot).family
    if family == "torus" and not found.names:
        right, by = fingerprint(curve) == fingerprint(starts.start(knot)), "fingerprint"
    else:
        names = (knot,) if family == "knots" else identify(starts.start(knot)).names
        right, by = found.names == names, str(found.known)
    if not right:
        raise ValueError(f"{file}: is of another knot type than {knot}; remove it or name it otherwise")
    return by


def _fit(file: str, watch: Watch) -> tuple[Components, Searched | None]:
    """Return the rope of a file, tight at R_s = 1 on edges of FINE_EDGE, centred, and where it is from."""
    curve, m, header = rope_in(file)
    components = [component / m.r_s for component in curve.components]
    fits = same_edges(m.dl / m.r_s, FINE_EDGE)
    if not (fits and header.status == TIGHT and forces(components).residual <= BALANCED):
        polished = _polished(components, FINE_EDGE, watch)
        if not polished.converged:
            raise ValueError(f"{file}: does not get tight with {polished.measures.n} vertices")
        components = list(polished.curve)
    return _centred(components), header.searched


def _finer(knot: str, curve: Components, watch: Watch) -> tuple[Components, Row]:
    """Give L_c on edges so fine that it is at most what is published, and the rope, perhaps shorter."""
    bound = published.beside({"knot": knot}, published.table())["published"]
    finer: dict[str, Value] = {"n_fine": None, "l_c_fine": None}
    if isinstance(bound, float) and _certified(curve) <= bound:
        return curve, finer
    for edge in FINER_EDGES if bound else FINER_EDGES[-1:]:
        if measure(curve).l_p / edge > FINEST:
            break
        fine = _polished(curve, edge, watch)
        # It may have left a groove of the beads that held it up.
        again = _polished(fine.curve, FINE_EDGE, watch)
        if again.converged and _shorter(again.curve, curve):
            curve = _centred(again.curve)
        confirmed_type(knot, list(fine.curve), knot)
        l_c = _certified(fine.curve)
        finer = {"n_fine": fine.measures.n, "l_c_fine": l_c}
        if isinstance(bound, float) and l_c <= bound:
            break
    return curve, finer


def _shorter(curve: Components, other: Components) -> bool:
    """Tell whether a tight rope is shorter than another."""
    one, two = (measure(rope).l_a_or_l_p for rope in (curve, other))
    return one < (1 - SHORTER) * two


def _measured(knot: str, curve: Components) -> dict[str, Value]:
    """Return what a rope measures."""
    m = measure(curve)
    return {"knot": knot, "n": m.n, "dl": m.dl, "l_p": m.l_p, "l_c": _certified(curve), "l_a": m.l_a}


def _certified(curve: Components) -> float:
    """Return the certified L_c of a rope. Raises `CurveError` where there is none."""
    l_c: float = _core.certify(list(curve))["l_c"]
    return l_c


def _polished(curve: Components, edge: float, watch: Watch) -> Tight:
    """Polish a rope on edges of this length."""
    return polished(curve, round(measure(curve).l_p / edge), watch)


def _centred(curve: Components) -> Components:
    """Return a rope round the origin, as an archive has it."""
    centre = np.vstack(curve).mean(axis=0)
    return archive.unpacked(archive.packed([component - centre for component in curve]))


def _agree(one: Value, other: Value) -> bool:
    """Tell whether two figures are equal but for the last digits, which differ between machines."""
    if isinstance(one, int | float) and isinstance(other, int | float):
        return math.isclose(one, other, rel_tol=1e-11)
    return one == other
