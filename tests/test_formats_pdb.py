"""PDB files: which atoms become a curve, which chains are closed, and what is refused."""

from collections.abc import Iterator, Sequence
from contextlib import suppress

import numpy as np
import pytest
from knots import Floats, damaged, hopf, trefoil

from sono import formats
from sono.formats import FormatError, VertexFile
from sono.formats.boxes import Box
from sono.formats.pdb import hybrid36
from sono.formats.vertices import Raw
from sono.invariants import fingerprint


def atom(
    serial: int, place: Sequence[float], name: str = "CA", residue: str = "ALA", chain: str = "A", **more: str
) -> str:
    """A row of a PDB file."""
    record, other, at = more.get("record", "ATOM"), more.get("other", " "), more.get("at", str(serial))
    at = at if at[-1].isalpha() else f"{at} "
    x, y, z = place
    called = f" {name}" if len(name) < 4 else name
    return (
        f"{record:<6}{serial:>5} {called:<4}{other}{residue:>3} {chain}{at:>5}   "
        f"{x:8.3f}{y:8.3f}{z:8.3f}  1.00  0.00           {name[0]}\n"
    )


def trace(rows: Floats, first: int = 1, **more: str) -> str:
    return "".join(atom(first + i, row.tolist(), **more) for i, row in enumerate(rows))


def full(rows: Floats, chain: str = "A", first: int = 1) -> str:
    """Residues of four atoms each, of which a chain goes through the second."""
    text = ""
    for i, row in enumerate(rows):
        for k, (name, shift) in enumerate([("N", -0.9), ("CA", 0.0), ("C", 0.8), ("O", 1.9)]):
            text += atom(first + 4 * i + k, (row + shift / 3).tolist(), name, chain=chain, at=str(i + 1))
    return text


def raws(content: str) -> Sequence[Raw]:
    return formats.READERS["pdb"].read(content, "k.pdb")


def read(content: str) -> list[VertexFile]:
    return formats.parse("k.pdb", content.encode())


def close(found: VertexFile, components: Sequence[Floats]) -> bool:
    pairs = zip(found.components, components, strict=True)
    return all(a.shape == b.shape and np.allclose(a, b, atol=6e-4) for a, b in pairs)


SIZE = 2.6
"""Scales the trefoil so that its edges are nearly as long as those of proteins."""
KNOT = trefoil(60, SIZE)
OPEN = KNOT[:45]


def test_a_trace_whose_ends_are_neighbours_is_closed() -> None:
    (curve,) = read(trace(KNOT) + "END\n")
    assert close(curve, [KNOT])
    assert curve.doubts() == [
        "k.pdb:1: chain A is closed, as its ends are as near as neighbours; no bond says so"
    ]
    assert [chain.closed for chain in raws(trace(OPEN))[0].chains] == [False]


@pytest.mark.parametrize("bond", ["CONECT   45    1\n", "CONECT    1   45\n", "CONECT    1    2   45\n"])
def test_conect_closes(bond: str) -> None:
    (raw,) = raws(trace(OPEN) + bond)
    assert [chain.closed for chain in raw.chains] == [True]
    assert raw.notes == []


def link(one: tuple[str, str, int], other: tuple[str, str, int]) -> str:
    ends = [f"{name:<3} ALA {chain}{number:>4}" for name, chain, number in (one, other)]
    return f"LINK         {ends[0]}                 {ends[1]}     1555   1555  1.33\n"


def shuffled(name: str, components: Sequence[Floats], skip: Sequence[int] = ()) -> str:
    """Atoms in any order, and bonds that tell their order; those after some atoms are left out."""
    rows = np.vstack(components)
    serials = np.random.default_rng(1).permutation(len(rows)) + 1
    text = "".join(atom(k, rows[i].tolist(), name) for k, i in sorted(zip(serials, range(999), strict=False)))
    for ring in np.split(serials, np.cumsum([len(part) for part in components])[:-1]):
        bonds = enumerate(zip(ring, np.roll(ring, -1), strict=True))
        text += "".join(f"CONECT{a:>5}{b:>5}\n" for i, (a, b) in bonds if i not in skip)
    return text


@pytest.mark.parametrize("name", ["B", "CA"])
@pytest.mark.parametrize("components", [[KNOT], hopf()], ids=["a knot", "a link"])
def test_beads_follow_their_bonds(name: str, components: Sequence[Floats]) -> None:
    (curve,) = read(shuffled(name, components) + atom(200, [90.0, 0, 0], name))
    assert fingerprint(curve.components) == fingerprint(components)
    assert sorted(map(len, curve.components)) == sorted(map(len, components))
    assert any("follows the bonds, which join its atoms in another order" in note for note in curve.doubts())


def test_bonds_that_leave_a_chain_open_do_so_in_any_order() -> None:
    with pytest.raises(FormatError, match=r"the chain is open"):
        read(shuffled("B", [KNOT], skip=[7]))
    assert formats.parse("k.pdb", shuffled("B", [KNOT], skip=[7]).encode(), "direct")


def test_bonds_that_tell_no_chain() -> None:
    cross = "CONECT    5   20\n"
    with pytest.raises(
        FormatError, match=r"^k\.pdb:5: a bond of this atom is not with a neighbour, and most"
    ):
        read(trace(KNOT, name="B") + cross)
    bonds = "".join(f"CONECT{i:>5}{i + 1:>5}\n" for i in range(1, 60))
    with pytest.raises(FormatError, match=r"^k\.pdb:5: this atom has 3 bonds, but curves do not branch"):
        read(trace(KNOT, name="B") + bonds + cross)


def test_links_across_residues_change_no_order() -> None:
    cross = "CONECT    5   20\nCONECT    9   40\n"
    bonds = "".join(f"CONECT{i:>5}{i % 60 + 1:>5}\n" for i in range(1, 61))
    for more in ("", bonds):
        (curve,) = read(trace(KNOT) + more + cross)
        assert close(curve, [KNOT])


def test_a_ring_of_two_chains_is_one() -> None:
    halves = trace(KNOT[:30], name="B") + "TER\n" + trace(KNOT[30:], 31, name="B", chain="B")
    (curve,) = read(halves + "".join(f"CONECT{i:>5}{i % 60 + 1:>5}\n" for i in range(1, 61)))
    assert close(curve, [KNOT])


def test_link_closes_a_backbone_but_no_side_chain() -> None:
    ring = full(OPEN)
    (raw,) = raws(link(("N", "A", 1), ("C", "A", 45)) + ring)
    assert [chain.closed for chain in raw.chains] == [True]
    (raw,) = raws(link(("SG", "A", 1), ("SG", "A", 45)) + ring)
    assert [chain.closed for chain in raw.chains] == [False]
    (raw,) = raws(ring + f"CONECT{1:>5}{4 * 44 + 3:>5}\n")
    assert [chain.closed for chain in raw.chains] == [True]


def test_closed_chains_are_a_link_and_open_ones_curves() -> None:
    two = trace(hopf()[0]) + "TER\n" + trace(hopf()[1], 30, chain="B")
    (curve,) = read(two)
    assert close(curve, hopf())
    assert curve.key == ""
    found = raws(trace(OPEN) + "TER\n" + trace(KNOT + 50, 100, chain="B"))
    assert [(raw.key, [chain.closed for chain in raw.chains]) for raw in found] == [
        ("A", [False]),
        ("B", [True]),
    ]


def test_a_chain_that_is_wrong_spoils_no_other() -> None:
    stray = atom(120, [0.0, 0, 90], chain="B") + atom(121, [0.0, 0, 0], chain="B")
    good, bad = raws(trace(OPEN) + "TER\n" + trace(KNOT[:20] + 50, 100, chain="B") + stray)
    assert len(VertexFile.checked("k.pdb", good, "direct").components) == 1
    with pytest.raises(FormatError, match=r"^k\.pdb:67: an edge of "):
        VertexFile.checked("k.pdb", bad, "direct")
    # But a ring does not come without the other ring that it may be linked with.
    stray_atom = KNOT + 500 * (np.arange(60) == 30)[:, None]
    with pytest.raises(FormatError, match=r"^k\.pdb:92: an edge of "):
        read(trace(KNOT) + "TER\n" + trace(stray_atom, 100, chain="B"))


def models(*contents: str) -> str:
    return "".join(f"MODEL {i:>8}\n{content}ENDMDL\n" for i, content in enumerate(contents, 1)) + "END\n"


def test_models_are_curves() -> None:
    found = read(models(trace(KNOT), trace(2 * KNOT)))
    assert [curve.key for curve in found] == ["1", "2"]
    assert close(found[1], [2 * KNOT])
    two = trace(OPEN) + "TER\n" + trace(OPEN + 50, 100, chain="B")
    assert [raw.key for raw in raws(models(two, two))] == ["1:A", "1:B", "2:A", "2:B"]


@pytest.mark.parametrize("place", [0, 1, 2])
@pytest.mark.parametrize("rows", [KNOT, OPEN], ids=["closed", "open"])
def test_a_model_that_is_wrong_spoils_no_other(place: int, rows: Floats) -> None:
    contents = [trace(rows)] * 3
    contents[place] = contents[place].replace("ALA A   7 ", "ALA A  left", 1).replace(".", "", 1)
    found = raws(models(*contents))
    for number, raw in enumerate(found):
        if number != place:
            assert close(VertexFile.checked("k.pdb", raw, "direct"), [rows]) or rows is OPEN
    with pytest.raises(FormatError, match=r"^k\.pdb:\d+: there are no x y z with decimals"):
        VertexFile.checked("k.pdb", found[place], "direct")


def test_segments_are_chains_where_these_have_no_ids() -> None:
    rows = [row.rstrip("\n")[:66].ljust(72) for row in trace(OPEN, chain=" ").splitlines()]
    content = "".join(f"{row}{segment}\n" for segment in ("PROA", "PROB") for row in rows)
    assert [raw.key for raw in raws(content)] == ["PROA", "PROB"]


def test_chains_without_ids_are_numbered() -> None:
    assert [raw.key for raw in raws(trace(OPEN, chain=" ") + "TER\n" + trace(OPEN, chain=" "))] == ["1", "2"]


def test_the_backbone_of_a_protein() -> None:
    # A first residue of selenomethionine, other places, inserted residues, waters, an ion and a ligand.
    rows = KNOT.tolist()
    text = atom(1, rows[0], residue="MSE", record="HETATM")
    text += atom(2, rows[1], other="A") + atom(2, np.add(rows[1], 0.5), other="B")
    text += "".join(atom(i + 1, rows[i], at=f"2{chr(63 + i)}") for i in range(2, 10))
    text += trace(KNOT[10:], 11) + "TER\n"
    text += atom(90, [50.0, 0, 0], "CA", "CA", record="HETATM") + atom(
        91, [60.0, 0, 0], "O", "HOH", record="HETATM"
    )
    text += trace(KNOT[:5] + 40, 92, name="CA", residue="LIG", record="HETATM")
    (curve,) = read(text)
    assert close(curve, [KNOT])
    (all_atoms,) = read(full(KNOT))
    assert close(all_atoms, [KNOT])
    assert all_atoms.doubts()[0] == "k.pdb:2: chain A goes through the atoms CA"


def test_nucleic_acids_and_beads() -> None:
    (curve,) = read(trace(KNOT, name="P", residue="DA"))
    assert close(curve, [KNOT])
    (curve,) = read(trace(KNOT, name="C", residue="MOL", record="HETATM", at="1"))
    assert close(curve, [KNOT])
    assert "goes through all its atoms, as none is called CA or P" in curve.doubts()[0]


def test_missing_residues_are_named() -> None:
    rows = np.delete(KNOT, range(20, 24), axis=0)
    numbers = [i + 1 for i in range(60) if not 20 <= i < 24]
    text = "".join(atom(n, row.tolist()) for n, row in zip(numbers, rows, strict=True))
    (curve,) = read(text)
    assert "chain A goes straight where residues seem to be missing: 21 to 24" in curve.doubts()[-1]


def test_a_second_chain_in_disguise_is_refused() -> None:
    with pytest.raises(
        FormatError, match=r"^k\.pdb:61: an edge of [\d.]+ times the median one leads here, from line 60"
    ):
        read(trace(KNOT) + trace(KNOT + 90))
    beads = trace(KNOT, name="C") + trace(KNOT + 5, 61, name="C")
    bonds = "".join(f"CONECT{i:>5}{i + 1 if i % 60 else i - 59:>5}\n" for i in range(1, 121))
    assert len(read(beads + bonds)[0].components) == 2
    bonds = "".join(f"CONECT{i:>5}{i + 1:>5}\n" for i in range(1, 120) if i != 60)
    with pytest.raises(FormatError, match=r"^k\.pdb:61: no CONECT joins this atom, from line 60; put TER"):
        read(beads + bonds)
    bonds += "".join(f"CONECT{i:>5}{i - 59:>5}\n" for i in (60, 120))
    assert (
        len(read(trace(KNOT, name="C") + "TER\n" + trace(KNOT + 5, 61, name="C") + bonds)[0].components) == 2
    )


def test_rings_side_by_side_in_one_chain_are_refused() -> None:
    for name in ("CA", "C"):
        two = trace(hopf()[0], name=name) + trace(hopf()[1], 25, name=name)
        with pytest.raises(
            FormatError, match=r"^k\.pdb:25: an edge of [\d.]+ times the median one leads here"
        ):
            read(two)
    again = trace(KNOT[:20]) + trace(KNOT[21:50])
    with pytest.raises(
        FormatError, match=r"^k\.pdb:21: the numbers of residues start again here, from line 20"
    ):
        read(again)


@pytest.mark.parametrize("end", ["END\n", "ENDMDL\n"])
def test_frames_that_are_only_ended_are_models(end: str) -> None:
    found = read((trace(KNOT) + end) * 3)
    assert [curve.key for curve in found] == ["1", "2", "3"]
    assert all(close(curve, [KNOT]) for curve in found)


def test_bonds_that_are_all_there_leave_open_what_they_do_not_close() -> None:
    bonds = "".join(f"CONECT{i:>5}{i + 1:>5}\n" for i in range(1, 60))
    assert [chain.closed for chain in raws(trace(KNOT, name="C") + bonds)[0].chains] == [False]


def test_rows_of_words_are_read() -> None:
    # As some programs write them, with no thought of columns.
    for row in (
        "ATOM {i} CA ALA A {i} {x:.5f} {y:.5f} {z:.5f} 1.00 0.00",
        "ATOM {i} C MOL {i} {x:.2f} {y:.2f} {z:.2f}",
    ):
        lines = [row.format(i=i, x=x, y=y, z=z) for i, (x, y, z) in enumerate(KNOT.tolist(), 1)]
        (curve,) = read("\n".join(lines))
        assert np.allclose(curve.components[0], KNOT, atol=6e-3)


def written(components: Sequence[Floats], comments: Sequence[str] = ()) -> str:
    content = formats.WRITERS["pdb"].write(components, comments)
    assert isinstance(content, str)
    return content


def test_what_is_written_is_read() -> None:
    for components in ([KNOT], hopf(), [part + np.array([900, -900, 0]) for part in hopf()], [1000 + KNOT]):
        content = written(components, ["a: tight", "b"])
        (curve,) = read(content)
        assert close(curve, components)
        assert fingerprint(curve.components) == fingerprint(components)
        assert curve.doubts() == []
        assert curve.comments == ["a: tight", "b"]
        assert content.startswith("REMARK 999 a: tight\nREMARK 999 b\nATOM      1  CA  GLY A   1 ")
        assert {len(line) for line in content.splitlines() if line.startswith("ATOM")} == {78}


def test_a_corner_does_not_close_without_its_bond() -> None:
    stick = np.array([[0.0, 0, 0], [9, 0, 0], [9, 9, 0], [0, 200, 0]])
    (curve,) = read(written([stick]))
    assert close(curve, [stick])


@pytest.mark.parametrize(
    ("n", "row"),
    [
        (10_001, "ATOM  10000  CA  GLY AA000 "),
        pytest.param(100_001, "ATOM  A0000  CA  GLY A", marks=pytest.mark.slow),
    ],
)
def test_long_curves_are_written_in_hybrid_36(n: int, row: str) -> None:
    t = 2 * np.pi * np.arange(n) / n
    circle = 900 * np.column_stack([np.cos(t), np.sin(t), np.zeros_like(t)])
    content = written([circle])
    assert row in content
    (curve,) = read(content)
    assert close(curve, [circle])


def test_hybrid_36_counts_up_without_a_gap() -> None:
    edges = [9_999, 10_000, 10_000 + 26 * 36**3 - 1, 10_000 + 26 * 36**3]
    assert [hybrid36(value, 4) for value in edges] == ["9999", "A000", "ZZZZ", "a000"]


@pytest.mark.parametrize(
    ("components", "message"),
    [
        ([KNOT + 9990], "coordinates from -999.999 to 9999.999 fit into a PDB file"),
        ([KNOT - 1000], "coordinates from -999.999 to 9999.999 fit into a PDB file"),
        ([KNOT * 1e-3], "the three decimals of a PDB file are too few for so thin a curve"),
        ([KNOT, KNOT], "the three decimals of a PDB file are too few for so thin a curve"),
        ([KNOT + 30 * i for i in range(63)], "a PDB file has ids for 62 chains, not for 63"),
    ],
)
def test_what_does_not_fit_is_not_written(components: Sequence[Floats], message: str) -> None:
    with pytest.raises(FormatError, match=message):
        written(components)


@pytest.mark.parametrize("name", ["B", "CA"])
@pytest.mark.parametrize("angles", [(90.0, 90.0, 90.0), (80.0, 95.0, 100.0)])
def test_a_unit_cell_unwraps_what_it_has_wrapped(name: str, angles: tuple[float, ...]) -> None:
    side = 1.5 * float(np.ptp(KNOT, axis=0).max())
    box = Box.of_angles(np.full(3, side), np.array(angles))
    cell = "CRYST1" + f"{side:9.3f}" * 3 + "".join(f"{angle:7.2f}" for angle in angles) + " P 1           1\n"
    scaled = KNOT @ np.linalg.inv(box.edges)
    (curve,) = read(cell + trace(box.at(scaled - np.floor(scaled)), name=name))
    (part,) = curve.components
    assert np.allclose(part - part[0], KNOT - KNOT[0], atol=0.02)
    assert any("the chains were unwrapped" in note for note in curve.doubts())
    (curve,) = read(cell + trace(KNOT, name=name))
    assert close(curve, [KNOT])


def test_a_ring_round_the_cell_is_refused_but_no_chain_that_touches_its_image() -> None:
    rows = np.column_stack([np.arange(20) * 3.8, 3 * np.sin(np.arange(20) * np.pi / 10), np.zeros(20)])
    text = "CRYST1   76.000   76.000   76.000  90.00  90.00  90.00 P 1\n" + trace(rows)
    assert [chain.closed for chain in raws(text)[0].chains] == [False]
    with pytest.raises(FormatError, match=r"^k\.pdb:21: the chain winds round the periodic box"):
        read(text + "CONECT    1   20\n")


@pytest.mark.parametrize("sides", ["    1.000" * 3, "    0.000" * 3, "    8.000" * 3, "", "     left" * 3])
def test_a_cell_that_is_none_changes_nothing(sides: str) -> None:
    (curve,) = read(f"CRYST1{sides}  90.00  90.00  90.00 P 1\n" + trace(KNOT))
    assert close(curve, [KNOT])


TRACE = trace(KNOT) + "END\n"
LINES = TRACE.splitlines(keepends=True)


def changed(row: int, start: int, text: str) -> str:
    line = LINES[row]
    return "".join([*LINES[:row], line[:start] + text + line[start + len(text) :], *LINES[row + 1 :]])


def malformed() -> Iterator[tuple[str, str, str]]:
    coordinates = "there are no x y z with decimals in the columns 31 to 54; correct the row"
    yield "empty", "", ":1: the file holds no ATOM or HETATM"
    yield "no atoms", "HEADER    A TREFOIL\nEND\n", ":1: the file holds no ATOM or HETATM"
    yield "plain rows", "0 0 0\n1 0 0\n0 1 0\n", ":1: the file holds no ATOM or HETATM"
    yield "lower case", TRACE.lower(), ":1: the file holds no ATOM or HETATM"
    yield "empty models", models("", ""), ":1: the file holds no ATOM or HETATM"
    yield "a word", changed(4, 30, "    left"), f":5: {coordinates}"
    yield "stars", changed(4, 38, "********"), f":5: {coordinates}"
    yield "blank", changed(4, 46, "        "), f":5: {coordinates}"
    yield "two points", changed(4, 30, " 1.000.0"), f":5: {coordinates}"
    yield "a point alone", changed(4, 30, "       ."), ":5: '. .* are not three finite numbers; correct x y z"
    yield "whole numbers", "ATOM 1 CA ALA A 1 0 0 0\n", f":1: {coordinates}"
    yield "two coordinates", "ATOM 1 CA ALA A 1 0.0 1.0\n", f":1: {coordinates}"
    yield "cut off", "".join(LINES[:40]) + LINES[40][:36], f":41: {coordinates}"
    yield "cut in a name", "".join(LINES[:40]) + "ATOM", f":41: {coordinates}"
    yield "not finite", changed(4, 30, "     nan"), ":5: .* are not three finite numbers"
    yield "infinite", changed(4, 30, "     inf"), ":5: .* are not three finite numbers"
    yield (
        "an atom twice",
        "".join([*LINES[:9], LINES[8], *LINES[9:]]),
        ":10: this vertex equals its neighbour",
    )
    yield "two atoms", "".join(LINES[:2]), ":1: .* too few vertices: 2"
    yield "water", atom(1, [0, 0, 0], "O", "HOH", record="HETATM"), ":1: .* too few vertices: 1"
    yield "a stray atom", changed(30, 30, "9000.000"), r":3\d: an edge of [\d.]+ times the median one"
    yield "wrapped", changed(30, 30, "-900.000"), r":3\d: an edge of [\d.]+ times the median one"


@pytest.mark.parametrize(("content", "message"), [pytest.param(b, c, id=a) for a, b, c in malformed()])
def test_what_is_wrong_is_said_in_one_line(content: str, message: str) -> None:
    with pytest.raises(FormatError, match=rf"^k\.pdb{message}") as caught:
        read(content)
    assert "\n" not in str(caught.value)


@pytest.mark.filterwarnings("error")
@pytest.mark.parametrize("content", [TRACE, written(hopf()), models(full(KNOT[:20]), full(KNOT[:20]))])
def test_damaged_files_raise_nothing_else(content: str) -> None:
    for text in damaged(content, 150):
        with suppress(FormatError):
            read(text)
