"""What every format reads into, and the checks that every curve file must pass."""

import math
import re
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace
from typing import Any, Self

import numpy as np
from numpy.typing import NDArray

from sono.formats.closing import WAYS, Ends, closing
from sono.formats.doubts import closing_edge, ends_apart, jumps

REPEATED = 1e-4
"""A last vertex nearer to the first than this share of the edges beside them is the first again, rounded: in
double or single precision, or to the digits of a file. An edge so short beside such long ones is none."""

_FORTRAN = re.compile(r"([+-]?\d*\.?\d*)[dq]([+-]?\d+)|([+-]?\d*\.\d*)([+-]\d{3})", re.ASCII | re.IGNORECASE)
"""1.0D+00, 1.0Q+00 and 1.0-100: Fortran leaves the letter out where an exponent has three digits."""


SHOWN = 12
"""Lines that a message names at most."""


class FormatError(ValueError):
    """A curve file that cannot be read or written; the message is "file:line: what is wrong; the cure"."""

    @classmethod
    def at(cls, name: str, line: int, message: str) -> Self:
        """Make the error for one line (1-based) of the file `name`."""
        return cls(f"{name}:{line}: {message}")


@dataclass(frozen=True, eq=False)
class Chain:
    """One component as a file has it: its vertices, `rows` (n, 3), and the `lines` (n,) that they stand on.

    A format in which chains may be open says whether this one is `closed`; None leaves that to its ends. Of
    plain rows nothing is `said`: they are taken as closed, but may be meant otherwise.
    """

    rows: Any
    lines: Sequence[int]
    closed: bool | None = True
    said: bool = True


@dataclass(frozen=True, eq=False)
class Raw:
    """A curve as a format has read it, not yet checked.

    The `key` tells it from the others in its file, if there may be any. The `notes` tell the user what was
    made of the file. The `comments` are what the file says of it. It may be made of `parts` that have keys.
    """

    chains: Sequence[Chain]
    key: str = ""
    notes: Sequence[str] = ()
    comments: Sequence[str] = ()
    parts: Sequence["Raw"] = ()


def alone(raw: Raw, *keys: str) -> list[Raw]:
    """Give the only curve of a file, which needs no key, and has those that it would have beside others."""
    return [replace(raw, key="", parts=[replace(raw, key=key) for key in dict.fromkeys(keys) if key])]


@dataclass(frozen=True, eq=False)
class VertexFile:
    """A curve as read: `components`, each (n_i, 3) in the file's unit, and the `lines`, each (n_i,).

    The `key` tells it from others of the same file. The `notes` tell the user what was made of the file, the
    `comments` are what the file says of the curve. Of a component that is an open chain, closed as asked, the
    first so many vertices are its `own`; None, or nothing at all, stands for components that are rings.
    """

    name: str
    components: list[NDArray[np.float64]]
    lines: list[NDArray[np.int64]]
    key: str = ""
    notes: Sequence[str] = ()
    comments: Sequence[str] = ()
    own: Sequence[int | None] = ()

    @property
    def rings(self) -> list[bool]:
        """Tell which components are rings in the file."""
        return [own is None for own in self.own] or [True] * len(self.components)

    @property
    def chains(self) -> list[NDArray[np.float64]]:
        """The components with no vertices but those of the file."""
        own = self.own or [None] * len(self.components)
        return [vertices[:count] for vertices, count in zip(self.components, own, strict=True)]

    def where(self, component: int, vertex: int) -> str:
        """Say where a vertex stands (both indices 0-based), as "name:line"."""
        return f"{self.name}:{self.lines[component][vertex]}"

    def doubts(self) -> list[str]:
        """Say what was made of the file, and which components look like open chains."""
        return [*self.notes] + [
            f"{self.where(component, -1)}: the edge that closes the curve, from here back to line "
            f"{self.lines[component][0]}, is {far:.0f} times the mean edge; if this chain is open, its knot "
            "is what this edge makes of it: --close sphere closes it round the outside"
            for component, (vertices, ring) in enumerate(zip(self.components, self.rings, strict=True))
            if ring and (far := closing_edge(vertices))
        ]

    @classmethod
    def checked(cls, name: str, raw: Raw, close: Ends | None = None) -> "VertexFile":
        """Check a curve that was read, and close its open chains as asked. Raises `FormatError`.

        If they are left open, their `own` vertices are all.
        """
        strands = [_Strand.of(name, chain) for chain in raw.chains]
        _refuse_jumps(name, strands)
        pairs = [strand.closed(close) for strand in strands]
        closed = [strand for strand, _ in pairs]
        notes = [*raw.notes, *(note for _, note in pairs if note)]
        own = [strand.own for strand in closed]
        vertices, lines = [it.vertices for it in closed], [it.lines for it in closed]
        return cls(name, vertices, lines, raw.key, notes, raw.comments, own if any(own) else ())


@dataclass(frozen=True, eq=False)
class _Strand:
    """One component (n, 3) of a file: its first vertex is not repeated, every edge has a length.

    It `is_open`, or `may_be` if the user closes chains; its `ends` may be all that tells, in a format of a
    `chain` of atoms or in one of plain rows. Once it is closed, its first `own` vertices are the file's.
    """

    name: str
    vertices: NDArray[np.float64]
    lines: NDArray[np.int64]
    is_open: bool
    may_be: bool
    ends: bool
    chain: bool
    own: int | None = None

    @classmethod
    def of(cls, name: str, chain: Chain) -> Self:
        """Check a chain. Raises `FormatError`."""
        vertices, lines = np.array(chain.rows, np.float64), np.array(chain.lines)
        finite = np.isfinite(vertices).all(axis=1)
        if not finite.all():
            raise FormatError.at(
                name, lines[finite.argmin()], "a coordinate is not finite; give a number in its place"
            )
        meet = ends_meet(vertices)
        if meet:
            vertices, lines = vertices[:-1], lines[:-1]
        if len(vertices) < 3:
            raise FormatError.at(
                name,
                lines[0],
                f"the component that starts here has too few vertices: {len(vertices)}; give at least 3",
            )
        far = bool(closing_edge(vertices))
        is_open = not meet and (far if chain.closed is None else not chain.closed)
        ends = not meet and (chain.closed is None or not chain.said)
        _refuse_twins(name, vertices, lines)
        may_be = far or (ends and ends_apart(vertices))
        return cls(name, vertices, lines, is_open, may_be, ends, chain.closed is None)

    def closed(self, close: Ends | None) -> "tuple[_Strand, str | None]":
        """Close a chain that is open, or may be, as asked, and tell. Raises `FormatError`."""
        first, last = self.lines[[0, -1]]
        asked = close in WAYS
        if not self.is_open and not (self.may_be and (asked or (close and self.chain))):
            ring = f"{self.name}:{last}: the chain that ends here is a ring, as line {first} is a bond away"
            return self, f"{ring}: --close leaves it alone" if asked and self.ends else None
        if close is None:
            raise FormatError.at(
                self.name,
                last,
                f"the chain is open: it ends here and began on line {first}; --close direct joins its ends "
                "by an edge, --close sphere by way of a sphere round it",
            )
        own = len(self.vertices)
        if close == "open":
            return replace(self, own=own), None
        added = closing(self.vertices, close)
        lines = np.concatenate([self.lines, np.full(len(added), last)])
        way = "a sphere round it" if close == "sphere" else "the straight way"
        note = (
            f"{self.name}:{last}: the open chain that ends here was closed to line {first} by {way}, "
            f"with {len(added)} more vertices"
        )
        return replace(self, vertices=np.vstack([self.vertices, added]), lines=lines, own=own), note


def _refuse_twins(name: str, vertices: NDArray[np.float64], lines: NDArray[np.int64]) -> None:
    coincident = (vertices == np.roll(vertices, 1, axis=0)).all(axis=1)
    if coincident.any():
        i = coincident.argmax()
        raise FormatError.at(
            name, lines[i], f"this vertex equals its neighbour on line {lines[i - 1]}; delete one of the two"
        )


def _refuse_jumps(name: str, strands: Sequence[_Strand]) -> None:
    edges, box = jumps([strand.vertices for strand in strands])
    if not box:
        return
    after = np.concatenate([np.roll(strand.lines, -1) for strand in strands])[edges]
    listed = ", ".join(map(str, after[:SHOWN])) + (" and so on" if len(after) > SHOWN else "")
    sizes = " and ".join(f"{size:.4g} in {axis}" for axis, size in box.items())
    raise FormatError.at(
        name,
        after[0],
        f"a periodic box of about {sizes} has wrapped the curve, which jumps {len(after)} times, to the "
        f"lines {listed}; unwrap it, or put vertices on these edges if they are meant to be so long",
    )


def ends_meet(vertices: NDArray[np.float64]) -> bool:
    """Tell whether the last of the vertices (n, 3) repeats the first, exactly or up to rounding."""
    if len(vertices) < 2:
        return False
    # Quarters, so that the distance of two finite points is finite.
    first, second, last, before = (vertices[[0, 1, -1, -2]] / 4).tolist()
    edges = math.dist(first, second), math.dist(before, last)
    return math.dist(first, last) <= REPEATED * min(edges) or bool((vertices[0] == vertices[-1]).all())


def numbers(cells: Iterable[str]) -> list[float]:
    """Read numbers, Fortran's 1.0D+00 among them. Raises `ValueError`."""
    cells = list(cells)
    try:
        return list(map(float, cells))
    except ValueError:
        return [float(_number(cell)) for cell in cells]


def place(cells: Sequence[str], name: str, line: int, where: str) -> tuple[float, float, float]:
    """Read the x, y and z of an atom, which should stand `where`. Raises `FormatError`."""
    try:
        x, y, z = numbers(cells)
    except ValueError:
        message = f"{shown(' '.join(cells))} are no three numbers; x y z should stand {where}"
        raise FormatError.at(name, line, message) from None
    return x, y, z


def _number(cell: str) -> str:
    fortran = _FORTRAN.fullmatch(cell.strip())
    return "e".join(part for part in fortran.groups() if part is not None) if fortran else cell


def not_a_number(cells: Sequence[str]) -> int | None:
    """Give the index of the first cell that is no number, or None."""
    for index, cell in enumerate(cells):
        try:
            numbers([cell])
        except ValueError:
            return index
    return None


def shown(cell: str) -> str:
    """Quote a cell for a message, shortened: in a binary file one cell may run to megabytes."""
    return repr(cell if len(cell) <= 30 else cell[:27] + "...")
