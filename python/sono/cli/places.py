"""Where a command writes: names of files, tried, locked and made ready before hours are spent."""

import errno
import os
from collections import Counter
from collections.abc import Iterable, Sequence
from contextlib import suppress

import click

from sono.cli.streams import complain
from sono.jobs.locks import Claims, Taken


def names_one_file(path: str) -> bool:
    """Tell whether this names a single file, or standard output, rather than a folder."""
    return not path.endswith(("/", os.sep)) and not os.path.isdir(path)


def check_suffix(path: str) -> None:
    """Refuse a file for vertices whose suffix is that of no format."""
    from sono import formats  # here, since numpy would make --help wait

    try:
        formats.by_suffix(path)
    except formats.FormatError as error:
        raise click.UsageError(str(error)) from error


def fresh(force: bool, resume: bool) -> bool:
    """Tell whether nothing is to be written over or gone on with."""
    if force and resume:
        raise click.UsageError("--force starts anew, --resume keeps what is there; give one of them")
    return not (force or resume)


def prepare(paths: Sequence[str], fresh: bool, more: Iterable[str] = ()) -> None:
    """Before hours are spent: see that these files can be written, by nobody else.

    If `fresh`, a file that is there is an error. `more` are names that may be written besides.
    """
    for path, times in Counter(map(os.path.normcase, paths)).items():
        if times > 1:
            raise click.UsageError(f"{path} would be written {times} times; give each knot once, by one name")
    try:
        claim(paths)
    except Taken as taken:
        why = "another sono is about to write it; let that one end, or name another place with -o"
        raise click.UsageError(f"{taken.path}: {why}") from taken
    for path in paths:
        if fresh and os.path.exists(path):
            raise click.UsageError(
                f"{path} exists; --force starts anew, --resume goes on from it, -o names another place"
            )
    for path in (*paths, *more):
        _try(path)


def claim(paths: Sequence[str]) -> None:
    """Make the folders of files, and keep other processes from writing the files until the command ends.

    Raises `Taken`.
    """
    context = click.get_current_context()
    if "sono.claims" not in context.meta:
        context.meta["sono.claims"] = context.with_resource(Claims())
    for folder in dict.fromkeys(os.path.dirname(path) for path in paths):
        make_folder(folder or ".")
        try:
            context.meta["sono.claims"].take(path for path in paths if os.path.dirname(path) == folder)
        except OSError as error:  # a file system without locks
            why = f"nothing can be locked here ({error.strerror})"
            complain(f"{folder or '.'}: {why}; let no other sono write here meanwhile")


def make_folder(folder: str) -> None:
    """Make a folder, or make sure that it can be written to."""
    try:
        os.makedirs(folder, exist_ok=True)
    except OSError as error:
        raise click.UsageError(f"{folder}: cannot be made: {error.strerror}") from error
    if not os.access(folder, os.W_OK):
        raise click.UsageError(f"{folder}: cannot be written to; -o names another folder")


def _try(path: str) -> None:
    """See that there can be a file of this name, without making one, which might outlive the program."""
    from sono import formats  # here, since numpy would make --help wait

    try:
        if os.path.isdir(path):
            raise IsADirectoryError(errno.EISDIR, os.strerror(errno.EISDIR))
        with suppress(FileNotFoundError):
            os.stat(path)  # which too long a name does not stand
        if not formats.is_stream(path):
            part = formats.part_of(path)
            os.close(os.open(part, os.O_WRONLY | os.O_CREAT | os.O_EXCL))
            os.unlink(part)
    except OSError as error:
        raise click.UsageError(
            f"{path}: cannot be written: {error.strerror}; -o names another place"
        ) from error
