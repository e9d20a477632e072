"""Backbones of proteins and nucleic acids, as PDB and mmCIF files hold them, and models made of beads.

A chain goes through its atoms CA, or P where there are none, or all atoms if the file has neither. Where
bonds join them in another order than the file's, it follows the bonds. It is closed if a bond joins its ends,
or if they are as near as neighbours. When all chains are closed, those of a model are the components of one
curve, a link perhaps, with the model as the key. When some are open, as those of proteins are, every chain is
a curve of its own, with the chain as the key, such as A, or 2:A in model 2.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import partial
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from sono.formats.bonds import against, along
from sono.formats.boxes import Box, rejoined, second_chain
from sono.formats.doubts import LONGEST, closing_edge
from sono.formats.images import together
from sono.formats.refused import Refused, attempted
from sono.formats.simulated import BY_NEAREST
from sono.formats.vertices import SHOWN, Chain, FormatError, Raw, alone

BACKBONE = ({"N", "C"}, {"P", "O3'"})
"""Atoms whose bond joins two residues, other than those that a chain goes through."""

CA_TO_CA = 4.2
"""Neighbours along a protein are nearer than so many ångströms; where they are not, some may be missing."""

NO_BOND = "no CONECT joins this atom"

Floats = NDArray[np.float64]

Bonds = set[frozenset[int]]


@dataclass(frozen=True)
class Atom:
    """An atom: its `name`, its `residue`, the `chain` that it is in, after how many breaks (`part`).

    The `number` of the residue includes its insertion code; `other` marks an alternative place.
    """

    hetero: bool
    name: str
    other: str
    residue: str
    chain: str
    part: int
    number: str
    place: tuple[float, float, float]
    line: int


@dataclass(frozen=True)
class Model:
    """A model: its atoms, the bonds between them as pairs of places in that list, and the periodic box.

    Of one that is `wrong` the error is all that is wanted. The `cure` is how its format tells chains apart.
    """

    key: str
    atoms: Sequence[Atom]
    bonds: Bonds
    box: Box | None = None
    wrong: FormatError | None = None
    cure: str = "put TER ahead of a second chain"


@np.errstate(all="ignore")  # what is not finite is refused later on
def curves(models: Sequence[Model], name: str) -> list[Raw]:
    """Give the curves of all models of the file `name`, at least one.

    A chain that is wrong spoils no open one: its error is raised by its chains.
    """
    traces = [[] if model.wrong else _traces(model, name) for model in models]
    links = all(trace.closed for several in traces for trace in several)
    found: list[Raw] = []
    for model, several in zip(models, traces, strict=True):
        if model.wrong:
            found.append(Raw(Refused(model.wrong), model.key))
        elif links:
            found.append(attempted(partial(_link, several, model.key), model.key))
        else:
            for chain, trace in zip(_keys(several), several, strict=True):
                key = f"{model.key}:{chain}" if len(models) > 1 else chain
                found.append(attempted(partial(_link, [trace], key), key))
    if len(found) > 1:
        return found
    chain = _keys(traces[0])[0] if len(traces[0]) == 1 else ""
    return alone(found[0], chain, models[0].key, f"{models[0].key}:{chain}" if chain else "")


def _link(traces: Sequence["_Trace"], key: str) -> Raw:
    notes = [note for trace in traces for note in trace.notes()]
    chains, moved = together(traces[0].box, [trace.chain() for trace in traces])
    return Raw(chains, key, [*notes, *(f"{traces[0].name}: {note}" for note in moved)])


def _keys(traces: Sequence["_Trace"]) -> list[str]:
    """Name chains by their ids, or by numbers where they have none, or not one each."""
    ids = [trace.atoms[0].chain for trace in traces]
    plain = all(ids) and len(set(ids)) == len(ids)
    return ids if plain else [str(number) for number in range(1, len(ids) + 1)]


def _traces(model: Model, name: str) -> list["_Trace"]:
    strands: dict[tuple[str, int], list[int]] = {}
    for index, atom in enumerate(model.atoms):
        strands.setdefault((atom.chain, atom.part), []).append(index)
    hetero = all(atom.hetero for atom in model.atoms)
    found = [pair for strand in strands.values() if (pair := _backbone(strand, model.atoms, hetero))]
    found = found or [("", strand) for strand in strands.values()]
    atoms = sum(len(places) for _, places in found)
    if bonds := against(model.bonds, [places for _, places in found], bool(found[0][0])):
        found = [(found[0][0], places) for places in _along(bonds, atoms, model, name)]
    long = [pair for pair in found if len(pair[1]) > 2] or found[:1]
    left = atoms - sum(len(places) for _, places in long) if bonds else 0
    return [_Trace(name, model, called, places, 0 if k else left) for k, (called, places) in enumerate(long)]


def _along(bonds: Bonds, atoms: int, model: Model, name: str) -> list[list[int]]:
    """Give the places of so many atoms along bonds. Raises `FormatError` if these branch, or are few."""
    bonded = sorted({place for bond in bonds for place in bond})
    if 2 * len(bonded) <= atoms:
        first = model.atoms[bonded[0]].line
        raise FormatError.at(
            name,
            first,
            "a bond of this atom is not with a neighbour, and most atoms have none; give all bonds",
        )
    lines = [atom.line for atom in model.atoms]
    chains = (places.tolist() for places, _ in along(np.array([sorted(bond) for bond in bonds]), name, lines))
    return sorted((places for places in chains if len(places) > 1), key=min)


def _backbone(strand: Sequence[int], atoms: Sequence[Atom], hetero: bool) -> tuple[str, list[int]] | None:
    """Give the name and the places of the atoms that a strand goes through, or None if it has no backbone."""
    if all(atoms[i].hetero for i in strand) and not hetero:  # water, or what else stands beside the chains
        return None
    for called in ("CA", "P"):
        # A residue that is called CA is an ion of calcium.
        places = [i for i in strand if atoms[i].name == called != atoms[i].residue]
        if places:
            return called, _first_places(places, atoms)
    return None


def _first_places(places: Sequence[int], atoms: Sequence[Atom]) -> list[int]:
    """Leave out the other places of an atom that has several."""
    kept = [places[0]]
    for place in places[1:]:
        if not (atoms[place].other and atoms[place].number == atoms[kept[-1]].number):
            kept.append(place)
    return kept


class _Trace:
    """A chain through some atoms of a model, all of the name `called`, or of any when that is empty.

    So many atoms are `left` out since no bonds join them to chains.
    """

    def __init__(self, name: str, model: Model, called: str, places: Sequence[int], left: int) -> None:
        self.name, self._model, self._called, self._places, self._left = name, model, called, places, left
        self.box, self.atoms = model.box, [model.atoms[place] for place in places]
        self._place(np.array([atom.place for atom in self.atoms]))
        self._joined = [frozenset(pair) in model.bonds for pair in pairwise(places)]
        self._spelled = sum(self._joined) > len(self._joined) / 2
        self._bonded = self._ends_bonded()
        self.moved = False
        self._wrong: FormatError | None = None
        if model.box and not self._missing():
            self._unwrap(model.box)
        self._ordered = [*places] == sorted(places)
        self.closed = self._bonded or (not self._spelled and self._ends_near())

    def _place(self, rows: Floats) -> None:
        self._rows = rows
        self._lengths = np.linalg.norm(np.roll(rows, -1, axis=0) - rows, axis=1)

    def _unwrap(self, box: Box) -> None:
        """Put the chain together if the box has wrapped it; an error waits for who wants the chain."""
        try:
            lines = [atom.line for atom in self.atoms]
            whole = rejoined(box, self._rows, self.name, lines, self._bonded)
        except FormatError as error:
            self._wrong = error
            return
        self.moved = whole is not self._rows
        self._place(whole)

    def _refuse_breaks(self) -> None:
        """Refuse to go on where a second chain seems to begin."""
        after, why = -1, ""
        if self._spelled:
            after, why = (-1, "") if all(self._joined) else (self._joined.index(False), NO_BOND)
        elif (found := second_chain(self._rows)) and not self._jumps(found[0]):
            after, why = found[0], f"an edge of {found[1]:.1f} times the median one leads here"
        elif restarts := self._restarts():
            after, why = restarts[0], "the numbers of residues start again here"
        if why:
            before, here = self.atoms[after : after + 2]
            raise FormatError.at(
                self.name,
                here.line,
                f"{why}, from line {before.line}; {self._model.cure}, or unwrap the first",
            )

    def _jumps(self, edge: int) -> bool:
        """Tell whether residues were left out between the ends of an edge, by their numbers."""
        before, after = (_number(atom) for atom in self.atoms[edge : edge + 2])
        return before is not None and after is not None and after > before + 1

    def _restarts(self) -> list[int]:
        """Give the edges that are rather long and after which the numbers of residues are lower."""
        far = self._lengths[:-1] > LONGEST * np.median(self._lengths)
        numbers = [_number(atom) for atom in self.atoms]
        pairs = [(i, numbers[i], numbers[i + 1]) for i in np.flatnonzero(far).tolist()]
        return [
            i for i, before, after in pairs if before is not None and after is not None and after < before
        ]

    def _ends_bonded(self) -> bool:
        first, last = self._places[0], self._places[-1]
        if len(self._places) > 2 and frozenset((first, last)) in self._model.bonds:
            return True
        ends = {(self.atoms[i].chain, self.atoms[i].number) for i in (0, -1)}
        for bond in self._model.bonds if self._called else ():
            pair = [self._model.atoms[place] for place in bond]
            if {atom.name for atom in pair} in BACKBONE and {(a.chain, a.number) for a in pair} == ends:
                return True
        return False

    def _ends_near(self) -> bool:
        if not self._called:
            return not closing_edge(self._rows)
        usual = np.quantile(self._lengths[:-1], 0.9) if len(self._lengths) > 2 else np.inf
        return bool(self._lengths[-1] <= LONGEST * usual)

    def chain(self) -> Chain:
        """Give the chain. Raises `FormatError` where a second one seems to begin."""
        if self._wrong:
            raise self._wrong
        self._refuse_breaks()
        closed = None if self.closed and not (self._bonded or self._called) else self.closed
        return Chain(self._rows, [atom.line for atom in self.atoms], closed)

    def notes(self) -> list[str]:
        """Tell which atoms were taken, why the chain is closed, and which may be missing."""
        where = f"{self.name}:{self.atoms[0].line}: chain {self.atoms[0].chain}".rstrip()
        notes = []
        if not self._called:
            notes = [f"{where} goes through all its atoms, as none is called CA or P"]
        elif any(atom.name != self._called for atom in self._model.atoms):
            notes = [f"{where} goes through the atoms {self._called}"]
        if not self._ordered:
            notes.append(f"{where} follows the bonds, which join its atoms in another order than the file's")
        if self.moved:
            notes.append(f"{self.name}: {BY_NEAREST}")
        if self._left:
            notes.append(f"{self.name}: {self._left} atoms in no chain of three or more were left out")
        if self.closed and not self._bonded and self._called:
            notes.append(f"{where} is closed, as its ends are as near as neighbours; no bond says so")
        if missing := self._missing():
            listed = ", ".join(missing[:SHOWN]) + (" and so on" if len(missing) > SHOWN else "")
            notes.append(f"{where} goes straight where residues seem to be missing: {listed}")
        return notes

    def _missing(self) -> list[str]:
        far = self._lengths[:-1] > max(CA_TO_CA, 1.1 * np.median(self._lengths))
        far &= ~np.array(self._joined, bool)
        pairs = [self.atoms[i : i + 2] for i in np.flatnonzero(far).tolist() if self._jumps(i)]
        gaps = [((_number(before) or 0) + 1, (_number(after) or 0) - 1) for before, after in pairs]
        return [f"{first} to {last}" if last > first else f"{first}" for first, last in gaps]


def _number(atom: Atom) -> int | None:
    digits = atom.number.rstrip("ABCDEFGHIJKLMNOPQRSTUVWXYZ")
    return int(digits) if digits.removeprefix("-").isdecimal() else None
