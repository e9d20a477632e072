"""What is asked for of a search."""

import os
from dataclasses import dataclass
from pathlib import Path

from sono.formats import is_stream
from sono.jobs.sources import Source
from sono.jobs.workers import Workers
from sono.searching.trials import FINE_EDGE


@dataclass(frozen=True)
class Quest:
    """Search the knot that `source` names, or its curve, for its shortest tight rope.

    The search ends after so many `trials` or `time_limit` seconds, the last of which are for refining. The
    shortest minimum is written to `output` whenever a shorter one is found; in the end the `minima` shortest
    are polished with edges `dl` long, in radii. `checkpoint` is the file that keeps the state of the search;
    with `resume` it goes on from there, an output whose search was finished is kept, and any other is only
    replaced by a better one; an output that holds another knot is an error. `way_on` tells the user how to go
    on from a checkpoint.
    """

    source: Source
    name: str
    output: str
    workers: Workers
    trials: int | None = None
    time_limit: float | None = None
    seed: int = 0
    dl: float = FINE_EDGE
    minima: int = 5
    checkpoint: Path | None = None
    resume: bool = False
    way_on: str = "--resume goes on from here"

    def files(self) -> list[str]:
        """Return the files that the job writes."""
        outputs = [] if is_stream(self.output) else [self.output]
        return [*outputs, os.fspath(self.checkpoint)] if self.checkpoint else outputs
