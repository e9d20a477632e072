"""What tells whether two curves have the same knot type.

`fingerprint` is what a search checks each trial with; `homfly` is sharper.
The single invariants of `polynomials` and `signatures` take a projection: `alexander(diagram(curve), -1)`.
"""

import cmath
import math
from typing import TypeAlias

from sono.curve import Components
from sono.invariants.crossings import Crossings, diagram, linking_numbers, planar_diagram
from sono.invariants.diagrams import as_crossings, gauss_code, homfly_polynomial, shortened, written
from sono.invariants.polynomials import alexander_modulo
from sono.invariants.signatures import signature

Fingerprint: TypeAlias = tuple[tuple[int, ...], tuple[int, ...], tuple[int, ...]]

ORDERS = (2, 3, 5)
"""Orders of the roots of unity at which a fingerprint has signatures and Alexander polynomials."""


def fingerprint(curve: Components) -> Fingerprint:
    """Return the linking numbers of all pairs, signatures, and Alexander polynomials modulo a prime.

    The signatures are those at exp(2 pi i/k), k = 2, 3, 5. The polynomial, at a root t of unity of the same
    orders modulo `PRIME`, is known up to a factor of plus or minus a power of t, which the power 2 k removes.
    Curves of one type, with their components in one order, have equal fingerprints, however thin they are.
    Few passages of strands leave it as it was, but 66 of the 249 knots to 10 crossings share theirs with
    others; see `homfly`. Raises `TooEntangledError`, and `CurveError` for a curve that crosses itself.
    """
    return fingerprint_of(diagram(curve))


def fingerprint_of(found: Crossings) -> Fingerprint:
    """Return the fingerprint of a curve by its projection."""
    signatures = tuple(signature(found, cmath.exp(2j * math.pi / k)) for k in ORDERS)
    return linking_numbers(found), signatures, tuple(alexander_modulo(found, k) for k in ORDERS)


def homfly(curve: Components) -> str:
    """Return the HOMFLY polynomial in Regina's variables alpha and z, written x and y.

    Of some 20 crossings and more it may need regina. Raises ImportError where that is not installed.
    """
    gauss = shortened(gauss_code(diagram(curve)))
    if (polynomial := homfly_polynomial(gauss)) is not None:
        return written(polynomial)
    import regina

    link = regina.Link.fromPD(planar_diagram(as_crossings(gauss)))
    link.insertLink(regina.Link(len(curve) - link.countComponents()))  # circles without crossings
    return str(link.homflyAZ())
