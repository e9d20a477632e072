"""PDB files: the columns of the Protein Data Bank, in which atoms have names, residues and chains.

    ATOM      1  CA  GLY A   1       0.000  -2.000   0.000  1.00  0.00           C
    ...
    TER      61      GLY A  60
    CONECT   60    1
    END

What of it becomes a curve is said in `molecules`. Rows with the right words, but not in their columns, are
read too. Written is a residue for every vertex, a chain for every component, and the bonds along it.
Coordinates have three decimals: a curve that this might change is refused. Comments are the remarks 999, and
numbers that need more columns are written in hybrid-36. Source: wwPDB, "Protein Data Bank Contents Guide",
version 3.3; hybrid-36 is of the cctbx project.
"""

import math
import re
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field, replace
from itertools import takewhile
from string import ascii_lowercase, ascii_uppercase, digits

import numpy as np
from numpy.typing import NDArray

from sono._core import CurveError
from sono.curve import measure
from sono.formats.boxes import Box
from sono.formats.molecules import Atom, Bonds, Model, curves
from sono.formats.vertices import FormatError, Raw, shown

CHAINS = ascii_uppercase + ascii_lowercase + digits
"""The ids of chains."""

REMARK = "REMARK 999"
"""Begins a line of comments."""

THIN = 0.005
"""A curve whose rope has a smaller radius might change its type when its coordinates are rounded."""

_RECORD = re.compile(r"HETATM|CONECT|(ATOM|MODEL|ENDMDL|END|TER|LINK|CRYST1)(?![A-Z])")
_FIRST = re.compile(r"(ATOM|HEADER|MODEL|REMARK) |HETATM|CRYST1")
_NUMBER = re.compile(r"-?\w+")
_DECIMAL = re.compile(r"[+-]?\d*\.\d*(e[+-]?\d+)?|[+-]?(nan|inf)", re.IGNORECASE)


def recognises(text: str) -> bool:
    """Tell whether a line among the first begins with the name of a record."""
    return any(_FIRST.match(line) for line in text[:10_000].split("\n")[:20])


def read(text: str, name: str) -> list[Raw]:
    """Parse a whole file; lengths keep its unit. Raises `FormatError`."""
    file = _File(name)
    for number, line in enumerate(text.split("\n"), 1):
        file.take(line, number)
    if not file.models:
        raise FormatError.at(
            name, 1, "the file holds no ATOM or HETATM; a PDB file begins each atom's line so"
        )
    models = [
        Model(found.key, found.atoms, file.bonds(found), file.box, found.wrong) for found in file.models
    ]
    return [replace(raw, comments=file.comments) for raw in curves(models, name)]


@dataclass
class _Found:
    """A model as it is read: the atoms, and the place of each by its serial number and by its residue."""

    key: str
    atoms: list[Atom] = field(default_factory=list)
    serials: dict[str, int] = field(default_factory=dict)
    sites: dict[tuple[str, str, str], int] = field(default_factory=dict)
    wrong: FormatError | None = None

    def add(self, serial: str, atom: Atom) -> None:
        """Take an atom."""
        self.serials.setdefault(serial, len(self.atoms))
        self.sites.setdefault((atom.chain, atom.number, atom.name), len(self.atoms))
        self.atoms.append(atom)


class _File:
    """What the lines have said so far."""

    def __init__(self, name: str) -> None:
        self._name = name
        self._part = 0
        self._ended = True
        self._key = ""
        self.box: Box | None = None
        self.comments: list[str] = []
        self._links: list[tuple[tuple[str, str, str], tuple[str, str, str]]] = []
        self._connected: list[str] = []
        self.models: list[_Found] = []

    def take(self, line: str, number: int) -> None:
        found = _RECORD.match(line)
        record = found[0] if found else ""
        if record in ("ATOM", "HETATM"):
            if self._ended:
                self.models.append(_Found(self._key or str(len(self.models) + 1)))
            self._ended = False
            try:
                self.models[-1].add(*self._atom(line, number))
            except FormatError as error:  # which spoils no other model
                self.models[-1].wrong = self.models[-1].wrong or error
        elif record == "MODEL":
            self._ended, self._key = True, line[5:].strip()
        elif record in ("ENDMDL", "END"):  # some programs end frames, but begin none
            self._ended, self._key = True, ""
        elif record == "TER":
            self._part += 1
        elif line.startswith(REMARK):
            self.comments.append(line.removeprefix(REMARK).strip())
        elif record == "CONECT":
            self._connected.append(line)
        elif record == "CRYST1":
            self.box = _box(line)
        elif record == "LINK":
            self._links.append((_site(line, 12), _site(line, 42)))

    def _atom(self, line: str, number: int) -> tuple[str, Atom]:
        """Read a row by its columns, or else by its words. Raises `FormatError`."""
        cells = [line[column : column + 8].strip() for column in (30, 38, 46)]
        if line[27:30].strip() or not all(_DECIMAL.fullmatch(cell) for cell in cells):
            return self._free(line, number)
        chain, at, _ = _site(line, 12)
        chain = chain or line[72:76].strip()  # the segment, in older files and those of CHARMM
        kind = line[17:20].strip()
        place = self._place(cells, number)
        hetero = line.startswith("HETATM")
        atom = Atom(hetero, line[12:16].strip(), line[16].strip(), kind, chain, self._part, at, place, number)
        return line[6:11].strip(), atom

    def _free(self, line: str, number: int) -> tuple[str, Atom]:
        words = line.split()
        first = next((i for i, word in enumerate(words) if i > 3 and _DECIMAL.fullmatch(word)), len(words))
        run = len(list(takewhile(_DECIMAL.fullmatch, words[first:])))
        # A number is missing where only one follows x y z, for occupancy and temperature come together.
        if run not in (3, *range(5, 9)) or not _NUMBER.fullmatch(words[first - 1]):
            raise FormatError.at(
                self._name,
                number,
                "there are no x y z with decimals in the columns 31 to 54; correct the row",
            )
        place = self._place(words[first : first + 3], number)
        chain = words[4] if first > 5 else ""
        hetero = words[0] == "HETATM"
        return words[1], Atom(
            hetero, words[2], "", words[3], chain, self._part, words[first - 1], place, number
        )

    def _place(self, cells: Sequence[str], number: int) -> tuple[float, float, float]:
        try:
            x, y, z = map(float, cells)
        except ValueError:
            x = y = z = math.nan
        if not math.isfinite(x + y + z):
            raise FormatError.at(
                self._name, number, f"{shown(' '.join(cells))} are not three finite numbers; correct x y z"
            )
        return x, y, z

    def bonds(self, model: _Found) -> Bonds:
        """Give the bonds between atoms of a model."""
        found = Bonds()
        for line in self._connected:
            serials = [line[at : at + 5].strip() for at in range(6, len(line.rstrip()), 5)]
            if any(serial not in model.serials for serial in serials):
                serials = line.split()[1:]
            places = [model.serials[serial] for serial in serials if serial in model.serials]
            found |= {frozenset((places[0], other)) for other in places[1:]}
        for one, other in self._links:
            if one in model.sites and other in model.sites:
                found.add(frozenset((model.sites[one], model.sites[other])))
        return found


def _box(line: str) -> Box | None:
    """Read the unit cell, or nothing where there is none, as for structures that are no crystals."""
    try:
        sides, angles = np.array(line[6:54].split(), float).reshape(2, 3)
        return Box.of_angles(sides, angles)
    except ValueError:
        return None


def _site(line: str, at: int) -> tuple[str, str, str]:
    """Give the chain, the residue's number and the name of an atom whose name stands at this column."""
    return line[at + 9 : at + 10].strip(), line[at + 10 : at + 15].strip(), line[at : at + 4].strip()


def write(components: Iterable[NDArray[np.float64]], comments: Sequence[str]) -> str:
    """Give the whole file. Raises `FormatError` for a curve that does not fit into the columns."""
    parts = list(components)
    _refuse_misfits(parts)
    lines = [f"{REMARK} {line}" for comment in comments for line in comment.splitlines()]
    bonds, serial = list[str](), 1
    for chain, vertices in zip(CHAINS, parts, strict=False):
        first = serial
        for residue, (x, y, z) in enumerate(vertices.tolist(), 1):
            at = f"GLY {chain}{hybrid36(residue, 4)}"
            row = f"ATOM  {hybrid36(serial, 5)}  CA  {at}    {x:8.3f}{y:8.3f}{z:8.3f}  1.00  0.00           C"
            lines.append(row)
            following = serial + 1 if residue < len(vertices) else first
            bonds.append(f"CONECT{hybrid36(serial, 5)}{hybrid36(following, 5)}")
            serial += 1
        lines.append(f"TER   {hybrid36(serial, 5)}      {at}")
        serial += 1
    return "\n".join([*lines, *bonds, "END", ""])


def _refuse_misfits(parts: Sequence[NDArray[np.float64]]) -> None:
    if len(parts) > len(CHAINS):
        raise FormatError(f"a PDB file has ids for {len(CHAINS)} chains, not for {len(parts)}; write .txt")
    rows = np.vstack(parts)
    if not (rows.min() > -999.9995 and rows.max() < 9999.9995):
        raise FormatError(
            "coordinates from -999.999 to 9999.999 fit into a PDB file; move the curve or write .txt"
        )
    if _radius(parts) < THIN:
        raise FormatError(
            "the three decimals of a PDB file are too few for so thin a curve; make it larger or write .txt"
        )


def _radius(parts: Sequence[NDArray[np.float64]]) -> float:
    try:
        return measure(parts).r_s
    except CurveError:  # it meets itself
        return 0.0


def hybrid36(value: int, width: int) -> str:
    """Write a number in so many columns: in decimals as far as they go, then with A to Z and a to z ahead.

    >>> hybrid36(9999, 4), hybrid36(10000, 4), hybrid36(10036, 4)
    ('9999', 'A000', 'A010')
    """
    if value < 10**width:
        return str(value).rjust(width)
    value -= 10**width
    blocks = 26 * 36 ** (width - 1)
    letters = digits + (ascii_uppercase if value < blocks else ascii_lowercase)
    value = value % blocks + 10 * 36 ** (width - 1)
    text = ""
    for _ in range(width):
        value, digit = divmod(value, 36)
        text = letters[digit] + text
    return text
