"""LAMMPS data files: the atoms and the bonds that a simulation begins with.

    LAMMPS data file: a trefoil

    60 atoms
    60 bonds
    1 atom types
    1 bond types

    -20.0 20.0 xlo xhi
    -20.0 20.0 ylo yhi
    -20.0 20.0 zlo zhi

    Atoms # bond

    1 1 1 0.0 -2.0 0.0 0 0 0
    ...

    Bonds

    1 1 1 2
    ...

With bonds, the chains follow them, and one is closed if its bonds are. Without, every molecule is a chain,
its atoms in order of their ids. Image flags unwrap a chain, or else every atom is taken at its image nearest
to the one before. Written are atoms of the style `bond` in a box in which no rope meets its images; every
coordinate reads back to the same bits. Source: the documentation of LAMMPS, command `read_data`.
"""

import re
from collections.abc import Iterable, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from sono.formats.bonds import along
from sono.formats.boxes import Box
from sono.formats.images import together
from sono.formats.simulated import BY_FLAGS, BY_NEAREST, Atoms, column, gaps, kept, whole
from sono.formats.vertices import FormatError, Raw, shown

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]

STYLES = {"atomic": 2, "charge": 3, "bond": 3, "angle": 3, "molecular": 3, "full": 4}
"""Columns ahead of x in each style of atoms."""

MOLECULAR = {"bond", "angle", "molecular", "full"}
"""Styles whose second column is the molecule."""

ROOM = 1.5
"""The box that is written reaches so many sizes of the curve to each side."""

_COUNT = re.compile(r"^[ \t]*\d+[ \t]+atoms\b", re.MULTILINE)
_SIDE = re.compile(r"(\S+)\s+(\S+)\s+([xyz])lo\s+\3hi")
_TILT = re.compile(r"(\S+)\s+(\S+)\s+(\S+)\s+xy\s+xz\s+yz")


def recognises(text: str) -> bool:
    """Tell whether a line near the beginning counts the atoms."""
    return _COUNT.search(text, 0, 10_000) is not None


@np.errstate(all="ignore")  # what is not finite is refused later on
def read(text: str, name: str) -> list[Raw]:
    """Parse a whole file; lengths keep its unit. Raises `FormatError`."""
    head, sections = _sections(text, name)
    for title in ("Atoms", "Bonds"):
        _agree(head, title.lower(), sections.get(title), name)
    if "Atoms" not in sections:
        raise FormatError.at(
            name, 1, "there is no section Atoms; give one, or call a file of plain rows .txt"
        )
    box = _box(head, name)
    atoms, flagged = _atoms(sections["Atoms"], box)
    bonds = _bonds(sections.get("Bonds"), atoms)
    groups, closed, notes = _by_order(atoms) if bonds is None else _by_bonds(bonds, atoms)
    pairs = [atoms.chain(group, box, ring) for group, ring in zip(groups, closed, strict=True)]
    for chain, _ in pairs if bonds is None else ():
        atoms.refuse_breaks(chain)
    if flagged or any(moved for _, moved in pairs):
        notes = [BY_NEAREST if any(moved for _, moved in pairs) else BY_FLAGS, *notes]
    sides = box if any(_SIDE.fullmatch(data) for _, data in head) else None
    chains, moved = together(sides, [chain for chain, _ in pairs])
    told = [f"{name}: {note}" for note in [*notes, *moved]]
    return [Raw(chains, notes=told, comments=_comments(text, head))]


def _by_order(atoms: Atoms) -> tuple[list[Ints], Sequence[bool | None], list[str]]:
    """Give the chains that molecules are, whether they are closed, and what there is to tell."""
    groups, notes = atoms.by_molecule()
    return groups, [None] * len(groups), notes + gaps([atoms.ids[group] for group in groups])


def _by_bonds(bonds: Ints, atoms: Atoms) -> tuple[list[Ints], Sequence[bool | None], list[str]]:
    """Give the chains along the bonds, likewise."""
    chains = list(along(bonds, atoms.name, atoms.lines))
    groups, notes = kept([chain for chain, _ in chains], len(atoms.ids))
    rings = {chain[0] for chain, ring in chains if ring}
    return groups, [group[0] in rings for group in groups], notes


@dataclass(frozen=True)
class _Section:
    """A section of the file `name`: what its comment says, its rows and the lines that they stand on."""

    name: str
    comment: str
    line: int
    rows: list[list[str]]
    lines: list[int]

    def columns(self, least: int, what: str) -> tuple[list[tuple[str, ...]], Ints]:
        """Give the columns that every row has, and the lines."""
        if not self.rows:
            raise FormatError.at(self.name, self.line, f"the section has no rows; give {what}")
        for row, line in zip(self.rows, self.lines, strict=True):
            if len(row) < least or len(row) != len(self.rows[0]):
                raise FormatError.at(
                    self.name, line, f"{len(row)} columns, where {what} should stand as in the other rows"
                )
        return list(zip(*self.rows, strict=True)), np.array(self.lines)


def _sections(text: str, name: str) -> tuple[list[tuple[int, str]], dict[str, _Section]]:
    """Give the lines of the head with their numbers, and the sections by their titles."""
    head: list[tuple[int, str]] = []
    sections: dict[str, _Section] = {}
    section = None
    for number, line in list(enumerate(text.split("\n"), 1))[1:]:  # the first line is a title
        data, _, comment = line.partition("#")
        if data.strip()[:1].isalpha():
            if data.strip() in sections:
                raise FormatError.at(name, number, f"there is a second section {data.strip()}; leave one out")
            section = sections[data.strip()] = _Section(name, comment.strip(), number, [], [])
        elif section is None:
            head += [(number, data.strip())]
        elif cells := data.split():
            section.rows.append(cells)
            section.lines.append(number)
    return head, sections


def _comments(text: str, head: Sequence[tuple[int, str]]) -> list[str]:
    """Give the title, and what stands alone behind a # before the sections."""
    lines = text.split("\n")
    said = [lines[0], *(lines[number - 1] for number, data in head if not data)]
    return [line.strip().removeprefix("#").strip() for line in said if line.strip()]


def _agree(head: Sequence[tuple[int, str]], things: str, section: _Section | None, name: str) -> None:
    """Check that a section has as many rows as the head says. Raises `FormatError`."""
    found = len(section.rows) if section else 0
    for line, data in head:
        words = data.split()
        if words[1:] == [things] and words[0] != str(found):
            raise FormatError.at(name, line, f"{data} are promised, the file has {found}; complete it")


def _box(head: Sequence[tuple[int, str]], name: str) -> Box:
    low, high, tilts = np.full(3, -0.5), np.full(3, 0.5), np.zeros(3)  # the box that LAMMPS assumes
    line = 1
    for number, data in head:
        here = np.array([number] * 3)
        if side := _SIDE.fullmatch(data):
            axis, line = "xyz".index(side[3]), number
            low[axis], high[axis] = column(side.groups()[:2], name, here, "a side of the box")
        elif tilt := _TILT.fullmatch(data):
            tilts = column(tilt.groups(), name, here, "a tilt of the box")
        elif "vec" in data:
            raise FormatError.at(name, number, "a box of any three edges is not read; write it restricted")
    try:
        return Box.of_bounds(low, high, tilts, np.full(3, True))
    except ValueError as error:
        raise FormatError.at(name, line, f"{error}; give each side its bounds, the lower one first") from None


def _atoms(section: _Section, box: Box) -> tuple[Atoms, bool]:
    """Read the atoms in order of their ids, and tell whether image flags moved any."""
    columns, lines = section.columns(5, "id, type and x y z")
    style = section.comment or _guess(columns, section)
    if style not in STYLES:
        raise FormatError.at(
            section.name,
            section.line,
            f"atoms of the style {shown(style)} are not read; write them as {', '.join(STYLES)}",
        )
    first = STYLES[style]
    if len(columns) not in (first + 3, first + 6):
        raise FormatError.at(
            section.name,
            lines[0],
            f"{len(columns)} columns; atoms of style {style} have {first + 3}, or {first + 6} with images",
        )
    rows = np.column_stack(
        [column(cells, section.name, lines, "a coordinate") for cells in columns[first : first + 3]]
    )
    flags = np.zeros(rows.shape)
    for axis, cells in enumerate(columns[first + 3 :]):
        flags[:, axis] = whole(cells, section.name, lines, "an image flag")
    if flags.any():
        rows = rows + flags @ box.edges
    molecules = whole(columns[1], section.name, lines, "a molecule's id") if style in MOLECULAR else None
    ids = whole(columns[0], section.name, lines, "an atom's id")
    images = len(columns) > first + 3
    return Atoms(section.name, ids, rows, lines, molecules, images).in_order(), bool(flags.any())


def _guess(columns: Sequence[tuple[str, ...]], section: _Section) -> str:
    """Tell the style by the number of columns, as far as it tells."""
    style = {5: "atomic", 8: "atomic", 6: "bond", 9: "bond", 7: "full", 10: "full"}.get(len(columns), "")
    if style == "bond" and not all(cell.isdigit() and int(cell) for cell in set(columns[2])):
        style = ""  # or charges
    if not style:
        raise FormatError.at(
            section.name, section.line, "the style of the atoms is not clear; write it behind: Atoms # bond"
        )
    return style


def _bonds(section: _Section | None, atoms: Atoms) -> Ints | None:
    """Give the bonds (m, 2) as places of their atoms, or None if there are none."""
    if section is None or not section.rows:
        return None
    columns, lines = section.columns(4, "id, type and two atoms")
    ends = np.column_stack([whole(cells, section.name, lines, "an atom's id") for cells in columns[2:4]])
    places = np.minimum(np.searchsorted(atoms.ids, ends), len(atoms.ids) - 1)
    unknown = (atoms.ids[places] != ends).any(axis=1)
    if unknown.any():
        raise FormatError.at(
            section.name,
            lines[unknown.argmax()],
            "the bond is with an atom that is not there; correct its id",
        )
    return places


def write(components: Iterable[NDArray[np.float64]], comments: Sequence[str]) -> str:
    """Give the whole file: a molecule for each component, and the bonds that close it."""
    parts = list(components)
    atoms, bonds = list[str](), list[str]()
    for molecule, vertices in enumerate(parts, 1):
        first = len(atoms) + 1
        for atom, (x, y, z) in enumerate(vertices.tolist(), first):
            following = atom + 1 if atom + 1 < first + len(vertices) else first
            atoms.append(f"{atom} {molecule} 1 {x!r} {y!r} {z!r} 0 0 0")
            bonds.append(f"{atom} 1 {atom} {following}")
    lines = [line for comment in comments for line in comment.splitlines()] or ["a curve, by sono"]
    head = [f"# {line}".rstrip() for line in lines]
    counts = [f"{len(atoms)} atoms", f"{len(bonds)} bonds", "1 atom types", "1 bond types"]
    sides = _sides(np.vstack(parts))
    masses = ["Masses", "", "1 1.0"]
    return "\n".join(
        [
            *head,
            "",
            *counts,
            "",
            *sides,
            "",
            *masses,
            "",
            "Atoms # bond",
            "",
            *atoms,
            "",
            "Bonds",
            "",
            *bonds,
            "",
        ]
    )


def _sides(rows: Floats) -> list[str]:
    low, high = rows.min(axis=0), rows.max(axis=0)
    half = ROOM * (high - low).max()
    middles = ((low + high) / 2).tolist()
    return [f"{m - half} {m + half} {axis}lo {axis}hi" for m, axis in zip(middles, "xyz", strict=True)]
