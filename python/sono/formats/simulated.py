"""What LAMMPS's two formats share: the atoms of one frame, put together to chains."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from sono.formats.boxes import Box, refuse_winding, second_chain, unwrapped
from sono.formats.doubts import jumps
from sono.formats.vertices import SHOWN, Chain, FormatError, not_a_number, numbers, shown

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]

BY_FLAGS = "the chains were unwrapped by their image flags"
BY_NEAREST = "the chains were unwrapped: each atom is at its periodic image nearest to the one before"
"""Notes on how wrapped chains were made whole."""


@dataclass(frozen=True, eq=False)
class Atoms:
    """The atoms of one frame of the file `name`: `ids` (n,), `rows` (n, 3) and the `lines` (n,) they are on.

    The `molecules` (n,) are 0 for atoms of none, and None if the file has no such column. With `images`, the
    rows have been unwrapped by the file itself.
    """

    name: str
    ids: Ints
    rows: Floats
    lines: Ints
    molecules: Ints | None
    images: bool

    def in_order(self) -> "Atoms":
        """Return the atoms in order of their ids. Raises `FormatError` for an id that comes twice."""
        order = np.argsort(self.ids, kind="stable")
        ids, lines = self.ids[order], self.lines[order]
        twice = np.flatnonzero(ids[1:] == ids[:-1])
        if len(twice):
            first, again = lines[twice[0]], lines[twice[0] + 1]
            raise FormatError.at(
                self.name, again, f"the id {ids[twice[0]]} stands on line {first} too; give each atom its own"
            )
        molecules = None if self.molecules is None else self.molecules[order]
        return Atoms(self.name, ids, self.rows[order], lines, molecules, self.images)

    def by_molecule(self) -> tuple[list[Ints], list[str]]:
        """Give the atoms of every molecule of three or more, as places in order, and what was left out.

        Raises `FormatError` if atoms without molecules are hardly one chain.
        """
        if self.molecules is None or not self.molecules.any():
            return [np.arange(len(self.ids))], []
        order = np.argsort(self.molecules, kind="stable")
        ends = np.flatnonzero(np.diff(self.molecules[order])) + 1
        groups = [group for group in np.split(order, ends) if self.molecules[group[0]]]
        return kept(groups, len(self.ids))

    def chain(self, places: Ints, box: Box | None, closed: bool | None) -> tuple[Chain, bool]:
        """Put some of the atoms together, and tell whether they had to be unwrapped. Raises `FormatError`."""
        rows, lines = self.rows[places], self.lines[places]
        if box is None:
            return Chain(rows, lines.tolist(), closed), False
        whole = rows if self.images and not jumps([rows])[1] else unwrapped(box, rows, self.name, lines)
        refuse_winding(box, whole, self.name, lines)
        return Chain(whole, lines.tolist(), closed), whole is not rows

    def refuse_breaks(self, chain: Chain) -> None:
        """Refuse a chain that only the order of ids holds together where another seems to begin."""
        if found := second_chain(chain.rows):
            edge, medians = found
            raise FormatError.at(
                self.name,
                chain.lines[edge + 1],
                f"the edge to this atom, from line {chain.lines[edge]}, is {medians:.1f} times the median "
                "one; if a second chain begins here, give each one its own mol",
            )


def kept(groups: Sequence[Ints], atoms: int) -> tuple[list[Ints], list[str]]:
    """Give the groups of three or more atoms, or all, and tell how many atoms were left out."""
    long = [group for group in groups if len(group) > 2] or list(groups)
    left = atoms - sum(map(len, long))
    return long, [f"{left} atoms in no chain of three or more were left out"] if left else []


def gaps(chains: Sequence[Ints]) -> list[str]:
    """Tell where the ids along the chains leave some out, since an atom may be missing there."""
    found = []
    for ids in chains:
        steps = np.diff(ids)
        found += [f"{ids[i]} to {ids[i + 1]}" for i in np.flatnonzero(steps > steps.min(initial=1 << 62))]
    more = " and so on" if len(found) > SHOWN else ""
    return [f"the ids of neighbours jump from {', '.join(found[:SHOWN])}{more}"] if found else []


def column(cells: Sequence[str], name: str, lines: Ints, what: str) -> Floats:
    """Read a column of numbers. Raises `FormatError` that says `what` should stand there."""
    try:
        values = np.array(numbers(cells))
        bad = None if np.isfinite(values).all() else int(np.isfinite(values).argmin())
    except ValueError:
        bad = not_a_number(cells) or 0
    if bad is not None:
        raise FormatError.at(
            name, lines[bad], f"{shown(cells[bad])} is not a finite number; {what} should stand here"
        )
    return values


def whole(cells: Sequence[str], name: str, lines: Ints, what: str) -> Ints:
    """Read a column of whole numbers, likewise."""
    values = column(cells, name, lines, what)
    wrong = ~((values == np.rint(values)) & (abs(values) < 2**53))
    if wrong.any():
        bad = wrong.argmax()
        raise FormatError.at(
            name, lines[bad], f"{shown(cells[bad])} is no whole number; {what} should stand here"
        )
    return values.astype(np.int64)
