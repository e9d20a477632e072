"""Numbers as a page has them: in base64, in as few bytes as they need. `data/view/curve.js` reads them."""

import base64
from typing import Any

import numpy as np
from numpy.typing import NDArray

from sono.curve import Floats
from sono.starts.archive import differences

Whole = NDArray[np.int64]


def vertices(points: Floats) -> dict[str, Any]:
    """Return vertices (n, 3) in steps of 1/2^24 of their extent from a corner, by their third differences."""
    corner, step = points.min(axis=0), float(np.ptp(points, axis=0).max()) / ((1 << 24) - 1)
    steps = np.rint((points - corner) / step).astype(np.int64)
    return {"corner": corner.tolist(), "step": step, "vertices": _digits(differences(steps).ravel())}


def shares(values: Floats, most: float) -> str:
    """Return values from 0 to `most` in steps of 1/65535 of that."""
    return _text(np.rint(65535 * values / most).astype("<u2"))


def pairs(rows: Whole, n: int) -> str:
    """Return pairs (m, 2) of numbers below n, which rise, the first number before the second.

    A pair (i, j) is i n + j, as the difference from the one before it: a byte where i is as before, and j a
    little more.

    >>> pairs(np.array([[0, 5], [0, 6], [2, 9]]), n=1000), bytes([5, 1, 128 | 2003 % 128, 2003 // 128])
    ('BQHTDw==', b'\\x05\\x01\\xd3\\x0f')
    """
    return _digits(np.diff(rows @ np.array([n, 1]), prepend=0))


def _digits(numbers: Whole) -> str:
    """Return whole numbers in digits of seven bits, the lowest first; all but the last have an eighth."""
    digits = numbers[:, None] >> np.arange(0, 63, 7)
    more = np.pad(digits[:, 1:] > 0, [(0, 0), (0, 1)])
    needed = np.pad(more[:, :-1], [(0, 0), (1, 0)], constant_values=True)
    return _text((digits & 127 | 128 * more).astype(np.uint8)[needed])


def _text(array: NDArray[Any]) -> str:
    return base64.b64encode(array.tobytes()).decode()
