"""Check a certificate of ropelength, and take nothing that it says on trust.

    python check_certificate.py CERTIFICATE FILE

CERTIFICATE is JSON as `sono certify` writes it, FILE the rows x y z that it is of. All is proven again from
the vertices, by docs/explanation/theorem.md: (T1) to (T3) and (C1) to (C9) are lines of it. The exit code is
0 if the certificate holds, 1 if it is refused: the message says which inequality fails, and where.

This file needs nothing but Python and shares no code with the program that makes certificates. It has no
floating point: a coordinate is a whole number of units, 2^-k each, with k so large that all are exact and the
longest edge has 2^128 units at least. Squares and products are exact; roots are rounded as the proof needs.
"""

from __future__ import annotations

import hashlib
import json
import re
import sys
from collections.abc import Callable, Iterator
from decimal import Decimal
from fractions import Fraction
from itertools import accumulate, pairwise
from math import ceil, floor, inf, isqrt
from pathlib import Path
from typing import Any, NamedTuple

Point = tuple[int, int, int]

TEXTS = ("format", "program", "file", "sha256")
DECIMALS = ("s", "min_rad", "r", "r_c", "length", "l_c")
FIELDS = {*TEXTS, *DECIMALS, "version", "curve", "n", "components", "decided_by"}

NUMBER = re.compile(r"[+-]?(\d+\.?\d*|\.\d+)([eE][+-]?\d+)?", re.ASCII)
DECIMAL = re.compile(r"(\d{1,400})(?:\.(\d{1,400}))?(?:[eE][+-]?\d{1,3})?", re.ASCII)
DIGITS = 20  # of a decimal, the significant ones, at most
BITS = 128  # the longest edge has 2^BITS units at least; fixed point has so many bits behind the point
PI = Fraction("3.14159265358979323846264338327950288419716939937510")  # from below (C6)
NEAR = Fraction(1, 10**9)  # share up to which what decided R attains it


class RefusedError(ValueError):
    """The certificate does not hold; the message says why."""


def check(certificate: str | Path, file: str | Path) -> dict[str, Any]:
    """Return the fields of a certificate, by its path, that holds for a file of rows x y z.

    Raises `RefusedError` for one that does not hold, `OSError` where a file cannot be read.
    """
    fields = fields_of(Path(certificate).read_bytes())
    prove(fields, Path(file).read_bytes())
    return fields


def prove(fields: dict[str, Any], content: bytes) -> None:
    """Prove what a certificate says of the content of a file. Raises `RefusedError`."""
    if hashlib.sha256(content).hexdigest() != fields["sha256"]:
        raise RefusedError("sha256: the certificate is of a file of other bytes")
    components = rows_of(content)
    counts = list(map(len, components))
    for key, found in (("n", sum(counts)), ("components", counts)):
        if fields[key] != found:
            raise RefusedError(f"{key}: {fields[key]} in the certificate, {found} in the file")
    vertices, units = in_units(components)
    loops = list(map(loop_of, vertices))
    claimed = {key: Fraction(fields[key]) * units for key in DECIMALS}
    four_r2 = ceil(4 * claimed["r"] ** 2)
    prove_thickness(loops, four_r2, units)
    prove_figures(loops, claimed, units)
    check_decided_by(fields["decided_by"], loops, four_r2)


def fields_of(content: bytes) -> dict[str, Any]:
    """Read a certificate, and see that each field is of its kind. Raises `RefusedError`."""
    try:
        fields = json.loads(content.decode(), object_pairs_hook=once)
    except (ValueError, RecursionError) as error:
        raise RefusedError(f"the certificate is no JSON: {error}") from None
    if not isinstance(fields, dict):
        raise RefusedError("the certificate is no JSON object")
    for key in sorted(FIELDS.symmetric_difference(fields)):
        raise RefusedError(f"{key}: the certificate {'lacks it' if key in FIELDS else 'may not have it'}")
    for key, kind in {**dict.fromkeys(TEXTS, str), "decided_by": dict}.items():
        if not isinstance(fields[key], kind):
            raise RefusedError(f"{key}: not {'a text' if kind is str else 'an object'}")
    for key in DECIMALS:
        match = DECIMAL.fullmatch(fields[key]) if isinstance(fields[key], str) else None
        digits = ((match[1] + (match[2] or "")) if match else "").strip("0")
        if not 0 < len(digits) <= DIGITS:
            raise RefusedError(f"{key}: not a text with a decimal above 0 of at most {DIGITS} digits")
    if (fields["format"], repr(fields["version"])) != ("sono certificate", "1"):
        raise RefusedError("format: not version 1 of a sono certificate, the only one that is known here")
    if fields["curve"] is not None:
        raise RefusedError("curve: one of several in a file; write it to a file of its own, in rows x y z")
    return fields


def once(pairs: list[tuple[str, Any]]) -> dict[str, Any]:
    """Make an object, none of whose keys may come twice."""
    if len(found := dict(pairs)) < len(pairs):
        raise ValueError("a key comes twice")
    return found


def rows_of(content: bytes) -> list[list[tuple[float, ...]]]:
    """Read the vertices of each component, as the nearest binary64 numbers. Raises `RefusedError`.

    A blank line ends a component, whose last vertex may repeat the first; a # starts a comment, and a line
    that has nothing else ends nothing.
    """
    blocks: list[list[tuple[float, ...]]] = [[]]
    for number, line in enumerate(content.splitlines(), 1):
        data, comment, _ = line.decode("latin-1").partition("#")
        cells = [cell.strip() for cell in data.split("," if "," in data else None)]
        if cells:
            row = tuple(float(cell) if NUMBER.fullmatch(cell) else inf for cell in cells)
            if len(row) != 3 or not all(abs(x) < inf for x in row):
                raise RefusedError(f"line {number} of the file is not three numbers x y z")
            blocks[-1].append(row)
        elif not comment:
            blocks.append([])
    components = [rows[:-1] if rows[0] == rows[-1] else rows for rows in blocks if rows]
    if not components or min(map(len, components)) < 3:
        raise RefusedError("the file has a component of fewer than 3 vertices, or none")
    return components


def in_units(components: list[list[tuple[float, ...]]]) -> tuple[list[list[Point]], int]:
    """Return the vertices as whole numbers of a unit, and how many units make 1."""
    ratios = [[[x.as_integer_ratio() for x in row] for row in rows] for rows in components]
    units = max(below for rows in ratios for row in rows for _, below in row)
    whole = [[[x * (units // below) for x, below in row] for row in rows] for rows in ratios]
    longest = max(square(p, q) for rows in whole for p, q in pairwise([*rows, rows[0]]))
    finer = 1 << max(0, BITS - (longest.bit_length() - 1) // 2)
    return [[(x * finer, y * finer, z * finer) for x, y, z in rows] for rows in whole], units * finer


def square(p: Point | list[int], q: Point | list[int]) -> int:
    """Return the square of the distance of two points."""
    return (p[0] - q[0]) ** 2 + (p[1] - q[1]) ** 2 + (p[2] - q[2]) ** 2


def root_above(value: int) -> int:
    """Return the least whole number that is not below the root of another."""
    return isqrt(value - 1) + 1 if value else 0


def shown(value: Fraction) -> str:
    """Show a number to more digits than the certificate has."""
    return f"{Decimal(value.numerator) / Decimal(value.denominator):.{DIGITS + 2}g}"


class Loop(NamedTuple):
    """One component in units.

    `along` are the arclengths to each vertex and all round, from above; `longest` is S_c^2; `bends` are
    4 Rad_i^2 from below where the polygon turns; `length` is that of its part of K_P, from above; pairs count
    from the arclength `counts` on, which is from below.
    """

    vertices: list[Point]
    along: list[int]
    longest: int
    bends: dict[int, int]
    length: int
    counts: int


def loop_of(vertices: list[Point]) -> Loop:
    """Measure a component."""
    edges = [(x - u, y - v, z - w) for (u, v, w), (x, y, z) in pairwise([*vertices, vertices[0]])]
    squares = [x * x + y * y + z * z for x, y, z in edges]
    along = list(accumulate(map(root_above, squares), initial=0))  # (C1)
    bends, saved = {}, 0
    for i, (x, y, z) in enumerate(edges):
        u, v, w = edges[i - 1]
        dot, product = u * x + v * y + w * z, squares[i - 1] * squares[i]
        shorter = min(squares[i - 1], squares[i])
        both = isqrt(product)  # |a||b| from below (C2)
        if cross := product - dot * dot:  # |a x b|^2
            bends[i] = shorter * max(0, both + dot) ** 2 // cross  # (C3)
            saved += isqrt(shorter) * saving(both, dot) >> BITS if dot > 0 else 0  # (C5)
        elif dot <= 0:  # back along the edge before, or from a vertex that comes twice
            bends[i] = 0
    counts = floor(PI * isqrt(min(bends.values())) / 2) - root_above(max(squares))  # (C6)
    return Loop(vertices, along, max(squares), bends, along[-1] - saved, counts)


def saving(both: int, dot: int) -> int:
    """Return 1 - atan(u)/u from below in fixed point, u = tan(theta/2), for |a||b| and a.b > 0 (C4)."""
    one = 1 << BITS
    cosine = root_above(-(-(both + dot << 2 * BITS) // (2 * both)))  # of theta/2, from above
    z = max(0, one - cosine) * one // (one + cosine)  # tan(theta/4)^2 from below
    total, power, k = 0, z, 1
    while power:
        total += power * 4 * k // (4 * k * k - 1)
        power, k = power * z >> BITS, k + 1  # z^k exceeds it by less than k
        total -= -(-(power + k) * 4 * k // (4 * k * k - 1))  # rounded up
        power, k = power * z >> BITS, k + 1
    return max(0, total)


def prove_thickness(loops: list[Loop], four_r2: int, units: int) -> None:
    """Prove the three conditions of the theorem for 4 R^2. Raises `RefusedError`."""

    def fail(what: str, most: int) -> None:
        r, bound = (shown(Fraction(isqrt(value), 2 * units)) for value in (four_r2, most))
        raise RefusedError(f"r: {what}: R = {r} against {bound}")

    longest = max(loop.longest for loop in loops)
    if four_r2 <= 2 * longest:
        fail("R > S/sqrt 2 fails (T3)", 2 * longest)
    for c, loop in enumerate(loops):
        for i, bend in loop.bends.items():
            if bend + loop.longest < four_r2:
                fail(f"R^2 <= M_c^2 + S_c^2/4 fails at {[c, i]} (T1)", bend + loop.longest)
    for c, loop in enumerate(loops):
        for d, other in enumerate(loops[c:], c):
            for i, j, apart in nearer(loop, other, four_r2):
                fail(f"2 R <= |v_i - v_j| fails for {[c, i]} and {[d, j]} (T2)", apart)


def nearer(one: Loop, other: Loop, least: int) -> Iterator[tuple[int, int, int]]:
    """Give vertices that may count and are nearer than the root of the `least` square, and theirs (C7)."""
    a, b, root = one.along, other.along, root_above(least)
    todo = [(0, len(one.vertices), 0, len(other.vertices))]
    while todo:
        i, i_end, j, j_end = todo.pop()
        if one is other and min(b[j_end - 1] - a[i], a[i_end - 1] - b[j] + b[-1]) < one.counts:
            continue
        p, q = (i + i_end) // 2, (j + j_end) // 2
        reach = root + max(a[p] - a[i], a[i_end - 1] - a[p]) + max(b[q] - b[j], b[j_end - 1] - b[q])
        apart = square(one.vertices[p], other.vertices[q])
        if apart >= reach * reach:
            continue
        if i_end - i == j_end - j == 1:
            if apart < least:
                yield i, j, apart
        elif one is other and i == j:
            todo += [(i, p, i, p), (i, p, p, i_end), (p, i_end, p, i_end)]
        elif i_end - i >= j_end - j:
            todo += [(i, p, j, j_end), (p, i_end, j, j_end)]
        else:
            todo += [(i, i_end, j, q), (i, i_end, q, j_end)]


def prove_figures(loops: list[Loop], claimed: dict[str, Fraction], units: int) -> None:
    """Prove what follows from the vertices, and from r and s. Raises `RefusedError`."""
    longest, bend = max(loop.longest for loop in loops), min(min(loop.bends.values()) for loop in loops)
    length, room = sum(loop.length for loop in loops), claimed["r"] ** 2 - claimed["s"] ** 2 / 4
    least = claimed["length"] / claimed["r_c"] * units
    for key, holds, what, bound in (
        ("s", claimed["s"] ** 2 >= longest, "below the longest edge", isqrt(longest)),
        ("min_rad", 4 * claimed["min_rad"] ** 2 <= bend, "above the least M_c", isqrt(bend) // 2),
        ("length", claimed["length"] >= length, "below Length(K_P)", length),
        ("r_c", claimed["r_c"] ** 2 <= room, "above sqrt(r^2 - s^2/4) (C8)", isqrt(max(0, int(room)))),
        ("l_c", claimed["l_c"] >= least, "below length / r_c (C9)", least),
    ):
        if not holds:
            said, proven = shown(claimed[key] / units), shown(Fraction(bound) / units)
            raise RefusedError(f"{key}: {said} is {what}, {proven}")


def check_decided_by(decided: dict[str, Any], loops: list[Loop], four_r2: int) -> None:
    """See that what is said to have decided R is there and attains it. Raises `RefusedError`."""
    condition, places = decided.get("condition"), decided.get("vertices")
    every = {repr([c, i]) for c, loop in enumerate(loops) for i in range(len(loop.vertices))}
    if not isinstance(places, list) or len(decided) > 2 or not every.issuperset(map(repr, places)):
        raise RefusedError("decided_by: its vertices are not in the file, or it has more than it may have")
    if (condition, len(places)) not in (("bend", 1), ("pair", 2)):
        raise RefusedError('decided_by: neither a "bend" with one vertex nor a "pair" with two')
    (c, i), (d, j) = places[0], places[-1]
    attained, along = 0, abs(loops[c].along[i] - loops[d].along[j])
    if condition == "bend":
        attained = loops[c].bends.get(i, 0) + loops[c].longest
    elif c != d or min(along, loops[c].along[-1] - along) * (1 + NEAR) >= loops[c].counts:
        attained = square(loops[c].vertices[i], loops[d].vertices[j])
    if not (1 - NEAR) ** 2 * four_r2 <= attained <= (1 + NEAR) ** 2 * four_r2:
        raise RefusedError(f"decided_by: R is not what the {condition} at {places} allows")


def main() -> int:
    """Check CERTIFICATE FILE; return the exit code."""
    return command(check, "CERTIFICATE", "l_c")


def command(check: Callable[[str, str], dict[str, Any]], kind: str, bound: str) -> int:
    """Check what the command line names, a proof of this `kind` and a FILE; return the exit code."""
    if len(sys.argv) != 3:
        print(f"usage: python check_{kind.lower()}.py {kind} FILE", file=sys.stderr)
        return 2
    _, proof, file = sys.argv
    try:
        proven = check(proof, file)[bound]
    except (RefusedError, OSError) as error:
        print(f"{proof}: refused: {error}", file=sys.stderr)
        return 1
    print(f"{proof}: holds: the type of {file} has a representative of ropelength {proven} at most")
    return 0


if __name__ == "__main__":
    sys.exit(main())
