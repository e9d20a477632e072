"""Jobs whose computing is done elsewhere, perhaps on other machines."""

import os
import tempfile
from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

from sono import formats
from sono.formats import FormatError
from sono.jobs.curvefiles import free_name
from sono.jobs.kept import kept_row
from sono.jobs.result import Result
from sono.jobs.tighten import Job, run
from sono.jobs.workers import Workers
from sono.tightening import Stopped


@dataclass(frozen=True)
class SentJob:
    """A job whose computing is done by `workers`, perhaps on other machines; its files stay here."""

    job: Job
    workers: Workers

    @property
    def name(self) -> str:
        """The knot's name in tables."""
        return self.job.name

    def results(self, show: Callable[[float, str], None]) -> "Iterator[Result]":
        """Do the job, giving its rows when all of it has come back. `show` may raise `Stopped`."""
        job = self.job
        try:
            source = job.source.looked_at()
            file = source.read()
            kept = [n for n, output in job.outputs.items() if job.resume and os.path.isfile(output)]
            for n in kept:
                yield kept_row(job, file, n)
            outputs = {n: output for n, output in job.outputs.items() if n not in kept}
            if not outputs:
                return
            sent = replace(job, source=source, outputs=outputs, resume=False)
            free = {path: free_name(path) for path in outputs.values()}
            waiting = self.workers.submit(_away, sent, free, watch=lambda: show(0, "on the cluster"))
            results, texts = waiting()
        except FormatError as error:
            yield Result(None, str(error))
            return
        except Stopped as why:
            yield Result(None, f"{job.name}: {why}; what the cluster had done of it is lost")
            return
        unwritten = set()
        for path, text in texts.items():
            try:
                formats.save(path, text)
            except FormatError as error:
                unwritten.add(path)
                yield Result(None, str(error))
        for result in results:
            lost = result.row and result.row["file"] in unwritten
            yield replace(result, row={**result.row, "file": None}) if result.row and lost else result


def _away(job: Job, free: dict[str, str]) -> "tuple[list[Result], dict[str, bytes]]":
    """Do a job far from its files: give its results, and what is to be written to them.

    Its source has been looked at. `free` says for each output where an unfinished rope is to go.
    """
    with tempfile.TemporaryDirectory() as folder:
        here: dict[str, str] = {}

        def moved(path: str) -> str:
            suffix = "" if path == "-" else "".join(Path(path).suffixes[-2:])
            temporary = os.path.join(folder, f"{len(here)}{suffix}")
            here[temporary] = path
            here[free_name(temporary)] = free.get(path, path)
            return temporary

        outputs = {n: moved(path) for n, path in job.outputs.items()}
        between = {n: moved(path) for n, path in job.forces.items()}
        done = [
            _named(result, here)
            for result in run(replace(job, outputs=outputs, forces=between), lambda _: None)
        ]
        written = [path for path in here if os.path.exists(path)]
        return done, {here[path]: formats.load(path)[1] for path in written}


def _named(result: "Result", names: dict[str, str]) -> "Result":
    """Put the files' own names into a result."""

    def named(text: Any) -> Any:
        for path, name in names.items():
            text = text.replace(path, name) if isinstance(text, str) else text
        return text

    row = result.row and {key: named(value) for key, value in result.row.items()}
    return Result(row, named(result.trouble), named(result.note))
