"""What is asked for of one curve, and the rows that answer it."""

import os
from dataclasses import dataclass, field, replace
from functools import cached_property
from pathlib import Path
from typing import Any

from sono import starts
from sono.curve import Components, Measures
from sono.formats import VertexFile, is_stream, unpacked
from sono.formats.ropefile import STUCK
from sono.jobs.curvefiles import digest
from sono.jobs.result import Result, as_row
from sono.jobs.sources import Source
from sono.tables import Row
from sono.tightening import Method
from sono.tightening.settings import TRIALS, default_settings
from sono.tightening.targets import Target


@dataclass(frozen=True)
class Order:
    """Tighten the curve of `source` to each target that is in `outputs`.

    `name` is the curve's name in tables. `outputs` says where the vertices for each go, and `forces` where
    those between them, if they are wanted; "-" is standard output. `time_limit` is in seconds. `checkpoint`
    is the file that keeps the state of the run. With `resume` a run goes on from its checkpoint, and outputs
    that are there are not computed again. `known` lets the rope of a knot by name begin with the shape that
    the atlas has of it. A `record` is written beside each output, which is a file then.
    """

    source: Source
    name: str
    outputs: dict[Target, str]
    settings: dict[str, Any]
    method: Method = "both"
    trials: int = TRIALS
    forces: dict[Target, str] = field(default_factory=dict)
    time_limit: float | None = None
    checkpoint: Path | None = None
    resume: bool = False
    known: bool = True
    record: bool = False

    @cached_property
    def shape(self) -> Components | None:
        """The shape of the atlas that the rope begins with, if there is one."""
        knot = self.source.knot if self.known and self.method == "both" else None
        return starts.known(knot) if knot else None

    def files(self) -> list[str]:
        """Return the files that the job writes."""
        paths = [*self.outputs.values(), *self.forces.values()]
        paths += map(record_beside, self.outputs.values()) if self.record else []
        outputs = [path for path in paths if not is_stream(path)]
        return [*outputs, os.fspath(self.checkpoint)] if self.checkpoint else outputs


def record_beside(output: str) -> str:
    """Return the name of the record beside a rope's file."""
    return os.fspath(Path(unpacked(output)).with_suffix(".record.json"))


def shown(target: Target) -> str:
    """Name a target to the user."""
    return f"n = {target}" if isinstance(target, int) else f"dl = {target:g}"


def rope_row(order: Order, output: str | None, measures: Measures, status: str, **more: Any) -> Row:
    """Make the row of a rope."""
    overlap = max(0.0, 2 - 2 * measures.sr)
    return as_row(order.name, output, measures, overlap=overlap, status=status, **more)


def judged(order: Order, row: Row, note: str | None = None) -> Result:
    """Make the result of a row whose vertices are in their file."""
    if row["status"] != STUCK:
        return Result(row, note=note)
    why = f"did not settle to {tolerance(order):g}"
    if order.method != "sono":
        why = "did not get tight"
        if row.get("mu") is not None:
            why += f": the polish ended at mu = {row['mu']:.1e} with the residual {row['residual']:.1e}"
    return Result(row, f"{order.name}: n = {row['n']} {why}; {row['file']} has its best", note)


def tolerance(order: Order) -> float:
    """Return the dispersion and overlap that SONO is to reach."""
    return float((default_settings() | order.settings)["tolerance"])


def made_from(order: Order, file: VertexFile) -> str:
    """Tell what a rope is made from: its curve, method and settings, as a digest."""
    more = [digest(replace(file, components=list(order.shape)))] if order.shape else []
    return digest(file, order.method, order.trials, order.settings, *more)
