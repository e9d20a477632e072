"""Certificates: bounds on ropelength that can be checked without trusting anybody's floating point.

The core computes in intervals that are rounded outward; here its doubles become decimals of DIGITS digits,
rounded the same way. The core's last step outward is half a last bit of a double at least, 5e-17 of it, so
that decimals which move by 1e-19 cannot undo what was proven: `l_c` is at least `length`/`r_c` as decimals,
and `r_c`^2 at most `r`^2 - `s`^2/4. docs/explanation/theorem.md has the theorem,
docs/reference/certificates.md the document.
"""

import hashlib
import os
from dataclasses import dataclass
from decimal import ROUND_CEILING, ROUND_FLOOR, Context, Decimal
from importlib.metadata import version
from pathlib import Path
from typing import Any, Literal, TypeAlias

import numpy as np

from sono import _core
from sono.calls import Rope, rope_of
from sono.curve import polygon as polygon_of
from sono.records import Record

FORMAT, VERSION = "sono certificate", 1

DIGITS = 20
"""Of each decimal, at most."""

Condition: TypeAlias = Literal["bend", "pair"]


@dataclass(frozen=True, eq=False, repr=False)
class Decider(Record):
    """What keeps R from being larger: the `condition`, and one vertex that bends or the two of a pair.

    The `vertices` are (component, vertex), both counted from 0.
    """

    condition: Condition
    vertices: tuple[tuple[int, int], ...]

    def __str__(self) -> str:
        """Say it in a table."""
        return " ".join([self.condition, *(f"{c}:{i}" for c, i in self.vertices)])


@dataclass(frozen=True, eq=False, repr=False)
class Certificate(Record):
    """Proves that the type of a polygon of `n` vertices has a ropelength of at most `l_c`.

    `components` are the numbers of their vertices. In the unit of the vertices, `s` is at least the longest
    edge, `min_rad` at most the least radius of the inscribed arcs, `r` at most R, which `decided_by` says
    more of, `r_c` at most sqrt(R^2 - s^2/4), `length` at least that of the inscribed knot. `l_c` is at least
    `length`/`r_c`. All are decimals: a float that is made of one may be smaller. `polygon` is the SHA-256 of
    the vertices as little-endian doubles.

    >>> import sono
    >>> certificate = sono.certify("3_1")
    >>> certificate.n, certificate.l_c > sono.measure(sono.start("3_1", known=True)).l_c
    (164, True)
    """

    n: int
    components: tuple[int, ...]
    s: Decimal
    min_rad: Decimal
    r: Decimal
    r_c: Decimal
    length: Decimal
    l_c: Decimal
    decided_by: Decider
    polygon: str

    def document(self, file: str | os.PathLike[str]) -> dict[str, Any]:
        """Return the certificate of a file of these vertices, as JSON has it.

        Raises `OSError` for a file that cannot be read, `ValueError` for one that does not hold these
        vertices in plain rows of x y z.
        """
        return document_of(file, self.polygon, (FORMAT, VERSION), {"curve": None, **self.to_dict()})

    def rounded(self, digits: int = 14) -> str:
        """Return the bound with fewer digits, rounded up."""
        return f"{_rounded_up(digits).plus(self.l_c):f}"


def certify(vertices: Rope, /) -> Certificate:
    """Prove a bound on the ropelength of a curve's type; a name stands for the atlas's rope of the knot.

    Raises `CurveError` where nothing is proven, as its edges are too long for its bends or its distances,
    `ValueError` for a name of which the atlas has no rope. The type is that of the curve: `identify` names
    it. Source: docs/explanation/theorem.md.

    >>> import sono
    >>> sono.certify(sono.tighten("3_1", 240)).rounded(6)
    '32.7919'
    """
    components = rope_of(vertices)
    bound = _core.certify(components)
    up, down = _rounded_up(DIGITS).create_decimal, Context(DIGITS, ROUND_FLOOR).create_decimal
    return Certificate(
        n=sum(map(len, components)),
        components=tuple(map(len, components)),
        s=up(bound["longest_edge"]),
        min_rad=down(bound["min_rad"]),
        r=down(bound["r"]),
        r_c=down(bound["r_c"]),
        length=up(bound["inscribed_length"]),
        l_c=up(bound["l_c"]),
        decided_by=Decider(bound["condition"], tuple(bound["vertices"])),
        polygon=polygon_of(components),
    )


def document_of(
    file: str | os.PathLike[str], polygon: str, format: tuple[str, int], figures: dict[str, Any]
) -> dict[str, Any]:
    """Return the document, of a format and its version, of a file that holds a `polygon`: what is proven.

    Raises `OSError` for a file that cannot be read, `ValueError` for one that does not hold these vertices in
    plain rows of x y z.
    """
    data = Path(file).read_bytes()
    if polygon_in(data) != polygon:
        name = os.fspath(file)
        raise ValueError(f"{name}: does not hold these vertices in plain rows of x y z; sono.write does")
    head = {
        "format": format[0],
        "version": format[1],
        "program": f"sono {version('sono')}",
        "file": os.path.basename(file),
        "sha256": hashlib.sha256(data).hexdigest(),
    }
    return head | {key: figure for key, figure in figures.items() if key != "polygon"}


def _rounded_up(digits: int) -> Context:
    return Context(digits, ROUND_CEILING)


def polygon_in(data: bytes) -> str | None:
    """Tell the vertices in the bytes of a file, if those are plain rows of x y z and nothing else.

    Read as simply as a checker may do it: cells between spaces or commas, # before comments, a blank line
    between components.
    """
    parts: list[list[list[float]]] = [[]]
    try:
        for line in data.decode().splitlines():
            row, comment, _ = line.partition("#")
            if cells := row.replace(",", " ").split():
                parts[-1].append(list(map(float, cells)))
            elif not comment:
                parts.append([])
        return polygon_of([np.array(part) for part in parts if part])
    except ValueError:
        return None
