"""Molecular XYZ: frames, elements, the extension, and that ropes written as .xyz are known again."""

import re
import time
from pathlib import Path

import numpy as np
import pytest
from conftest import QUICK, Sono

from sono import formats, starts
from sono.formats import FormatError, VertexFile, xyz

POINTS = [[0.0, 0.0, 0.0], [1.0, 0.25, 0.0], [0.0, 1.0, 0.5], [-1.0, 0.0, 2.0]]


def parsed(content: str) -> list[VertexFile]:
    return formats.parse("k.xyz", content.encode())


def frame(comment: str = "", template: str = "C {1} {2} {3}") -> str:
    rows = [template.format(i, x, y, z) for i, (x, y, z) in enumerate(POINTS, 1)]
    return "\n".join([str(len(POINTS)), comment, *rows, ""])


@pytest.mark.parametrize(
    "template",
    [
        "C {1} {2} {3}",
        "ca {1}\t{2} {3}",
        "6 {1} {2} {3}",
        "1 {1} {2} {3}",
        "{1} {2} {3}",
        "O {1} {2} {3} 7 7 7",
    ],
)
def test_rows(template: str) -> None:
    (curve,) = parsed(frame("a ring", template))
    assert [component.tolist() for component in curve.components] == [POINTS]
    assert (curve.key, list(curve.comments), curve.where(0, 0)) == ("", ["a ring"], "k.xyz:3")


@pytest.mark.parametrize("between", ["", "\n", "\n \n"])
def test_frames_are_curves(between: str) -> None:
    curves = parsed(between.join([frame("one"), frame(), frame("3")]) + "\n\n")
    assert [curve.key for curve in curves] == ["1", "2", "3"]
    assert [list(curve.comments) for curve in curves] == [["one"], [], ["3"]]
    assert all(curve.components[0].tolist() == POINTS for curve in curves)


@pytest.mark.parametrize(
    ("properties", "template"),
    [
        ("species:S:1:pos:R:3", "C {1} {2} {3}"),
        ("id:I:1:species:S:1:pos:R:3:forces:R:3", "{0} C {1} {2} {3} 0 0 0"),
        ("pos:R:3", "{1} {2} {3}"),
        ("charge:R:1:pos:R:3:species:S:1", "0.5 {1} {2} {3} H"),
    ],
)
def test_the_extension_says_where_coordinates_are(properties: str, template: str) -> None:
    for quote in ("", '"'):
        comment = f'Lattice="9 0 0 0 9 0 0 0 9" Properties={quote}{properties}{quote} Time=0.5'
        assert parsed(frame(comment, template))[0].components[0].tolist() == POINTS


def test_the_extension_tells_molecules_apart() -> None:
    comment = "Properties=molecule:I:1:pos:R:3"
    rows = [f"{number} {x} {y} {z}" for x, y, z in POINTS for number in (1, 2)]
    (curve,) = parsed("\n".join(["8", comment, *rows]))
    assert [component.tolist() for component in curve.components] == [POINTS, POINTS]


@pytest.mark.parametrize(
    "comments",
    [
        [],
        ["a knot"],
        ["two", "lines"],
        ['"quoted" and \\ back'],
        ["Properties=pos:R:3 x"],
        ['components="1 2"'],
    ],
)
def test_what_is_written_is_read_again(comments: list[str], tmp_path: Path) -> None:
    link = [*starts.start("Hopf"), starts.start("3_1")[0] + 50]
    formats.write(tmp_path / "k.xyz", link, comments)
    curve = formats.read(tmp_path / "k.xyz")
    assert [part.tobytes() for part in curve.components] == [part.tobytes() for part in link]
    assert list(curve.comments) == comments
    assert (tmp_path / "k.xyz").read_text().count("\n") == 2 + sum(map(len, link))


def test_rings_that_nothing_tells_apart_are_told() -> None:
    rings = [*starts.start("Hopf"), starts.start("3_1")[0] + 50]
    content = xyz.write(rings, [])
    (told,) = parsed(re.sub('components="[^"]*"', "a melt", content))
    sizes = [len(ring) for ring in rings]
    notes = [note.partition(";")[0] for note in told.doubts() if "far longer edge" in note]
    assert notes == [f"k.xyz:{2 + sum(sizes[:k])}: a far longer edge follows" for k in (1, 2)]
    assert parsed(content)[0].doubts() == []
    for name in ("3_1", "8_19", "T(2,9)"):
        assert parsed(re.sub("components", "c", xyz.write(starts.start(name), [])))[0].doubts() == []


def test_open_chains() -> None:
    steps = np.cumsum(np.full((40, 3), 0.5), axis=0) + np.random.default_rng(1).normal(0, 0.1, (40, 3))
    rows = "".join(f"C {x} {y} {z}\n" for x, y, z in steps)
    with pytest.raises(FormatError, match=r"k.xyz:42: the chain is open: it ends here and began on line 3"):
        parsed(f"40\n\n{rows}")
    assert parsed(f'40\ncomponents="40"\n{rows}')  # it says that it is closed
    (closed,) = formats.parse("k.xyz", f"40\n\n{rows}".encode(), "sphere")
    assert len(closed.notes) == 1


@pytest.mark.parametrize(
    ("content", "message"),
    [
        (
            frame().replace("4", "5", 1),
            "1: 5 rows should follow, there are 4; correct the count, or complete",
        ),
        (frame() + frame().replace("4", "9", 1), "7: 9 rows should follow, there are 4; correct the count"),
        (frame().replace("4", "3", 1), "6: 'C -1.0 0.0 2.0' is no count of rows; each frame begins with one"),
        (frame() + "end\n", "7: 'end' is no count of rows; each frame begins with one, then a comment"),
        (frame() + "0\n\n", "7: '0' is no count of rows"),
        (frame().replace("1.0", "one", 1), "4: 'one' is not a number; give x, y and z in each row"),
        (frame().replace("C 1.0", "1.0", 1), "4: 3 columns, where the first row has 4; give as many"),
        (frame().replace("C 0.0 0.0", "C", 1), "3: 2 columns; give an element and x y z"),
        (frame("Properties=pos:R"), "3: the comment's Properties are not name:type:columns"),
        (frame("Properties=pos:R:x"), "3: the comment's Properties are not name:type:columns"),
        (frame("Properties=species:S:1"), "3: the comment's Properties are not name:type:columns"),
        (
            frame("Properties=id:I:1:pos:R:3", "9 {1} {2} {3}"),
            "4: the index must go up, but goes on from 9 to 9",
        ),
        (frame('components="3 2"'), "2: the comment's components have 5 rows, the count says 4; correct one"),
        (frame('components="4 0"'), "2: the comment's components have 4 rows, the count says 4; correct one"),
        (
            frame('components="3 1"'),
            "6: the component that starts here has too few vertices: 1; give at least 3",
        ),
        (frame().replace("2.0", "nan"), "6: a coordinate is not finite; give a number in its place"),
    ],
)
def test_errors(content: str, message: str) -> None:
    with pytest.raises(FormatError, match=rf"^k\.xyz:{re.escape(message)}"):
        parsed(content)


def test_ropes_are_known_again(sono: Sono) -> None:
    begun = sono("tighten", "Hopf.txt", "-n", "60", "-o", "rope.xyz", *QUICK)
    assert begun.exit_code == 0
    again = sono("tighten", "Hopf.txt", "-n", "60", "-o", "rope.xyz", "--resume", *QUICK)
    assert (again.exit_code, again.stderr) == (0, "")
    assert again.stdout.split("\t")[:5] == begun.stdout.split("\t")[:5]
    other = sono("tighten", "3_1.txt", "-n", "60", "-o", "rope.xyz", "--resume", *QUICK)
    assert "rope.xyz: is of another curve, method or setting" in other.stderr


def test_a_trajectory_is_a_row_a_frame(sono: Sono) -> None:
    (trefoil,) = starts.start("3_1")
    frames = [xyz.write([trefoil * scale], [f"frame {scale}"]) for scale in (1, 2, 3)]
    Path("run.xyz").write_text("".join(frames))
    done = sono("measure", "run.xyz", "--columns", "knot,dl")
    assert [row.split("\t")[0] for row in done.stdout.splitlines()[1:]] == ["run:1", "run:2", "run:3"]
    assert formats.read("run.xyz:2").components[0].tolist() == (2 * trefoil).tolist()


def test_large_files_are_quick() -> None:
    content = xyz.write([np.random.default_rng(1).normal(size=(100_000, 3))], [])
    start = time.process_time()
    assert len(parsed(content)[0].components[0]) == 100_000
    assert time.process_time() - start < 3  # 0.5 s as a rule


KNOT = starts.start("3_1")[0] * 3
TILTED = np.array([[40.0, 0, 0], [9, 40, 0], [5, -8, 40]])


def boxed(rows: np.ndarray, edges: np.ndarray, wrap: bool = True, marks: str = ' pbc="T T T"') -> str:
    """A frame in a periodic box, the rows wrapped into it."""
    scaled = rows @ np.linalg.inv(edges)
    inside = (scaled - np.floor(scaled)) @ edges if wrap else rows
    lattice = " ".join(map(str, edges.ravel().tolist()))
    content = "".join(f"C {x} {y} {z}\n" for x, y, z in inside.tolist())
    return f'{len(rows)}\nLattice="{lattice}" Properties=species:S:1:pos:R:3{marks}\n{content}'


@pytest.mark.parametrize("marks", [' pbc="T T T"', ""])
@pytest.mark.parametrize("edges", [np.eye(3) * 1.3, TILTED / 26], ids=["right", "tilted"])
@pytest.mark.parametrize("shift", [0.0, 0.3, 0.9])
def test_a_box_unwraps_what_it_has_wrapped(edges: np.ndarray, marks: str, shift: float) -> None:
    edges = edges * np.ptp(KNOT, axis=0).max()
    rows = KNOT + shift * edges.sum(axis=0)
    (curve,) = parsed(boxed(rows, edges, marks=marks))
    (part,) = curve.components
    assert np.allclose(part - part[0], rows - rows[0])
    assert not shift or any("the chains were unwrapped" in note for note in curve.doubts())


@pytest.mark.parametrize("size", [1.01, 1.3, 9.0, 0.3])
def test_a_chain_that_is_not_wrapped_stays(size: float) -> None:
    edges = np.eye(3) * np.ptp(KNOT, axis=0).max() * size
    (curve,) = parsed(boxed(KNOT, edges, wrap=False))
    assert curve.components[0].tobytes() == KNOT.tobytes()
    assert curve.doubts() == []


@pytest.mark.parametrize(("sides", "unclear"), [(1.3, True), (3, False)])
def test_components_are_unwrapped_and_told_where_images_are_unclear(sides: float, unclear: bool) -> None:
    content = boxed(
        np.vstack([KNOT, KNOT + 0.4 * np.ptp(KNOT, axis=0)]), np.eye(3) * sides * np.ptp(KNOT, axis=0).max()
    )
    head, comment, *rows = content.splitlines()
    rows = [f"{row} {1 + i // len(KNOT)}" for i, row in enumerate(rows)]
    (curve,) = parsed("\n".join([head, comment.replace("pos:R:3", "pos:R:3:molecule:I:1"), *rows]))
    assert all(np.allclose(part - part[0], KNOT - KNOT[0]) for part in curve.components)
    assert any("depends on the image" in note for note in curve.doubts()) == unclear


def test_what_a_box_cannot_tell_is_refused() -> None:
    line = np.column_stack([np.arange(40) * 0.25 + 5, np.sin(np.arange(40) / 6.4), np.zeros(40)])
    with pytest.raises(FormatError, match="winds round the periodic box"):
        parsed(boxed(line, np.eye(3) * 10))
    sticks = np.array([[0.1, 0, 0], [9, 0.1, 0], [9, 9, 1], [0, 9, 2], [1, 1, 9]])
    with pytest.raises(
        FormatError, match=r"^k.xyz:4: the step to this atom is longer than half the periodic"
    ):
        parsed(boxed(sticks, np.eye(3) * 10))
    with pytest.raises(FormatError, match=r"^k.xyz:2: '1 2' is no periodic box; give nine numbers"):
        parsed(frame('Lattice="1 2" Properties=species:S:1:pos:R:3'))


@pytest.mark.parametrize(
    ("bad", "message"),
    [
        (frame().replace("C -1.0 0.0 2.0", "C -1.0 0.0"), "12: 3 columns, where the first row has 4"),
        (frame().replace("C -1.0 0.0 2.0", "C -1.0 nought 2.0"), "12: 'nought' is not a number"),
        (frame().replace("C -1.0 0.0 2.0\n", ""), "7: 4 rows should follow, there are 3; correct the count"),
        (frame().replace("4", "3", 1), "12: 'C -1.0 0.0 2.0' is no count of rows"),
        (frame().replace("4", "9", 1), "7: 9 rows should follow, there are 4"),
        (frame().replace("4", "0", 1), "7: '0' is no count of rows"),
        (frame("Properties=pos:R:2"), "9: the comment's Properties are not"),
    ],
)
@pytest.mark.parametrize("last", [False, True])
def test_a_frame_that_is_wrong_spoils_no_other(bad: str, message: str, last: bool) -> None:
    found = xyz.read(frame() + bad + ("" if last else frame("3") + frame()), "k.xyz")
    assert [raw.key for raw in found] == ["1", "2", "3", "4"][: len(found)]
    assert len(found) == (2 if last else 4)
    for place, raw in enumerate(found):
        if place != 1:
            assert VertexFile.checked("k.xyz", raw).components[0].tolist() == POINTS
    with pytest.raises(FormatError, match=rf"^k\.xyz:{re.escape(message)}"):
        VertexFile.checked("k.xyz", found[1])
