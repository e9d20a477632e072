"""`sono export`: what is printed is closed, keeps its gap, and has the size that was asked for."""

import itertools
import math
import os
import re
import sys
import zipfile
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from conftest import Sono, Spawn

import sono as package
from sono import formats
from sono.curve import Components, Floats
from sono.figures import solids
from sono.figures.lengths import Lengths
from sono.figures.solidfiles import FORMATS
from sono.figures.tube import sides_within

trimesh = pytest.importorskip("trimesh")

ONE_BODY = ("stl", "ply", "obj")
"""Formats in which trimesh finds one; objects of .obj, which other programs see, it joins."""


def bodies(path: str | Path) -> list[Any]:
    """Read a file; give its components in millimetres, where all are one body by what hangs together."""
    path = Path(path)
    if path.suffix == ".3mf":
        return in_3mf(path)
    meshes = list(trimesh.load_scene(path).geometry.values())
    if path.suffix == ".glb":
        for mesh in meshes:
            mesh.apply_scale(1000)
    for mesh in meshes:
        mesh.merge_vertices()
    return [part for mesh in meshes for part in parts(mesh)] if path.suffix[1:] in ONE_BODY else meshes


def in_3mf(path: Path) -> list[Any]:
    """Read the objects of a 3MF file, without what trimesh needs for it."""
    from xml.etree import ElementTree

    core = "{http://schemas.microsoft.com/3dmanufacturing/core/2015/02}"
    with zipfile.ZipFile(path) as archive:
        model = ElementTree.fromstring(archive.read("3D/3dmodel.model"))
    assert model.get("unit") == "millimeter"
    objects = model.findall(f"{core}resources/{core}object")
    (item,) = model.iter(f"{core}item")
    assert item.get("objectid") == objects[-1].get("id")
    bodies = [one for one in objects if one.find(f"{core}mesh") is not None]
    if len(bodies) > 1:
        listed = [part.get("objectid") for part in objects[-1].iter(f"{core}component")]
        assert listed == [one.get("id") for one in objects[:-1]] == [one.get("id") for one in bodies]
        assert objects[-1].get("pid") is None
    found = []
    for one in bodies:
        vertices = [[float(v.get(k, "")) for k in "xyz"] for v in one.iter(f"{core}vertex")]
        faces = [[int(t.get(k, "")) for k in ("v1", "v2", "v3")] for t in one.iter(f"{core}triangle")]
        found.append(trimesh.Trimesh(vertices, faces, process=False))
    return found


def parts(mesh: Any) -> list[Any]:
    """Divide a mesh into what hangs together by its vertices."""
    label = np.arange(len(mesh.vertices))
    while True:
        least = label[mesh.faces].min(axis=1)
        new = label.copy()
        np.minimum.at(new, mesh.faces, least[:, None])
        new = new[new]
        if (new == label).all():
            break
        label = new
    of = label[mesh.faces[:, 0]]
    return [mesh.submesh([np.flatnonzero(of == k)], append=True) for k in np.unique(of)]


def check_solid(meshes: list[Any], components: int) -> None:
    assert len(meshes) == components
    for mesh in meshes:
        assert mesh.is_watertight
        assert mesh.is_winding_consistent
        assert mesh.euler_number == 0
        assert mesh.volume > 0
        assert mesh.area_faces.min() > 0


@pytest.mark.parametrize("suffix", FORMATS)
@pytest.mark.parametrize("name", ["3_1", "Hopf"])
def test_each_format_is_read_back(sono: Sono, name: str, suffix: str) -> None:
    file = f"k.{suffix}"
    result = sono("export", name, "-o", file, "--tolerance", "0.1mm")
    assert (result.exit_code, result.stdout) == (0, "")
    curve = package.start(name, known=True)
    meshes = bodies(file)
    check_solid(meshes, len(curve))
    length = 3 * (package.measure(curve).l_c or 0)
    assert sum(mesh.volume for mesh in meshes) == pytest.approx(math.pi * 2.8**2 * length, rel=0.08)
    corners = np.array([[mesh.vertices.min(axis=0), mesh.vertices.max(axis=0)] for mesh in meshes])
    size = corners[:, 1].max(axis=0) - corners[:, 0].min(axis=0)
    assert corners[:, 0].min(axis=0) == pytest.approx([0, 0, 0], abs=1e-4)
    told = f"{file}: {' x '.join(f'{edge:.1f}' for edge in size)} mm, "
    assert told in result.stderr
    assert float(result.stderr.split(told)[1].split()[0]) == pytest.approx(length, rel=0.02)
    assert f"{sum(len(mesh.faces) for mesh in meshes):,} triangles" in result.stderr


def test_objects_have_names(sono: Sono) -> None:
    sono("export", "Hopf", "-o", "k.obj", "--tolerance", "0.1mm")
    rows = Path("k.obj").read_text().splitlines()
    assert [row for row in rows if row.startswith("o ")] == ["o component 0", "o component 1"]


@pytest.mark.parametrize("suffix", FORMATS)
def test_the_same_rope_gives_the_same_bytes(sono: Sono, suffix: str) -> None:
    for name in ("a", "b"):
        assert sono("export", "3_1", "-o", f"{name}.{suffix}", "--tolerance", "0.2").exit_code == 0
    assert Path(f"a.{suffix}").read_bytes() == Path(f"b.{suffix}").read_bytes()


def segments_apart(line: Components) -> float:
    """Return the least distance of edges that are further than pi radii apart along a curve, R = 1."""
    start = np.concatenate(line)
    end = np.concatenate([np.roll(part, -1, axis=0) for part in line])
    of = np.repeat(np.arange(len(line)), [len(part) for part in line])
    at = np.concatenate([np.arange(len(part)) / len(part) for part in line])
    length = np.array([np.linalg.norm(np.roll(part, -1, axis=0) - part, axis=1).sum() for part in line])
    best = math.inf
    for i in range(len(start)):
        along = np.abs(at - at[i])
        far = (of != of[i]) | (np.minimum(along, 1 - along) * length[of[i]] > math.pi)
        share = np.linspace(0, 1, 3)[:, None, None]
        mine = start[i] + share * (end[i] - start[i])
        theirs = start[far] + share * (end[far] - start[far])
        best = min(best, float(np.linalg.norm(mine[:, None] - theirs[None], axis=-1).min()))
    return best


def coarse(name: str, n: int) -> Components:
    return list(package.refine(package.start(name, known=True), n))


@pytest.mark.parametrize(
    ("curve", "gap"),
    [
        (list(package.start("3_1", known=True)), 0.4),
        (list(package.start("3_1", known=True)), 0.0),
        (list(package.start("6^3_2", known=True)), 1.5),
        (list(package.start("4_1")), 0.4),
        (coarse("3_1", 15), 0.2),
        (coarse("3_1", 7), 0.2),
        ([1e5 * part for part in package.start("Hopf")], 0.2),
    ],
    ids=["tight", "no gap", "link", "loose", "n=15", "n=7", "huge"],
)
def test_strands_keep_the_gap(curve: Components, gap: float) -> None:
    made = solids.solid(curve, Lengths(2.0, gap=gap, tolerance=0.1))
    assert made.radius == pytest.approx(1 - gap / 2)
    sides = sides_within(made.radius, 0.1)
    line = [mesh.vertices.reshape(-1, sides, 3).mean(axis=1) for mesh in made.components]
    assert segments_apart(line) >= 2 * made.radius + gap - 1e-9
    assert segments_apart(line) == pytest.approx(2, rel=0.05) or package.measure(line).min_rad < 1.05
    for mesh in made.components:
        check_solid([trimesh.Trimesh(mesh.vertices, mesh.faces, process=False)], 1)
    assert package.identify(line).names == package.identify(curve).names


def crossed(one: Floats, other: Floats) -> bool:
    """Whether an edge of a triangle (3, 3) passes through another triangle."""
    for a, b in ((one, other), (other, one)):
        normal = np.cross(b[1] - b[0], b[2] - b[0])
        for p, q in itertools.permutations(a, 2):
            before, after = np.dot(p - b[0], normal), np.dot(q - b[0], normal)
            if before * after >= 0:
                continue
            x = p + (q - p) * before / (before - after)
            signs = [np.dot(np.cross(b[k - 2] - b[k], x - b[k]), normal) for k in range(3)]
            if min(signs) > 0:
                return True
    return False


@pytest.mark.slow
@pytest.mark.parametrize(
    "curve", [list(package.start("Hopf", known=True)), coarse("3_1", 12)], ids=["Hopf", "12"]
)
def test_no_triangle_meets_another(curve: Components) -> None:
    made = solids.solid(curve, Lengths(2.0, gap=0, tolerance=0.05))
    triangles = np.concatenate([mesh.vertices[mesh.faces] for mesh in made.components])
    low, high = triangles.min(axis=1), triangles.max(axis=1)
    for i, one in enumerate(triangles):
        near = np.flatnonzero(((low[i + 1 :] < high[i]) & (high[i + 1 :] > low[i])).all(axis=1)) + i + 1
        for j in near:
            shared = (one[:, None] == triangles[j][None]).all(axis=-1).any()
            assert shared or not crossed(one, triangles[j])


def test_the_scale_is_that_of_the_rope(folder: Path, sono: Sono) -> None:
    sizes = []
    for diameter in ("6mm", "0.6cm", "6", "12mm"):
        sono("export", "3_1", "-o", "k.ply", "--rope-diameter", diameter, "--force", "--tolerance", "0.1")
        sizes.append(bodies("k.ply")[0].extents + 0.4)  # as if there were no gap
    assert np.allclose(sizes[0], sizes[1])
    assert np.allclose(sizes[0], sizes[2])
    assert np.allclose(2 * sizes[0], sizes[3], atol=0.2)
    doubled = [2 * part for part in package.start("3_1", known=True)]
    package.write("doubled.txt", doubled)
    sono("export", "doubled.txt", "-o", "d.ply", "--tolerance", "0.1")
    assert np.allclose(bodies("d.ply")[0].extents + 0.4, sizes[0], atol=0.02)


def about(vector: Floats) -> Floats:
    """Return a rotation of space that lays the x axis along a vector."""
    turn = np.linalg.qr(np.column_stack([vector, np.eye(3)]))[0]
    return np.asarray(turn * [np.linalg.det(turn), 1, 1])


@pytest.mark.parametrize("name", ["3_1", "4_1", "8_18", "Borromean", "T(2,7)", "T(3,5)"])
@pytest.mark.parametrize("lies", [[1.0, 0, 0], [0.3, -0.5, 0.8], [-0.2, 0.9, 0.1]])
def test_a_rope_is_laid_flat_however_its_file_has_it(name: str, lies: list[float]) -> None:
    rope = [part @ about(np.array(lies)) for part in package.start(name, known=True)]
    made = solids.solid(rope, Lengths(gap=0, tolerance=0.1))
    x, y, z = made.size
    assert x > y - 0.05 > z - 0.1
    points = np.concatenate([mesh.vertices for mesh in made.components])
    assert (points.min(axis=0) == 0).all()
    random = np.random.default_rng(3)
    for _ in range(500):
        box = np.ptp(points @ about(random.normal(size=3)) @ about(random.normal(size=3)), axis=0)
        assert np.prod(box) > 0.99 * x * y * z
    assert (
        package.identify(
            [mesh.vertices.reshape(-1, sides_within(3, 0.1), 3).mean(axis=1) for mesh in made.components]
        ).names
        == package.identify(rope).names
    )


def test_a_flat_trefoil_is_less_high_than_two_ropes() -> None:
    x, y, z = solids.solid(list(package.start("3_1", known=True)), Lengths()).size
    assert z < 12.2
    assert x == pytest.approx(23.4, abs=0.2)
    assert y == pytest.approx(22.4, abs=0.2)


@pytest.mark.parametrize("gap", [0, 0.4, 3.0])
@pytest.mark.parametrize(("name", "size"), [("3_1", 80), ("8_18", 30), ("Borromean", 25), ("T(2,11)", 200)])
def test_the_longest_side_is_the_size(name: str, size: float, gap: float) -> None:
    made = solids.solid(list(package.start(name, known=True)), Lengths(size=size, gap=gap, tolerance=0.05))
    assert size - 0.1 < max(made.size) < size + 1e-9
    assert made.diameter == pytest.approx(2 * made.radius + gap)
    same = solids.solid(
        list(package.start(name, known=True)), Lengths(made.diameter, gap=gap, tolerance=0.05)
    )
    assert same.size == pytest.approx(made.size, abs=0.2)


def test_the_size_of_any_curve(folder: Path, sono: Sono) -> None:
    package.write("loose.txt", [30 * part for part in package.start("4_1")])
    for source in ("loose.txt", "7_4", "Whitehead"):
        result = sono("export", source, "-o", "k.3mf", "--size", "2.5in", "--force", "--tolerance", "0.1mm")
        assert "k.3mf: 63.5 x " in result.stderr or "k.3mf: 63.4 x " in result.stderr


@pytest.mark.parametrize(
    "lengths", [{"rope_diameter": "6mm"}, {"size": "80"}, {"gap": None}, {"tolerance": [1]}, {"size": True}]
)
def test_what_is_no_number_of_millimetres(lengths: dict[str, Any]) -> None:
    with pytest.raises(ValueError, match="give a number of millimetres, such as 6"):
        package.export("k.3mf", "3_1", **lengths)
    with pytest.raises(ValueError, match="both; give one"):
        package.export("k.3mf", "3_1", rope_diameter=6, size=80)


def test_inches_are_told_from_millimetres(sono: Sono) -> None:
    result = sono("export", "3_1", "-o", "k.stl", "--rope-diameter", "0.5 in", "--gap", "0.05in")
    assert "mm of rope 12.7 mm thick, printed 11.4 mm thick" in result.stderr


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (
            ["-o", "k.foo"],
            "k.foo: .foo is no format of solids; the suffixes are: .stl, .obj, .ply, .glb, .3mf",
        ),
        (["-o", "k"], "k: no suffix is no format of solids"),
        (["-o", "k.stl", "--format", "step"], "--format .step: .step is no format of solids"),
        (["-o", "k.stl", "--rope-diameter", "6 ft"], "'6 ft' is no length; give one such as 6mm"),
        (["-o", "k.stl", "--rope-diameter", "mm"], "'mm' is no length"),
        (["-o", "k.stl", "--rope-diameter", "1.2.3mm"], "'1.2.3mm' is no length"),
        (["-o", "k.stl", "--rope-diameter", "-6mm"], "'-6mm' is no length"),
        (["-o", "k.stl", "--rope-diameter", "0mm"], "the rope's diameter is 0 mm; give one above 0"),
        (["-o", "k.stl", "--rope-diameter", "9e999"], "the rope's diameter is inf mm"),
        (["-o", "k.stl", "--tolerance", "0"], "the tolerance is 0 mm; give one above 0"),
        (["-o", "k.stl", "--gap", "6mm"], "a gap of 6 mm leaves nothing of a rope of 6 mm"),
        (["-o", "k.stl", "--size", "0"], "the size is 0 mm; give one above 0"),
        (
            ["-o", "k.stl", "--size", "9", "--rope-diameter", "6"],
            "--rope-diameter and --size both tell the scale",
        ),
        (["-o", "k.stl", "--size", "9", "--gap", "1e999"], "the gap is inf mm; give 0 or more"),
        (["4_1", "-o", "prints"], "prints is one file; name a folder, prints/, for 2 ropes"),
        (["-o", "prints"], "prints/ is a folder, and --format tells"),
        (["4_1", "-o", "k.stl"], "k.stl is one file; name a folder, k.stl/, for 2 ropes"),
        ([], "Missing option '-o'"),
    ],
)
def test_wrong_usage(sono: Sono, arguments: list[str], message: str) -> None:
    result = sono("export", "3_1", *arguments)
    assert (result.exit_code, result.stdout, os.path.exists("k.stl")) == (2, "", False)
    assert message in result.stderr.replace("\n", " ")


def test_several_ropes_go_to_a_folder_and_one_bad_one_spoils_none(folder: Path, sono: Sono) -> None:
    (folder / "bad.txt").write_text("0 0 0\n2 2 0\n2 0 0\n0 2 0\n")
    result = sono(
        "export", "bad.txt", "3_1", "nix", "T(2,103)", "Hopf.txt", "-o", "out/", "--tolerance", "0.2"
    )
    assert result.exit_code == 1
    assert sorted(os.listdir("out")) == ["3_1.stl", "Hopf.stl"]
    for message in (
        "bad.txt:1: the curve crosses itself",
        "nix: no such file",
        "`sono tighten 'T(2,103)' -o",
    ):
        assert message in result.stderr
    again = sono("export", "3_1", "-o", "out/", "--tolerance", "0.2")
    assert (again.exit_code, again.stderr) == (1, "sono: out/3_1.stl exists; --force overwrites it\n")
    assert sono("export", "3_1", "-o", "out/", "--tolerance", "0.2", "--force", "-q").stderr == ""


def test_frames_do_not_overwrite_each_other(folder: Path, sono: Sono) -> None:
    formats.write_all("run.xyz", [(package.start("3_1"), ["a"]), (package.start("4_1"), ["b"])])
    one = sono("export", "run.xyz", "-o", "k.stl", "--force", "--tolerance", "0.2")
    assert one.exit_code == 1
    assert "run.xyz:2: k.stl is written already; -o FOLDER/ takes several" in one.stderr
    sono("export", "run.xyz", "-o", "out/", "--format", "3mf", "--tolerance", "0.2")
    assert sorted(os.listdir("out")) == ["run.1.3mf", "run.2.3mf"]


def test_a_rope_that_is_too_thin_for_its_length(folder: Path, sono: Sono) -> None:
    n = 40
    angles = np.linspace(0, math.tau, n, endpoint=False)
    ring = np.stack([np.cos(angles), np.sin(angles), 0 * angles], axis=1)
    package.write("thin.txt", [ring, ring + np.array([0, 0, 1e-7])])
    result = sono("export", "thin.txt", "-o", "k.stl")
    assert (result.exit_code, os.path.exists("k.stl")) == (1, False)
    assert "radii long, and takes over 5000000 triangles; tighten the curve" in result.stderr


def test_without_trimesh(sono: Sono, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "trimesh", None)
    result = sono("export", "3_1", "-o", "k.stl", "--tolerance", "0.2")
    assert result.exit_code == 1
    assert "k.stl: is written by trimesh; pip install 'sono[mesh]', or name a file .3mf\n" in result.stderr
    assert sono("export", "3_1", "-o", "k.3mf", "--tolerance", "0.2").exit_code == 0


@pytest.mark.parametrize(
    ("source", "message"),
    [
        ("gauss:1 2 3 1 2 3", "no minus tells what is below; put one where it is, as in 1 -2 3 -1 2 -3"),
        ("gauss:1 -2 -1 2", "it cannot be drawn in the plane"),
        ("dt:4 x 2", "DT code '4 x 2': not readable"),
        ("8_22", "did you mean one of 8_1 to 8_21?"),
        ("3 1", "falls into pieces; did you mean '3_1'?"),
    ],
)
def test_what_is_no_knot_is_not_told_to_be_tightened(sono: Sono, source: str, message: str) -> None:
    result = sono("export", source, "-o", "k.3mf")
    assert (result.exit_code, os.path.exists("k.3mf")) == (1, False)
    assert message in result.stderr
    assert "sono tighten" not in result.stderr


def test_what_has_the_atlas_by_another_name_is_printed_so(sono: Sono) -> None:
    for name in ("P(-2,3,7)", "12n_242", "pd:[(1,5,2,4),(3,1,4,6),(5,3,6,2)]", "3_1"):
        assert sono("export", name, "-o", "out/", "--format", "3mf", "--tolerance", "0.2").exit_code == 0
    sizes = {os.path.getsize(f"out/{name}") for name in os.listdir("out")}
    assert len(os.listdir("out")) == 4
    assert len(sizes) == 2


def test_a_loose_curve_is_told_to_be_loose(sono: Sono) -> None:
    for name in ("8_18", "Borromean", "T(2,11)"):
        package.write("loose.txt", package.start(name))
        loose = sono("export", "loose.txt", "-o", "k.3mf", "--force", "--tolerance", "0.2")
        assert loose.exit_code == 0
        assert "`sono tighten loose.txt -o rope.txt` makes it shorter first" in loose.stderr
        package.write("tight.txt", package.start(name, known=True))
        for tight in (name, "tight.txt"):
            result = sono("export", tight, "-o", "k.3mf", "--force", "--tolerance", "0.2")
            assert "loose" not in result.stderr


def test_ropes_of_few_beads_are_not_loose(sono: Sono) -> None:
    for n in (40, 60, 2000):
        package.write("rope.txt", coarse("3_1", n))
        assert (
            "loose" not in sono("export", "rope.txt", "-o", "k.3mf", "--force", "--tolerance", "0.2").stderr
        )


@pytest.mark.parametrize("suffix", ["stl", "ply", "glb", "3mf"])
def test_a_solid_is_no_curve(sono: Sono, suffix: str) -> None:
    sono("export", "3_1", "-o", f"k.{suffix}", "--tolerance", "0.2")
    for command in (("export", "-o", "again.3mf"), ("measure",), ("identify",)):
        result = sono(command[0], f"k.{suffix}", *command[1:])
        assert result.exit_code == 1
        assert f"k.{suffix}:1: this is a solid, not a curve; give the curve, or the knot's" in result.stderr


def test_a_solid_in_words_is_no_curve_either(folder: Path, sono: Sono) -> None:
    (folder / "k.stl").write_text("solid k\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\n")
    assert "k.stl:1: this is a solid, not a curve" in sono("measure", "k.stl").stderr


def test_what_the_message_says_of_the_rope_is_what_it_takes(sono: Sono) -> None:
    for name in ("4_1", "Whitehead"):
        result = sono("export", name, "-o", f"{name}.3mf", "--rope-diameter", "50mm", "--tolerance", "0.5")
        told = re.search(r"([0-9]+) mm of rope 50 mm thick, printed 49.6 mm thick", result.stderr)
        assert told is not None
        ropelength = package.measure(name).l_a or 0
        assert int(told[1]) == pytest.approx(25 * ropelength, rel=0.003)


def test_a_place_that_cannot_be_written(folder: Path, sono: Sono) -> None:
    result = sono("export", "3_1", "-o", "nowhere/k.stl", "--tolerance", "0.2")
    assert (result.exit_code, result.stderr.count("\n")) == (1, 1)
    assert result.stderr.startswith("sono: nowhere/k.stl: cannot be written: ")
    assert "; make the folder nowhere first" in result.stderr


@pytest.mark.skipif(not os.path.exists("/dev/full"), reason="needs a full device")
def test_a_full_disk(sono: Sono) -> None:
    result = sono("export", "3_1", "-o", "/dev/full", "--format", "stl", "--tolerance", "0.2")
    assert result.exit_code == 1
    assert result.stderr == "sono: /dev/full: cannot be written: No space left on device\n"


def test_standard_output(spawn: Spawn) -> None:
    arguments = ("export", "3_1", "-o", "-", "--format", "stl", "--tolerance", "0.2", "-q")
    with open("k.stl", "wb") as stream:
        process = spawn(*arguments, stdout=stream)
        assert process.wait() == 0
    check_solid(bodies("k.stl"), 1)


def test_the_library_writes_what_the_command_does(sono: Sono) -> None:
    sono("export", "3_1.txt", "-o", "a.stl", "--tolerance", "0.2")
    made = package.export("b.stl", package.read("3_1.txt"), tolerance=0.2)
    assert Path("a.stl").read_bytes() == Path("b.stl").read_bytes()
    assert made.triangles == len(made.components[0].faces)
    with pytest.raises(ValueError, match="has no rope"):
        package.export("c.stl", "T(2,103)")
    with pytest.raises(ValueError, match="no format of solids"):
        package.export("c.xyz", "3_1")


def test_components_have_colours_of_their_own(sono: Sono, folder: Path) -> None:
    for suffix in ("glb", "3mf"):
        assert sono("export", "Borromean", "-o", f"rings.{suffix}", "--tolerance", "0.2").exit_code == 0
    meshes = trimesh.load_scene(folder / "rings.glb").geometry.values()
    assert len({tuple(mesh.visual.material.baseColorFactor) for mesh in meshes}) == 3
    with zipfile.ZipFile(folder / "rings.3mf") as archive:
        model = archive.read("3D/3dmodel.model").decode()
    paints = re.findall('displaycolor="(#[0-9A-F]{6})"', model)
    assert len(set(paints)) == 3
    assert re.findall('pid="1" pindex="([0-9]+)"', model) == ["0", "1", "2"]
