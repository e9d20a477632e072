"""What the commands share: options, the table on standard output, messages on standard error."""

import functools
import io
import math
import re
import sys
from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING, Any, TextIO, TypeVar, cast

import click

from sono import tables
from sono.cli.streams import complain as complain
from sono.tables import TableWriter

if TYPE_CHECKING:
    from sono.jobs.workers import Cluster, Threads

Function = TypeVar("Function", bound=Callable[..., Any])

MOST_JOBS = 256
"""Threads of one process at most; shards and clusters go further."""


def files(function: Function) -> Function:
    """The input files, `-` for standard input."""
    return click.argument("sources", metavar="FILE...", nargs=-1, required=True)(function)


def knots(function: Function) -> Function:
    """Files or names of knots, as arguments and from `--list`, of which `--shard` takes a part."""

    @click.argument("arguments", metavar="[FILE|NAME]...", nargs=-1)
    @click.option(
        "--list",
        "list_file",
        metavar="FILE",
        type=click.Path(allow_dash=True, dir_okay=False, exists=True),
        help="More files or names, one a line; # begins a comment.",
    )
    @click.option(
        "--shard",
        metavar="I/N",
        callback=_shard,
        help="Take only every N-th of them, beginning with the I-th: for arrays of jobs.",
    )
    @functools.wraps(function)
    def command(
        arguments: tuple[str, ...], list_file: str | None, shard: slice | None, **more: object
    ) -> object:
        sources = [*arguments, *(_listed(list_file) if list_file else [])]
        if not sources:
            raise click.UsageError("give a FILE or the NAME of a knot, or a --list of them")
        if not sources[shard or slice(None)]:
            complain("nothing to do: there are fewer knots than shards")
            return None
        return function(sources=sources[shard or slice(None)], **more)

    return cast("Function", command)


def _shard(ctx: click.Context, param: click.Parameter, value: str | None) -> slice | None:
    match = re.fullmatch(r"(\d{1,15})/(\d{1,15})", value or "1/1")
    if not match or not 1 <= int(match[1]) <= int(match[2]):
        raise click.BadParameter(f"{value!r}: give I/N with I from 1 to N, such as 3/20")
    return slice(int(match[1]) - 1, None, int(match[2]))


def _listed(path: str) -> list[str]:
    try:
        with click.open_file(path, encoding="utf-8", errors="surrogateescape") as lines:
            words = (line.split("#")[0].strip() for line in lines)
            return [word for word in words if word]
    except OSError as error:
        raise click.UsageError(f"{path}: cannot be read: {error.strerror}") from error


def tell_of_shadows(sources: Sequence[str], quiet: bool) -> None:
    """Say which sources are files called like a knot."""
    from sono.jobs.sources import shadowed  # here, since numpy would make --help wait

    for source in sources if not quiet else []:
        if shadowed(source):
            why = "is a file here, which is taken, and not the knot of this name"
            complain(f"{source}: {why}; `sono start {source}` draws that")


def parallel(jobs_help: str) -> Callable[[Function], Function]:
    """`--jobs` and `--cluster`."""

    def decorate(function: Function) -> Function:
        function = click.option(
            "--cluster",
            metavar="ADDRESS",
            help="Have a Dask scheduler's workers do it, tcp://host:8786 say; needs the extra sono[cluster].",
        )(function)
        return click.option(
            "-j", "--jobs", type=click.IntRange(1, MOST_JOBS), default=1, show_default=True, help=jobs_help
        )(function)

    return decorate


def workers(jobs: int, cluster: str | None) -> "Threads | Cluster":
    """Threads, or the cluster at this address."""
    from sono.jobs.workers import Cluster, Threads

    if not cluster:
        return Threads(jobs)
    try:
        return Cluster(cluster)
    except ValueError as error:
        raise click.UsageError(str(error)) from error


def table(default: Sequence[str]) -> Callable[[Function], Function]:
    """`--format` and `--columns`, these columns being the default."""

    def decorate(function: Function) -> Function:
        function = click.option(
            "--format",
            "format_",
            type=click.Choice(list(tables.FORMATS)),
            help="Format of the table.  [default: table on a terminal, tsv elsewhere]",
        )(function)
        return click.option(
            "--columns",
            default=",".join(default),
            show_default=True,
            callback=_columns,
            metavar="KEY,...",
            help=f"Columns of the table, l_p or L_p, of: {', '.join(tables.COLUMNS)}.",
        )(function)

    return decorate


class Number(click.FloatRange):
    """A number in a range, which nan is not."""

    def convert(self, value: Any, param: click.Parameter | None, ctx: click.Context | None) -> float:
        """Read it."""
        number = float(super().convert(value, param, ctx))
        return number if number == number else self.fail(f"{value} is not a number", param, ctx)


def time_limit(help: str) -> Callable[[Function], Function]:
    """`--time-limit`."""
    return click.option("--time-limit", type=float, callback=_seconds, metavar="SECONDS", help=help)


def _seconds(ctx: click.Context, param: click.Parameter, value: float | None) -> float | None:
    if value is not None and not 0 < value < math.inf:
        raise click.BadParameter(f"{value} is no number of seconds above 0")
    return value


def output(help: str) -> Callable[[Function], Function]:
    """`--output`."""
    return click.option("-o", "--output", metavar="PATH", help=help)


def force(function: Function) -> Function:
    """`--force`."""
    return click.option("--force", is_flag=True, help="Overwrite files that are there.")(function)


def checkpoint(help: str, default: str | None = None) -> Callable[[Function], Function]:
    """`--checkpoint`."""
    folder = click.Path(file_okay=False)
    return click.option(
        "--checkpoint", metavar="FOLDER", type=folder, default=default, show_default=bool(default), help=help
    )


def resume(kept: str) -> Callable[[Function], Function]:
    """`--resume`, which keeps such outputs."""
    return click.option(
        "--resume", is_flag=True, help=f"Go on from checkpoints; keep outputs that are {kept}."
    )


def other_starts(function: Function) -> Function:
    """`--seed` of a search."""
    return click.option(
        "--seed", type=click.IntRange(0, 10**6), default=0, help="Other starts.  [default: 0]"
    )(function)


def quiet(function: Function) -> Function:
    """`--quiet`."""
    return click.option("-q", "--quiet", is_flag=True, help="No progress and no messages but errors.")(
        function
    )


def _columns(ctx: click.Context, param: click.Parameter, value: str) -> list[str]:
    try:
        keys = [tables.key_of(name) for name in value.split(",") if name.strip()]
    except ValueError as error:
        raise click.BadParameter(str(error)) from error
    if not keys:
        raise click.BadParameter("name at least one column")
    return keys


def writer(format_: str | None, columns: Sequence[str], stream: TextIO | None = None) -> TableWriter:
    """The table on a stream, by default on standard output."""
    stream = stream or sys.stdout
    return tables.writer(format_ or ("table" if stream.isatty() else "tsv"), columns, stream)


def table_beside(format_: str | None, columns: list[str], taken: bool, quiet: bool) -> TableWriter:
    """The table, which leaves standard output to vertices or contacts if they go there."""
    if not taken:
        return writer(format_, columns)
    return writer(format_, columns, io.StringIO() if quiet else sys.stderr)
