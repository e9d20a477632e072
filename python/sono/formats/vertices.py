"""What every format reads into, and the checks that every curve file must pass."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Self

import numpy as np
from numpy.typing import NDArray


class FormatError(ValueError):
    """A curve file that cannot be read or written; the message is "file:line: what is wrong; the cure"."""

    @classmethod
    def at(cls, name: str, line: int, message: str) -> Self:
        """Make the error for one line (1-based) of the file `name`."""
        return cls(f"{name}:{line}: {message}")


@dataclass(frozen=True, eq=False)
class VertexFile:
    """A curve as read: `components`, each (n_i, 3) in the file's unit, and the `lines`, each (n_i,)."""

    name: str
    components: list[NDArray[np.float64]]
    lines: list[NDArray[np.int64]]

    def where(self, component: int, vertex: int) -> str:
        """Say where a vertex stands (both indices 0-based), as "name:line"."""
        return f"{self.name}:{self.lines[component][vertex]}"

    @classmethod
    def checked(
        cls, name: str, components: Sequence[tuple[Sequence[Sequence[float]], Sequence[int]]]
    ) -> "VertexFile":
        """Check components, each as (rows of x y z, their line numbers). Raises `FormatError`."""
        pairs = [_closed(name, np.array(rows, np.float64), np.array(lines)) for rows, lines in components]
        return cls(name, [vertices for vertices, _ in pairs], [lines for _, lines in pairs])


def _closed(
    name: str, vertices: NDArray[np.float64], lines: NDArray[np.int64]
) -> tuple[NDArray[np.float64], NDArray[np.int64]]:
    """Give one component as a closed polygon: the first vertex is not repeated, every edge has a length."""
    finite = np.isfinite(vertices).all(axis=1)
    if not finite.all():
        raise FormatError.at(
            name, lines[finite.argmin()], "a coordinate is not finite; give a number in its place"
        )
    if len(vertices) > 1 and (vertices[0] == vertices[-1]).all():
        vertices, lines = vertices[:-1], lines[:-1]
    if len(vertices) < 3:
        raise FormatError.at(
            name,
            lines[0],
            f"the component that starts here has too few vertices: {len(vertices)}; give at least 3",
        )
    coincident = (vertices == np.roll(vertices, 1, axis=0)).all(axis=1)
    if coincident.any():
        i = coincident.argmax()
        raise FormatError.at(
            name, lines[i], f"this vertex equals its neighbour on line {lines[i - 1]}; delete one of the two"
        )
    return vertices, lines


def not_a_number(cells: Sequence[str]) -> int | None:
    """Give the index of the first cell that is no number, or None."""
    for index, cell in enumerate(cells):
        try:
            float(cell)
        except ValueError:
            return index
    return None


def shown(cell: str) -> str:
    """Quote a cell for a message, shortened: in a binary file one cell may run to megabytes."""
    return repr(cell if len(cell) <= 30 else cell[:27] + "...")
