"""What all drawn curves share: how fine they are, how large they may be, and their mirror images."""

import math

import numpy as np
from numpy.typing import NDArray

from sono.curve import Components

MOST_VERTICES = 500_000
"""Vertices of a curve that is drawn."""


def check_size(vertices: int, what: str) -> None:
    """Refuse what would take more memory and time than anyone has, before any is taken."""
    if vertices > MOST_VERTICES:
        raise ValueError(f"{what} would take over {MOST_VERTICES:,} vertices; give a smaller one")


def divided(corners: NDArray[np.float64], longest: float) -> NDArray[np.float64]:
    """Divide the edges of a polygon until none is longer than `longest`."""
    pieces = [
        np.linspace(begin, end, math.ceil(np.linalg.norm(end - begin) / longest), endpoint=False)
        for begin, end in zip(corners, np.roll(corners, -1, axis=0), strict=True)
    ]
    return np.vstack(pieces)


def mirror(curve: Components) -> Components:
    """Return the mirror image of `curve` in the plane z = 0."""
    return [component * (1, 1, -1) for component in curve]
