"""Whether two curves may be of one type, whatever the order and orientation of their components.

>>> from sono.starts import start
>>> may_be_alike(start("L6n1{0,0}")[::-1], start("T(3,3)")), may_be_alike(start("6^3_1"), start("6^3_3"))
(True, False)
"""

from collections import Counter
from itertools import product

from sono.curve import Components
from sono.invariants import fingerprint
from sono.invariants.crossings import diagram, linking_matrix
from sono.starts.drawing import mirror

MOST_TURNED = 4
"""Components that are turned round in all ways: of more only linking numbers and the knots are compared."""


def may_be_alike(one: Components, other: Components) -> bool:
    """Tell whether invariants allow that a curve is of the type of the other, or of its mirror image.

    They are those of `fingerprint`, for some orientation of the components, and for each of these alone.
    Raises `TooEntangledError`, and `CurveError` for a curve that crosses itself.
    """
    if len(one) != len(other):
        return False
    if len(one) == 1:
        ours = fingerprint(one)
        return ours == fingerprint(other) or ours == fingerprint(mirror(other))
    return _linked(one) == _linked(other) and any(
        _knots(one) == _knots(image) and (len(one) > MOST_TURNED or bool(_turned(one) & _turned(image)))
        for image in (other, mirror(other))
    )


def _linked(curve: Components) -> list[list[int]]:
    """Return how often each component is linked with others, in the order of these numbers."""
    return sorted(sorted(row) for row in abs(linking_matrix(diagram(curve))).tolist())


def _knots(curve: Components) -> Counter[object]:
    return Counter(fingerprint([component]) for component in curve)


def _turned(curve: Components) -> set[object]:
    """Return the fingerprints for all orientations, but for linking numbers, which tell of the order."""
    ways = product((1, -1), repeat=len(curve) - 1)  # to turn all components round changes nothing
    return {
        fingerprint([component[::turn] for component, turn in zip(curve, (1, *way), strict=True)])[1:]
        for way in ways
    }
