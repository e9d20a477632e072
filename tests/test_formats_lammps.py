"""LAMMPS dumps and data files: chains are put together, unwrapped, and never made of what is unclear."""

import re
from collections.abc import Sequence
from contextlib import suppress
from pathlib import Path

import numpy as np
import pytest
from conftest import Sono
from hypothesis import given
from hypothesis import strategies as st
from knots import Floats, damaged, hopf, trefoil

from sono import formats
from sono.formats import FormatError, VertexFile
from sono.invariants import fingerprint

SIZE = 9.0
BOX = np.diag([SIZE] * 3)
TILTED = np.array([[SIZE, 0, 0], [2.5, SIZE, 0], [-1.5, 3.0, SIZE]])


def frame(
    components: Sequence[Floats],
    columns: str = "id mol type x y z ix iy iz",
    edges: Floats = BOX,
    step: int = 0,
) -> str:
    """One frame of a dump with its atoms in any order, wrapped into the box with a corner at -1 -2 -3."""
    origin = np.array([-1.0, -2.0, -3.0])
    rows = np.vstack(components)
    scaled = (rows - origin) @ np.linalg.inv(edges)
    images = np.floor(scaled)
    wrapped = rows - images @ edges
    molecules = np.repeat(np.arange(len(components)) + 1, [len(part) for part in components])
    table = {"id": np.arange(len(rows)) + 1, "mol": molecules, "type": np.ones(len(rows), int)}
    places = {"": wrapped, "u": rows, "s": scaled - images, "su": scaled}
    for suffix, values in places.items():
        table |= {axis + suffix: values[:, i] for i, axis in enumerate("xyz")}
    table |= {"i" + axis: images[:, i].astype(int) for i, axis in enumerate("xyz")}
    names = columns.split()
    order = np.random.default_rng(step).permutation(len(rows))
    lines = [" ".join(str(table[name][atom]) for name in names) for atom in order]
    return f"ITEM: TIMESTEP\n{step}\nITEM: NUMBER OF ATOMS\n{len(rows)}\n{bounds(origin, edges)}" + "".join(
        f"{line}\n" for line in [f"ITEM: ATOMS {columns}", *lines]
    )


def bounds(origin: Floats, edges: Floats) -> str:
    high = origin + np.diag(edges)
    if (edges == np.diag(np.diag(edges))).all():
        return "ITEM: BOX BOUNDS pp pp pp\n" + "".join(
            f"{a} {b}\n" for a, b in zip(origin, high, strict=True)
        )
    xy, xz, yz = edges[[1, 2, 2], [0, 0, 1]]
    low = origin + np.array([min(0, xy, xz, xy + xz), min(0, yz), 0])
    high = high + np.array([max(0, xy, xz, xy + xz), max(0, yz), 0])
    rows = zip(low, high, (xy, xz, yz), strict=True)
    return "ITEM: BOX BOUNDS xy xz yz pp pp pp\n" + "".join(f"{a} {b} {c}\n" for a, b, c in rows)


def read(content: str, name: str = "k.lammpstrj") -> list[VertexFile]:
    return formats.parse(name, content.encode())


def same(curve: VertexFile, components: Sequence[Floats]) -> bool:
    """Whether a curve is the same up to a shift of all of it that is one of whole boxes."""
    pairs = list(zip(curve.components, components, strict=True))
    return all(np.allclose(a - a[0], b - b[0], atol=1e-9) for a, b in pairs)


COLUMNS = ["x y z ix iy iz", "xu yu zu", "xs ys zs ix iy iz", "xsu ysu zsu", "x y z", "xs ys zs"]


@pytest.mark.parametrize("edges", [BOX, TILTED], ids=["orthogonal", "tilted"])
@pytest.mark.parametrize("columns", COLUMNS)
def test_chains_are_unwrapped(columns: str, edges: Floats) -> None:
    (curve,) = read(frame([trefoil()], f"id type {columns}", edges))
    assert same(curve, [trefoil()])
    assert fingerprint(curve.components) == fingerprint([trefoil()])
    assert curve.key == ""


def test_flags_and_unwrapped_coordinates_keep_molecules_together() -> None:
    for columns in COLUMNS[:4]:
        (curve,) = read(frame(hopf(), f"id mol {columns}"))
        assert np.allclose(np.vstack(curve.components), np.vstack(hopf()))


def test_the_user_is_told() -> None:
    (flags,) = read(frame([trefoil()]))
    assert flags.doubts() == ["k.lammpstrj:9: the chains were unwrapped by their image flags"]
    (nearest,) = read(frame([trefoil()], "id x y z"))
    assert "each atom is at its periodic image nearest" in nearest.doubts()[0]
    (nothing,) = read(frame([trefoil()], "id xu yu zu"))
    assert nothing.doubts() == []


def test_frames_are_curves() -> None:
    two = frame([trefoil()], step=0) + frame([trefoil(scale=1.1)], step=5000)
    assert [curve.key for curve in read(two)] == ["0", "5000"]
    assert same(read(two)[1], [trefoil(scale=1.1)])
    assert [curve.key for curve in read(two + frame([trefoil()], step=0))] == ["1", "2", "3"]


def test_empty_lines_between_frames_are_read_over() -> None:
    assert len(read(frame([trefoil()], step=0) + "\n \n" + frame([trefoil()], step=5) + "\n")) == 2


def test_units_and_times_are_read_over() -> None:
    (curve,) = read("ITEM: UNITS\nlj\nITEM: TIME\n0.5\n" + frame([trefoil()]))
    assert same(curve, [trefoil()])


def test_a_box_of_any_edges() -> None:
    origin, edges = np.array([-1.0, -2.0, -3.0]), TILTED
    rows = "".join(f"{a} {b} {c} {o}\n" for (a, b, c), o in zip(edges, origin, strict=True))
    content = frame([trefoil()], "id x y z", edges)
    restricted = bounds(origin, edges)
    (curve,) = read(content.replace(restricted, f"ITEM: BOX BOUNDS abc origin pp pp pp\n{rows}"))
    assert same(curve, [trefoil()])


def test_walls_do_not_wrap() -> None:
    wide = frame([trefoil()], "id xu yu zu").replace("pp pp pp", "ff ff ff").replace("xu yu zu", "x y z")
    (curve,) = read(wide)
    assert same(curve, [trefoil()])
    assert curve.doubts() == []


def test_long_edges_without_a_box_are_edges() -> None:
    sticks = trefoil(7)
    content = frame([sticks], "id xu yu zu")
    (curve,) = read(content)
    assert same(curve, [sticks])
    with pytest.raises(
        FormatError, match=r"k\.lammpstrj:\d+: the step to this atom is about half the periodic"
    ):
        read(content.replace("xu yu zu", "x y z"))


def test_a_ring_round_the_box_is_refused() -> None:
    x = np.linspace(0, SIZE, 30, endpoint=False)
    line = np.column_stack([x, np.sin(2 * np.pi * x / SIZE), np.zeros(30)])
    for columns in COLUMNS:
        with pytest.raises(FormatError, match="the chain winds round the periodic box"):
            read(frame([line], f"id {columns}"))


def test_two_rings_without_molecules_are_refused() -> None:
    for rings in ([hopf(60)[0], hopf(60)[1] + 20], hopf(24), hopf(24)[::-1]):
        with pytest.raises(FormatError, match="if a second chain begins here, give each one its own mol"):
            read(frame(rings, "id xu yu zu"))
        with pytest.raises(FormatError, match="if a second chain begins here, give each one its own mol"):
            read(re.sub(r"(?m)^(\d+) 2 ", r"\1 1 ", frame(rings, "id mol xu yu zu")))
        assert len(read(frame(rings, "id mol xu yu zu"))[0].components) == 2


def test_solvent_is_left_out_and_gaps_are_told() -> None:
    solvent = [np.array([[0.1 * i, 0, 0]]) for i in range(5)]
    (curve,) = read(frame([*hopf(), *solvent], "id mol xu yu zu"))
    assert len(curve.components) == 2
    assert curve.doubts() == ["k.lammpstrj:9: 5 atoms in no chain of three or more were left out"]
    lines = frame([trefoil()], "id xu yu zu").splitlines()
    fewer = [line for line in lines if not line.startswith("17 ")]
    (curve,) = read("\n".join(fewer).replace("\n60\n", "\n59\n"))
    assert curve.doubts() == ["k.lammpstrj:9: the ids of neighbours jump from 16 to 18"]


def test_a_frame_that_is_cut_off_spoils_no_other(tmp_path: Path, sono: Sono) -> None:
    whole = frame([trefoil()], step=0) + frame([trefoil()], step=5)
    for end in (whole.rfind("\n", 0, -9), whole.rfind("ITEM: ATOMS"), whole.rfind("60")):
        (tmp_path / "k.lammpstrj").write_text(whole[:end])
        assert same(formats.read(tmp_path / "k.lammpstrj:0"), [trefoil()])
        with pytest.raises(FormatError, match=r"k\.lammpstrj:\d+: "):
            formats.read(tmp_path / "k.lammpstrj:5")
        result = sono("measure", "k.lammpstrj")
        assert [row.split()[0] for row in result.stdout.splitlines()] == ["knot", "k:0"]
        assert result.exit_code == 1


DUMP = frame([trefoil()], "id mol x y z ix iy iz")


def swapped(old: str, new: str, count: int = 1) -> str:
    assert old in DUMP
    return DUMP.replace(old, new, count)


def rows_of(text: str) -> list[str]:
    return text.splitlines(keepends=True)


MALFORMED = {
    "empty": ("", r":1: .* is no ITEM:"),
    "plain rows": ("0 0 0\n1 0 0\n0 1 0\n", r":1: '0 0 0' is no ITEM:"),
    "rubbish first": (f"x\n{DUMP}", r":1: 'x' is no ITEM:"),
    "no atoms block": (
        DUMP.partition("ITEM: ATOMS")[0],
        r":5: the frame has no ITEM: ATOMS; complete it",
    ),
    "only a time": ("ITEM: TIME\n0\n", r":1: the file holds no block ITEM: ATOMS"),
    "no timestep": (DUMP.partition("0\n")[2], r":7: the frame has no ITEM: TIMESTEP; complete it"),
    "no number": (
        DUMP.replace("ITEM: NUMBER OF ATOMS\n60\n", ""),
        r":7: the frame has no ITEM: NUMBER; complete it",
    ),
    "words as a timestep": (swapped("\n0\n", "\nzero\n"), r":2: 'zero' is no whole number"),
    "words as a number": (swapped("\n60\n", "\nsixty\n"), r":4: 'sixty' is no whole number"),
    "too few rows": ("".join(rows_of(DUMP)[:-5]), r":64: the frame ends here after 55 atoms"),
    "too many rows": (swapped("\n60\n", "\n59\n"), r":69: the frame ends here after 60 atoms"),
    "half a row": (DUMP[:-8], r":69: \d columns, but ITEM: ATOMS names 8"),
    "no id": (swapped("id mol", "tag mol"), r":9: there is no column id"),
    "no coordinates": (swapped("x y z", "a b c"), r":9: there are no columns x y z"),
    "mixed coordinates": (swapped("x y z", "xu y zs"), r":9: there are no columns x y z"),
    "scaled without a box": (
        frame([trefoil()], "id xs ys zs").replace(bounds(np.array([-1.0, -2, -3]), BOX), ""),
        r":5: xs ys zs are scaled by a box",
    ),
    "two bounds": (swapped("-1.0 8.0\n", ""), r":5: the box should have three rows of 2 numbers"),
    "a flat box": (swapped("-1.0 8.0\n", "8.0 -1.0\n"), r":6: the box has no volume"),
    "bounds of words": (swapped("-1.0 8.0\n", "low high\n"), r":6: 'low' is not a finite number"),
    "local dump": (DUMP.replace("ITEM: ATOMS", "ITEM: ENTRIES"), r":9: the dump is one of ENTRIES"),
    "an id twice": (DUMP.replace("\n17 ", "\n18 "), r":\d+: the id 18 stands on line \d+ too"),
    "half an id": (DUMP.replace("\n17 ", "\n17.5 "), r":\d+: '17.5' is no whole number"),
    "not a number": (
        DUMP.replace("\n17 1 ", "\n17 1 x"),
        r":\d+: 'x.*' is not a finite number; a coordinate x",
    ),
    "not finite": ("".join(rows_of(DUMP)[:9]) + "1 1 nan 0 0 0 0 0\n" * 60, r":10: 'nan' is not a finite"),
    "words as flags": ("".join(rows_of(DUMP)[:9]) + "1 1 0 0 0 a b c\n" * 60, r":10: 'a' is not a finite"),
    "words as molecules": (
        "".join(rows_of(DUMP)[:9]) + "1 A 0 0 0 0 0 0\n" * 60,
        r":10: 'A' is not a finite",
    ),
}


@pytest.mark.parametrize("case", MALFORMED)
def test_what_is_wrong_with_a_dump_is_said_in_one_line(case: str) -> None:
    content, message = MALFORMED[case]
    with pytest.raises(FormatError, match=rf"^k\.lammpstrj{message}") as caught:
        read(content)
    assert "\n" not in str(caught.value)


def data(components: Sequence[Floats], *changes: tuple[str, str]) -> str:
    content = formats.WRITERS["lammps"].write(components, ["rings"])
    assert isinstance(content, str)
    for old, new in changes:
        assert old in content
        content = content.replace(old, new)
    return content


coordinates = st.floats(-1e6, 1e6)


@given(
    st.lists(
        st.lists(st.tuples(*[coordinates] * 3), min_size=4, max_size=8, unique=True).map(np.array),
        min_size=1,
        max_size=3,
    )
)
def test_data_keep_every_bit(components: list[Floats]) -> None:
    content = data(components)
    assert formats.READERS["lammps"].recognises(content)
    chains = formats.READERS["lammps"].read(content, "k.data")[0].chains
    assert [np.array(chain.rows).tobytes() for chain in chains] == [part.tobytes() for part in components]
    assert all(chain.closed for chain in chains)


def test_data_and_their_comments(tmp_path: Path) -> None:
    formats.write(tmp_path / "k.data", hopf(), ["a: tight", "second"])
    text = (tmp_path / "k.data").read_text()
    assert text.startswith("# a: tight\n# second\n")
    curve = formats.read(tmp_path / "k.data")
    assert [c.tobytes() for c in curve.components] == [c.tobytes() for c in hopf()]
    assert curve.doubts() == []
    assert curve.comments == ["a: tight", "second"]


def section(rows: Floats, style: str, columns: str, wrap: bool = True) -> str:
    """A data file of a trefoil without bonds, wrapped into a box around zero."""
    images = np.rint(rows / SIZE).astype(int) if wrap else np.zeros(rows.shape, int)
    lines = []
    for i, (row, image) in enumerate(zip(rows, images, strict=True), 1):
        x, y, z = row - SIZE * image
        flags = " ".join(map(str, image))
        lines.append(columns.format(id=i, xyz=f"{x} {y} {z}", flags=flags))
    sides = "".join(f"{-SIZE / 2} {SIZE / 2} {axis}lo {axis}hi\n" for axis in "xyz")
    return f"title\n\n{len(rows)} atoms\n1 atom types\n\n{sides}\nAtoms{style}\n\n" + "\n".join(lines) + "\n"


@pytest.mark.parametrize(
    ("style", "columns"),
    [
        (" # atomic", "{id} 1 {xyz} {flags}"),
        ("  # bond", "{id} 1 1 {xyz} {flags}"),
        (" # molecular", "{id} 1 2 {xyz}"),
        (" # full", "{id} 1 2 0.0 {xyz} {flags}"),
        (" # charge", "{id} 1 -0.5 {xyz}"),
        ("", "{id} 1 {xyz}"),
        ("", "{id} 1 2 {xyz} {flags}"),
        ("", "{id} 1 2 -1.0 {xyz} {flags}"),
    ],
)
def test_styles_of_atoms(style: str, columns: str) -> None:
    (curve,) = read(section(trefoil(), style, columns), "k.data")
    assert same(curve, [trefoil()])
    assert "unwrapped" in curve.doubts()[0]


def test_flags_of_zero_that_cannot_be_right_are_not_believed() -> None:
    content = section(trefoil(), " # bond", "{id} 1 1 {xyz} 0 0 0")
    (curve,) = read(content, "k.data")
    assert same(curve, [trefoil()])
    assert "nearest to the one before" in curve.doubts()[0]


def test_chains_follow_the_bonds() -> None:
    # Ids in any order, as in data that a simulation has written: the ring goes 0, 7, 14, ... in steps of 7.
    rows = trefoil()
    places = 7 * np.arange(60) % 60
    shuffled = np.empty_like(rows)
    shuffled[places] = rows
    content = data([shuffled])
    atoms = content.partition("Bonds\n\n")[0]
    ring = "".join(f"{i + 1} 1 {places[i] + 1} {places[i - 1] + 1}\n" for i in range(60))
    (curve,) = read(f"{atoms}Bonds\n\n{ring}", "k.data")
    assert fingerprint(curve.components) == fingerprint([rows])


def test_open_bonds_are_an_open_chain() -> None:
    content = data([trefoil()], ("60 bonds", "59 bonds"), ("\n60 1 60 1\n", "\n"))
    (raw,) = formats.READERS["lammps"].read(content, "k.data")
    assert [chain.closed for chain in raw.chains] == [False]


DATA = data([trefoil()])
MALFORMED_DATA = {
    "empty": ("", r":1: there is no section Atoms"),
    "plain rows": ("0 0 0\n1 0 0\n0 1 0\n", r":1: there is no section Atoms"),
    "no atoms": (DATA.replace("Atoms # bond", "Velocities"), r":3: 60 atoms are promised, the file has 0"),
    "no rows": ("t\n\nAtoms # bond\n\n", r":3: the section has no rows"),
    "twice": (DATA + DATA, r":\d+: there is a second section Masses; leave one out"),
    "too few": (DATA.replace("60 atoms", "61 atoms"), r":3: 61 atoms are promised, the file has 60"),
    "too few bonds": (DATA.replace("60 bonds", "9 bonds"), r":4: 9 bonds are promised, the file has 60"),
    "cut off": (DATA[: len(DATA) // 2], r":3: 60 atoms are promised, the file has \d+"),
    "cut in bonds": (DATA[:-20], r":4: 60 bonds are promised, the file has 5\d"),
    "half a row": (DATA.replace("\n7 1 1 ", "\n7 1 "), r":\d+: 8 columns, where id, type and x y z should"),
    "half a bond": (DATA.replace("\n7 1 7 8\n", "\n7 1 7\n"), r":\d+: 3 columns, where id, type and two"),
    "unknown style": (DATA.replace("# bond", "# ellipsoid"), r":\d+: atoms of the style 'ellipsoid' are not"),
    "wrong style": (DATA.replace("# bond", "# full"), r":\d+: 9 columns; atoms of style full have 7, or 10"),
    "an id twice": (DATA.replace("\n7 1 1 ", "\n8 1 1 "), r":\d+: the id 8 stands on line \d+ too"),
    "half an id": (DATA.replace("\n7 1 1 ", "\n7.5 1 1 "), r":\d+: '7.5' is no whole number"),
    "not a number": (DATA.replace("\n7 1 1 ", "\n7 1 1 x"), r":\d+: 'x.*' is not a finite number"),
    "infinite": (DATA.replace("\n7 1 1 ", "\n7 1 1 1e999"), r":\d+: '1e999.*' is not a finite number"),
    "a flat box": (re.sub(r"\S+ \S+ ylo", "3 3 ylo", DATA), r":10: the box has no volume"),
    "an endless box": (re.sub(r"\S+ \S+ ylo", "-inf 3 ylo", DATA), r":9: '-inf' is not a finite number"),
    "any edges": (DATA.replace("xlo xhi", "avec"), r":8: a box of any three edges is not read"),
    "a stranger": (
        DATA.replace("\n7 1 7 8\n", "\n7 1 7 99\n"),
        r":\d+: the bond is with an atom that is not",
    ),
    "branches": (
        DATA.replace("\n7 1 7 8\n", "\n7 1 7 9\n"),
        r":\d+: this atom has 3 bonds, but curves do not",
    ),
    "a loop": (DATA.replace("\n7 1 7 8\n", "\n7 1 7 7\n"), r":\d+: this atom has \d bonds"),
}


@pytest.mark.parametrize("case", MALFORMED_DATA)
def test_what_is_wrong_with_data_is_said_in_one_line(case: str) -> None:
    content, message = MALFORMED_DATA[case]
    with pytest.raises(FormatError, match=rf"^k\.data{message}") as caught:
        read(content, "k.data")
    assert "\n" not in str(caught.value)


@pytest.mark.filterwarnings("error")
@pytest.mark.parametrize(("name", "content"), [("k.lammpstrj", DUMP), ("k.data", data(hopf()))])
def test_damaged_files_raise_nothing_else(name: str, content: str) -> None:
    for text in damaged(content, 150):
        with suppress(FormatError):
            read(text, name)
