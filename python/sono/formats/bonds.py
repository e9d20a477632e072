"""Chains of atoms along their bonds."""

from collections import Counter
from collections.abc import Iterator, Sequence
from itertools import chain, pairwise

import numpy as np

from sono.formats.simulated import Ints
from sono.formats.vertices import FormatError

Pairs = set[frozenset[int]]


def along(bonds: Ints, name: str, lines: Sequence[int] | Ints) -> Iterator[tuple[Ints, bool]]:
    """Give the chains along bonds (m, 2) as places of their atoms, and tell which are rings.

    A ring begins at its first atom and goes on to the nearer in the file of the two beside it. The atoms
    stand on the `lines` (n,) of the file `name`. Raises `FormatError` for an atom with more than two bonds.
    """
    beside = _beside(bonds, name, lines)
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


def _beside(bonds: Ints, name: str, lines: Sequence[int] | Ints) -> list[list[int]]:
    """Give the places of the atoms that each atom is bonded to, two at most."""
    beside: list[list[int]] = [[] for _ in lines]
    for a, b in np.unique(np.sort(bonds, axis=1), axis=0).tolist():
        beside[a].append(b)
        beside[b].append(a)
    for place, others in enumerate(beside):
        if len(others) > 2 or place in others:
            raise FormatError.at(
                name,
                int(lines[place]),
                f"this atom has {len(others)} bonds, but curves do not branch; leave some out",
            )
    return beside


def against(bonds: Pairs, strands: Sequence[Sequence[int]], residues: bool) -> Pairs:
    """Give all bonds in strands of atoms if these are not in the order of their bonds, or else none.

    A strand in order has bonds between neighbours, and of its ends. Between `residues` a bond may cross-link,
    if few of them have bonds, or if neighbours have theirs and others come on top.
    """
    atoms = {*chain.from_iterable(strands)}
    within = {bond for bond in bonds if len(bond) == 2 and bond <= atoms}
    steps = {frozenset(pair) for strand in strands for pair in pairwise(strand)}
    if within <= steps | {frozenset((strand[0], strand[-1])) for strand in strands}:
        return set()
    times = Counter(chain.from_iterable(within))
    network = max(times.values()) > 2 and 2 * len(steps & within) > len(steps)
    return set() if residues and (2 * len(times) <= len(atoms) or network) else within
