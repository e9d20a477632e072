"""The atlas: the shortest known tight rope of every knot, with its bounds and where it came from.

A folder holds `tight/NAME.txt`, the vertices with edges of about 0.2 radii, and `atlas.tsv`, a row each. The
figures of a row are what its file measures; L_c, an upper bound on the ropelength of the smooth knot, is
given once more on finer edges, where it is nearer to it. A knot's type is checked before its row is written.
"""

import io
import math
import os
import re
import threading
from collections import defaultdict
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np

from sono import formats, starts, tables
from sono.curve import Components, forces, measure
from sono.formats import FormatError
from sono.formats.ropefile import TIGHT, Header, Searched
from sono.invariants import fingerprint, homfly
from sono.jobs.curvefiles import KEPT_RESIDUAL, measured, rope_in
from sono.searching.minima import same_edges
from sono.searching.trials import FINE_EDGE, Watch, unwatched
from sono.tables import Row, Value, published
from sono.tightening import Tight, polished

FINEST_EDGE = 0.03
"""Edge length at which L_c is given once more, in radii."""

DECIMALS = 10
"""Decimals of the coordinates in the atlas, which rounds lengths by less than the polish leaves open."""

SHORTER = 1e-7
"""A rope is shorter than another if its L_a is by so much, relatively."""

COLUMNS = (
    *("knot", "n", "dl", "l_p", "l_c", "l_a", "residual", "n_fine", "l_c_fine"),
    *("published", "source", "l_a_difference", "l_c_difference", "seed", "variant", "type"),
)


@dataclass(frozen=True)
class Atlas:
    """An atlas in a folder, which one process at a time may change."""

    folder: Path
    lock: threading.Lock = field(default_factory=threading.Lock)
    knot_locks: dict[str, threading.Lock] = field(default_factory=lambda: defaultdict(threading.Lock))

    def path(self, knot: str) -> str:
        """Return where the vertices of a knot are."""
        return os.fspath(self.folder / "tight" / f"{knot}.txt")

    def rows(self) -> dict[str, Row]:
        """Return the rows there are, by knot. Raises `FormatError`."""
        table = self.folder / "atlas.tsv"
        return {str(row["knot"]): row for row in tables.read(os.fspath(table))} if table.exists() else {}

    def take(self, knot: str, file: str, watch: Watch = unwatched) -> Row:
        """Take a rope for a knot if it is shorter than the one there is; return the knot's row.

        A rope of other edges, or one that is not tight, is polished first. Raises `FormatError` for a file
        that cannot be read or written, `ValueError` for a rope that does not get tight, or of another type
        than its name says.
        """
        with self.knot_locks[knot]:
            return self._take(knot, file, watch)

    def _take(self, knot: str, file: str, watch: Watch) -> Row:
        curve = self._fit(file, watch)
        confirmed_type(knot, curve, file)
        if not self._is_shorter(knot, curve):
            row = self.rows().get(knot)
            if row and self._is_current(row):
                return row
            file = self.path(knot)
            curve = measured(file)[0].components
        origin = rope_in(file)[2].searched
        fine = _polished(curve, FINEST_EDGE, watch)
        # It may have left a groove of the beads that held it up.
        again = _polished(fine.curve, FINE_EDGE, watch)
        if again.converged and (again.measures.l_a or math.inf) < (measure(curve).l_a or math.inf):
            curve = _centred(again.curve)
        for rope in (curve, fine.curve):
            confirmed_type(knot, rope, file)
        if self._is_shorter(knot, curve):
            self._make()
            searched = Searched(origin.variant, origin.seed) if origin else None
            header = Header.of(knot, TIGHT, measure(curve), searched=searched)
            formats.write(self.path(knot), curve, header.lines())
        finer = {"n_fine": fine.measures.n, "l_c_fine": fine.measures.l_c}
        row = published.beside({**self.measured(knot), **finer}, published.table())
        self._write(row)
        return row

    def _is_shorter(self, knot: str, curve: Components) -> bool:
        """Tell whether a rope is shorter than what there is. Raises `FormatError` and `ValueError`."""
        path = self.path(knot)
        if not os.path.exists(path):
            return True
        there, m = measured(path)
        confirmed_type(knot, there.components, path)
        return (measure(curve).l_a or math.inf) < (1 - SHORTER) * (m.l_a or 0)

    def _make(self) -> None:
        """Make the folders. Raises `FormatError`."""
        try:
            (self.folder / "tight").mkdir(parents=True, exist_ok=True)
        except OSError as error:
            raise FormatError(f"{self.folder}: cannot be made: {error.strerror}") from error

    def _fit(self, file: str, watch: Watch) -> Components:
        """Return the rope of a file: tight, of radius 1, with edges of FINE_EDGE, centred."""
        curve, m, header = rope_in(file)
        components = [component / m.r_s for component in curve.components]
        fits = same_edges(m.dl / m.r_s, FINE_EDGE)
        if not (fits and header.status == TIGHT and forces(components).residual <= KEPT_RESIDUAL):
            polished = _polished(components, FINE_EDGE, watch)
            if not polished.converged:
                raise ValueError(f"{file}: does not get tight with {polished.measures.n} vertices")
            components = list(polished.curve)
        return _centred(components)

    def measured(self, knot: str) -> Row:
        """Return the row of a knot but for the finer level, its type confirmed.

        Raises `FormatError` and `ValueError`.
        """
        file, m, header = rope_in(self.path(knot))
        found = header.searched
        variant, seed = (found.variant, found.seed) if found else (None, None)
        return {
            **{"knot": knot, "n": m.n, "dl": m.dl, "l_p": m.l_p, "l_c": m.l_c, "l_a": m.l_a},
            **{"residual": forces(file.components).residual, "seed": seed, "variant": variant},
            "type": confirmed_type(knot, file.components, self.path(knot)),
        }

    def checked(self, knot: str) -> Row:
        """Measure the file of a knot and compare it with its row. Raises `FormatError` and `ValueError`."""
        row = self.rows().get(knot)
        if not row:
            table = self.folder / "atlas.tsv"
            raise FormatError(f"{knot}: is no file and not in {table}; --update adds a knot by its name")
        again = self.measured(knot)
        if not self._is_current(row):
            raise ValueError(f"{knot}: its row is not that of its file; --update mends it")
        return {**row, "type": again["type"]}

    def _is_current(self, row: Row) -> bool:
        """Tell whether a row has the figures of its file."""
        m = measured(self.path(str(row["knot"])))[1]
        same = (_agree(row.get(key), getattr(m, key)) for key in ("n", "dl", "l_p", "l_c", "l_a"))
        return row.get("l_c_fine") is not None and all(same)

    def _write(self, row: Row) -> None:
        with self.lock:
            rows = self.rows() | {str(row["knot"]): row}
            text = io.StringIO()
            with tables.writer("tsv", COLUMNS, text) as table:
                for knot in sorted(rows, key=_by_number):
                    table.row(rows[knot])
            formats.save(os.fspath(self.folder / "atlas.tsv"), text.getvalue())


def _polished(curve: Components, edge: float, watch: Watch) -> Tight:
    """Polish a rope on edges of this length."""
    n = round(measure(curve).l_p / edge)
    return polished(curve, n, watch)


def _centred(curve: Components) -> Components:
    """Return a rope round the origin, with as many decimals as its file has."""
    centre = np.vstack(curve).mean(axis=0)
    return [(component - centre).round(DECIMALS) for component in curve]


def confirmed_type(knot: str, curve: Components, file: str) -> str:
    """Return in which invariant a file's curve agrees with the knot of this name: "homfly" or "alexander".

    Where its polynomial needs the extra sono[identify] it is the weaker one. A few pairs of knots, such as
    8_16 and 10_156, agree in both. Raises `ValueError` if the curve is another knot.
    """
    start = starts.start(knot)
    wrong = fingerprint(curve) != fingerprint(start)
    try:
        wrong = wrong or homfly(curve) != homfly(start)
        by = "homfly"
    except ImportError:
        by = "alexander"
    if wrong:
        raise ValueError(f"{file}: is of another knot type than {knot}; remove it or name it otherwise")
    return by


def _agree(one: Value, other: Value) -> bool:
    """Tell whether two figures are equal but for the last digits, which differ between machines."""
    if isinstance(one, int | float) and isinstance(other, int | float):
        return math.isclose(one, other, rel_tol=1e-11)
    return one == other


def _by_number(knot: str) -> list[int]:
    return [int(number) for number in re.findall(r"\d+", knot)]
