"""What is made of a report, a line of JSON for each rope, so that a report that was stopped goes on.

A rope is taken as it is while what it is made from is the same, and its files are as they were written.
"""

import json
import zlib
from collections.abc import Iterable
from contextlib import suppress
from dataclasses import asdict, dataclass
from pathlib import Path

from sono import formats
from sono.figures.report.ropes import SUFFIXES, Rope
from sono.formats import FormatError

NAME = "made.jsonl"


@dataclass(frozen=True)
class Made:
    """A rope that is made, the `key` of what it is made from, and the checksum of it and of its files."""

    key: str
    crc: int
    rope: Rope


def earlier(site: Path) -> dict[str, Made]:
    """Return what was made in a folder, by the places of ropes; damaged lines are left out."""
    found = {}
    with suppress(OSError):
        for line in site.joinpath(NAME).read_bytes().splitlines():
            with suppress(ValueError, TypeError, LookupError, RecursionError):
                read = json.loads(line)
                rope = Rope(**read["rope"])
                found[rope.at] = Made(read["key"], read["crc"], rope)
    return found


def checksum(site: Path, rope: Rope) -> int:
    """Return what tells a rope and its files from others."""
    crc = zlib.crc32(json.dumps(asdict(rope)).encode())
    for suffix in SUFFIXES:
        data = b"none"
        with suppress(OSError):
            data = Path(f"{site.joinpath(*rope.at.split('/'))}{suffix}").read_bytes()
        crc = zlib.crc32(data, crc)
    return crc


def keep(site: Path, key: str, rope: Rope) -> Made:
    """Write down that a rope is made, in one go, as other processes do. Raises `FormatError`."""
    made = Made(key, checksum(site, rope), rope)
    line = f"\n{json.dumps(asdict(made))}".encode()  # first the end of a line that may have been cut off
    try:
        with open(site / NAME, "ab", buffering=len(line) + 1) as file:
            file.write(line)
    except OSError as error:
        raise FormatError(f"{site / NAME}: cannot be written: {error.strerror or error}") from error
    return made


def keep_only(site: Path, made: Iterable[Made]) -> None:
    """Write down what is made in this order, and nothing else. Raises `FormatError`."""
    formats.save(str(site / NAME), "".join(f"{json.dumps(asdict(one))}\n" for one in made))
