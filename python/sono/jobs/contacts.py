"""The forces in a tight rope as a table: which beads press against each other, and how hard."""

from sono import formats
from sono.curve import Components, Forces

HEADER = """\
# Forces in a rope of radius 1, in units of its mean tension; beads count from 0 through all components.
# tension: of the edge from bead i to bead j; contact: with which beads i and j press against each other;
# couple: with which bead i withstands bending beyond the radius of the rope.
kind\ti\tj\tforce
"""


def write(target: str, curve: Components, forces: Forces) -> None:
    """Write the forces in a curve as TSV, to standard output for "-". Raises `formats.FormatError`."""
    rows: list[tuple[str, int, int | str, float]] = []
    first = 0
    for component in curve:
        n = len(component)
        rows += [("tension", first + i, first + (i + 1) % n, forces.tension[first + i]) for i in range(n)]
        first += n
    rows += [("contact", i, j, force) for (i, j), force in zip(forces.contacts, forces.pressing, strict=True)]
    rows += [("couple", i, "-", couple) for i, couple in enumerate(forces.couple)]
    formats.save(target, HEADER + "".join(f"{kind}\t{i}\t{j}\t{force}\n" for kind, i, j, force in rows))
