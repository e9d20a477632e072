"""Curve files: what is read, what is refused and in which words, and that nothing is lost on the way."""

import io
import os
import re
import sys
import time
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st
from numpy.typing import NDArray

from sono import formats
from sono.formats import FormatError, Reader, VertexFile, atomic, text, vect
from sono.formats.doubts import jumps
from sono.formats.vertices import ends_meet

TRIANGLE = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]]
ROWS = "0 0 0\n1 0 0\n0 1 0\n"

numbers = st.floats(allow_nan=False, allow_infinity=False)
polygons = st.lists(st.tuples(numbers, numbers, numbers), min_size=3, max_size=8, unique=True).map(np.array)
comments = st.lists(st.text(st.characters(exclude_categories=["Cs"])), max_size=3)


def parse(format: Reader, content: str, name: str) -> VertexFile:
    (raw,) = format.read(content, name)
    return VertexFile.checked(name, raw)


def parsed(content: str) -> list[list[list[float]]]:
    return lists(parse(text, content, "k.xyz"))


def lists(curve: VertexFile) -> list[list[list[float]]]:
    return [component.tolist() for component in curve.components]


@pytest.mark.parametrize("suffix", ["txt", "xyz", "vect", "obj", "json", "npz", "npy", "txt.gz"])
@settings(max_examples=50)
@given(curve=st.lists(polygons, min_size=1, max_size=4), comments=comments)
def test_round_trip_keeps_every_bit(
    suffix: str,
    tmp_path_factory: pytest.TempPathFactory,
    curve: list[NDArray[np.float64]],
    comments: list[str],
) -> None:
    assume(not any(map(ends_meet, curve)))
    assume(suffix != "npy" or len({len(component) for component in curve}) == 1)
    assume(not jumps(curve)[1])
    path = tmp_path_factory.getbasetemp() / f"curve.{suffix}"
    formats.write(path, curve, comments)
    assert [c.tobytes() for c in formats.read(path).components] == [c.tobytes() for c in curve]


@pytest.mark.parametrize(
    "content", ["0 0 0\n1 0 0\n0 1 0", "0,0,0\n1,0,0\n0,1,0\n", "0\t0\t0\n1 , 0 0\n0, 1,0\n"]
)
def test_separators(content: str) -> None:
    assert parsed(content) == [TRIANGLE]


def test_comments_separate_nothing() -> None:
    assert parsed("# a knot\n0 0 0 # first\n#\n   # indented\n1 0 0#last\n0 1 0\n") == [TRIANGLE]


def test_blank_lines_separate_components() -> None:
    assert parsed(f"\n \n{ROWS}\n\t\n\n# second\n{ROWS}\n\n") == [TRIANGLE, TRIANGLE]


def test_last_vertex_may_repeat_the_first() -> None:
    assert parsed(f"{ROWS}0 0 -0.0\n") == [TRIANGLE]


SPACING = 2 * np.pi / 40
SHAPE = np.arange(40) * SPACING
TREFOIL = np.column_stack(
    [
        (2 + np.cos(3 * SHAPE)) * np.cos(2 * SHAPE),
        (2 + np.cos(3 * SHAPE)) * np.sin(2 * SHAPE),
        np.sin(3 * SHAPE),
    ]
)


@pytest.mark.parametrize("scale", [1e-50, 1e-3, 1.0, 1e50])
@pytest.mark.parametrize("error", [0, 1e-15, 1e-9, -2e-6])
def test_a_last_vertex_repeats_the_first_up_to_rounding(error: float, scale: float) -> None:
    knot = scale * TREFOIL
    again = np.vstack([knot, knot[0] + error * scale * np.array([0.3, 0.5, -0.2])])
    for content in (text.write([again], []), vect.write([again], []), open_vect(again)):
        read = parse(vect if content.startswith("VECT") else text, content, "k")
        assert [c.tobytes() for c in read.components] == [knot.tobytes()]
    # In the second component of a link too.
    far = knot + 9 * scale
    assert [len(c) for c in parse(text, text.write([far, again], []), "k").components] == [40, 40]


def open_vect(vertices: NDArray[np.float64]) -> str:
    """A VECT file of one polyline that is said to be open."""
    return vect.write([vertices], []).replace(f"\n-{len(vertices)}\n", f"\n{len(vertices)}\n")


def test_single_precision_repeats_too() -> None:
    t = np.linspace(0, 2 * np.pi, 200, dtype=np.float32)
    circle = np.column_stack([5 * np.cos(7 * t) + 7, 5 * np.sin(7 * t), np.sin(t)]).astype(np.float64)
    assert circle[0].tolist() != circle[-1].tolist()
    assert len(parse(text, text.write([circle], []), "k").components[0]) == 199


@pytest.mark.parametrize("share", [1e-3, 1e-1, 0.5])
def test_a_short_closing_edge_is_an_edge(share: float) -> None:
    knot = np.vstack([TREFOIL, TREFOIL[0] + share * (TREFOIL[-1] - TREFOIL[0])])
    assert len(parse(text, text.write([knot], []), "k").components[0]) == 41
    with pytest.raises(FormatError, match="the chain is open"):
        parse(vect, open_vect(knot), "k")


def test_short_edges_beside_a_short_closing_edge_are_edges() -> None:
    small = np.vstack([TREFOIL, TREFOIL[0] + 1e-9 * np.array([[3, 0, 0], [2, 1, 0], [1, 0, 1]])])
    assert len(parse(text, text.write([small], []), "k").components[0]) == 43


@pytest.mark.parametrize(
    ("word", "value"),
    [("1.5D+00", 1.5), ("-2d-3", -0.002), (".5D1", 5.0), ("1.25Q+02", 125.0), ("1.5-300", 1.5e-300)],
)
def test_fortran_numbers(word: str, value: float) -> None:
    assert parsed(f"{word} 0 0\n1 0 0\n0 1.0D+00 0\n")[0][0] == [value, 0, 0]
    vectors = parse(vect, f"VECT 1 3 0 -3 0\n{word} 0 0\n1 0 0\n0 1.0D+00 0\n", "k")
    assert vectors.components[0][0].tolist() == [value, 0, 0]


@pytest.mark.parametrize("word", ["1D", "D1", "1-2", "1.0-2", "12-345", "1.0D+", "0.5D0.5", "1E5D5"])
def test_what_fortran_does_not_write(word: str) -> None:
    with pytest.raises(FormatError, match=rf"k\.xyz:1: '{re.escape(word)}' is not a number"):
        parsed(f"{word} 0 0\n1 0 0\n0 1 0\n")


@pytest.mark.parametrize("suffix", ["stl", "png", "xls", "n480"])
def test_a_suffix_of_no_format_is_not_written(tmp_path: Path, suffix: str) -> None:
    path = tmp_path / f"k.{suffix}"
    with pytest.raises(FormatError, match=rf"k\.{suffix}: \.{suffix} is no format for vertices"):
        formats.write(path, [TREFOIL])
    assert not path.exists()
    formats.write(path, [TREFOIL], format="text")
    assert len(formats.read(path).components[0]) == 40


@pytest.mark.parametrize("end", [b"\r\n", b"\r", b"\n"])
def test_line_ends_and_byte_order_mark(tmp_path: Path, end: bytes) -> None:
    path = tmp_path / "knot.txt"
    path.write_bytes(b"\xef\xbb\xbf" + ROWS.encode().replace(b"\n", end))
    curve = formats.read(path)
    assert lists(curve) == [TRIANGLE]
    assert curve.where(0, 2) == f"{path}:3"


def test_where_counts_comments_and_blank_lines() -> None:
    curve = parse(text, f"# title\n{ROWS}\n{ROWS}", "k.xyz")
    assert [curve.where(0, 0), curve.where(0, 2), curve.where(1, 0)] == ["k.xyz:2", "k.xyz:4", "k.xyz:6"]


@pytest.mark.parametrize(
    ("content", "message"),
    [
        ("", "k.xyz:1: the file holds no vertices; give rows of three numbers x y z"),
        ("# nothing\n\n", "k.xyz:1: the file holds no vertices; give rows of three numbers x y z"),
        (
            "0 0 0\nx 0 0\n",
            "k.xyz:2: 'x' is not a number; give three numbers x y z, and start other lines with #",
        ),
        (
            "0,0,0\n1,,0\n",
            "k.xyz:2: '' is not a number; give three numbers x y z, and start other lines with #",
        ),
        (
            f"{'y' * 99} 0 0\n",
            f"k.xyz:1: '{'y' * 27}...' is not a number; "
            "give three numbers x y z, and start other lines with #",
        ),
        ("# a\n0 0\n", "k.xyz:2: 2 columns; give three numbers x y z, and start other lines with #"),
        ("1 0 0 C\n", "k.xyz:1: 4 columns; give three numbers x y z, and start other lines with #"),
        ("1, ,0,0\n", "k.xyz:1: 4 columns; give three numbers x y z, and start other lines with #"),
        (
            "the knot 3_1 in five\n",
            "k.xyz:1: 5 columns; give three numbers x y z, and start other lines with #",
        ),
        (f"{ROWS}nan 0 0\n", "k.xyz:4: a coordinate is not finite; give a number in its place"),
        (f"{ROWS}0 -inf 0\n", "k.xyz:4: a coordinate is not finite; give a number in its place"),
        (f"{ROWS}0 0 1e999\n", "k.xyz:4: a coordinate is not finite; give a number in its place"),
        ("0 0 0\n", "k.xyz:1: the component that starts here has too few vertices: 1; give at least 3"),
        (
            f"{ROWS}\n0 0 0\n1 0 0\n0 0 0\n",
            "k.xyz:5: the component that starts here has too few vertices: 2; give at least 3",
        ),
        (
            "0 0 0\n1 0 0\n# again\n1 0 0\n0 1 0\n",
            "k.xyz:4: this vertex equals its neighbour on line 2; delete one of the two",
        ),
        (
            f"{ROWS}0 0 0\n0 0 0\n",
            "k.xyz:1: this vertex equals its neighbour on line 4; delete one of the two",
        ),
    ],
)
def test_errors_in_plain_text(content: str, message: str) -> None:
    with pytest.raises(FormatError) as caught:
        parse(text, content, "k.xyz")
    assert str(caught.value) == message


VECT = """# a triangle and a square
VECT
2 7 1
-3 -4  # closed
1 0
0 0 0  1 0 0  0 1 0
0 0 1
1 0 1
1 1 1
0 1 1
1 0.5 0 1
"""
SQUARE = [[0.0, 0.0, 1.0], [1.0, 0.0, 1.0], [1.0, 1.0, 1.0], [0.0, 1.0, 1.0]]


def test_vect() -> None:
    curve = parse(vect, VECT, "k.vect")
    assert lists(curve) == [TRIANGLE, SQUARE]
    assert [curve.where(0, 2), curve.where(1, 3)] == ["k.vect:6", "k.vect:10"]


def test_vect_may_repeat_the_first_vertex() -> None:
    for count in (-4, 4):
        assert lists(parse(vect, f"VECT 1 4 0 {count} 0 {ROWS} 0 0 0", "k")) == [TRIANGLE]


@pytest.mark.parametrize(
    ("content", "message"),
    [
        ("", "1: the file ends where the header VECT should follow; complete it or correct its counts"),
        ("0 0 0\n", "1: the header is '0'; only three-dimensional VECT is read"),
        ("# a\n4VECT 1 3 0\n", "2: the header is '4VECT'; only three-dimensional VECT is read"),
        ("VECT BINARY\n", "1: the file is binary VECT; save it as ASCII VECT"),
        ("VECT\nx 3 0\n", "2: 'x' is not the number of polylines; give a whole number"),
        ("VECT\n1\n3.5 0\n", "3: '3.5' is not the number of vertices; give a whole number"),
        ("VECT\n1 3\n-1\n", "3: -1 cannot be the number of colours; give zero or more"),
        ("VECT\n0 0 0\n", "2: the file holds no polylines; give at least one"),
        ("VECT\n1 3 0\n-4\n0\n", "3: the polylines have 4 vertices, the header says 3; correct the counts"),
        ("VECT\n1 3 0\n-3\n1\n", "4: the polylines have 1 colours, the header says 0; correct the counts"),
        (
            "VECT\n2 3 0\n-3\n",
            "3: the file ends where the vertex count of a polyline should follow; "
            "complete it or correct its counts",
        ),
        (
            "VECT\n1 3 0\n-3\n0\n0 0 0\n1 0 0\n",
            "6: the file ends where a vertex should follow; complete it or correct its counts",
        ),
        (
            f"VECT\n1 3 1\n-3\n1\n{ROWS}1 0\n",
            "8: the file ends where a colour should follow; complete it or correct its counts",
        ),
        ("VECT\n1 3 0\n-3\n0\n0 0 0\n1 y 0\n0 1 0\n", "6: 'y' is not a number; a vertex should stand here"),
        (f"VECT\n1 3 0\n-3\n0\n{ROWS}0.5\n", "8: '0.5' is left over; correct the counts"),
        (
            f"VECT\n1 3 0\n3\n0\n{ROWS}",
            "7: the chain is open: it ends here and began on line 5; --close direct joins its ends by an "
            "edge, --close sphere by way of a sphere round it",
        ),
        (f"VECT\n2 3 0\n-3\n0\n0 0\n{ROWS}", "4: a polyline has no vertices; give at least 3"),
        (
            "VECT\n1 2 0\n-2\n0\n0 0 0\n1 0 0\n",
            "5: the component that starts here has too few vertices: 2; give at least 3",
        ),
        (
            "VECT\n1 3 0\n-3\n0\n0 0 0\n1 nan 0\n0 1 0\n",
            "6: a coordinate is not finite; give a number in its place",
        ),
        (
            "VECT\n1 3 0\n-3\n0\n0 0 0\n0 1 0\n0 1 0\n",
            "7: this vertex equals its neighbour on line 6; delete one of the two",
        ),
    ],
)
def test_errors_in_vect(content: str, message: str) -> None:
    with pytest.raises(FormatError) as caught:
        parse(vect, content, "k.vect")
    assert str(caught.value) == f"k.vect:{message}"


@pytest.mark.parametrize(
    ("name", "content"),
    [("k.vect", VECT), ("k.VECT", VECT), ("k.txt", VECT), ("k", f"VECT 1 3 0 -3 0 {ROWS}"), ("k.txt", ROWS)],
)
def test_format_is_recognised(tmp_path: Path, name: str, content: str) -> None:
    (tmp_path / name).write_text(content)
    assert lists(formats.read(tmp_path / name))[0] == TRIANGLE


def test_suffix_vect_is_binding(tmp_path: Path) -> None:
    (tmp_path / "k.vect").write_text(ROWS)
    with pytest.raises(FormatError, match=r"k\.vect:1: the header is '0'"):
        formats.read(tmp_path / "k.vect")


def test_binary_files_are_refused(tmp_path: Path) -> None:
    path = tmp_path / "k.xyz"
    path.write_bytes(b"0 0 0\n1 0 0\n\xff\x00")
    with pytest.raises(FormatError) as caught:
        formats.read(path)
    assert (
        str(caught.value)
        == f"{path}:3: byte 0xff is not UTF-8 text; give rows of x y z, or a file of another format"
    )


@pytest.mark.parametrize(
    ("name", "reason"), [("absent", "No such file or directory"), ("", "Is a directory")]
)
def test_unreadable_files_are_named(tmp_path: Path, name: str, reason: str) -> None:
    path = tmp_path / name
    with pytest.raises(FormatError) as caught:
        formats.read(path)
    assert str(caught.value) == f"{path}: cannot be read: {reason}"


def test_standard_input(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(sys, "stdin", io.TextIOWrapper(io.BytesIO(VECT.encode())))
    curve = formats.read("-")
    assert lists(curve) == [TRIANGLE, SQUARE]
    assert curve.where(0, 0) == "<stdin>:6"


def test_standard_output(capsys: pytest.CaptureFixture[str]) -> None:
    formats.write("-", [np.array(TRIANGLE), np.array(SQUARE)], ["two\nlines", ""])
    assert capsys.readouterr().out == (
        "# two\n# lines\n0.0 0.0 0.0\n1.0 0.0 0.0\n0.0 1.0 0.0\n"
        "\n0.0 0.0 1.0\n1.0 0.0 1.0\n1.0 1.0 1.0\n0.0 1.0 1.0\n"
    )
    formats.write("-", [np.array(TRIANGLE)], ["one"], format="vect")
    assert capsys.readouterr().out == ("VECT\n# one\n1 3 0\n-3\n0\n0.0 0.0 0.0\n1.0 0.0 0.0\n0.0 1.0 0.0\n")


def test_unknown_format_is_refused() -> None:
    with pytest.raises(ValueError, match=r"unknown format 'stl'; the formats are: .*text, vect"):
        formats.write("-", [], format="stl")


def test_unwritable_files_are_named(tmp_path: Path) -> None:
    path = tmp_path / "absent" / "k.xyz"
    with pytest.raises(FormatError) as caught:
        formats.write(path, [np.array(TRIANGLE)])
    cure = f"make the folder {path.parent} first, or name another one"
    assert str(caught.value) == f"{path}: cannot be written: No such file or directory; {cure}"
    with pytest.raises(FormatError) as caught:
        formats.write(tmp_path, [np.array(TRIANGLE)])
    assert str(caught.value) == f"{tmp_path}: cannot be written: Is a directory"
    assert list(tmp_path.iterdir()) == []


def test_write_leaves_only_the_file(tmp_path: Path) -> None:
    path = tmp_path / "k.xyz"
    path.write_text("old")
    path.chmod(0o640)
    with atomic(path) as stream:
        stream.write(b"new")
        assert path.read_text() == "old"
    assert path.read_text() == "new"
    assert path.stat().st_mode & 0o777 == 0o640
    assert list(tmp_path.iterdir()) == [path]


@pytest.mark.parametrize("failure", [KeyboardInterrupt, OSError, ValueError])
def test_failure_leaves_the_old_file(tmp_path: Path, failure: type[BaseException]) -> None:
    def fail() -> None:
        with atomic(path) as stream:
            stream.write(b"half")
            raise failure

    path = tmp_path / "k.xyz"
    path.write_text("old")
    with pytest.raises(failure):
        fail()
    assert path.read_text() == "old"
    assert list(tmp_path.iterdir()) == [path]


def test_links_and_pipes_are_not_replaced(tmp_path: Path) -> None:
    path, link = tmp_path / "k.xyz", tmp_path / "link"
    link.symlink_to(path)
    formats.write(link, [np.array(TRIANGLE)])
    assert link.is_symlink()
    assert lists(formats.read(path)) == [TRIANGLE]
    pipe = tmp_path / "pipe"
    os.mkfifo(pipe)
    reader = os.open(pipe, os.O_RDONLY | os.O_NONBLOCK)
    formats.write(pipe, [np.array(TRIANGLE)])
    assert os.read(reader, 1000) == path.read_bytes()
    os.close(reader)
    assert pipe.is_fifo()


@pytest.mark.parametrize("format", [text, vect])
def test_large_files_are_quick(format: Any) -> None:
    content = format.write([np.random.default_rng(1).normal(size=(100_000, 3))], [])
    start = time.process_time()
    assert len(parse(format, content, "large").components[0]) == 100_000
    assert time.process_time() - start < 2  # 0.25 s as a rule
