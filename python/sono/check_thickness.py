"""Check a sharper bound on ropelength, from the thickness of the inscribed curve itself; trust nothing.

    python check_thickness.py THICKNESS FILE

THICKNESS is JSON as `sono certify --sharp` writes it, FILE the rows x y z that it is of. All is proven again
from the vertices, by docs/explanation/theorem.md: (T1) to (T3) as check_certificate.py does, (T5) and (T6)
by (C11). The exit code is 0 if the bound holds, 1 if it is refused.

It shares whole numbers and readers with check_certificate.py, beside which it has to be, and nothing with
the program that makes bounds.
"""

from __future__ import annotations

import hashlib
import json
import sys
from fractions import Fraction
from math import ceil, isqrt
from pathlib import Path
from typing import Any, NamedTuple, TypeAlias

if __package__:
    from sono import check_certificate as exact
else:
    try:
        import check_certificate as exact  # type: ignore[import-not-found,no-redef]
    except ModuleNotFoundError:
        sys.exit("check_thickness.py: needs check_certificate.py beside it; copy both into one folder")

Point: TypeAlias = exact.Point
RefusedError = exact.RefusedError

TEXTS = ("format", "program", "file", "sha256")
DECIMALS = ("r", "tau", "length", "l_k")
DEPTH = 12  # halvings of an arc at most
ONE = 1 << exact.BITS


def check(thickness: str | Path, file: str | Path) -> dict[str, Any]:
    """Return the fields of a thickness, by its path, that holds for a file of rows x y z.

    Raises `RefusedError` for one that does not hold, `OSError` where a file cannot be read.
    """
    fields, content = fields_of(Path(thickness).read_bytes()), Path(file).read_bytes()
    if hashlib.sha256(content).hexdigest() != fields["sha256"]:
        raise RefusedError("sha256: the thickness is of a file of other bytes")
    prove({key: Fraction(fields[key]) for key in DECIMALS}, exact.rows_of(content))
    return fields


def fields_of(content: bytes) -> dict[str, Any]:
    """Read a thickness, and see that each field is of its kind. Raises `RefusedError`."""
    try:
        fields = json.loads(content.decode(), object_pairs_hook=exact.once)
    except (ValueError, RecursionError) as error:
        raise RefusedError(f"the thickness is no JSON: {error}") from None
    if not isinstance(fields, dict) or set(fields) != {*TEXTS, *DECIMALS, "version"}:
        raise RefusedError("the thickness is no JSON object of the keys that it has to have")
    for key in (*TEXTS, *DECIMALS):
        if not isinstance(fields[key], str):
            raise RefusedError(f"{key}: not a text")
    for key in DECIMALS:
        match = exact.DECIMAL.fullmatch(fields[key])
        digits = (match[1] + (match[2] or "")).strip("0") if match else ""
        if not 0 < len(digits) <= exact.DIGITS:
            raise RefusedError(f"{key}: not a decimal above 0 of at most {exact.DIGITS} digits")
    if (fields["format"], repr(fields["version"])) != ("sono thickness", "1"):
        raise RefusedError("format: not version 1 of a sono thickness, the only one that is known here")
    return fields


def prove(claimed: dict[str, Fraction], components: list[list[tuple[float, ...]]]) -> None:
    """Prove r, tau, length and l_k, in the unit of the vertices. Raises `RefusedError`."""
    vertices, units = exact.in_units(components)
    loops = list(map(exact.loop_of, vertices))
    exact.prove_thickness(loops, ceil(4 * (claimed["r"] * units) ** 2), units)  # (T1) to (T3)
    bend, two_tau = min(min(loop.bends.values()) for loop in loops), ceil(2 * claimed["tau"] * units)
    if two_tau**2 > bend:
        raise RefusedError("tau: above the least M_c (T5)")
    prove_distances(loops, two_tau)
    if claimed["length"] * units < sum(loop.length for loop in loops):
        raise RefusedError("length: below Length(K_P)")
    if claimed["l_k"] * claimed["tau"] < claimed["length"]:
        raise RefusedError("l_k: below length / tau (T7)")


def prove_distances(loops: list[exact.Loop], two_tau: int) -> None:
    """Prove (T6). Raises `RefusedError`."""
    longest = exact.root_above(max(loop.longest for loop in loops))
    spare = (longest >> exact.BITS - 10) + (1 << 10)  # far more than rounding moves any point of an arc
    arcs = [[arc_at(loop.vertices, i, spare) for i in range(len(loop.vertices))] for loop in loops]
    for c, one in enumerate(loops):
        for d, other in enumerate(loops[c:], c):
            for i, j, _ in exact.nearer(one, other, (two_tau + longest) ** 2):
                if not are_apart(arcs[c][i], arcs[d][j], two_tau):
                    raise RefusedError(f"tau: K_P is not proven 2 tau apart at {[c, i]} and {[d, j]} (T6)")


Capsule: TypeAlias = tuple[list[int], list[int], int]


class Arc(NamedTuple):
    """A part of K_i: an arc from `start` to `end`, whose tangents meet in `corner`, all in units.

    `cosine` is that of half its angle, in fixed point. Points of K_i, and those of the arc as it would be
    without rounding, are no more than `spare` away from it.
    """

    start: Point
    corner: Point
    end: Point
    cosine: int
    spare: int

    def halves(self) -> tuple[Arc, Arc]:
        """Cut the arc in its middle, which lies between the corners of both halves."""
        before, after = (
            between(p, self.corner, self.cosine, ONE + self.cosine) for p in (self.start, self.end)
        )
        middle, cosine = between(before, after, 1, 2), isqrt((ONE + self.cosine) * ONE // 2)
        return (
            Arc(self.start, before, middle, cosine, self.spare),
            Arc(middle, after, self.end, cosine, self.spare),
        )

    def capsule(self) -> Capsule:
        """Return centre and half axis of a straight piece, and how far K_i is from it, times 8 (C11)."""
        chord = [p + q for p, q in zip(self.start, self.end, strict=True)]
        height = [2 * p - q for p, q in zip(self.corner, chord, strict=True)]
        centre = [4 * p + q for p, q in zip(chord, height, strict=True)]
        axis = [4 * (q - p) for p, q in zip(self.start, self.end, strict=True)]
        return centre, axis, exact.root_above(exact.square(height, [0, 0, 0])) + 8 * self.spare


def between(p: Point, q: Point, share: int, whole: int) -> Point:
    """Return the point on the way from p to q at a share of the whole, rounded."""
    x, y, z = (a + (b - a) * share // whole for a, b in zip(p, q, strict=True))
    return x, y, z


def arc_at(vertices: list[Point], i: int, spare: int) -> Arc:
    """Return the arc at a vertex, `spare` being for rounding: for unequal edges more is needed."""
    v, ends = vertices[i], (vertices[i - 1], vertices[(i + 1) % len(vertices)])
    squares = [exact.square(v, end) for end in ends]
    both = isqrt(squares[0] * squares[1])
    dot = sum((b - a) * (c - b) for a, b, c in zip(ends[0], v, ends[1], strict=True))
    share = [isqrt(min(squares) * ONE * ONE // square) for square in squares]
    start, end = (between(v, ends[k], share[k], 2 * ONE) for k in (0, 1))
    cosine = isqrt(max(0, both + dot) * ONE * ONE // (2 * both))
    unequal = exact.root_above(max(squares)) - isqrt(min(squares))
    return Arc(start, v, end, cosine, spare + unequal)


def are_apart(one: Arc, other: Arc, two_tau: int) -> bool:
    """Tell whether two parts are proven to be 2 tau apart (C11)."""
    todo = [(one, other, 0)]
    while todo:
        a, b, depth = todo.pop()
        if capsules_apart(a.capsule(), b.capsule(), 8 * two_tau):
            continue
        if depth == DEPTH:
            return False
        todo += [(x, y, depth + 1) for x in a.halves() for y in b.halves()]
    return True


def capsules_apart(one: Capsule, other: Capsule, least: int) -> bool:
    """Tell whether two capsules are so far apart in the direction of their centres (C7)."""
    (x, g, d), (y, h, e) = one, other
    n = [q - p for p, q in zip(x, y, strict=True)]
    along = [sum(p * q for p, q in zip(n, axis, strict=True)) for axis in (n, g, h)]
    gap, needed = along[0] - abs(along[1]) - abs(along[2]), least + d + e
    return gap >= 0 and gap * gap >= needed * needed * along[0]


def main() -> int:
    """Check THICKNESS FILE; return the exit code."""
    return exact.command(check, "THICKNESS", "l_k")


if __name__ == "__main__":
    sys.exit(main())
