"""Bytes from and to disk: reading a whole file, and writing one that appears whole or not at all."""

import gzip
import os
import secrets
import shutil
import sys
import zlib
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import IO, Any

from sono.formats.vertices import FormatError

GZIP = b"\x1f\x8b"
"""What a gzip file begins with."""

UTF_16 = (b"\xff\xfe", b"\xfe\xff")
"""What a file of UTF-16 begins with."""

HEAD = 1 << 14
"""Bytes that are looked at to tell what a file is."""


def load(source: str | os.PathLike[str]) -> tuple[str, bytes]:
    """Give the name for messages and the bytes of a file, or of standard input for "-".

    What gzip has packed is unpacked. Raises `FormatError` when the file cannot be read.
    """
    name = "<stdin>" if source == "-" else os.fspath(source)
    try:
        data = sys.stdin.buffer.read() if source == "-" else Path(source).read_bytes()
    except OSError as error:
        raise FormatError(f"{name}: cannot be read: {error.strerror or error}") from error
    if not data.startswith(GZIP):
        return name, data
    try:
        return name, gzip.decompress(data)
    except (OSError, EOFError, zlib.error) as error:
        raise FormatError(f"{name}: is no whole gzip file: {error}; pack it again") from error


def head(path: str) -> bytes:
    """Give the first whole lines of a file. Raises `FormatError` when it cannot be read."""
    try:
        with open(path, "rb") as stream:
            data = stream.read(HEAD)
        if data.startswith(GZIP):
            data = zlib.decompressobj(zlib.MAX_WBITS + 16).decompress(data, HEAD)
    except (OSError, zlib.error) as error:
        raise FormatError(f"{path}: cannot be read: {error}") from error
    return data[: data.rfind(b"\n") + 1] or data


def decoded(name: str, data: bytes) -> str:
    r"""Give the text in a file's bytes; its lines end in \n. Raises `FormatError` when it is not UTF-8."""
    if data.startswith(UTF_16) or b"\0" in data[:2]:
        raise FormatError.at(name, 1, "this is UTF-16 text, or none; save it as UTF-8")
    try:
        text = data.decode("utf-8-sig")
    except UnicodeDecodeError as error:
        line = data.count(b"\n", 0, error.start) + 1
        byte = f"0x{data[error.start]:02x}"
        raise FormatError.at(
            name, line, f"byte {byte} is not UTF-8 text; give rows of x y z, or a file of another format"
        ) from error
    return text.replace("\r\n", "\n").replace("\r", "\n")


def is_stream(output: str) -> bool:
    """Tell what can be written to but not read again: standard output, a device, a pipe."""
    there = os.path.exists(output)
    return output == "-" or (there and not os.path.isfile(output) and not os.path.isdir(output))


def unpacked(path: str) -> str:
    """Return the name that a file packed by gzip has when it is unpacked."""
    return path[: -len(".gz")] if path.lower().endswith(".gz") else path


def save(target: str, content: str | bytes) -> None:
    """Write a whole file, packed if it is called .gz, or to standard output for "-". Raises `FormatError`."""
    if target == "-":
        stdout: IO[Any] = sys.stdout if isinstance(content, str) else sys.stdout.buffer
        stdout.write(content)
        stdout.flush()
        return
    data = content.encode() if isinstance(content, str) else content
    try:
        with atomic(target) as stream:
            # Without the time, so that the same curve gives the same bytes.
            stream.write(data if unpacked(target) == target else gzip.compress(data, mtime=0))
    except OSError as error:
        folder = os.path.dirname(target)
        cure = (
            "" if os.path.isdir(folder or ".") else f"; make the folder {folder} first, or name another one"
        )
        raise FormatError(f"{target}: cannot be written: {error.strerror or error}{cure}") from error


def make_folder(folder: Path) -> None:
    """Make a folder, and those that it is in. Raises `FormatError`."""
    try:
        folder.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise FormatError(f"{folder}: cannot be made: {error.strerror}") from error


def part_of(path: str | os.PathLike[str]) -> Path:
    """Return a new name for what is to replace a file, in the folder where the file itself is."""
    # Anywhere else, on another file system say, a rename would not be atomic.
    return Path(os.path.realpath(path)).with_name(f".sono-{secrets.token_hex(8)}.part")


@contextmanager
def atomic(path: str | os.PathLike[str]) -> Iterator[IO[bytes]]:
    """Open a file for writing bytes that replaces `path` only once it is complete and on the disk.

    Upon any failure `path` stays as it was and nothing is left behind. Raises `OSError`.
    """
    # A link keeps pointing where it did, and a device or a pipe is written to, never replaced.
    target = Path(os.path.realpath(path))
    if target.exists() and not target.is_file() and not target.is_dir():
        with target.open("wb") as stream:
            yield stream
        return
    part = part_of(target)
    try:
        with part.open("xb") as stream:
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
