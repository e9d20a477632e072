"""Fourier series of knots in the files of D. H. Fremlin.

    % Knot 3_1 (trefoil knot)
       0.000000    0.224483    0.224483    0.000000    0.000000    0.000000
       0.995730    0.000000    0.000000    0.995730    0.000000    0.000000
    ...

The row j, from 1, has the coefficients of cos(jt) and sin(jt) in x, then in y and in z; a row of only three
numbers ahead of them is the middle of the knot. Lines that begin with % are comments. How finely the series
is sampled is said in `sampling`.
"""

import numpy as np

from sono.formats.fourier import polygons
from sono.formats.vertices import Chain, FormatError, Raw, not_a_number, numbers, shown


def recognises(text: str) -> bool:
    """Tell whether a comment comes first, and then a row of six numbers, or one of three ahead of it."""
    lines = [line for line in text[:10_000].split("\n") if line.strip()]
    rows = [line.split() for line in lines if not line.lstrip().startswith("%")][:2]
    series = [len(row) for row in rows] in ([6, 6], [3, 6], [6])
    return lines[:1] != [] and lines[0].lstrip().startswith("%") and series


def read(text: str, name: str) -> list[Raw]:
    """Parse a whole file; lengths keep its unit. Raises `FormatError`."""
    rows = _rows(text, name)
    middle = rows.pop(0)[1] if len(rows[0][1]) == 3 else [0.0, 0.0, 0.0]
    for line, row in rows:
        if len(row) != 6:
            raise FormatError.at(name, line, f"{len(row)} columns; give six: cos and sin of x, of y and of z")
    if not rows:
        raise FormatError.at(
            name, 1, "the file holds no rows of six numbers: cos and sin of x, of y and of z"
        )
    table = np.array([row for _, row in rows])
    a, b = np.vstack([middle, table[:, ::2]]), np.vstack([np.zeros(3), table[:, 1::2]])
    try:
        (curve,) = polygons([(a, b)])
    except ValueError as error:
        raise FormatError.at(name, rows[0][0], f"{error}; correct the series that begins here") from None
    note = f"{name}: the Fourier series of {len(rows)} harmonics was sampled at {len(curve)} points"
    comments = [
        line.strip().removeprefix("%").strip() for line in text.split("\n") if "%" in line.lstrip()[:1]
    ]
    return [Raw([Chain(curve, [rows[0][0]] * len(curve))], notes=[note], comments=comments)]


def _rows(text: str, name: str) -> list[tuple[int, list[float]]]:
    """Give the rows of numbers, with their lines."""
    rows: list[tuple[int, list[float]]] = []
    ended = False
    for number, line in enumerate(text.split("\n"), 1):
        data = line.partition("%")[0].strip()
        if not data:
            ended = bool(rows)
            continue
        if ended:
            raise FormatError.at(name, number, "a second series begins here; give each a file of its own")
        cells = data.split()
        try:
            rows.append((number, numbers(cells)))
        except ValueError:
            bad = shown(cells[not_a_number(cells) or 0])
            raise FormatError.at(
                name, number, f"{bad} is not a number; begin lines that are comments with %"
            ) from None
    if not rows:
        raise FormatError.at(
            name, 1, "the file holds no rows of six numbers: cos and sin of x, of y and of z"
        )
    return rows
