"""The record beside a rope's file: what proves, and what else was looked at, that its type is the input's.

docs/reference/records.md says what it holds and what that is worth; `data/record.schema.json` is its schema.
"""

import hashlib
import json
import os
from collections.abc import Callable
from contextlib import suppress
from functools import partial
from pathlib import Path
from typing import Any, TypeVar

import sono
from sono import formats
from sono.curve import Components, polygon
from sono.formats import VertexFile
from sono.invariants import TooEntangledError, fingerprint
from sono.jobs.order import Order, record_beside
from sono.naming import identify
from sono.patience import within
from sono.tightening import Tight
from sono.tightening.settings import default_settings

Found = TypeVar("Found")

FORMAT, VERSION = "sono record", 1

MOST_SECONDS = 5.0
"""Invariants of a curve that take longer are left out."""


class Records:
    """Writes the records of a job. What they say of its input is found once, when the job begins."""

    def __init__(self, job: Order, file: VertexFile) -> None:
        """Look at the input: its file as it is now, and its invariants."""
        self.job = job
        path = None if job.source.knot or job.source.piped else formats.split(job.source.given)[0]
        self.input = {"given": job.source.given, **_of_file(path), **_of_curve(file.components)}
        self.type = _type_of(file.components)

    def write(self, output: str, tight: Tight, status: str) -> None:
        """Write the record of a rope that is in its file. Raises `formats.FormatError`."""
        kind = _type_of(tight.curve)
        known = [found and {key: found[key] for key in COMPARED} for found in (self.type, kind)]
        record = {
            "format": FORMAT,
            "version": VERSION,
            "program": f"sono {sono.__version__}",
            "input": self.input,
            "output": {**_of_file(output), **_of_curve(tight.curve)},
            "status": status,
            "type": {
                "input": self.type,
                "output": kind,
                "agree": None if None in known else known[0] == known[1],
            },
            "begins_with": "atlas" if tight.known else "input",
            "method": self.job.method,
            "trials": len(tight.shapes) + len(tight.failed),
            "settings": default_settings() | self.job.settings,
            "path": [work.to_dict() for work in tight.path],
            "total": tight.total,
        }
        formats.save(record_beside(output), json.dumps(record, indent=1) + "\n")


def check(output: str) -> None:
    """See that the record of a rope's file is of it. Raises `formats.FormatError`."""
    path = record_beside(output)
    try:
        told = json.loads(Path(path).read_bytes())["output"]["sha256"]
    except (OSError, ValueError, LookupError, TypeError):
        told = None
    if told != _of_file(output)["sha256"]:
        why = "is missing, or of another file; only the run that made the rope can write it"
        raise formats.FormatError(f"{output}: its record {path} {why}: --force starts anew")


def remove(path: str) -> None:
    """Remove a rope's file, and the record that is of it. Raises `OSError`."""
    with suppress(formats.FormatError):
        check(path)
        os.unlink(record_beside(path))
    os.unlink(path)


COMPARED = ("linking", "signatures", "alexander")


def _of_file(path: str | None) -> dict[str, Any]:
    """Name a file, without its folder, and tell it from others. Raises `formats.FormatError`."""
    if path is None:
        return {"file": None, "sha256": None}
    try:
        return {"file": os.path.basename(path), "sha256": hashlib.sha256(Path(path).read_bytes()).hexdigest()}
    except OSError as error:
        raise formats.FormatError(f"{path}: cannot be read: {error.strerror or error}") from error


def _of_curve(curve: Components) -> dict[str, Any]:
    return {"vertices": polygon(curve), "components": list(map(len, curve))}


def _type_of(curve: Components) -> dict[str, Any] | None:
    """Return the invariants that tightening compares, and the name; None where they take too long."""
    found = _in_time(partial(fingerprint, curve))
    if found is None:
        return None
    named = _in_time(partial(identify, curve))
    names = {"name": named and named.name, "known": named.known if named else "undecided"}
    return {**dict(zip(COMPARED, json.loads(json.dumps(found)), strict=True)), **names}


def _in_time(call: Callable[[], Found]) -> Found | None:
    with suppress(TooEntangledError):
        return within(MOST_SECONDS, call)
    return None
