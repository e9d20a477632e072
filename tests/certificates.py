"""Certificates of polygons, made slowly and to sixty digits, for tests of what checks them."""

import hashlib
import math
from decimal import ROUND_CEILING, ROUND_FLOOR, Context, Decimal, localcontext
from typing import Any

import numpy as np

from sono.formats import text

PI = Decimal("3.141592653589793238462643383279502884197169399375105820974944")


def content_of(components: list[Any]) -> bytes:
    """The file that `sono` writes."""
    return text.write([np.asarray(part, float) for part in components], ["a rope"]).encode()


def certificate(components: list[Any], digits: int = 20) -> dict[str, Any]:
    """The certificate of a polygon, whose decimals have so many digits."""
    with localcontext(Context(prec=60, Emin=-9999, Emax=9999)):
        parts = [_Part(np.asarray(part, float)) for part in components]
        bends = [(_root(p.rad2[i] + p.s**2 / 4), "bend", [[c, i]]) for c, p in enumerate(parts) for i in p.rad2]
        r, condition, vertices = min([*bends, *_pairs(parts, min(bends)[0])])
        down, up = (Context(prec=digits, rounding=way) for way in (ROUND_FLOOR, ROUND_CEILING))
        r, s = r.normalize(down), max(p.s for p in parts).normalize(up)
        r_c = _root(max(r**2 - s**2 / 4, Decimal(0))).normalize(down)
        length = sum(p.length for p in parts).normalize(up)
        return {
            "format": "sono certificate",
            "version": 1,
            "program": "tests",
            "file": "rope.txt",
            "sha256": hashlib.sha256(content_of(components)).hexdigest(),
            "curve": None,
            "n": sum(p.n for p in parts),
            "components": [p.n for p in parts],
            "s": str(s),
            "min_rad": str(min(p.m for p in parts).normalize(down)),
            "r": str(r),
            "r_c": str(r_c),
            "length": str(length),
            "l_c": str((length / r_c if r_c else Decimal(1)).normalize(up)),
            "decided_by": {"condition": condition, "vertices": vertices},
        }


class _Part:
    """A component: edges `s_i`, their longest `s`, squares of Rad_i, the least Rad_i `m`, Length(K_P)."""

    def __init__(self, vertices: Any) -> None:
        self.vertices = vertices
        self.n = len(vertices)
        points = [[Decimal(x) for x in row] for row in vertices.tolist()]
        edges = [[b - a for a, b in zip(p, q, strict=True)] for p, q in zip(points, points[1:] + points[:1], strict=True)]
        self.s_i = [_root(sum(x * x for x in edge)) for edge in edges]
        self.s = max(self.s_i)
        self.rad2: dict[int, Decimal] = {}
        self.length = sum(self.s_i)
        for i, edge in enumerate(edges):
            before, both = edges[i - 1], self.s_i[i - 1] * self.s_i[i]
            dot = sum(a * b for a, b in zip(before, edge, strict=True))
            tangent = min(self.s_i[i - 1], self.s_i[i]) / 2
            u2 = (both - dot) / (both + dot) if both + dot > Decimal("1e-40") * both else Decimal("1e40")
            if u2 > Decimal("1e-40"):
                self.rad2[i] = tangent**2 / u2
                u = _root(u2)
                self.length -= 2 * tangent * (1 - _arctan(u) / u)
        self.m = _root(min(self.rad2.values()))


def _pairs(parts: list[_Part], most: Decimal) -> list[Any]:
    """Half the distances of the nearest pairs that count, by floating point up to the last step."""
    found = []
    for c, one in enumerate(parts):
        for d, other in list(enumerate(parts))[c:]:
            far = np.linalg.norm(one.vertices[:, None] / float(most) - other.vertices[None] / float(most), axis=2)
            if c == d:
                along = np.cumsum([0, *map(float, one.s_i)])
                apart = abs(along[:-1, None] - along[None, :-1])
                counts = np.minimum(apart, along[-1] - apart) >= float(PI * one.m - one.s)
                far = np.where(counts, far, np.inf)
            if far.min() < np.inf:
                i, j = np.unravel_index(far.argmin(), far.shape)
                ends = zip(one.vertices[i].tolist(), other.vertices[j].tolist(), strict=True)
                half = _root(sum((Decimal(a) - Decimal(b)) ** 2 for a, b in ends)) / 2
                found.append((half, "pair", [[c, int(i)], [d, int(j)]]))
    return found


def _root(value: Any) -> Decimal:
    return Decimal(value).sqrt()


def _arctan(u: Decimal) -> Decimal:
    """To sixty digits nearly, by a quarter of the angle again and again."""
    halvings = 12
    for _ in range(halvings):
        u = u / (1 + (1 + u * u).sqrt())
    return sum((-1) ** k * u ** (2 * k + 1) / (2 * k + 1) for k in range(12)) * 2**halvings


def last_digit(decimal: str, steps: int) -> str:
    """A decimal some steps of its last digit up or down, its twentieth if it has fewer."""
    value = Decimal(decimal)
    place = value.adjusted() - 19
    return str(value + Decimal(steps).scaleb(place)) if math.isfinite(value) else decimal
