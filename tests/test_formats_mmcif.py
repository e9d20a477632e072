"""mmCIF files, read by gemmi: as PDB files are."""

import sys
from collections.abc import Iterator, Sequence
from contextlib import suppress

import numpy as np
import pytest
from knots import Floats, damaged, hopf, trefoil

from sono import formats
from sono.formats import FormatError, VertexFile
from sono.formats.vertices import Raw

pytest.importorskip("gemmi")

KNOT = trefoil(60, 2.6)
OPEN = KNOT[:56]

ITEMS = [
    *("group_PDB", "id", "type_symbol", "label_atom_id", "label_alt_id", "label_comp_id", "label_asym_id"),
    *("label_entity_id", "label_seq_id", "pdbx_PDB_ins_code", "Cartn_x", "Cartn_y", "Cartn_z", "occupancy"),
    *("auth_seq_id", "auth_asym_id", "pdbx_PDB_model_num"),
]


def rows(places: Floats, name: str = "CA", chain: str = "A", first: int = 1, **more: str) -> str:
    group, residue, part = more.get("group", "ATOM"), more.get("residue", "GLY"), more.get("part", chain)
    model = more.get("model", "1")
    return "".join(
        f"{group} {i} C {name} . {residue} {part} 1 {i} ? {x:.3f} {y:.3f} {z:.3f} 1.00 {i} {chain} {model}\n"
        for i, (x, y, z) in enumerate(places.tolist(), first)
    )


def file(*loops: str, links: str = "") -> str:
    items = "".join(f"_atom_site.{item}\n" for item in ITEMS)
    return f"data_KNOT\n#\n_entry.id KNOT\n#\n{links}loop_\n{items}{''.join(loops)}#\n"


def raws(content: str) -> Sequence[Raw]:
    return formats.READERS["mmcif"].read(content, "k.cif")


def read(content: str) -> list[VertexFile]:
    return formats.parse("k.cif", content.encode())


def close(found: VertexFile, components: Sequence[Floats]) -> bool:
    pairs = zip(found.components, components, strict=True)
    return all(a.shape == b.shape and np.allclose(a, b, atol=6e-4) for a, b in pairs)


def test_atoms_and_their_lines() -> None:
    (curve,) = read(file(rows(KNOT)))
    assert close(curve, [KNOT])
    lines = file(rows(KNOT)).splitlines()
    assert lines[int(curve.where(0, 7).partition(":")[2]) - 1].startswith("ATOM 8 C CA")


def test_chains_and_models_are_as_in_pdb_files() -> None:
    (curve,) = read(file(rows(hopf()[0]), rows(hopf()[1], chain="B")))
    assert close(curve, hopf())
    found = raws(file(rows(OPEN), rows(KNOT + 50, chain="B")))
    assert [(raw.key, raw.chains[0].closed) for raw in found] == [("A", False), ("B", True)]
    assert [raw.key for raw in raws(file(rows(OPEN), rows(OPEN, model="2")))] == ["1:A", "2:A"]


def test_water_and_ions_of_a_chain_are_no_part_of_it() -> None:
    water = rows(KNOT[:4] + 9, "O", group="HETATM", residue="HOH", part="C")
    ion = rows(KNOT[:1] + 9, "CA", group="HETATM", residue="CA", part="D")
    (curve,) = read(file(rows(KNOT), ion, water))
    assert close(curve, [KNOT])


def bond(kind: str, one: str, other: str) -> str:
    items = ["id", "conn_type_id", "ptnr1_auth_asym_id", "ptnr1_auth_seq_id", "ptnr1_label_atom_id"]
    items += [item.replace("ptnr1", "ptnr2") for item in items[2:]]
    return (
        "loop_\n" + "".join(f"_struct_conn.{item}\n" for item in items) + f"1 {kind} A {one} A {other}\n#\n"
    )


def test_a_covalent_bond_closes() -> None:
    protein = rows(OPEN) + rows(OPEN[:1] - 0.9, "N") + rows(OPEN[-1:] + 0.9, "C", first=56)
    for kind, name, closed in (("covale", "N", True), ("disulf", "N", False), ("covale", "SG", False)):
        (raw,) = raws(file(protein, links=bond(kind, f"1 {name}", "56 C")))
        assert raw.chains[0].closed == closed, kind


def test_quoted_names_are_read() -> None:
    (curve,) = read(file(rows(KNOT, "'CA'")))
    assert close(curve, [KNOT])


def test_without_gemmi_the_extra_is_named(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "gemmi", None)
    with pytest.raises(
        FormatError, match=r"^k\.cif: mmCIF files are read by gemmi; pip install 'sono\[molecules\]'"
    ):
        read(file(rows(KNOT)))


FILE = file(rows(KNOT))


def malformed() -> Iterator[tuple[str, str, str]]:
    no_atoms = ":1: there is no loop of _atom_site.Cartn_x with atoms in it"
    yield "empty", "", no_atoms
    yield "no atoms", "data_x\n_entry.id x\n", no_atoms
    yield "an empty loop", file(), no_atoms
    yield "a small molecule", FILE.replace("_atom_site.Cartn_", "_atom_site_fract_"), no_atoms
    yield "one atom, no loop", "data_x\n_atom_site.Cartn_x 1.0\n", no_atoms
    yield "no z", FILE.replace("Cartn_z", "depth"), ":1: there are no _atom_site.Cartn_x, y and z"
    yield "plain rows", "0 0 0\n1 0 0\n", ":1: this is no CIF: "
    yield "PDB", "ATOM      1  CA  GLY\n", ":1: this is no CIF: "
    yield "words first", f"knot\n{FILE}", ":1: this is no CIF: "
    yield "a loop without tags", FILE.replace("loop_\n", "loop_\nATOM\n"), r":\d+: this is no CIF: "
    yield (
        "a row is short",
        FILE.replace(" 1.00 8 A 1\n", " 1.00 8\n"),
        r":\d+: this is no CIF: .*number of values",
    )
    yield "a row is long", FILE.replace(" 1.00 8 A 1\n", " 1.00 8 A 1 1\n"), r":\d+: this is no CIF: "
    yield "cut off", FILE[: len(FILE) - 40], r":\d+: this is no CIF: "
    yield "an open quote", FILE.replace("_entry.id KNOT", "_entry.id 'KNOT"), ":3: this is no CIF: "
    yield "an open text", FILE.replace("_entry.id KNOT", "_entry.id\n;KNOT"), r":\d+: this is no CIF: "
    yield (
        "twice",
        FILE.replace("_atom_site.id", "_atom_site.Cartn_x"),
        r":\d+: this is no CIF: .*duplicate tag",
    )
    yield (
        "an entry twice",
        FILE.replace("_entry.id K\n", "_entry.id K\n_entry.id K\n", 1) + FILE,
        r":\d+: this is no",
    )
    yield "a word", FILE.replace("15.600", "left"), ":23: 'left .*' are no three numbers; x y z should"
    yield "unknown", FILE.replace("15.600", "?"), ":23: ' .*' are no three numbers; x y z should"
    yield "not finite", FILE.replace("15.600", "nan"), ":23: a coordinate is not finite"
    yield "two atoms", file(rows(KNOT[:2])), ":23: .* too few vertices: 2"
    yield "a stray atom", FILE.replace("15.600", "1560.0"), r":\d+: an edge of "


@pytest.mark.parametrize(("content", "message"), [pytest.param(b, c, id=a) for a, b, c in malformed()])
def test_what_is_wrong_is_said_in_one_line(content: str, message: str) -> None:
    with pytest.raises(FormatError, match=rf"^k\.cif{message}") as caught:
        read(content)
    assert "\n" not in str(caught.value)


@pytest.mark.filterwarnings("error")
def test_damaged_files_raise_nothing_else() -> None:
    for text in damaged(FILE):
        with suppress(FormatError):
            read(text)
