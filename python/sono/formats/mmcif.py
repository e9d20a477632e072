"""mmCIF files: the atoms of structures of the Protein Data Bank and of predicted ones, read by gemmi.

What of them becomes a curve is said in `molecules`. Chains and residues go by the names that the authors gave
them, as in PDB files. Source: wwPDB, "PDBx/mmCIF Dictionary", categories `atom_site` and `struct_conn`.
"""

import re
from collections.abc import Iterator, Mapping, Sequence
from typing import Any

from sono.formats.molecules import Atom, Bonds, Model, curves
from sono.formats.vertices import FormatError, Raw, place

Site = tuple[str, str, str]
"""The chain, the residue's number and the name of an atom."""

Table = Mapping[str, list[str]]
"""A category: the values of every item, all of the same length; what is unknown or left out is empty."""

ATOM = [
    ("pdbx_PDB_model_num",),
    ("group_PDB",),
    ("label_atom_id", "auth_atom_id"),
    ("label_alt_id",),
    ("label_comp_id", "auth_comp_id"),
    ("auth_asym_id", "label_asym_id"),
    ("label_asym_id",),
    ("auth_seq_id", "label_seq_id"),
    ("pdbx_PDB_ins_code",),
    ("Cartn_x",),
    ("Cartn_y",),
    ("Cartn_z",),
]
"""The items of an atom that are read: for each the first of these names that the file has."""


CURE = "give a second chain another auth_asym_id"
"""How this format tells chains apart."""


def recognises(text: str) -> bool:
    """Tell whether the first word that is not in a comment begins a block of data."""
    return re.match(r"(?:\s|#[^\n]*\n)*data_", text, re.IGNORECASE) is not None


def read(text: str, name: str) -> list[Raw]:
    """Parse a whole file; lengths keep its unit. Raises `FormatError`."""
    table, bonds, line = _tables(text, name)
    if not all(f"Cartn_{axis}" in table for axis in "xyz"):
        raise FormatError.at(
            name, 1, "there are no _atom_site.Cartn_x, y and z; only mmCIF with these is read"
        )
    models: dict[str, list[Atom]] = {}
    parts: dict[str, int] = {}
    for number, row in enumerate(zip(*(_column(table, *items) for items in ATOM), strict=True), line):
        model, group, atom, other, residue, chain, part, at, inserted, *cells = row
        xyz = place(cells, name, number, "here")
        part_number = parts.setdefault(part, len(parts))
        models.setdefault(model or "1", []).append(
            Atom(group == "HETATM", atom, other, residue, chain, part_number, at + inserted, xyz, number)
        )
    links = list(_links(bonds))
    return curves([Model(key, atoms, _bonds(links, atoms), cure=CURE) for key, atoms in models.items()], name)


def _tables(text: str, name: str) -> tuple[Table, Table, int]:
    """Give the atoms and bonds of the first block that has atoms, and the line of its first atom."""
    try:
        from gemmi import cif
    except ImportError:
        raise FormatError(f"{name}: mmCIF files are read by gemmi; pip install 'sono[molecules]'") from None
    try:
        document = cif.read_string(text)
        for block in document:
            for item in block:
                if item.loop and item.loop.length() and "_atom_site.Cartn_x" in item.loop.tags:
                    first = item.line_number + len(item.loop.tags) + 1  # gemmi tells where the loop begins
                    return _table(block, "_atom_site."), _table(block, "_struct_conn."), first
    except (ValueError, RuntimeError) as error:
        where = re.match(r"string:(\d+)", str(error))
        what = str(error).splitlines()[0].partition(" ")[2]
        raise FormatError.at(
            name, int(where[1]) if where else 1, f"this is no CIF: {what}; correct it"
        ) from None
    raise FormatError.at(name, 1, "there is no loop of _atom_site.Cartn_x with atoms in it; give mmCIF")


def _table(block: Any, category: str) -> Table:
    # gemmi gives None for "?" and False for ".".
    found = block.get_mmcif_category(category)
    return {item: [value or "" for value in values] for item, values in found.items()}


def _column(table: Table, *items: str) -> list[str]:
    """Give the first of these columns that there is, or else nothing for every row."""
    rows = len(next(iter(table.values()), []))
    return next((table[item] for item in items if item in table), [""] * rows)


def _links(table: Table) -> Iterator[list[Site]]:
    """Give the two ends of each covalent bond that the file lists."""
    ends = [
        [
            _column(table, f"ptnr{i}_auth_asym_id", f"ptnr{i}_label_asym_id"),
            _column(table, f"ptnr{i}_auth_seq_id", f"ptnr{i}_label_seq_id"),
            _column(table, f"pdbx_ptnr{i}_PDB_ins_code"),
            _column(table, f"ptnr{i}_label_atom_id"),
        ]
        for i in (1, 2)
    ]
    for kind, *both in zip(
        _column(table, "conn_type_id"), *(zip(*end, strict=True) for end in ends), strict=True
    ):
        if kind.startswith("coval"):
            yield [(chain, at + inserted, atom) for chain, at, inserted, atom in both]


def _bonds(links: Sequence[Sequence[Site]], atoms: list[Atom]) -> Bonds:
    places = {(atom.chain, atom.number, atom.name): place for place, atom in reversed(list(enumerate(atoms)))}
    return {frozenset(map(places.__getitem__, ends)) for ends in links if all(end in places for end in ends)}
