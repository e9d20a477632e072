"""Torus knots and links, and chains of rings: smooth curves, drawn for a rope of radius about 1.

Their length is close to their ropelength, and they are sampled so finely (turning angles below about 20
degrees) that the polygon has the knot type of the smooth curve.

>>> len(torus(2, 3)), len(torus(2, 4)), len(chain(3))
(1, 2, 3)
"""

import math

import numpy as np

from sono.curve import Components
from sono.starts.drawing import check_size


def torus(p: int, q: int, n: int | None = None) -> Components:
    """Return the torus knot or link T(p,q), which winds p times the long way round and q times the short way.

    The minor radius of the torus is 1. There are g = gcd(p, q) components of n vertices each; by default n
    gives turning angles of 15 to 20 degrees and is a multiple of q/g, so that the polygon has the (q/g)-fold
    symmetry of the curve. pq > 0 is right-handed, pq < 0 its mirror image. Raises ValueError where p or q is
    zero, n is less than 3, or there would be over `MOST_VERTICES`.
    """
    check_type(p, q)
    components = math.gcd(p, q)
    long, short = abs(p) // components, abs(q) // components
    n = short * max(3, round(14 * (long + short) / short)) if n is None else n
    if n < 3:
        raise ValueError(f"a closed polygon needs at least 3 vertices, not {n}")
    check_size(components * n, f"T({p},{q})")
    # q/p: the strands climb at 45 degrees, as in the tightest rope of two strands. 1: room in the hole.
    major = 1 + short / long
    time = 2 * np.pi * np.arange(n) / n
    curve = []
    for k in range(components):
        around = long * time
        through = short * time + 2 * np.pi * k / abs(p)
        rho = major + np.cos(through)
        # Turning clockwise as seen looking forward along the strand: a right-handed screw.
        z = -math.copysign(1, p * q) * np.sin(through)
        curve.append(np.column_stack([rho * np.cos(around), rho * np.sin(around), z]))
    return curve


def check_type(p: int, q: int) -> None:
    """Refuse what is no torus knot or link."""
    if p == 0 or q == 0:
        raise ValueError(f"T({p},{q}) is no torus knot: p and q must not be zero")


def chain(rings: int) -> Components:
    """Return a simple chain of round rings: 1 is the unknot, 2 the Hopf link, 3 the sum of two Hopf links.

    The rings have radius 3. Each is the one before it, moved on by 4 and turned by 90 degrees: every gap is
    then 2, and neighbours have linking number +1. Raises ValueError for less than one ring, or where there
    would be over `MOST_VERTICES`.
    """
    check_size(48 * rings, f"a chain of {rings} rings")
    if rings < 1:
        raise ValueError(f"a chain has at least one ring, not {rings}")
    time = 2 * np.pi * np.arange(48) / 48
    along, across = 3 * np.cos(time), 3 * np.sin(time)
    turns = np.pi / 2 * np.arange(rings)
    return [
        np.column_stack([along + 4 * k, across * math.cos(turn), -across * math.sin(turn)])
        for k, turn in enumerate(turns)
    ]
