"""Which periodic images of several chains are together: those that may be linked.

Chains are linked only if they overlap: if their extents do along each edge of the periodic box. A chain that
overlaps with none, as it is, is moved by whole boxes to where it does. Where more than one image overlaps
with another chain, links depend on the image that is taken, which the user is told.
"""

from collections.abc import Sequence
from dataclasses import replace
from itertools import product

import numpy as np
from numpy.typing import NDArray

from sono.formats.boxes import Box
from sono.formats.vertices import Chain

Floats = NDArray[np.float64]

MOVED = "chains were moved by whole boxes, to where they are nearest to each other"
UNCLEAR = (
    "chains reach several periodic images of each other, and how they are linked depends on the image that "
    "is taken; take images that are sure to be together, or a larger box"
)
"""Notes on what became of several chains in a box."""

AROUND = np.array(list(product((-1, 0, 1), repeat=3)), float)


@np.errstate(all="ignore")  # what is not finite is refused later on
def gathered(box: Box | None, chains: Sequence[Floats]) -> tuple[list[Floats], list[str]]:
    """Give whole chains, each (n_i, 3), where they overlap if some image does, and what was done."""
    if box is None or len(chains) < 2 or not all(np.isfinite(rows).all() for rows in chains):
        return list(chains), []
    scaled = [rows @ np.linalg.inv(box.edges) for rows in chains]
    low, high = (np.array([bound(rows, axis=0) for rows in scaled]) for bound in (np.min, np.max))
    shifts = _shifts((low + high) / 2, (high - low) / 2, box.periodic)
    notes = [MOVED] if shifts.any() else []
    if _unclear((low + high) / 2 + shifts, (high - low) / 2, box.periodic):
        notes.append(UNCLEAR)
    return [rows + shift @ box.edges for rows, shift in zip(chains, shifts, strict=True)], notes


def together(box: Box | None, chains: Sequence[Chain]) -> tuple[list[Chain], list[str]]:
    """Do the same to chains that know their lines."""
    rows, notes = gathered(box, [np.asarray(chain.rows, float) for chain in chains])
    return [replace(chain, rows=part) for chain, part in zip(chains, rows, strict=True)], notes


def _shifts(middles: Floats, halves: Floats, periodic: NDArray[np.bool_]) -> Floats:
    """Give by how many boxes to move each chain, (k, 3): beside one that has its place, if it overlaps so."""
    shifts = np.zeros(middles.shape)
    waiting, placed = list(range(len(middles))), list[int]()
    while waiting:
        one = placed.pop() if placed else waiting.pop(0)
        apart = middles[waiting] - middles[one] - shifts[one]
        room = halves[waiting] + halves[one]
        nearest = np.where(periodic & (abs(apart) >= room).any(axis=1)[:, None], -np.rint(apart), 0)
        beside = (abs(apart + nearest) < room).all(axis=1)
        shifts[waiting] += np.where(beside[:, None], nearest, 0)
        placed += [other for other, near in zip(waiting, beside, strict=True) if near]
        waiting = [other for other, near in zip(waiting, beside, strict=True) if not near]
    return shifts


def _unclear(middles: Floats, halves: Floats, periodic: NDArray[np.bool_]) -> bool:
    """Tell whether some chain overlaps with an image of another that is not the one which was taken."""
    around = AROUND[(AROUND[:, ~periodic] == 0).all(axis=1)]
    for k in range(1, len(middles)):
        apart = middles[:k] - middles[k]
        taken = np.where(periodic, np.rint(apart), 0)
        images = (apart - taken)[:, None] + around
        overlap = (abs(images) < (halves[:k] + halves[k])[:, None]).all(axis=2)
        if (overlap & (around != taken[:, None]).any(axis=2)).any():
            return True
    return False
