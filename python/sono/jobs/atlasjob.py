"""One knot of the atlas as a job: searched for, taken from a file, or checked."""

import os
from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Self

from sono import starts
from sono.formats.ropefile import TIGHT
from sono.jobs.atlas import Atlas
from sono.jobs.result import Result, Show
from sono.jobs.search import SearchJob
from sono.jobs.sources import Source
from sono.jobs.workers import Workers
from sono.starts.shapes import place
from sono.tightening import Stopped


@dataclass(frozen=True)
class AtlasJob:
    """Search a knot further and take in what is shorter, or take in a `file`, or only check the atlas."""

    atlas: Atlas
    name: str
    search: SearchJob | None
    file: str | None

    @classmethod
    def of(cls, atlas: Atlas, source: str, search: Callable[[str], SearchJob] | None) -> Self:
        """Make the job of a name, which may be searched, or of a file called NAME.txt or NAME.more.txt."""
        if os.path.isfile(source):
            return cls(atlas, place(Path(source).stem.split(".")[0]).knot, None, source)
        knot = place(source).knot if starts.knows(source) else source
        return cls(atlas, knot, search(knot) if search else None, None)

    def results(self, show: Show) -> Iterator[Result]:
        """Do it."""
        file = self.file
        if self.search:
            for result in self.search.results(show):
                yield replace(result, row=None)
                if result.row and result.row["status"] == TIGHT:
                    file = self.search.output
            if not file:
                return
        try:
            taken = self.atlas.take(self.name, file, lambda: show(1, "polish")) if file else None
            yield Result(taken or self.atlas.checked(self.name))
        except ValueError as error:  # FormatError, or another knot type
            yield Result(None, str(error))
        except Stopped as why:
            yield Result(None, f"{self.name}: {why}; not taken into the atlas")


def atlas_search(name: str, folder: str, workers: Workers, trials: int, seed: int) -> SearchJob:
    """Make the search of a knot of the atlas, which keeps its rope and its state in a folder of its own."""
    return SearchJob(
        Source(name),
        name,
        str(Path(folder, f"{name}.s{seed}.tight.txt")),
        workers,
        trials=trials,
        seed=seed,
        minima=1,
        checkpoint=Path(folder, f"{name}.s{seed}.json"),
        resume=True,
        way_on="the next --update goes on from here",
    )
