"""LAMMPS dump files: frames of a simulation, each of blocks that begin with `ITEM:`.

    ITEM: TIMESTEP
    5000
    ITEM: NUMBER OF ATOMS
    60
    ITEM: BOX BOUNDS pp pp pp
    -4 4
    -4 4
    -4 4
    ITEM: ATOMS id mol type x y z ix iy iz
    1 1 1 0.0 -2.0 0.0 0 0 0
    ...

Every frame is a curve, with its timestep as the key, or its number if timesteps come twice. Every molecule is
a component; its atoms follow each other in order of their ids. A chain is unwrapped out of the periodic box:
by its image flags, by the unwrapped coordinates, or else every atom to its image nearest to the one before.
Source: the documentation of LAMMPS, commands `dump` and `Howto_triclinic`.
"""

import re
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from functools import partial

import numpy as np
from numpy.typing import NDArray

from sono.formats.boxes import Box
from sono.formats.images import together
from sono.formats.refused import attempted
from sono.formats.simulated import BY_FLAGS, BY_NEAREST, Atoms, column, gaps, whole
from sono.formats.vertices import FormatError, Raw, alone, shown

Floats = NDArray[np.float64]

PLACES = [("xu", "yu", "zu"), ("xsu", "ysu", "zsu"), ("x", "y", "z"), ("xs", "ys", "zs")]
FLAGS = ("ix", "iy", "iz")
"""The columns of the place of an atom, those that need no unwrapping first, and of the image of the box."""


def recognises(text: str) -> bool:
    """Tell whether the text begins with a block of a dump."""
    return re.match(r"\s*ITEM:", text) is not None


def read(text: str, name: str) -> list[Raw]:
    """Parse a whole file; lengths keep its unit. Raises `FormatError`.

    A frame that is wrong spoils no other: its error is raised by its chains.
    """
    frames = list(_frames(text, name))
    if not frames:
        raise FormatError.at(
            name, 1, "the file holds no block ITEM: ATOMS; write one with dump atom or custom"
        )
    keys = [frame["TIMESTEP"].first if "TIMESTEP" in frame else "" for frame in frames]
    if len(set(keys)) < len(keys):
        keys = [str(number) for number in range(1, len(frames) + 1)]
    found = [attempted(partial(_curve, frame, key), key) for key, frame in zip(keys, frames, strict=True)]
    return found if len(found) > 1 else alone(found[0], keys[0])


@dataclass(frozen=True)
class _Block:
    """One block of the file `name`: the words after `ITEM:`, its rows, and the line that it begins on."""

    name: str
    title: str
    rows: list[str]
    line: int

    @property
    def first(self) -> str:
        """Its first row."""
        return self.rows[0].strip() if self.rows else ""

    def number(self) -> int:
        """Read the whole number that its first row should be. Raises `FormatError`."""
        if not (self.first.isascii() and self.first.isdigit()):
            raise self.error(0, f"{shown(self.first)} is no whole number; it should stand here")
        return int(self.first[:18])

    def error(self, row: int, message: str) -> FormatError:
        """Make the error for one row, or for the title for -1."""
        return FormatError.at(self.name, self.line + 1 + row, message)


def _blocks(text: str, name: str) -> Iterator[_Block]:
    lines = [line.rstrip() for line in text.rstrip().split("\n")]
    starts = [i for i, line in enumerate(lines) if line.startswith("ITEM:")]
    if not starts or "".join(lines[: starts[0]]).strip():
        raise FormatError.at(
            name, 1, f"{shown(lines[0])} is no ITEM:, with which each block of a dump begins"
        )
    for start, end in zip(starts, [*starts[1:], len(lines)], strict=True):
        yield _Block(
            name, lines[start].removeprefix("ITEM:").strip(), _filled(lines[start + 1 : end]), start + 1
        )


def _filled(rows: list[str]) -> list[str]:
    """Leave out empty rows at the end."""
    while rows and not rows[-1]:
        rows.pop()
    return rows


def _frames(text: str, name: str) -> Iterator[dict[str, _Block]]:
    """Give the blocks of every frame by the first word of their titles."""
    frame: dict[str, _Block] = {}
    for block in _blocks(text, name):
        word = block.title.partition(" ")[0]
        if word == "ENTRIES":
            raise block.error(-1, "the dump is one of ENTRIES, not of atoms; use dump custom id mol x y z")
        frame[word] = block
        if word == "ATOMS":
            yield frame
            frame = {}
    if "TIMESTEP" in frame:
        yield frame


def _check(frame: dict[str, _Block]) -> None:
    """Refuse a frame that is not whole."""
    last = [*frame.values()][-1]
    for word in ("TIMESTEP", "NUMBER", "ATOMS"):
        if word not in frame:
            raise last.error(-1, f"the frame has no ITEM: {word}; complete it, or cut the file off above it")
    frame["TIMESTEP"].number()
    promised, found = frame["NUMBER"].number(), len(frame["ATOMS"].rows)
    if promised != found:
        raise last.error(
            found - 1,
            f"the frame ends here after {found} atoms, its ITEM: NUMBER OF ATOMS is {promised}; complete it, "
            f"or cut the file off above line {frame['TIMESTEP'].line}",
        )


@np.errstate(all="ignore")  # what is not finite is refused later on
def _curve(frame: dict[str, _Block], key: str) -> Raw:
    _check(frame)
    box = _box(frame["BOX"]) if "BOX" in frame else None
    atoms, notes = _atoms(frame["ATOMS"], box)
    groups, left = atoms.by_molecule()
    pairs = [atoms.chain(group, box, None) for group in groups]
    for chain, _ in pairs:
        atoms.refuse_breaks(chain)
    if any(moved for _, moved in pairs):
        notes = [BY_NEAREST]
    chains, moved = together(box, [chain for chain, _ in pairs])
    notes = [*notes, *moved, *left, *gaps([atoms.ids[group] for group in groups])]
    where = f"{atoms.name}:{frame['ATOMS'].line}"
    return Raw(chains, key, [f"{where}: {note}" for note in notes])


def _atoms(block: _Block, box: Box | None) -> tuple[Atoms, list[str]]:
    """Read the rows of atoms, in order of their ids, and say how they were unwrapped."""
    columns = _columns(block)
    lines = block.line + 1 + np.arange(len(block.rows))
    if "id" not in columns:
        raise block.error(
            -1, "there is no column id, without which the order along a chain is lost; dump it too"
        )
    names = next((names for names in PLACES if all(name in columns for name in names)), None)
    if names is None:
        raise block.error(
            -1, "there are no columns x y z, xs ys zs, xu yu zu or xsu ysu zsu; dump three of them"
        )
    rows = np.column_stack([column(columns[c], block.name, lines, f"a coordinate {c}") for c in names])
    unwrapped, flagged, notes = "u" in names[0], False, list[str]()
    if "s" in names[0]:
        if box is None:
            raise block.error(
                -1, f"{' '.join(names)} are scaled by a box, but the frame has no ITEM: BOX BOUNDS"
            )
        rows = box.at(rows)
    if not unwrapped and box is not None and all(flag in columns for flag in FLAGS):
        flags = [whole(columns[flag], block.name, lines, f"an image flag {flag}") for flag in FLAGS]
        flagged, rows = True, rows + np.column_stack(flags) @ box.edges
        notes = [BY_FLAGS] if np.any(flags) else []
    molecules = whole(columns["mol"], block.name, lines, "a molecule's id") if "mol" in columns else None
    ids = whole(columns["id"], block.name, lines, "an atom's id")
    return Atoms(block.name, ids, rows, lines, molecules, unwrapped or flagged).in_order(), notes


def _columns(block: _Block) -> dict[str, Sequence[str]]:
    names = block.title.split()[1:]
    cells = [row.split() for row in block.rows]
    for row, found in enumerate(cells):
        if len(found) != len(names):
            raise block.error(
                row, f"{len(found)} columns, but ITEM: ATOMS names {len(names)}; complete the row"
            )
    if not cells:
        raise block.error(-1, "the frame has no atoms; dump a group that has some")
    return dict(zip(names, zip(*cells, strict=True), strict=False))


def _box(block: _Block) -> Box:
    """Read a box, also a tilted one, given by the bounds of all of it, and one of any three edges."""
    words = block.title.split()[2:]
    marks = [word for word in words if len(word) == 2 and set(word) <= set("pfsm")]
    periodic = np.array([mark == "pp" for mark in marks] if len(marks) == 3 else [True] * 3)
    lines = block.line + 1 + np.arange(len(block.rows))
    cells = [row.split() for row in block.rows]
    width = 4 if "abc" in words else 3 if "xy" in words else 2
    if len(cells) != 3 or any(len(row) != width for row in cells):
        raise block.error(-1, f"the box should have three rows of {width} numbers; complete it")
    bounds = np.array([column(row, block.name, lines[[i] * width], "a bound") for i, row in enumerate(cells)])
    try:
        if "abc" in words:
            return Box(bounds[:, 3], bounds[:, :3], periodic).checked()
        xy, xz, yz = bounds[:, 2] if "xy" in words else np.zeros(3)
        low = bounds[:, 0] - [min(0, xy, xz, xy + xz), min(0, yz), 0]
        high = bounds[:, 1] - [max(0, xy, xz, xy + xz), max(0, yz), 0]
        return Box.of_bounds(low, high, np.array([xy, xz, yz]), periodic)
    except ValueError as error:
        raise block.error(0, f"{error}; give each side its bounds, the lower one first") from None
