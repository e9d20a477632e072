"""The tables and figures of the paper, made from nothing, and beside what it prints.

    python examples/paper.py made/       # a minute of a core; needs pip install 'sono[plot]'

The paper is J. Baranska, P. Pieranski, E. J. Rawdon, "Ropelength of tight polygonal knots". The folder gets
tables.md and a picture for each of its figures that shows a tight rope, lengths of ropes, or the model.
"""

import csv
import sys
from collections.abc import Callable, Iterator, Sequence
from pathlib import Path
from typing import Any

import sono

PRINTED = Path(__file__).parent.parent / "tests" / "paper" / "tables.csv"

BEADS = (15, 30, 60, 120, 240, 480)
"""n of the trefoils that are shown."""

EDGES = (21, 30, 42, 60, 84, 120, 168, 240, 336, 480, 672, 960, 1342, 1920)
"""n of the trefoils whose L_p and L_c are shown."""

COARSE = 120
"""Up to this n each rope is found from a loose start; finer ones are polished from the one before."""


def ropes(knot: str, counts: Sequence[int]) -> Iterator[sono.Tight]:
    """Tighten a knot at each n, from its loose start."""
    tight = None
    for n in counts:
        if tight is None or n <= COARSE:
            tight = sono.tighten(knot, n, known=False)
        else:
            tight = sono.tighten(sono.refine(tight, n), n, method="polish")
        print(f"{knot}: n = {n}, L_a = {tight.measures.l_a_or_l_p:.4f}", flush=True)
        yield tight


def tables(folder: Path) -> dict[str, list[sono.Tight]]:
    """Write the four tables, ours beside the printed ones; return the ropes."""
    with PRINTED.open() as stream:
        printed = list(csv.DictReader(stream))
    found = {}
    lines = [
        "| knot | n | L_p | printed | L_c | printed | L_a | printed |",
        "|---|---|---|---|---|---|---|---|",
    ]
    for knot in dict.fromkeys(row["knot"] for row in printed):
        rows = [row for row in printed if row["knot"] == knot]
        found[knot] = list(ropes(knot, [int(row["n"]) for row in rows]))
        for row, tight in zip(rows, found[knot], strict=True):
            cells: list[object] = [knot, row["n"]]
            for name in ("L_p", "L_c", "L_a"):
                cells += [f"{getattr(tight.measures, name.lower()):.6f}", row[name]]
            lines.append(f"| {' | '.join(map(str, cells))} |")
    (folder / "tables.md").write_text("\n".join(lines) + "\n")
    return found


def main(folder: Path) -> None:
    """Make everything."""
    folder.mkdir(parents=True, exist_ok=True)

    def save(name: str, draw: Callable[..., Any], *given: Any, **more: Any) -> None:
        with sono.plot.style("light"):
            axes = draw(*given, **more)
            (axes if hasattr(axes, "figure") else axes[0]).figure.savefig(folder / f"{name}.png")

    save("model", sono.plot.model)
    found = tables(folder)
    for knot, tight in found.items():
        save(f"convergence-{knot}", sono.plot.convergence, tight)
    save("convergence-finest-3_1", sono.plot.convergence, found["3_1"][1:])
    save("convergence-all-3_1", sono.plot.convergence, list(ropes("3_1", EDGES)))
    shown = list(ropes("3_1", BEADS))
    save("trefoils", sono.plot.knot, *shown, beads=True, labels=[f"n = {n}" for n in BEADS])
    save("trefoil-15", sono.plot.knot, shown[0], beads=True)
    save("torus-2-59", sono.plot.knot, sono.tighten("T(2,59)", dl=0.5, trials=1))


if __name__ == "__main__":
    main(Path(sys.argv[1] if len(sys.argv) > 1 else "made"))
