"""Certificates of polygons, made slowly and to sixty digits, for the tests of what checks them."""

import hashlib
import json
import math
from decimal import ROUND_CEILING, ROUND_FLOOR, Context, Decimal, localcontext
from itertools import pairwise
from typing import Any, TypeAlias

import numpy as np

from sono.formats import text

Parts: TypeAlias = list[Any]
"""Components, (n, 3) each."""

Fields: TypeAlias = dict[str, Any]

PI = Decimal("3.141592653589793238462643383279502884197169399375105820974944")


def content_of(components: Parts) -> bytes:
    """The file that `sono` writes."""
    return text.write([np.asarray(part, float) for part in components], ["a rope"]).encode()


def coded(fields: Fields) -> bytes:
    return json.dumps(fields, indent=1).encode()


def certificate(components: Parts, digits: int = 20) -> Fields:
    """The certificate of a polygon, with decimals of so many digits."""
    with localcontext(Context(prec=60, Emin=-9999, Emax=9999)):
        loops = [Loop(np.asarray(part, float)) for part in components]
        bends = [((p.rad2[i] + p.s**2 / 4).sqrt(), [[c, i]]) for c, p in enumerate(loops) for i in p.rad2]
        r, places = min(bends + _pairs(loops))
        least = max(p.s for p in loops) / 1000  # where nothing is true, as no figure may be 0
        down, up = (Context(prec=digits, rounding=way) for way in (ROUND_FLOOR, ROUND_CEILING))
        fields = {
            "format": "sono certificate",
            "version": 1,
            "program": "tests",
            "file": "rope.txt",
            "sha256": hashlib.sha256(content_of(components)).hexdigest(),
            "curve": None,
            "n": sum(p.n for p in loops),
            "components": [p.n for p in loops],
            "s": str(max(p.s for p in loops).normalize(up)),
            "min_rad": str(max(least, min(p.m for p in loops)).normalize(down)),
            "r": str(max(least, r).normalize(down)),
            "length": str(sum((p.length for p in loops), Decimal(0)).normalize(up)),
            "decided_by": {"condition": "bend" if len(places) == 1 else "pair", "vertices": places},
        }
    return concluded(fields, digits)


def concluded(fields: Fields, digits: int = 20) -> Fields:
    """The certificate with what follows from r, s and length."""
    with localcontext(Context(prec=60, Emin=-9999, Emax=9999)):
        down, up = (Context(prec=digits, rounding=way) for way in (ROUND_FLOOR, ROUND_CEILING))
        r, s = Decimal(fields["r"]), Decimal(fields["s"])
        r_c = max(r**2 - s**2 / 4, r**2 / 100).sqrt().normalize(down)
        l_c = (Decimal(fields["length"]) / r_c).normalize(up)
    return {**fields, "r_c": str(r_c), "l_c": str(l_c)}


def nudged(decimal: str, steps: int) -> str:
    """A decimal, so many steps of its twentieth digit up or down."""
    value = Decimal(decimal)
    return str(value + steps * Decimal(1).scaleb(value.adjusted() - 19))


class Loop:
    """A component: edges `s_i`, the longest `s`, squares of Rad_i, the least Rad_i `m`, Length(K_P)."""

    def __init__(self, vertices: Any) -> None:
        self.vertices, self.n = vertices, len(vertices)
        points = [[Decimal(x) for x in row] for row in vertices.tolist()]
        edges = [[b - a for a, b in zip(p, q, strict=True)] for p, q in pairwise([*points, points[0]])]
        self.s_i = [sum((x * x for x in edge), Decimal(0)).sqrt() for edge in edges]
        self.s = max(self.s_i)
        self.rad2: dict[int, Decimal] = {}
        self.length, self.turns = sum(self.s_i, Decimal(0)), list[float]()
        for i, edge in enumerate(edges):
            dot = sum((a * b for a, b in zip(edges[i - 1], edge, strict=True)), Decimal(0))
            both, tangent = self.s_i[i - 1] * self.s_i[i], min(self.s_i[i - 1], self.s_i[i]) / 2
            cosine = dot / both
            self.turns.append(math.degrees(math.acos(max(-1, min(1, float(cosine))))))
            if abs(cosine) < 1 - Decimal("1e-45"):
                u = ((1 - cosine) / (1 + cosine)).sqrt()
                self.rad2[i] = (tangent / u) ** 2
                self.length -= 2 * tangent * (1 - arctan(u) / u)
            elif cosine < 0:
                self.rad2[i] = Decimal(0)
        self.m = min(self.rad2.values()).sqrt()

    def counts(self, i: int, j: int) -> bool:
        """Whether a pair of its vertices counts."""
        along = sum(self.s_i[min(i, j) : max(i, j)])
        return min(along, sum(self.s_i) - along) >= PI * self.m - self.s


def _pairs(loops: list[Loop]) -> list[Any]:
    """Half the least distances of pairs that count; floating point only leaves out what is far from them."""
    found = []
    for c, one in enumerate(loops):
        for d, other in enumerate(loops[c:], c):
            size = max(abs(one.vertices).max(), abs(other.vertices).max())
            far = np.linalg.norm((one.vertices / size)[:, None] - other.vertices / size, axis=2)
            if c == d:
                at = np.array([float(sum(one.s_i[:i]) / one.s) for i in range(one.n + 1)])
                apart = abs(at[:-1, None] - at[:-1])
                least = float((PI * one.m - one.s) / one.s) - 1e-9 * at[-1]
                far[(np.minimum(apart, at[-1] - apart) < least) | (apart == 0)] = np.inf
            most = np.inf
            for place in np.argsort(far, axis=None):
                i, j = map(int, np.unravel_index(place, far.shape))
                if far[i, j] > most or far[i, j] == np.inf:
                    break
                if c != d or one.counts(i, j):
                    most = min(most, far[i, j] * (1 + 1e-12))
                    found.append((_apart(one.vertices[i], other.vertices[j]) / 2, [[c, i], [d, j]]))
    return found


def _apart(one: Any, other: Any) -> Decimal:
    ends = zip(one.tolist(), other.tolist(), strict=True)
    return sum(((Decimal(a) - Decimal(b)) ** 2 for a, b in ends), Decimal(0)).sqrt()


def arctan(u: Decimal) -> Decimal:
    """By halves of the angle, and the series."""
    for _ in range(12):
        u = u / (1 + (1 + u * u).sqrt())
    return 2**12 * sum(((-1) ** k * u ** (2 * k + 1) / (2 * k + 1) for k in range(12)), Decimal(0))
