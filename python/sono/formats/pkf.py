"""PKF files of libbiarc: nodes with tangents, between which a curve goes along two arcs of circles, a biarc.

    PKF 0.2
    BIARC_KNOT trefoil
    ETICL 0
    END
    CITEL 0
    END
    HISTL 6
    HIST drawn
    END
    NCMP 1
    COMP 100
    NODE 1.1363 0.2903 0.1548 0.2936 1.2251 0.2837
    ...
    END

The arcs are sampled, as finely as `sampling` says. Nodes without tangents, or with the same one for all, are
joined by edges. Source: M. Carlen's libbiarc, its documentation of `Curve::readPKF`.
"""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from sono.formats.biarcs import Arcs, drawn
from sono.formats.doubts import closing_edge
from sono.formats.sampling import sampled
from sono.formats.vertices import Chain, FormatError, Raw, not_a_number, numbers, shown

Floats = NDArray[np.float64]

PIECES = [1 << doublings for doublings in range(10)]
"""Into how many edges an arc is divided, as far as needed."""


def recognises(text: str) -> bool:
    """Tell whether the text begins as a PKF file of any version does."""
    return text.startswith("PKF ")


@np.errstate(all="ignore")
def read(text: str, name: str) -> list[Raw]:
    """Parse a whole file; lengths keep its unit. Raises `FormatError`."""
    lines = _Lines(text, name)
    parts = list(lines.components())
    said = [lines.knot]
    if not all(part.smooth for part in parts):
        chains = [Chain(part.nodes[:, :3], part.lines, part.closed) for part in parts]
        note = f"{name}: the nodes are joined by edges, as they have no tangents of their own"
        return [Raw(chains, notes=[note], comments=said)]
    arcs = [part.arcs(name) for part in parts]
    try:
        curves = sampled(lambda pieces: drawn(arcs, pieces), PIECES)
    except ValueError as error:
        raise FormatError.at(name, parts[0].lines[0], f"{error}; correct the nodes") from None
    chains = [part.chain(curve) for part, curve in zip(parts, curves, strict=True)]
    note = f"{name}: the biarcs were sampled at {sum(map(len, curves))} points"
    return [Raw(chains, notes=[note], comments=said)]


class _Lines:
    """The lines of a file, taken one after the other."""

    def __init__(self, text: str, name: str) -> None:
        self._name = name
        self._lines = iter(enumerate([*text.rstrip().split("\n"), ""], 1))
        self._line = 1
        self.knot = ""

    def _take(self, what: str) -> str:
        self._line, line = next(self._lines, (self._line, ""))
        if not line.strip():
            raise self._error(f"the file ends where {what} should follow; complete it")
        return line

    def _error(self, message: str) -> FormatError:
        return FormatError.at(self._name, self._line, message)

    def components(self) -> Iterator["_Part"]:
        if self._take("PKF 0.2").split() != ["PKF", "0.2"]:
            raise self._error("only version 0.2 of PKF is read; the first line should be PKF 0.2")
        self.knot = self._take("BIARC_KNOT and a name").partition(" ")[2].strip()
        for tag in ("ETICL", "CITEL", "HISTL"):
            self._count(tag, 0)
            while self._take("END").strip() != "END":
                pass
        for _ in range(self._count("NCMP", 1)):
            count = self._count("COMP", 3)
            yield self._part([self._node() for _ in range(count)])
        for number, line in self._lines:
            if line.strip():
                raise FormatError.at(self._name, number, f"{shown(line.strip())} is left over; correct NCMP")

    def _count(self, tag: str, least: int) -> int:
        words = self._take(f"{tag} and a number").split()
        if len(words) != 2 or words[0] != tag or not words[1].isdecimal() or int(words[1][:9]) < least:
            raise self._error(f"{tag} and a whole number, {least} or more, should stand here")
        return int(words[1][:9])

    def _node(self) -> tuple[int, list[float]]:
        tag, *cells = self._take("NODE and its numbers").split()
        if tag != "NODE" or len(cells) not in (3, 6):
            raise self._error("NODE and x y z, and mostly a tangent, should stand here; or correct COMP")
        try:
            return self._line, numbers(cells)
        except ValueError:
            raise self._error(
                f"{shown(cells[not_a_number(cells) or 0])} is not a number; correct it"
            ) from None

    def _part(self, nodes: Sequence[tuple[int, list[float]]]) -> "_Part":
        for line, row in nodes:
            if len(row) != len(nodes[0][1]) or not np.isfinite(row).all():
                raise FormatError.at(self._name, line, f"{len(nodes[0][1])} finite numbers should stand here")
        if self._take("END").strip() != "END":
            raise self._error("END should stand here, after as many NODEs as COMP says")
        return _Part(np.array([row for _, row in nodes]), [line for line, _ in nodes])


@dataclass(frozen=True, eq=False)
class _Part:
    """A component: its nodes, (n, 6) with tangents or (n, 3), and the lines that they stand on."""

    nodes: Floats
    lines: list[int]

    @property
    def smooth(self) -> bool:
        """Whether there are tangents, and not one for all, as programs write that know none."""
        return self.nodes.shape[1] == 6 and bool(np.ptp(self.nodes[:, 3:], axis=0).any())

    @property
    def closed(self) -> bool:
        return not closing_edge(self.nodes[:, :3])

    def arcs(self, name: str) -> Arcs:
        """Give the arcs along the nodes. Raises `FormatError` where there are none."""
        found = Arcs.of(self.nodes, self.closed)
        if not found.proper.all():
            raise FormatError.at(
                name,
                self.lines[found.proper.argmin()],
                "no biarc goes from this node to the next, as one of the tangents points back; correct it, "
                "or leave out all tangents to join the nodes by edges",
            )
        return found

    def chain(self, curve: Floats) -> Chain:
        """Give the points of a curve the lines of the nodes ahead of them."""
        biarcs = len(self.nodes) - (not self.closed)
        lines = np.repeat(self.lines[:biarcs], len(curve) // biarcs).tolist()
        return Chain(curve, lines if self.closed else [*lines, self.lines[-1]], self.closed)
