"""What commands share that do something with each curve of files, one after the other."""

import shlex
from collections.abc import Callable, Sequence
from itertools import chain
from typing import TYPE_CHECKING

from sono.cli.streams import complain

if TYPE_CHECKING:
    from sono.formats import Close, VertexFile
    from sono.jobs.sources import Source


def each(given: Sequence[str], close: "Close | None", work: "Callable[[Source], None]") -> int:
    """Work on each curve of the files given; a wrong one spoils only itself. Return the exit code."""
    # Imported here, since numpy would make --help wait.
    from sono.formats import FormatError
    from sono.jobs.sources import curves

    failed = False
    for source in chain.from_iterable(curves(one, close) for one in given):
        try:
            work(source)
        except FormatError as error:
            failed = True
            complain(str(error))
    return int(failed)


def file_of(source: "Source", command: str, does: str) -> "VertexFile":
    """Read the file of a command that takes no names of knots, and `does` so. Raises `FormatError`."""
    from sono import starts
    from sono.formats import FormatError

    if source.knot and starts.knows(source.knot):
        start = f"`sono start {shlex.quote(source.knot)} | sono {command} -`"
        raise FormatError(f"{source}: no such file; {command} takes files; {start} {does} a loose start")
    return source.read()


def rope_of(source: "Source") -> "VertexFile":
    """Read a file, or return the rope that the atlas has of a name. Raises `FormatError`."""
    import sono
    from sono import starts
    from sono.formats import FormatError
    from sono.jobs.sources import as_file

    if not (source.knot and starts.knows(source.knot)):
        return source.read()
    try:
        curve = sono.start(source.given, known=True)
    except ValueError as error:
        name = shlex.quote(source.given)
        cure = f"`sono tighten {name} -o rope.txt` makes one, `sono search {name}` looks for the shortest"
        raise FormatError(f"{source}: {error}; {cure}") from error
    return as_file(source.given, list(curve), f"{source.name}, the rope of the atlas")
