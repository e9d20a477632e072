"""Connected sums: two curves side by side, joined by two parallel strands.

>>> from sono.starts import start
>>> len(joined(start("3_1"), start("4_1"))), len(joined(start("Hopf"), start("3_1")))
(1, 2)
"""

import numpy as np
from numpy.typing import NDArray

from sono.curve import Components
from sono.starts.drawing import divided

APART = 4.0
"""Distance of two summands, in radii; the strands between them are half of it apart at least."""

TURNS = 1000
"""Directions that are tried for one from which the first component is farthest out."""


class EnclosedError(ValueError):
    """A link that cannot be joined to another as it is drawn."""


def joined(one: Components, other: Components, seed: int = 0) -> Components:
    """Return the connected sum of two curves, at the first component of each, in a rope's units.

    Each summand is turned to a random direction, by the seed, such that its first component is farthest out
    towards the other; the vertex where it is so is opened to two strands. Nothing of either curve lies
    between the two, so the strands may be drawn straight, and both keep their orientations. The sum is the
    first component; those of `one` come next. Raises `EnclosedError` where other components are all around.
    """
    random = np.random.default_rng(seed)
    (one, a), (other, b) = _turned(one, 1, random), _turned(other, -1, random)
    shift = one[0][a] - other[0][b] + [APART, 0, 0]
    other = [component + shift for component in other]
    begin, end = _opened(one[0], a), _opened(other[0], b)
    return [divided(np.vstack([begin, end]), 0.6), *one[1:], *other[1:]]


def _turned(curve: Components, side: int, random: np.random.Generator) -> tuple[Components, int]:
    """Turn a curve at random until its first component is farthest out along x on this side; say where."""
    for _ in range(TURNS):
        turn, _ = np.linalg.qr(random.normal(size=(3, 3)))
        turn *= np.sign(np.linalg.det(turn))
        turned = [component @ turn for component in curve]
        reach = [(side * component[:, 0]).max() for component in turned]
        if np.argmax(reach) == 0:
            return turned, int(np.argmax(side * turned[0][:, 0]))
    raise EnclosedError("the first component is inside of others, where nothing can be joined to it")


def _opened(component: NDArray[np.float64], vertex: int) -> NDArray[np.float64]:
    """Return the strand that is left of a component when it is cut open at a vertex, which becomes two."""
    before, at, after = (component[(vertex + k) % len(component)] for k in (-1, 0, 1))
    ends = [at + (after - at) / 4, at + (before - at) / 4]
    strand = np.roll(component, -vertex, axis=0)[1:]
    return np.vstack([ends[:1], strand, ends[1:]])
