"""Rows with an index, an element or a header: what is read, and what is refused rather than guessed."""

import re
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from sono import formats
from sono.formats import FormatError

POINTS = [[0.0, 0.0, 0.0], [1.0, 0.25, 0.0], [0.0, 1.0, 0.5], [-1.0, 0.0, 2.0]]


def parsed(content: str) -> list[list[list[float]]]:
    (curve,) = formats.parse("k.txt", content.encode())
    return [component.tolist() for component in curve.components]


def rows(template: str, first: int = 1) -> str:
    return "".join(template.format(i, x, y, z) + "\n" for i, (x, y, z) in enumerate(POINTS, first))


@pytest.mark.parametrize("first", [0, 1, 17, -2])
@pytest.mark.parametrize(
    "template",
    [
        *("{} {} {} {}", "{}\t{}\t{}\t{}", "{}, {}, {}, {}", "{};{};{};{}", "{}.0 {} {} {}", "{:e} {} {} {}"),
        *("C {1} {2} {3}", "ca,{1},{2},{3}", "C1\t{1} {2} {3}", "C {} {} {} {}", "{} C {} {} {}"),
        *("{1};{2};{3}", '"{1}","{2}","{3}"', '"{}" "{}" "{}" "{}"'),
        *('"bead one",{1},{2},{3}', "bead one\t{1}\t{2}\t{3}", "C {1}, {2}, {3}", "bead one; {1}; {2}; {3}"),
    ],
)
def test_leading_columns(template: str, first: int) -> None:
    block = rows(template, first)
    assert parsed(f"# a comment\n{block}") == [POINTS]
    assert parsed(f"{block}\n# again from the first index\n{block}\n") == [POINTS, POINTS]


@pytest.mark.parametrize(
    ("header", "template"),
    [
        ("x,y,z", "{1},{2},{3}"),
        ("index x y z", "{} {} {} {}"),
        ("id type x y z", "{} 1 {} {} {}"),
        ('"X";"Y";"Z"', "{1};{2};{3}"),
        ("x [nm]\ty [nm]\tz [nm]", "{1}\t{2}\t{3}"),
        ("x(A) y(A) z(A)", "{1} {2} {3}"),
        ("X/nm, Y/nm, Z/nm", "{1}, {2}, {3}"),
        ("z,y,x,radius", "{3},{2},{1},0.5"),
        (",x,y,z", "{},{},{},{}"),
        ('"","x","y","z"', '"{}",{},{},{}'),
        ("Points:0,Points:1,Points:2,vtkId", "{1},{2},{3},9"),
        ("pos_x pos_y pos_z vx vy vz", "{1} {2} {3} 1 1 1"),
        ("element,x,y,z,charge", "C,{1},{2},{3},-1"),
        ("x y z", "{1} {2} {3}"),
        ("x,y,z,", "{1},{2},{3},"),
        ("x_nm,y_nm,z_nm", "{1},{2},{3}"),
        ("residue name,x,y,z", "ALA 1,{1},{2},{3}"),
        ("x,y,z,what it is", '{1},{2},{3},"a bead, blue"'),
        ("bead name;x;y;z", "bead one;{1};{2};{3}"),
        ("bead name\tx\ty\tz", "bead {0}\t{1}\t{2}\t{3}"),
        ("pos x,pos y,pos z", "{1},{2},{3}"),
        ("x-coord y-coord z-coord", "{1} {2} {3}"),
    ],
)
@pytest.mark.parametrize("end", ["\n", "\r\n"])
def test_a_header_names_the_columns(header: str, template: str, end: str) -> None:
    content = f"# title\n\n{header}\n{rows(template)}\n{rows(template)}"
    assert parsed(content.replace("\n", end)) == [POINTS, POINTS]


@pytest.mark.parametrize("name", ["component", "chain", "molecule", "ring", "strand", "Mol", "CHAIN"])
@pytest.mark.parametrize("mark", [",", " ", "\t", ";"])
def test_a_column_tells_components_apart(name: str, mark: str) -> None:
    header = mark.join([name, "id", "x", "y", "z"])
    block = [rows(mark.join([label, "{}", "{}", "{}", "{}"])) for label in ("a", "b")]
    assert parsed(f"{header}\n{block[0]}{block[1]}") == [POINTS, POINTS]
    mixed = [row for pair in zip(*(part.splitlines() for part in block), strict=True) for row in pair]
    assert parsed("\n".join([header, *mixed])) == [POINTS, POINTS]


@pytest.mark.parametrize(
    ("content", "message"),
    [
        ("1 0 0 0\n2 1 0 0\n1 0 1 0\n", "3: the index goes on from 2 to 1; sort the rows, put a blank line"),
        ("1 0 0 0\n3 1 0 0\n", "2: the index goes on from 1 to 3; sort"),
        ("0 0 0 7\n1 0 1 7\n0 1 1 7\n", "3: the index goes on from 1 to 0; sort the rows"),
        ("0.5 0 0 7\n1 0 1 7\n", "1: 4 columns, and '0.5' is no index; a header line such as `index x y z`"),
        ("1 1 0 0 0\n", "1: 5 columns; give three numbers x y z; a header line such as"),
        ("C H 0 0 0\n", "1: 5 columns; give three numbers x y z, and start other lines with #"),
        ("0 0 0 C\n", "1: 4 columns; give three numbers x y z, and start other lines with #"),
        ("id x y z\n1 0 0 0\n3 1 0 0\n2 0 1 0\n", "4: the index must go up, but goes on from 3 to 2; sort"),
        ("id x y z\na 0 0 0\n", "2: 'a' is no index; give a whole number in its column"),
        ("x y z\n0 0 0 0\n", "2: 4 columns, where the first row has 3; give as many"),
        ("x y z\n0 0 nought\n", "2: 'nought' is not a number; give x, y and z in each row"),
        ("x y z x y z\n", "1: the header names x, y or z twice; name other columns otherwise"),
        ("x,y\n0,0\n", "1: 2 columns; give three numbers x y z, and start other lines with #"),
        ("frame,x,y,z\n1,0,0,0\n", "1: the column 'frame' tells frames apart; give a file for each frame"),
        ("x,y,z\n# no rows\n", "1: there are no rows under the header; give numbers x y z"),
        ("x;y;z\n1,5;2,5;3,5\n", "2: '1,5' has a decimal comma; write a point in its place"),
        ("1,5 2,5 3,5\n", "1: '1,5' has a decimal comma"),
        ("1,5;2,5;3,5\n", "1: '1,5' has a decimal comma"),
        ("0 0 0\n1,5 2,5 3,5\n", "2: '1,5' has a decimal comma"),
        ("0 0 0\n1;2;3\n", "2: this row is not written as those before it"),
        ("C 0 0 0\nC 1 0 0\n0 1 0\n", "3: 3 columns, where the first row has 4; give as many"),
        (
            "a 0 0 0\na 1 0 0\na 0 1 0\nb 0 0 0\nb 1 0 0\nb 0 1 0\n",
            "4: the first column changes from 'a' to 'b', which may be another component; a header line says",
        ),
    ],
)
def test_what_is_not_guessed(content: str, message: str) -> None:
    with pytest.raises(FormatError, match=rf"^k\.txt:{re.escape(message)}"):
        parsed(content)


def test_a_comment_may_be_the_header_of_more_columns() -> None:
    assert parsed("# made by hand\n# x y z radius\n" + rows("{1} {2} {3} 0.5")) == [POINTS]
    assert parsed("# model of a knot\n" + rows("{} {} {} {}")) == [POINTS]
    assert parsed("# x, y, z, tension\n" + rows("{1}, {2}, {3}, 0.5")) == [POINTS]
    assert parsed("# z y x\n" + rows("{1} {2} {3}")) == [POINTS]  # three columns are x y z whatever is said


@pytest.mark.parametrize("count", [1, 2])
def test_csv_is_written(tmp_path: Path, count: int) -> None:
    parts = [np.array(POINTS) + 7 * k for k in range(count)]
    formats.write(tmp_path / "k.csv", parts, ["a: knot", "x,y,z"])
    header = "x,y,z" if count == 1 else "component,x,y,z"
    first = "0.0,0.0,0.0" if count == 1 else "1,0.0,0.0,0.0"
    assert (tmp_path / "k.csv").read_text().splitlines()[2:4] == [header, first]
    curve = formats.read(tmp_path / "k.csv")
    assert [part.tolist() for part in curve.components] == [part.tolist() for part in parts]
    assert curve.comments == ["a: knot", "x,y,z"]


def test_tables_may_be_joined() -> None:
    table = "id,x,y,z\n" + rows("{},{},{},{}")
    assert parsed(table + table) == [POINTS, POINTS]
    both = "chain,ring,x,y,z\n" + "".join(rows(f"{a},{b},{{1}},{{2}},{{3}}") for a in "AB" for b in "12")
    assert parsed(both) == [POINTS] * 4


def test_a_mark_may_end_the_rows() -> None:
    assert parsed(rows("{1},{2},{3},")) == [POINTS]
    assert parsed(rows("{};{};{};{};")) == [POINTS]
    with pytest.raises(FormatError, match=r"k\.txt:1: '' is not a number"):
        parsed("1,2,,\n")


def test_elements_may_change() -> None:
    names = ["N", "C", "C", "N"]
    content = "".join(f"{name} {x} {y} {z}\n" for name, (x, y, z) in zip(names, POINTS, strict=True))
    assert parsed(content) == [POINTS]


@given(st.lists(st.sampled_from([*'xyz 1,;\t#\n"-.', "index", "chain", "1e5", "C ", "\n\n"]), max_size=60))
def test_anything_else_gives_one_clear_line(pieces: list[str]) -> None:
    message = ""
    try:
        parsed("".join(pieces))
    except FormatError as error:
        message = str(error)
    assert re.match(r"k\.txt:\d+: .*; |$", message)
