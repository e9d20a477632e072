"""GRO files of GROMACS: columns, frames, boxes, and what is refused."""

from contextlib import suppress

import numpy as np
import pytest
from knots import Floats, damaged, trefoil

from sono import formats
from sono.formats import FormatError, VertexFile

KNOT = trefoil(60, 0.26)


def frame(rows: Floats, box: str = "0.0 0.0 0.0", name: str = "CA", digits: int = 3) -> str:
    width = digits + 5
    lines = [
        f"{i:>5}{'ALA':<5}{name:>5}{i:>5}" + "".join(f"{x:{width}.{digits}f}" for x in row)
        for i, row in enumerate(rows.tolist(), 1)
    ]
    return "\n".join(["a ring, t= 0.0", f"{len(rows):>5}", *lines, f"   {box}", ""])


def parsed(content: str, name: str = "k.gro") -> list[VertexFile]:
    return formats.parse(name, content.encode())


@pytest.mark.parametrize("called", ["CA", "B", "P"])
@pytest.mark.parametrize("digits", [3, 5])
def test_atoms_are_read(called: str, digits: int) -> None:
    for file in ("k.gro", "k.txt"):
        (curve,) = parsed(frame(KNOT, name=called, digits=digits), file)
        assert np.allclose(curve.components[0], KNOT, atol=0.51 * 10**-digits)
        assert list(curve.comments) == ["a ring, t= 0.0"]


def test_frames_are_curves_and_other_atoms_are_left_out() -> None:
    assert [curve.key for curve in parsed(frame(KNOT) * 3)] == ["1", "2", "3"]
    water = frame(KNOT).replace("   60\n", "   61\n", 1).splitlines()
    water.insert(-1, "   61SOL     OW   61   9.000   9.000   9.000  0.1000  0.2000  0.3000")
    assert len(parsed("\n".join(water))[0].components[0]) == 60


@pytest.mark.parametrize("edges", [np.eye(3) * 1.3, np.array([[1.4, 0, 0], [0.3, 1.4, 0], [0.2, -0.3, 1.4]])])
def test_the_box_unwraps(edges: Floats) -> None:
    edges = edges * np.ptp(KNOT, axis=0).max()
    scaled = KNOT @ np.linalg.inv(edges)
    box = " ".join(map(str, [*np.diag(edges), 0, 0, edges[1, 0], 0, *edges[2, :2]]))
    (curve,) = parsed(frame((scaled - np.floor(scaled)) @ edges, box, digits=5))
    assert np.allclose(np.diff(curve.components[0], axis=0), np.diff(KNOT, axis=0), atol=1e-4)
    assert any("the chains were unwrapped" in note for note in curve.doubts())


@pytest.mark.parametrize(
    ("content", "message"),
    [
        (
            frame(KNOT).replace("   60\n", "   70\n", 1),
            "1: a count of atoms, so many rows, and the box should",
        ),
        (frame(KNOT).replace("   60\n", "  left\n", 1), "1: a count of atoms, so many rows, .* not 'left'"),
        (frame(KNOT, "1.0 2.0"), "63: '1.0 2.0' is no box; its three or nine numbers end the frame"),
        (frame(KNOT).replace("0.000", "0.0x0", 1), r"\d+: .* are no three numbers; x y z should stand"),
        ("title\n", "1: a count of atoms"),
    ],
)
def test_what_is_wrong_is_said(content: str, message: str) -> None:
    with pytest.raises(FormatError, match=rf"^k\.gro:{message}"):
        parsed(content)


@pytest.mark.filterwarnings("error")
def test_damaged_files_raise_nothing_else() -> None:
    for text in damaged(frame(KNOT), 150):
        with suppress(FormatError):
            parsed(text)
