"""What the commands share: options, the table on standard output, messages on standard error."""

import functools
import io
import math
import re
import sys
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, TextIO, TypeVar, cast

import click

from sono import tables
from sono.cli.streams import complain as complain
from sono.tables import TableWriter

if TYPE_CHECKING:
    from sono.formats import Close
    from sono.jobs.workers import Cluster, Threads

Function = TypeVar("Function", bound=Callable[..., Any])

MOST_JOBS = 256
"""Threads of one process at most; shards and clusters go further."""


def files(function: Function) -> Function:
    """The input files, `-` for standard input."""
    return click.argument("sources", metavar="FILE...", nargs=-1, required=True)(function)


def codes(function: Function) -> Function:
    """`--pd`, `--dt` and `--gauss`, as names in `codes`."""

    @click.option(
        "--pd", multiple=True, metavar="CODE", help='A PD code, such as "X[1,5,2,4] X[3,1,4,6] X[5,3,6,2]".'
    )
    @click.option("--dt", multiple=True, metavar="CODE", help='A DT code, "4 6 2" or "[[6,8],[2,4]]".')
    @click.option("--gauss", multiple=True, metavar="CODE", help='A Gauss code, "1 -2 3 -1 2 -3".')
    @functools.wraps(function)
    def command(pd: tuple[str, ...], dt: tuple[str, ...], gauss: tuple[str, ...], **more: object) -> object:
        given = (("pd", pd), ("dt", dt), ("gauss", gauss))
        return function(codes=[f"{kind}:{code}" for kind, written in given for code in written], **more)

    return cast("Function", command)


def knots(function: Function) -> Function:
    """Names, codes or files of knots, as arguments and from `--list`, of which `--shard` takes a part."""

    @click.argument("arguments", metavar="[FILE|NAME]...", nargs=-1)
    @codes
    @click.option(
        "--list",
        "list_file",
        metavar="FILE",
        type=click.Path(allow_dash=True, dir_okay=False, exists=True),
        help="More files or names, one a line; # at its beginning or after a space begins a comment.",
    )
    @click.option(
        "--shard",
        metavar="I/N",
        callback=_shard,
        help="Take only every N-th of them, beginning with the I-th: for arrays of jobs.",
    )
    @close
    @functools.wraps(function)
    def command(
        *,
        arguments: tuple[str, ...],
        codes: list[str],
        list_file: str | None,
        shard: slice,
        close: "Close",
        **more: object,
    ) -> object:
        from sono.jobs.sources import curves  # here, since numpy would make --help wait

        given = [*arguments, *codes, *(_listed(list_file) if list_file else [])]
        if not given:
            raise click.UsageError("give a FILE or the NAME of a knot, or a --list of them")
        sources = [curve for source in given for curve in curves(source, close)]
        if not sources[shard]:
            complain("nothing to do: there are fewer knots than shards")
            return None
        return function(sources=sources[shard], **more)

    return cast("Function", command)


def _shard(ctx: click.Context, param: click.Parameter, value: str | None) -> slice:
    match = re.fullmatch(r"(\d{1,15})/(\d{1,15})", value or "1/1")
    if not match or not 1 <= int(match[1]) <= int(match[2]):
        raise click.BadParameter(f"{value!r}: give I/N with I from 1 to N, such as 3/20")
    return slice(int(match[1]) - 1, None, int(match[2]))


def _listed(path: str) -> list[str]:
    try:
        with click.open_file(path, encoding="utf-8-sig", errors="surrogateescape") as lines:
            words = (re.split(r"(?:^|\s)#", line)[0].strip() for line in lines)
            return [word for word in words if word]
    except OSError as error:
        raise click.UsageError(f"{path}: cannot be read: {error.strerror}") from error


def close(function: Function) -> Function:
    """`--close`."""
    return click.option(
        "--close",
        type=click.Choice(["direct", "sphere"]),
        help="Close open chains, by an edge between the ends or by way of a sphere round the chain.",
    )(function)


def tell_of_shadows(sources: Iterable[object], shown: "Shown") -> None:
    """Say which sources are files called like a knot."""
    from sono.jobs.sources import shadowed  # here, since numpy would make --help wait

    for source in filter(shadowed, map(str, sources)):
        why = "is a file here, which is taken, and not the knot of this name"
        shown.tell(f"{source}: {why}; `sono start {source}` draws that")


@dataclass(frozen=True)
class Pool:
    """Who does the work: so many threads, or the cluster at this address."""

    jobs: int
    cluster: str | None

    def workers(self) -> "Threads | Cluster":
        """Make them ready. Raises `click.UsageError` if the cluster does not answer."""
        from sono.jobs.workers import Cluster, Threads

        if not self.cluster:
            return Threads(self.jobs)
        try:
            return Cluster(self.cluster)
        except ValueError as error:
            raise click.UsageError(str(error)) from error


def parallel(jobs_help: str) -> Callable[[Function], Function]:
    """`--jobs` and `--cluster`, as a `pool`."""

    def decorate(function: Function) -> Function:
        @click.option(
            "-j", "--jobs", type=click.IntRange(1, MOST_JOBS), default=1, show_default=True, help=jobs_help
        )
        @click.option(
            "--cluster",
            metavar="ADDRESS",
            help="Have a Dask scheduler's workers do it, tcp://host:8786 say; needs the extra sono[cluster].",
        )
        @functools.wraps(function)
        def command(jobs: int, cluster: str | None, **more: object) -> object:
            return function(pool=Pool(jobs, cluster), **more)

        return cast("Function", command)

    return decorate


@dataclass(frozen=True)
class Shown:
    """How results are shown: the table's format and columns, and whether that is all."""

    format: str | None
    columns: list[str]
    quiet: bool

    def table(self, taken: bool = False) -> TableWriter:
        """Return the table on standard output, unless that is `taken` by vertices or contacts."""
        stream: TextIO = sys.stdout
        if taken:
            stream = io.StringIO() if self.quiet else sys.stderr
        return tables.writer(self.format or ("table" if stream.isatty() else "tsv"), self.columns, stream)

    def tell(self, message: str) -> None:
        """Write what a quiet user does not want to hear."""
        if not self.quiet:
            complain(message)


FILLED: dict[str, tuple[str, ...]] = {
    "measure": (
        *("knot", "file", "n", "components", "dl", "dispersion", "min_rad", "sr", "r_s", "r_c", "length"),
        *("inscribed_length", "l_p", "l_c", "l_a", *tables.SHAPE, "residual"),
    ),
    "identify": (
        *("file", "knot", "known", "may_be", "components", "crossings", "determinant", "signature"),
        *("linking", "alexander", "homfly"),
    ),
}
"""The columns that commands of few columns have."""


def table(default: Sequence[str], command: str | None = None) -> Callable[[Function], Function]:
    """`--format`, `--columns`, these columns being the default, and `--quiet`: as how results are `shown`.

    A `command` that is named refuses columns that it has not.
    """
    filled = FILLED.get(command or "", tuple(tables.COLUMNS))

    def decorate(function: Function) -> Function:
        @click.option(
            "--columns",
            default=",".join(default),
            show_default=True,
            callback=lambda ctx, param, value: _columns(value, filled),
            metavar="KEY,...",
            help=f"Columns of the table, l_p or L_p, of: {', '.join(filled)}.",
        )
        @click.option(
            "--format",
            "format_",
            type=click.Choice(list(tables.FORMATS)),
            help="Format of the table.  [default: table on a terminal, tsv elsewhere]",
        )
        @click.option("-q", "--quiet", is_flag=True, help="No progress and no messages but errors.")
        @functools.wraps(function)
        def command(format_: str | None, columns: list[str], quiet: bool, **more: object) -> object:
            return function(shown=Shown(format_, columns, quiet), **more)

        return cast("Function", command)

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


def _columns(value: str, filled: Sequence[str]) -> list[str]:
    try:
        keys = [tables.key_of(name) for name in value.split(",") if name.strip()]
    except ValueError as error:
        raise click.BadParameter(str(error)) from error
    if not keys:
        raise click.BadParameter("name at least one column")
    for key in keys:
        if key not in filled:
            others = [f"`sono {name}`" for name, columns in FILLED.items() if key in columns]
            cure = f"{' and '.join(others)} has it" if others else f"there are: {', '.join(filled)}"
            raise click.BadParameter(f"{key} is no column of this command; {cure}")
    return keys
