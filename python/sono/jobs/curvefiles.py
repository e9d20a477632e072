"""Files of curves and ropes: measured, told from each other, and their free names."""

import hashlib
import json
import os
from collections.abc import Iterator
from itertools import chain, count
from pathlib import Path
from typing import Any

from sono import formats
from sono._core import CurveError
from sono.curve import Measures, measure
from sono.formats import FormatError, VertexFile, is_stream, ropefile, unpacked
from sono.formats.ropefile import Header

KEPT_RESIDUAL = 1e-6
"""Residual up to which a file counts as a tight rope. Fitted to vertices alone it is seldom below 1e-7:
contacts just out of touch, which at mu = 1e-11 bear that much, are left out."""


def measured(source: str) -> tuple[VertexFile, Measures]:
    """Read and measure a curve file. Raises `FormatError` naming file and line."""
    file = formats.read(source)
    return file, measures_of(file)


def rope_in(path: str) -> tuple[VertexFile, Measures, Header]:
    """Read and measure a rope's file, and its header, likewise."""
    file, measures = measured(path)
    return file, measures, ropefile.parse("".join(f"# {line}\n" for line in file.comments))


def measures_of(file: VertexFile) -> Measures:
    """Measure a curve that was read, likewise."""
    try:
        return measure(file.components)
    except CurveError as error:
        raise located(error, file) from error


def located(error: CurveError, file: VertexFile) -> FormatError:
    """Say in which line, or in which two, of its file a curve is wrong."""
    places = [file.where(component, vertex or 0) for component, vertex in error.places]
    first, *others = places or [file.name]
    other = "".join(f" (the other: {place})" for place in others)
    return FormatError(f"{first}: {error}{other}")


def free_name(output: str) -> str:
    """A name beside `output` for an unfinished result: NAME.best.txt, NAME.best2.txt, ..."""
    if is_stream(output):
        return output
    return next(name for name in names_of_best(output) if not os.path.exists(name))


def names_of_best(output: str) -> Iterator[str]:
    """Give the names beside `output` for unfinished results, one after the other."""
    path = Path(unpacked(output))
    packed = output[len(unpacked(output)) :]
    return (os.fspath(path.with_suffix(f".best{k}{path.suffix}{packed}")) for k in chain([""], count(2)))


def digest(file: VertexFile, *settings: Any) -> str:
    """Return what tells a curve, and settings, from others."""
    found = hashlib.sha256(json.dumps(settings, sort_keys=True).encode())
    for component in file.components:
        found.update(component.tobytes() + b"end of component")
    return found.hexdigest()[:32]
