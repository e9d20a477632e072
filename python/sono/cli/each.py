"""What commands share that do something with each curve of files, one after the other."""

import math
import re
import shlex
import time
from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING, TypeVar

from sono.cli.streams import complain

if TYPE_CHECKING:
    from sono.formats import Ends, VertexFile
    from sono.jobs.sources import Source

Result = TypeVar("Result")

LONG = 3
"""Seconds of waiting after which is told for what."""

_NUMBER = re.compile(r"\d+(\.\d+)?")
"""What differs in messages that say the same of several curves."""


def each(
    given: Sequence[str],
    close: "Ends | None",
    work: "Callable[[Source], Sequence[str] | None]",
    tell: Callable[[str], None] = complain,
) -> int:
    """Work on each curve of the files given; a wrong one spoils only itself. Return the exit code.

    What the work says of several curves of a file the user is told once.
    """
    # Imported here, since numpy would make --help wait.
    from sono.formats import FormatError
    from sono.jobs.sources import curves

    failed = False
    for one in given:
        heard: list[Sequence[str]] = []
        wrong: list[Sequence[str]] = []
        sources = curves(one, close)
        try:
            for source in sources:
                try:
                    heard.append(work(source) or ())
                except FormatError as error:
                    wrong.append([str(error)])
        finally:
            alike = len(wrong) == len(sources) and len(once(wrong)) == 1
            for message in once(wrong) if alike else [error for (error,) in wrong]:
                complain(message)
            for message in once(heard):
                tell(message)
        failed |= bool(wrong)
    return int(failed)


def once(heard: Sequence[Sequence[str]]) -> list[str]:
    """Return what is said of the curves of a file: what is said of several in one message."""
    if len(heard) == 1:
        return list(heard[0])
    kinds: dict[str, list[str]] = {}
    for messages in heard:
        for kind, message in {_NUMBER.sub("", message): message for message in reversed(messages)}.items():
            kinds.setdefault(kind, []).append(message)
    return [_counted(said, len(heard)) for said in kinds.values()]


def _counted(said: Sequence[str], curves: int) -> str:
    """Give the first of messages that say the same, and of how many curves."""
    if len(said) == 1:
        return said[0]
    many = f"all {curves}" if len(said) == curves else f"{len(said)} of {curves}"
    return f"{said[0]} (in {many} curves of the file)"


def waited(call: Callable[[], Result], what: str) -> Result:
    """Return what a call returns, for which Ctrl-C does not wait; if it takes long, tell `what` does so."""
    from sono.patience import patiently

    until = time.monotonic() + LONG

    def look() -> None:
        nonlocal until
        if what and time.monotonic() > until:
            until = math.inf
            complain(what)

    return patiently(call, look)


def knot_of(source: "Source") -> str | None:
    """Return the name of a knot that a source is; None for a file."""
    if not source.knot:
        return None
    from sono import starts  # here, since files need none of them

    return source.knot if starts.knows(source.knot) else None


def file_of(source: "Source", command: str, does: str) -> "VertexFile":
    """Read the file of a command that takes no names of knots, and `does` so. Raises `FormatError`."""
    from sono.formats import FormatError

    if knot := knot_of(source):
        start = f"`sono start {shlex.quote(knot)} | sono {command} -`"
        raise FormatError(f"{source}: no such file; {command} takes files; {start} {does} a loose start")
    return source.read()


def rope_of(source: "Source") -> "VertexFile":
    """Read a file, or return the rope that the atlas has of a name. Raises `FormatError`."""
    if not knot_of(source):
        return source.read()
    from sono import starts
    from sono.formats import FormatError
    from sono.jobs.sources import as_file

    if rope := starts.known(source.given):
        return as_file(source.given, rope, f"{source.name}, the rope of the atlas")
    source.read()  # says what is wrong with it, if it is no name at all
    if doubt := starts.doubt(source.given):
        raise FormatError(f"{source}: {doubt}")
    name = shlex.quote(source.given)
    cure = f"`sono tighten {name} -o rope.txt` makes one, `sono search {name}` looks for the shortest"
    raise FormatError(f"{source}: the atlas has no rope of {source.given!r}; {cure}")
