"""Curves that the tests of formats write in the style of other programs."""

from collections.abc import Iterator

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]


def trefoil(n: int = 60, scale: float = 1.0) -> Floats:
    """A trefoil on a torus, of radii 4 and 2, as n vertices (n, 3)."""
    t = 2 * np.pi * np.arange(n) / n
    around = 4 + 2 * np.cos(3 * t)
    return scale * np.column_stack([around * np.cos(2 * t), around * np.sin(2 * t), 2 * np.sin(3 * t)])


def hopf(n: int = 24, radius: float = 3.0) -> list[Floats]:
    """Two linked circles of n vertices each."""
    t = 2 * np.pi * np.arange(n) / n
    zero = np.zeros(n)
    return [
        radius * np.column_stack([np.cos(t), np.sin(t), zero]),
        radius * np.column_stack([1 + np.cos(t), zero, np.sin(t)]),
    ]


PIECES = [
    "nan",
    "1e999",
    "-1e308",
    "9" * 400,
    "\n",
    "\n\n",
    " ",
    "\0",
    "-",
    ".",
    "#",
    "%",
    '"',
    "<",
    "é",
    "\u2028",
    "",
]


def damaged(content: str, count: int = 400) -> Iterator[str]:
    """Texts that are cut off, or in which a few characters are others; the same ones every time."""
    draw = np.random.default_rng(0)
    words = content.split()
    for _ in range(count):
        place, length = draw.integers(len(content)), draw.integers(12)
        yield content[:place]
        piece = draw.choice([*PIECES, words[draw.integers(len(words))]])
        yield content[:place] + str(piece) + content[place + length :]
