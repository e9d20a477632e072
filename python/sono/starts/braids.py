"""Closed braids: strands round an axis, drawn for a rope of radius about 1.

>>> len(braid([1, -2, 1, -2])), len(braid([1, 1]))
(1, 2)
"""

import math
from collections.abc import Iterator, Sequence

import numpy as np
from numpy.typing import NDArray

from sono.curve import Components
from sono.starts.drawing import check_size


def braid(word: Sequence[int]) -> Components:
    """Return the closure of the braid `word` of generators +-1, +-2, ...; a positive one is right-handed.

    The strands run round the z axis at radii 2 apart. In a crossing two neighbours make half a turn about the
    point between them, so they stay 2 apart; crossings that share no strand share a sector where their order
    allows. There are max |generator| + 1 strands, and a strand without crossings is a circle. Raises
    ValueError for a generator 0, or where there would be over `MOST_VERTICES`.
    """
    if 0 in word:
        raise ValueError("a braid generator must not be 0: they count from +-1")
    strands = max(map(abs, word), default=0) + 1
    # At least 36 vertices on each strand, and 12 for each crossing on two of them.
    check_size(max(36 * strands, 24 * len(word)), f"a braid of {strands} strands, {len(word)} crossings")
    target, lift = _sectors(word, strands)
    sectors = len(target)
    check_size(12 * sectors * strands, f"a braid of {strands} strands, {len(word)} crossings")
    # A sector 4 long at the innermost strand keeps the half turns from pinching below radius 1.
    inner = max(2.0, 4 * sectors / (2 * np.pi))
    samples = max(12, math.ceil(36 / sectors))
    time = np.arange(samples) / samples
    half_turn = np.pi * time**2 * (3 - 2 * time)

    def piece(sector: int, position: int) -> NDArray[np.float64]:
        end = target[sector, position]
        rho = inner + (position + end) + (position - end) * np.cos(half_turn)
        angle = 2 * np.pi * (sector + time) / sectors
        return np.column_stack(
            [rho * np.cos(angle), rho * np.sin(angle), lift[sector, position] * np.sin(half_turn)]
        )

    return [
        np.vstack([piece(sector, position) for sector, position in circuit]) for circuit in _circuits(target)
    ]


def _circuits(target: NDArray[np.int_]) -> Iterator[list[tuple[int, int]]]:
    """Follow each component once: give its sectors, and the position at which it enters each."""
    sectors, strands = target.shape
    unseen = set(range(strands))
    while unseen:
        first = position = min(unseen)
        circuit: list[tuple[int, int]] = []
        while not circuit or position != first:
            unseen.remove(position)
            for sector in range(sectors):
                circuit.append((sector, position))
                position = int(target[sector, position])
        yield circuit


def _sectors(word: Sequence[int], strands: int) -> tuple[NDArray[np.int_], NDArray[np.float64]]:
    """Pack the crossings into as few sectors as their order allows.

    Returns two (sectors, strands) arrays: where each position goes in each sector, and +1, -1 or 0 for a
    strand that passes over, under or straight on.
    """
    free = [0] * strands
    target, lift = [np.arange(strands)], [np.zeros(strands)]
    for generator in word:
        left = abs(generator) - 1
        sector = max(free[left], free[left + 1])
        free[left] = free[left + 1] = sector + 1
        if sector == len(target):
            target.append(np.arange(strands))
            lift.append(np.zeros(strands))
        target[sector][[left, left + 1]] = left + 1, left
        lift[sector][[left, left + 1]] = np.sign(generator), -np.sign(generator)
    return np.array(target), np.array(lift)
