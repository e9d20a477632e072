"""Chains of atoms along their bonds."""

from collections.abc import Iterator

import numpy as np

from sono.formats.simulated import Atoms, Ints
from sono.formats.vertices import FormatError


def along(bonds: Ints, atoms: Atoms) -> Iterator[tuple[Ints, bool]]:
    """Give the chains along bonds (m, 2) as places of their atoms, and tell which are rings.

    A ring begins at its first atom and goes on to the nearer in the file of the two beside it. Raises
    `FormatError` for an atom with more than two bonds.
    """
    beside = _beside(bonds, atoms)
    seen = [False] * len(beside)
    ends = [place for place, others in enumerate(beside) if len(others) < 2]
    for start in [*ends, *range(len(beside))]:  # rings are left when all chains with ends are gone
        chain, here = [], start
        while here >= 0 and not seen[here]:
            seen[here] = True
            chain.append(here)
            here = min((other for other in beside[here] if not seen[other]), default=-1)
        if chain:
            yield np.array(chain), len(beside[start]) == 2


def _beside(bonds: Ints, atoms: Atoms) -> list[list[int]]:
    """Give the places of the atoms that each atom is bonded to, two at most."""
    beside: list[list[int]] = [[] for _ in atoms.ids]
    for a, b in np.unique(np.sort(bonds, axis=1), axis=0).tolist():
        beside[a].append(b)
        beside[b].append(a)
    for place, others in enumerate(beside):
        if len(others) > 2 or place in others:
            raise FormatError.at(
                atoms.name,
                int(atoms.lines[place]),
                f"atom {atoms.ids[place]} has {len(others)} bonds, but curves do not branch; leave some out",
            )
    return beside
