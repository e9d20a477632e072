"""Bytes from and to disk: reading a whole text, and writing one that appears whole or not at all."""

import os
import secrets
import shutil
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import TextIO

from sono.formats.vertices import FormatError


def load(source: str | os.PathLike[str]) -> tuple[str, str]:
    r"""Give the name for messages and the text of a file, or of standard input for "-"; its lines end in \n.

    Raises `FormatError` when the file cannot be read or is not UTF-8.
    """
    name = "<stdin>" if source == "-" else os.fspath(source)
    try:
        data = sys.stdin.buffer.read() if source == "-" else Path(source).read_bytes()
    except OSError as error:
        raise FormatError(f"{name}: cannot be read: {error.strerror or error}") from error
    try:
        text = data.decode("utf-8-sig")
    except UnicodeDecodeError as error:
        line = data.count(b"\n", 0, error.start) + 1
        byte = f"0x{data[error.start]:02x}"
        raise FormatError.at(
            name, line, f"byte {byte} is not UTF-8 text; give rows of x y z or an ASCII VECT file"
        ) from error
    return name, text.replace("\r\n", "\n").replace("\r", "\n")


def is_stream(output: str) -> bool:
    """Tell what can be written to but not read again: standard output, a device, a pipe."""
    there = os.path.exists(output)
    return output == "-" or (there and not os.path.isfile(output) and not os.path.isdir(output))


def save(target: str, content: str) -> None:
    """Write a whole text to a file, or to standard output for "-". Raises `FormatError`."""
    if target == "-":
        sys.stdout.write(content)
        sys.stdout.flush()
        return
    try:
        with atomic_text(target) as stream:
            stream.write(content)
    except OSError as error:
        raise FormatError(f"{target}: cannot be written: {error.strerror or error}") from error


def part_of(path: str | os.PathLike[str]) -> Path:
    """Return a new name for what is to replace a file, in the folder where the file itself is."""
    # Anywhere else, on another file system say, a rename would not be atomic.
    return Path(os.path.realpath(path)).with_name(f".sono-{secrets.token_hex(8)}.part")


@contextmanager
def atomic_text(path: str | os.PathLike[str]) -> Iterator[TextIO]:
    """Open a text file for writing that replaces `path` only once it is complete and on the disk.

    Upon any failure `path` stays as it was and nothing is left behind. Raises `OSError`.
    """
    # A link keeps pointing where it did, and a device or a pipe is written to, never replaced.
    target = Path(os.path.realpath(path))
    if target.exists() and not target.is_file() and not target.is_dir():
        with target.open("w", encoding="utf-8", newline="\n") as stream:
            yield stream
        return
    part = part_of(target)
    try:
        with part.open("x", encoding="utf-8", newline="\n") as stream:
            yield stream
            stream.flush()
            os.fsync(stream.fileno())
        if target.exists():
            shutil.copymode(target, part)
        part.replace(target)
    except OSError as error:
        if error.filename == str(part):  # the user knows nothing of this name
            raise OSError(error.errno, error.strerror, os.fspath(path)) from error
        raise
    finally:
        part.unlink(missing_ok=True)
