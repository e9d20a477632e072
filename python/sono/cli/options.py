"""What the commands share: options, the table on standard output, messages on standard error."""

import sys
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any, TextIO, TypeVar

import click

from sono import tables
from sono.tables import TableWriter

Function = TypeVar("Function", bound=Callable[..., Any])


def files(function: Function) -> Function:
    """The input files, `-` for standard input."""
    return click.argument("sources", metavar="FILE...", nargs=-1, required=True)(function)


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
            help=f"Columns of the table, of: {', '.join(tables.COLUMNS)}.",
        )(function)

    return decorate


def quiet(function: Function) -> Function:
    """`--quiet`."""
    return click.option("-q", "--quiet", is_flag=True, help="No progress and no messages but errors.")(
        function
    )


def _columns(ctx: click.Context, param: click.Parameter, value: str) -> list[str]:
    keys = [key.strip() for key in value.split(",") if key.strip()]
    for key in keys:
        if key not in tables.COLUMNS:
            raise click.BadParameter(f"unknown column {key!r}; the columns are: {', '.join(tables.COLUMNS)}")
    if not keys:
        raise click.BadParameter("name at least one column")
    return keys


def writer(format_: str | None, columns: Sequence[str], stream: TextIO | None = None) -> TableWriter:
    """The table on a stream, by default on standard output."""
    stream = stream or sys.stdout
    return tables.writer(format_ or ("table" if stream.isatty() else "tsv"), columns, stream)


def knot_name(source: str) -> str:
    """A file's name without folder and suffix; "stdin" for standard input."""
    return "stdin" if source == "-" else Path(source).stem


def complain(message: str) -> None:
    """An error or a warning, on standard error."""
    click.echo(f"sono: {message}", err=True)
