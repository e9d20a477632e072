"""Standard input, output and error, however they were left: closed, full, or read by nobody."""

import errno
import io
import os
import sys
from contextlib import suppress
from typing import TextIO

import click

from sono.printing import printable


class _ClosedOutput(io.TextIOBase):
    """Standard output that was closed before the program began."""

    def write(self, text: str) -> int:
        """Refuse it."""
        raise OSError(errno.EBADF, "standard output is closed")


class _ClosedInput(io.RawIOBase):
    """Standard input that was closed before the program began."""

    def readable(self) -> bool:
        """Let it be tried."""
        return True

    def readinto(self, buffer: object) -> int:
        """Refuse it."""
        raise OSError(errno.EBADF, "standard input is closed")


def secure() -> None:
    """Make the three streams fit for use, so that what is closed is met where it is used."""
    with suppress(OSError):
        # A file that is opened later must not get one of their numbers.
        while (descriptor := os.open(os.devnull, os.O_RDWR)) <= 2:
            pass
        os.close(descriptor)
    sys.stdin = sys.stdin or io.TextIOWrapper(io.BufferedReader(_ClosedInput()), encoding="utf-8")
    sys.stdout = sys.stdout or _ClosedOutput()
    sys.stderr = sys.stderr or open(os.devnull, "w", encoding="utf-8")  # noqa: SIM115
    if isinstance(sys.stdout, io.TextIOWrapper):
        # A file's name in characters that the terminal has not must not stop a table.
        sys.stdout.reconfigure(errors="backslashreplace")
        if os.name == "nt" and not sys.stdout.isatty() and "PYTHONIOENCODING" not in os.environ:
            as_files_are(sys.stdout)


def as_files_are(stream: io.TextIOWrapper) -> None:
    """Write to a pipe what is written to files: UTF-8 and plain ends of lines."""
    stream.reconfigure(encoding="utf-8", newline="\n")


def tell(message: str) -> None:
    """Write lines to standard error; where they cannot be written the exit code has to tell."""
    try:
        click.echo(message, err=True)
    except OSError:
        abandon(sys.stderr)


def complain(message: str) -> None:
    """Write an error or a warning, on one line."""
    tell(f"sono: {printable(message)}")


def unwritten(error: OSError) -> None:
    """Say that standard output cannot be written, unless nobody reads it any more."""
    if not isinstance(error, BrokenPipeError):
        complain(f"the output cannot be written: {error.strerror or error}")
    abandon(sys.stdout)


def abandon(stream: TextIO) -> None:
    """Drop what could not be written, which is still in the buffer; Python would try again at its exit."""
    with suppress(OSError):
        os.dup2(os.open(os.devnull, os.O_WRONLY), stream.fileno())
