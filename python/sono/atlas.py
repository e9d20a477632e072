"""The atlas: the shortest known tight rope of every knot, with its bounds and where it came from.

A folder holds `tight/NAME.txt`, the vertices with edges of about 0.2 radii, and `atlas.tsv`, a row each. The
figures of a row are what its file measures; L_c, an upper bound on the ropelength of the smooth knot, is
given once more on finer edges, where it is nearer to it. A knot's type is checked before its row is written.
"""

import io
import os
import re
import threading
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np

from sono import formats, library, published, tables
from sono.batch import TIGHT, measured, title
from sono.formats import FormatError
from sono.invariants import Curve, fingerprint, homfly
from sono.pipeline import forces, measure, tighten
from sono.tables import Row

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

_ORIGIN = re.compile(r"^# searched: variant (\d+), seed (\d+)", re.MULTILINE)


@dataclass(frozen=True)
class Atlas:
    """An atlas in a folder."""

    folder: Path
    lock: threading.Lock = field(default_factory=threading.Lock)

    def path(self, knot: str) -> str:
        """Return where the vertices of a knot are."""
        return os.fspath(self.folder / "tight" / f"{knot}.txt")

    def rows(self) -> dict[str, Row]:
        """Return the rows there are, by knot. Raises `FormatError`."""
        table = self.folder / "atlas.tsv"
        return {str(row["knot"]): row for row in tables.read(os.fspath(table))} if table.exists() else {}

    def take(self, knot: str, file: str) -> Row:
        """Take a rope for a knot if it is tight and shorter than the one there is; return the knot's row.

        Raises `FormatError` for a file that cannot be read or written, `ValueError` for a rope of another
        type than its name says: it is not taken.
        """
        found, measures = measured(file)
        there = os.path.exists(self.path(knot))
        bound = measured(self.path(knot))[1].l_a if there else None
        if measures.l_a is not None and (bound is None or measures.l_a < (1 - SHORTER) * bound):
            confirmed_type(knot, found.components)
            origin = _ORIGIN.search(formats.load(file)[1])
            searched = [f"searched: variant {origin[1]}, seed {origin[2]}"] if origin else []
            centre = np.vstack(found.components).mean(axis=0)
            curve = [(component - centre).round(DECIMALS) for component in found.components]
            (self.folder / "tight").mkdir(parents=True, exist_ok=True)
            formats.write(self.path(knot), curve, [*title(knot, TIGHT, measure(curve)), *searched])
        elif self._is_current(knot):
            return self.rows()[knot]
        row = published.beside({**self.measured(knot), **self.finer(knot)}, published.table())
        self._write(row)
        return row

    def measured(self, knot: str) -> Row:
        """Return the row of a knot but for the finer level, its type confirmed.

        Raises `FormatError` and `ValueError`.
        """
        file, m = measured(self.path(knot))
        origin = _ORIGIN.search(formats.load(self.path(knot))[1])
        variant, seed = map(int, origin.groups()) if origin else (None, None)
        return {
            **{"knot": knot, "n": m.n, "dl": m.dl, "l_p": m.l_p, "l_c": m.l_c, "l_a": m.l_a},
            **{"residual": forces(file.components).residual, "seed": seed, "variant": variant},
            "type": confirmed_type(knot, file.components),
        }

    def checked(self, knot: str) -> Row:
        """Measure the file of a knot and compare it with its row. Raises `FormatError` and `ValueError`."""
        row = self.rows().get(knot)
        if not row:
            raise FormatError(f"{knot}: is not in {self.folder / 'atlas.tsv'}; --update adds it")
        again = self.measured(knot)
        wrong = [key for key in ("n", "l_p", "l_c", "l_a", "variant", "seed") if again[key] != row[key]]
        if wrong:
            raise ValueError(f"{knot}: {wrong[0]} in its row is not that of its file; --update mends it")
        return {**row, "type": again["type"]}

    def finer(self, knot: str) -> Row:
        """Polish the rope of a knot on finer edges, for a lower L_c."""
        file, m = measured(self.path(knot))
        fine = tighten(file.components, round(m.l_p / FINEST_EDGE), method="polish").measures
        return {"n_fine": fine.n, "l_c_fine": fine.l_c}

    def _is_current(self, knot: str) -> bool:
        """Tell whether the row of a knot is that of its file."""
        row = self.rows().get(knot, {})
        return row.get("l_a") == measured(self.path(knot))[1].l_a and row.get("l_c_fine") is not None

    def _write(self, row: Row) -> None:
        with self.lock:
            rows = self.rows() | {str(row["knot"]): row}
            text = io.StringIO()
            with tables.writer("tsv", COLUMNS, text) as table:
                for knot in sorted(rows, key=_by_number):
                    table.row(rows[knot])
            formats.save(os.fspath(self.folder / "atlas.tsv"), text.getvalue())


def confirmed_type(knot: str, curve: Curve) -> str:
    """Return by which invariant a curve is confirmed to be the knot of this name: "homfly" or "alexander".

    Without the extra sono[identify] it is the weaker one. Raises `ValueError` if it is another knot.
    """
    start = library.start(knot)
    wrong = fingerprint(curve) != fingerprint(start)
    try:
        wrong = wrong or homfly(curve) != homfly(start)
        by = "homfly"
    except ImportError:
        by = "alexander"
    if wrong:
        raise ValueError(f"{knot}: the rope is of another knot type; it is not taken")
    return by


def _by_number(knot: str) -> list[int]:
    return [int(number) for number in re.findall(r"\d+", knot)]
