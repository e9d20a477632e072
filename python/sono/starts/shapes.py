"""The shortest shapes known of knots: the ropes of the atlas, on coarse beads, as the package carries them.

They are what a rope of any number of beads is polished from. A shape has R_s = 1 and edges of about `EDGE`,
and its coordinates are whole thousandths of the radius.

>>> shape = known("m8_18")
>>> len(shape), 160 < len(shape[0]) < 170, known("T(2,59)") is None
(1, True, True)
"""

import io
import zipfile
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cache
from importlib import resources
from importlib.resources.abc import Traversable
from typing import Any

import numpy as np

from sono.curve import Components
from sono.starts.drawing import mirror
from sono.starts.tabled import tabled_name

EDGE = 0.45
"""Edge length of the shapes, in radii."""

PARTS = 1000
"""Their coordinates are whole numbers of so many parts of the radius."""

FILE: Traversable = resources.files("sono").joinpath("data", "shapes.npz")


@dataclass(frozen=True)
class Shape:
    """The shape of a knot, and the L_a of the rope in the atlas that it was made from."""

    curve: Components
    l_a: float


def known(name: str) -> Components | None:
    """Return the shortest shape known of a knot that the atlas has, or None."""
    plain = name.strip()
    if plain[:1].casefold() == "m":
        found = known(plain[1:])
        return found and mirror(found)
    there = {knot.casefold(): knot for knot in lengths()}
    knot = there.get(tabled_name(plain).casefold())
    return shape(knot) if knot else None


@cache
def lengths() -> dict[str, float]:
    """Return the L_a of the atlas's rope for each knot that has a shape."""
    with np.load(io.BytesIO(FILE.read_bytes())) as file:
        return dict(zip(file["names"].tolist(), file["l_a"].tolist(), strict=True))


def shape(knot: str) -> Components:
    """Return the shape of one of the knots in `lengths`."""
    with np.load(io.BytesIO(FILE.read_bytes())) as file:
        steps, begin = file[f"{knot}/steps"], file[f"{knot}/begin"]
    components = np.split(steps.astype(np.int64), np.cumsum(begin[:-1, 0]))
    return [
        (first + steps.cumsum(axis=0)) / PARTS for first, steps in zip(begin[:, 1:], components, strict=True)
    ]


def packed(shapes: Mapping[str, Shape]) -> bytes:
    """Return the bytes of a file of shapes by their knots.

    It is NumPy's, with two arrays for each knot: the steps (n, 3) from vertex to vertex, 0 to the first of a
    component, and where each component begins (k, 4), its number of vertices ahead of the first of them.
    """
    names, l_a = np.array(list(shapes)), np.array([known.l_a for known in shapes.values()])
    arrays: dict[str, Any] = {"names": names, "l_a": l_a}
    for knot, known in shapes.items():
        whole = [np.rint(PARTS * component).astype(np.int32) for component in known.curve]
        steps = [np.diff(vertices, axis=0, prepend=vertices[:1]) for vertices in whole]
        arrays[f"{knot}/steps"] = np.vstack(steps).astype(np.int16)
        arrays[f"{knot}/begin"] = np.array([[len(v), *v[0]] for v in whole], np.int32)
    data = io.BytesIO()
    with zipfile.ZipFile(data, "w") as archive:
        for name, array in arrays.items():
            member = io.BytesIO()
            np.save(member, array)
            # With no time of writing, so that the same shapes are the same bytes.
            archive.writestr(zipfile.ZipInfo(f"{name}.npy"), member.getvalue(), zipfile.ZIP_DEFLATED, 9)
    return data.getvalue()
