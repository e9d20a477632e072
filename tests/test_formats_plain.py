"""OBJ, JSON, NPY, NPZ and gzip: what is read, what is written, and that nothing in a file is run."""

import gzip
import io
import json
import os
import zipfile
from importlib import resources
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from conftest import QUICK, Sono

import sono as package
from sono import formats, starts
from sono.formats import FormatError, VertexFile, jsons, npy, npz

POINTS = [[0.0, 0.0, 0.0], [1.0, 0.25, 0.0], [0.0, 1.0, 0.5], [-1.0, 0.0, 2.0]]
OTHER = [[9.0, 0.0, 0.0], [9.0, 1.0, 0.0], [9.0, 1.0, 1.0]]
V = "".join(f"v {x} {y} {z}\n" for x, y, z in POINTS)
W = "".join(f"v {x} {y} {z}\n" for x, y, z in OTHER)


def parsed(name: str, content: str | bytes) -> VertexFile:
    (curve,) = formats.parse(name, content.encode() if isinstance(content, str) else content)
    return curve


def lists(name: str, content: str | bytes) -> list[Any]:
    return [component.tolist() for component in parsed(name, content).components]


@pytest.mark.parametrize(
    "content",
    [
        f"{V}l 1 2 3 4 1\n",
        f"# a comment\nmtllib a.mtl\no knot\ng all\n{V}usemtl b\ns off\nl 1 2 3 4 1\n",
        f"{V}l 1 2\nl 2 3\nl 3 4\nl 4 1\n",
        f"{V}l 4 1\nl 2 1\nl 3 2\nl 3 4\n",
        f"{V}l -4 -3 -2 -1 -4\n",
        f"{V}l 1/1 2/2 3/3 4/4 1/1\n",
        f"{V}l 1 2 3\nl 3 4 1\n",
        f"l\n{V}l 1 2 3 4 1\n".removeprefix("l\n"),
        f"{V}vn 0 0 1\nvt 0 0\nf 1 2 3\nl 1 2 3 4 1\n",
        V.replace("\n", " 1.0 0.5 0.5 0.5\n") + "l 1 2 3 4 1\n",
        V,
        V.replace(" ", "\t"),
        f"{V}l 1 2 \\\n3 4 \\\n1\n",
    ],
)
def test_obj(content: str) -> None:
    (component,) = lists("k.obj", content)
    turned = [POINTS[k:] + POINTS[:k] for k in range(4)]
    assert component in turned + [points[::-1] for points in turned]
    assert lists("k.txt", content) == [component]  # it is recognised too


def test_elements_are_no_words_of_obj() -> None:
    for element in ("p", "s", "f", "o", "c"):
        assert lists("k.txt", "".join(f"{element} {x} {y} {z}\n" for x, y, z in POINTS)) == [POINTS]


def test_obj_of_several_components() -> None:
    lines = "l 1 2\nl 5 6\nl 2 3\nl 6 7\nl 3 4\nl 7 5\nl 4 1\n"
    assert lists("k.obj", f"{V}{W}{lines}") == [POINTS, OTHER]
    assert lists("k.obj", f"{V}l 1 2 3 4 1\n{W}l -3 -2 -1 -3\n") == [POINTS, OTHER]


def test_an_open_line_of_obj_is_an_open_chain() -> None:
    with pytest.raises(FormatError, match=r"k.obj:4: the chain is open: it ends here and began on line 1"):
        parsed("k.obj", f"{V}l 1 2 3 4\n")
    assert len(formats.parse("k.obj", f"{V}l 1 2 3 4\n".encode(), "direct")) == 1
    again = f"{V}v 0 0 0\nl 1 2 3 4 5\n"  # it comes back to the place of its first vertex
    assert lists("k.obj", again) == [POINTS]


@pytest.mark.parametrize(
    "content",
    [
        POINTS,
        [POINTS],
        {"components": [POINTS]},
        {"vertices": POINTS},
        {"vertices": [POINTS]},
        {"components": POINTS, "color": [1, 2, 3]},
        {"format": "other", "version": "2.0", "vertices": POINTS},
    ],
)
@pytest.mark.parametrize("indent", [None, 1])
def test_json(content: Any, indent: int | None) -> None:
    text = json.dumps(content, indent=indent)
    for name in ("k.json", "k.txt"):
        assert lists(name, text) == [POINTS]
    assert lists("k.json", json.dumps([POINTS, OTHER])) == [POINTS, OTHER]


ROWS = [", ".join(map(str, row)) for row in POINTS]
MORE = [", ".join(map(str, row)) for row in OTHER]


@pytest.mark.parametrize(
    "content",
    [
        "\n".join(f"[{row}]" for row in ROWS),
        "# a knot\n" + "\n".join(f"[{row}],  # a vertex\n # more" for row in ROWS),
        "\n".join(f"({row})" for row in ROWS),
        "\n".join("{" + row + "}" for row in ROWS) + "\n",
        "{" + ",\n".join("{" + row + "}" for row in ROWS) + "}",
        "{{" + "}, {".join(ROWS).replace("0.25", "2.5`17.*^-1") + "}}",
        "[[" + "]\n [".join(ROWS).replace(",", " ") + "]]\n",
        str([tuple(row) for row in POINTS]).strip("[]"),
    ],
)
@pytest.mark.parametrize("suffix", ["txt", "json", "dat"])
def test_vertices_in_brackets(content: str, suffix: str) -> None:
    assert lists(f"k.{suffix}", content) == [POINTS]


def test_components_in_brackets() -> None:
    assert lists("k.txt", "{{{" + "}, {".join(ROWS) + "}},\n{{" + "},\n {".join(MORE) + "}}}") == [
        POINTS,
        OTHER,
    ]
    assert lists("k.txt", "\n".join(f"[{row}]" for row in [*ROWS, *MORE]).replace("2.0]", "2.0]\n")) == [
        POINTS,
        OTHER,
    ]


@pytest.mark.parametrize(
    ("content", "message"),
    [
        ("[0, 0, 0]\n[1, 0, x]\n", "2: '1, 0, x' is no vertex; give three numbers"),
        ("[0, 0, 0]\n[1, 0]\n", "2: '1, 0' is no vertex"),
        ("{{0, 0, 0},\n{1, 0, 0},\n{0, 1, 0}", "3: brackets are opened that are not closed"),
        ("{{0, 0, 0},\n{1, 0, 0},\n{0, 1", "3: '0, 1' is in no brackets"),
        ("[0, 0, 0]\n[1, 0, 0]\n0, 1, 0\n", "3: '0, 1, 0' is in no brackets"),
        ("<svg>\n<path/>\n</svg>\n", "1: of XML only ideal knots, with Coeff in them, are read"),
        ('<?xml version="1.0"?>\n<a><b></a>\n', "1: of XML only ideal knots"),
    ],
)
def test_what_is_wrong_in_brackets_and_tags(content: str, message: str) -> None:
    with pytest.raises(FormatError, match=rf"^k\.txt:{message}"):
        parsed("k.txt", content)


@pytest.mark.parametrize("kind", ["utf-16", "utf-16-le", "utf-16-be"])
def test_utf_16_is_to_be_saved_otherwise(kind: str) -> None:
    with pytest.raises(FormatError, match=r"^k\.txt:1: this is UTF-16 text, or none; save it as UTF-8"):
        parsed("k.txt", "0 0 0\n1 0 0\n0 1 0\n".encode(kind))


def test_json_keeps_what_is_known_of_a_rope(sono: Sono) -> None:
    sono("tighten", "3_1.txt", "-n", "60", "-o", "rope.json", *QUICK)
    document = json.loads(Path("rope.json").read_text())
    schema = json.loads(resources.files("sono").joinpath("data", "curve.schema.json").read_text())
    assert set(schema["required"]) <= set(document) <= set(schema["properties"])
    assert document["format"] == schema["properties"]["format"]["const"] == jsons.FORMAT
    assert document["version"] == schema["properties"]["version"]["const"] == jsons.VERSION
    assert document["unit"] == schema["properties"]["unit"]["const"] == jsons.UNIT
    assert (document["name"], document["provenance"]["method"]) == ("3_1", "both")
    assert document["measures"]["l_p"] == package.measure(document["components"]).l_p
    again = sono("tighten", "3_1.txt", "-n", "60", "-o", "rope.json", "--resume", *QUICK)
    assert (again.exit_code, again.stderr) == (0, "")
    lines = [
        i for i, row in enumerate(Path("rope.json").read_text().splitlines(), 1) if row.startswith("   [")
    ]
    assert formats.read("rope.json").lines[0].tolist() == lines


def test_json_has_no_number_that_json_lacks(tmp_path: Path) -> None:
    formats.write(
        tmp_path / "k.json",
        starts.start("unknot"),
        ["u: tight, rope radius R_s = 1", "n 3  dl 1  (length over radius)"],
    )
    json.loads((tmp_path / "k.json").read_text(), parse_constant=lambda word: pytest.fail(word))


@pytest.mark.parametrize("dtype", ["f8", "f4", "f2", ">f8", "i4", "u1", "i8", "g"])
@pytest.mark.parametrize("order", ["C", "F"])
def test_npy(dtype: str, order: Any) -> None:
    points = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 2], [0, 3, 1]])
    for name in ("k.npy", "k", "k.txt"):
        content = npy.packed(points.astype(dtype, order=order))
        assert lists(name, content) == [points.tolist()]
    stacked = np.stack([points, points + 9]).astype(dtype)
    link = parsed("k.npy", npy.packed(stacked))
    assert [part.tolist() for part in link.components] == stacked.tolist()
    assert link.doubts() == ["k.npy: was read as a link of 2 components"]


def test_npy_has_components_of_one_size(tmp_path: Path) -> None:
    with pytest.raises(FormatError, match=r"k.npy: NPY holds components of one size.* 3 to 4; write .npz"):
        formats.write(tmp_path / "k.npy", [np.array(POINTS), np.array(OTHER)])
    assert list(tmp_path.iterdir()) == []


def saved(**arrays: object) -> bytes:
    stream = io.BytesIO()
    np.savez(stream, **arrays)  # type: ignore[arg-type]
    return stream.getvalue()


BESIDE = [
    {"box": np.ones(3)},
    {"box": np.eye(3), "n": 4},
    {"names": np.array(["a", "b"]), "bounds": np.zeros((2, 3)), "distances": np.zeros((4, 4))},
    {"empty": np.zeros((0, 3)), "flags": np.zeros((4, 3), bool)},
]


@pytest.mark.parametrize("beside", BESIDE)
@pytest.mark.parametrize("coords", [POINTS, [POINTS, POINTS]])
def test_arrays_beside_the_curve_are_left_out(beside: dict[str, object], coords: list[Any]) -> None:
    content = saved(**beside, coords=coords)
    assert np.array_equal(lists("k.npz", content), np.reshape(coords, (-1, 4, 3)))
    left = f"k.npz: left out the arrays {', '.join(beside)}, which are no curves"
    assert parsed("k.npz", content).notes[-1] == left


def test_arrays_of_an_npz_are_a_link_or_one_is_chosen(tmp_path: Path) -> None:
    (tmp_path / "k.npz").write_bytes(saved(one=POINTS, two=OTHER, box=np.ones(3)))
    curve = formats.read(tmp_path / "k.npz")
    assert len(curve.components) == 2
    assert "was read as a link of 2 components, the arrays one, two; " in curve.notes[0]
    assert [part.tolist() for part in formats.read(f"{tmp_path}/k.npz:two").components] == [OTHER]
    with pytest.raises(FormatError, match="holds no curve 'box'; there are: one, two"):
        formats.read(f"{tmp_path}/k.npz:box")
    assert parsed("k.npz", npz.write([np.array(POINTS), np.array(OTHER)], [])).notes == []


def test_npz() -> None:
    for save in (np.savez, np.savez_compressed):
        stream = io.BytesIO()
        save(stream, np.array(POINTS), second=np.array(OTHER))
        assert sorted(lists("k.npz", stream.getvalue())) == [POINTS, OTHER]
    assert lists("k.npz", npz.write([np.array(POINTS)], [])) == [POINTS]


class Bomb:
    """What would be run by a careless reader."""

    def __reduce__(self) -> Any:
        return os.mkdir, ("run",)


def test_nothing_is_run(folder: Path) -> None:
    bomb = np.array([Bomb()], dtype=object)
    np.save("k.npy", bomb, allow_pickle=True)
    np.savez("k.npz", bomb)
    for name in ("k.npy", "k.npz"):
        with pytest.raises(FormatError, match=r":1: holds Python objects; save the vertices as an array"):
            formats.read(name)
    assert not Path("run").exists()


@pytest.mark.parametrize("suffix", ["txt", "xyz", "vect", "obj", "json", "npy", "npz"])
def test_gzip(folder: Path, suffix: str) -> None:
    for name in ("3_1", "Hopf"):
        curve = starts.start(name)
        path = f"{name}.{suffix}.gz"
        formats.write(path, curve, ["a", "b"])
        data = Path(path).read_bytes()
        assert data[:2] == b"\x1f\x8b"
        formats.write(path, curve, ["a", "b"])
        assert Path(path).read_bytes() == data
        file = formats.read(path)
        assert [part.tobytes() for part in file.components] == [part.tobytes() for part in curve]
        assert list(file.comments) == (["a", "b"] if suffix != "npy" else [])


def test_ropes_are_packed_and_known_again(sono: Sono) -> None:
    for suffix in ("vect.gz", "npz", "obj"):
        arguments = ("tighten", "3_1.txt", "-n", "60", "-o", f"rope.{suffix}", *QUICK)
        assert sono(*arguments).exit_code == 0
        again = sono(*arguments, "--resume")
        assert (again.exit_code, again.stderr) == (0, "")
    stopped = sono("tighten", "3_1.txt", "-n", "300", "-o", "long.vect.gz", "--time-limit", "0.01")
    assert "is in long.best.vect.gz" in stopped.stderr
    assert formats.read("long.best.vect.gz").comments


def test_a_broken_gzip_file(folder: Path) -> None:
    Path("k.txt.gz").write_bytes(gzip.compress(b"0 0 0\n" * 1000)[:-9])
    with pytest.raises(FormatError, match=r"^k.txt.gz: is no whole gzip file: .*; pack it again"):
        formats.read("k.txt.gz")


def archive(**members: bytes) -> bytes:
    stream = io.BytesIO()
    with zipfile.ZipFile(stream, "w") as file:
        for name, data in members.items():
            file.writestr(zipfile.ZipInfo(name.replace("_npy", ".npy")), data)  # of no time, as ids need
    return stream.getvalue()


GOOD = npy.packed(np.array(POINTS))
ARRAY = "; save the vertices as an array of numbers"
SHAPE = r"; give \(n, 3\), or \(k, n, 3\) for k components"

BROKEN: dict[str, list[tuple[str | bytes, str]]] = {
    "k.obj": [
        ("", "1: the file holds no vertices; give v x y z"),
        ("# nothing\n", "1: the file holds no vertices; give v x y z"),
        ("l 1 2 3\n", "1: there is no vertex '1' among the 0 so far; correct"),
        (f"{V}l 1 2 3 4 5\n", "5: there is no vertex '5' among the 4 so far; correct"),
        (f"{V}l 0 1 2\n", "5: there is no vertex '0' among"),
        (f"{V}l -5 1 2\n", "5: there is no vertex '-5' among"),
        (f"{V}l 1 2 x\n", "5: 'x' is no vertex; give l with"),
        (f"{V}l 1 2 1.5\n", "5: '1.5' is no vertex; give l with"),
        (f"{V}l 1\n", "5: a line of 1 vertices; give l with two"),
        (f"{V}l\n", "5: a line of 0 vertices; give l with two"),
        (f"{V}l 1 1 2\n", "5: the vertex 1 is joined to itself; leave out"),
        (f"{V}l 1 2 3\nl 2 4\n", "6: the vertex 2 joins three edges; a curve does not branch"),
        (f"{V}l 1 2 3 4 2\n", "5: the vertex 2 joins three edges; a curve does not branch"),
        (f"{V}f 1 2 3\n", "1: the file holds a surface and no line; give v x y z, and l"),
        ("v 1 2\n", "1: a vertex of 2 numbers; give v x y z"),
        ("v 1 2 z\n", "1: 'z' is not a number; give v x y z"),
        ("v\n", "1: a vertex of 0 numbers; give v x y z"),
        (f"{V}v 1 nan 0\n", "5: a coordinate is not finite; give a number"),
        (f"{V}7 8 9\n", "5: '7' begins no line of OBJ; give v x y z"),
        (f"{V}l 1 2 1\n", "1: the component that starts here has too few vertices: 2; give at least 3"),
        (f"{V}l 1 2 3 4\n", "4: the chain is open: .*; --close direct"),
        (f"{V}v -1 0 2\nl 1 2 3 4 5 1\n", "5: this vertex equals its neighbour on line 4; delete"),
    ],
    "k.json": [
        ("", "1: is no JSON: Expecting value; complete or correct it"),
        ("[[0, 0, 0],\n[1, 0", "2: is no JSON: Expecting .*; complete or correct it"),
        ("[[0, 0, 0],\n[1, 0, x]]", "2: is no JSON: Expecting value; complete"),
        ("[[0, 0, 0],\n[1, 0, 0],]", "2: is no JSON: .*; complete or correct it"),
        ("[[0, 0, 0]] 7", "1: is no JSON: Extra data; complete or correct it"),
        ("{'components': []}", "1: is no JSON: Expecting property name"),
        ("[]", "1: there is no list of vertices; give"),
        ("{}", "1: there is no list of vertices; give"),
        ("[[]]", r"1: \[\] is no vertex; give \[x, y, z\], three numbers"),
        ("[[[]]]", r"1: \[\] is no vertex; give \[x, y, z\], three numbers"),
        ("[1, 2, 3]", "1: there is no list of vertices; give"),
        ("7", "1: there is no list of vertices; give"),
        ('{"components": 3}', "1: there is no list of vertices; give"),
        ("[[0, 0], [1, 0], [1, 1]]", r"1: \[0, 0\] is no vertex; give"),
        ("[[0, 0, 0, 1], [1, 0, 0, 1]]", r"1: \[0, 0, 0, 1\] is no vertex; give"),
        ('[["0", "0", "0"]]', r'1: \["0", "0", "0"\] is no vertex; give'),
        ("[[null, 0, 0]]", r"1: \[null, 0, 0\] is no vertex; give"),
        ("[[true, 0, 0]]", r"1: \[true, 0, 0\] is no vertex; give"),
        ("[[0, 0, 0], 5]", "1: 5 is no vertex; give"),
        ("[[[0, 0, 0]], 5]", "1: 5 is no vertex; give"),
        ("[\n[0, 0, 0],\n[1, NaN, 0],\n[0, 1, 0]]", "3: a coordinate is not finite; give a number"),
        (f"[[1{'0' * 400}, 0, 0]]", "1: a coordinate is not finite; give a number"),
        (f"[[1{'0' * 5000}, 0, 0]]", "1: is no JSON of a curve: too many digits, or lists; correct it"),
        ("[" * 100000, "1: is no JSON of a curve: too many digits, or lists; correct it"),
        ('{"format": "sono curve", "version": 2}', "1: the version is not 1; a newer sono may"),
        ("[\n[0, 0, 0],\n[1, 0, 0]]", "2: the component that starts here has too few vertices: 2; give"),
    ],
    "k.npy": [
        (b"", f"1: is no whole NPY file{ARRAY}"),
        (b"0 0 0\n1 0 0\n0 1 0\n", f"1: is no whole NPY file{ARRAY}"),
        *((GOOD[:cut], f"1: is no whole NPY file{ARRAY}") for cut in (6, 7, 9, 20, 60, 127, 128, 150)),
        (b"\x93NUMPY\x09\x00" + GOOD[8:], f"1: is no whole NPY file{ARRAY}"),
        (GOOD.replace(b"descr", b"dascr"), f"1: is no whole NPY file{ARRAY}"),
        (GOOD.replace(b"<f8", b"<q9"), f"1: is no whole NPY file{ARRAY}"),
        (GOOD.replace(b"(4, 3)", b"(9, 3)"), f"1: is no whole NPY file{ARRAY}"),
        (GOOD.replace(b"<f8", b"<c8"), "1: "),
        (npy.packed(np.zeros((4, 2))), rf"1: the array has the shape \(4, 2\){SHAPE}"),
        (npy.packed(np.zeros((3, 4))), rf"1: the array has the shape \(3, 4\){SHAPE}"),
        (npy.packed(np.zeros(12)), rf"1: the array has the shape \(12,\){SHAPE}"),
        (npy.packed(np.zeros((0, 3))), rf"1: the array has the shape \(0, 3\){SHAPE}"),
        (npy.packed(np.zeros((1, 1, 4, 3))), rf"1: the array has the shape \(1, 1, 4, 3\){SHAPE}"),
        (npy.packed(np.zeros((4, 3), complex)), "1: the array holds complex128; save"),
        (npy.packed(np.zeros((4, 3), "U2")), "1: the array holds <U2; save"),
        (npy.packed(np.zeros(4, "f8,f8,f8")), "1: the array holds .*; save"),
        (npy.packed(np.array([*POINTS, [0, np.nan, 0]])), "5: a coordinate is not finite; give"),
        (npy.packed(np.array(POINTS[:2])), "1: the component that starts here has too few vertices: 2; give"),
        (npy.packed(np.array([*POINTS, POINTS[3]])), "5: this vertex equals its neighbour on line 4; delete"),
    ],
    "k.npz": [
        (b"", "1: is no whole NPZ archive; save it again"),
        (b"0 0 0\n", "1: is no whole NPZ archive; save it again"),
        *(
            (archive(a_npy=GOOD, b_npy=GOOD)[:cut], "1: is no whole NPZ archive; save it again")
            for cut in (4, 10, 30, 100, 300, 500, 600, 630)
        ),
        (archive(), "1: "),
        (archive(a_npy=b""), rf"1: is no whole NPY file{ARRAY}"),
        (archive(a_npy=GOOD[:150]), rf"1: is no whole NPY file{ARRAY}"),
        (archive(a_npy=GOOD, b_npy=b"7"), rf"1: is no whole NPY file{ARRAY}"),
        (archive(a_npy=GOOD, text=b"7"), "1: the archive holds 'text'; it should hold .npy arrays"),
        (archive(a_npy=npy.packed(np.zeros(3))), r"1: the array has the shape \(3,\)"),
        (archive(a_npy=npy.packed(np.zeros((3, 3), "U2"))), "1: the array holds <U2; save"),
        (archive(comments_npy=npy.packed(np.array(["a"]))), "1: the archive holds no arrays; give one"),
        (archive(a_npy=GOOD).replace(b"<f8", b"<f4"), "1: is no whole NPZ archive; save it again"),
        (archive(a_npy=npy.packed(np.array(POINTS[:2]))), "1: the component that starts here has too few"),
    ],
}


@pytest.mark.parametrize(
    ("name", "content", "message"),
    [(name, content, message) for name, cases in BROKEN.items() for content, message in cases],
)
def test_broken_files_give_one_clear_line(name: str, content: str | bytes, message: str) -> None:
    with pytest.raises(FormatError, match=rf"^{name}(\[\w+\])?:{message}") as caught:
        parsed(name, content)
    assert str(caught.value).isprintable()
    assert "; " in str(caught.value)


def test_there_are_twenty_each() -> None:
    assert all(len(cases) >= 20 for cases in BROKEN.values())
