"""GRO files of GROMACS: a title, a count, atoms in columns, and the periodic box; then the next frame.

    a ring
        3
        1BEA      B    1   1.000   0.700   1.000
        ...
       3.00000   3.00000   3.00000

What of them becomes a curve is said in `molecules`. Lengths are in nanometres. Source: GROMACS,
reference manual, "gro file format".
"""

import re
from collections.abc import Sequence
from dataclasses import replace
from itertools import accumulate, groupby, pairwise

import numpy as np

from sono.formats.boxes import Box
from sono.formats.molecules import Atom, Model, curves
from sono.formats.vertices import FormatError, Raw, numbers, place, shown

CURE = "have the numbers of residues begin anew in a second chain"
"""How this format tells chains apart."""

_ROW = r"[ \d]{5}.{10}[ \d]{5}(?: *-?\d+\.\d+){3}"
_HEAD = re.compile(rf".*\n[ \t]*\d+[ \t]*\n{_ROW}")


def recognises(text: str) -> bool:
    """Tell whether a count and a row of an atom follow the first line."""
    return _HEAD.match(text) is not None


def read(text: str, name: str) -> list[Raw]:
    """Parse a whole file; lengths keep its unit. Raises `FormatError`."""
    lines = text.rstrip().split("\n")
    models, titles, first = list[Model](), list[str](), 0
    while first < len(lines):
        count = lines[first + 1].strip() if first + 1 < len(lines) else ""
        after = first + 2 + (int(count[:9]) if count.isdecimal() else 0)
        if not 2 < after - first <= len(lines) - first - 1:
            message = f"a count of atoms, so many rows, and the box should follow, not {shown(count)}"
            raise FormatError.at(name, first + 1, f"{message}; complete the frame")
        atoms = [_atom(line, name, number) for number, line in enumerate(lines[first + 2 : after], first + 3)]
        box = _box(lines[after], name, after + 1)
        models.append(Model(str(len(models) + 1), _parted(atoms), set(), box, cure=CURE))
        titles.append(lines[first].strip())
        first = after + 1
    return [replace(raw, comments=titles[:1]) for raw in curves(models, name)]


def _parted(atoms: Sequence[Atom]) -> list[Atom]:
    """Tell molecules apart, which GRO does by the numbers of residues alone.

    Where each residue holds three beads or more, all of one name, it is a molecule. Otherwise one begins
    where the numbers go back, but for 0, which comes after 99999.
    """
    sizes = [len(list(same)) for _, same in groupby(atom.number for atom in atoms)]
    beads = len({atom.name for atom in atoms}) == 1 and min(sizes) > 2
    numbers = [int(atom.number) if atom.number.isdecimal() else 0 for atom in atoms]
    begins = [one != other if beads else 0 < other < one for one, other in pairwise(numbers)]
    parts = accumulate(map(int, begins), initial=0)
    return [replace(atom, part=part) for atom, part in zip(atoms, parts, strict=True)]


def _atom(line: str, name: str, number: int) -> Atom:
    points = [column for column, sign in enumerate(line) if sign == "." and column >= 20]
    width = points[1] - points[0] if len(points) > 2 else 8  # more decimals have wider columns
    cells = [line[at : at + width].strip() for at in range(20, 20 + 3 * width, width)]
    at = place(cells, name, number, "from column 21")
    return Atom(False, line[10:15].strip(), "", line[5:10].strip(), "", 0, line[:5].strip(), at, number)


def _box(line: str, name: str, number: int) -> Box | None:
    try:
        cells = numbers(line.split())
        edges = np.diag(cells[:3])
        rest: Sequence[float] = cells[3:] or [0.0] * 6
        edges[[0, 0, 1, 1, 2, 2], [1, 2, 0, 2, 0, 1]] = rest
    except (ValueError, IndexError):
        raise FormatError.at(
            name, number, f"{shown(line.strip())} is no box; its three or nine numbers end the frame"
        ) from None
    there = np.isfinite(edges).all() and np.linalg.det(edges) != 0
    return Box(np.zeros(3), edges, np.full(3, True)) if there else None
