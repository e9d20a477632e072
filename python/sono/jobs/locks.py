"""Files that one process at a time may write, on whatever machine it runs.

In each folder there is one small file, of which a process locks a byte for each name that it is going to
write. The operating system lets go of the bytes when the process ends, however it ends, so that no lock is
ever stale; whoever uses the file last removes it.
"""

import errno
import hashlib
import os
import sys
import time
from collections.abc import Iterable
from contextlib import suppress
from pathlib import Path
from typing import Self

NAME = ".sono.lock"

TRIES, PAUSE = 5, 0.05
"""A byte that is locked is tried again, since whoever removes the file has all of it for a moment."""

_TAKEN = (errno.EACCES, errno.EAGAIN, errno.EDEADLK)


class Taken(Exception):  # noqa: N818 - no error, but what another process does
    """Another process is going to write the file `path`."""

    def __init__(self, path: str) -> None:
        """Say which."""
        super().__init__(path)
        self.path = path


class Claims:
    """The files that this process is going to write, until it leaves the context or ends."""

    def __init__(self) -> None:
        """Begin without any."""
        self._open: dict[Path, int] = {}

    def take(self, paths: Iterable[str]) -> None:
        """Claim files in folders that are there, one after the other.

        Raises `Taken` at the first that another process has, and `OSError` where nothing can be locked.
        """
        for path in paths:
            folder, name = os.path.split(os.path.realpath(path))
            place = int.from_bytes(hashlib.sha256(os.fsencode(name)).digest()[:7])
            for attempt in range(TRIES):
                if self._lock(Path(folder, NAME), place):
                    break
                if attempt + 1 == TRIES:
                    raise Taken(path)
                time.sleep(PAUSE)

    def _lock(self, file: Path, place: int) -> bool:
        """Lock a byte of a file; tell whether that was possible."""
        first = file not in self._open
        descriptor = os.open(file, os.O_RDWR | os.O_CREAT, 0o666) if first else self._open[file]
        try:
            _lock_byte(descriptor, place)
            # Nobody removes a file of which a byte is locked; it may have gone just before.
            there = not first or os.path.samestat(os.fstat(descriptor), os.stat(file))
        except OSError as error:
            if first:
                os.close(descriptor)
            if error.errno in (*_TAKEN, errno.ENOENT):
                return False
            raise
        if there:
            self._open[file] = descriptor
        else:
            os.close(descriptor)
        return there

    def __enter__(self) -> Self:
        """Return the claims."""
        return self

    def __exit__(self, *_: object) -> None:
        """Give the files up."""
        for file, descriptor in self._open.items():
            _leave(descriptor, file)
        self._open = {}


if sys.platform == "win32":
    import msvcrt

    _PLACES = 2**31 - 1
    """Bytes that can be locked there."""

    def _lock_byte(descriptor: int, place: int) -> None:
        """Lock one byte. Raises `OSError` where another process has it."""
        os.lseek(descriptor, place % _PLACES, os.SEEK_SET)
        msvcrt.locking(descriptor, msvcrt.LK_NBLCK, 1)

    def _leave(descriptor: int, file: Path) -> None:
        """Close a file, and remove it, which is refused there while somebody else uses it."""
        os.close(descriptor)
        with suppress(OSError):
            file.unlink()

else:
    import fcntl

    def _lock_byte(descriptor: int, place: int) -> None:
        """Lock one byte. Raises `OSError` where another process has it."""
        fcntl.lockf(descriptor, fcntl.LOCK_EX | fcntl.LOCK_NB, 1, place)

    def _leave(descriptor: int, file: Path) -> None:
        """Close a file, and remove it if all of it can be locked, since then nobody else uses it."""
        with suppress(OSError):
            fcntl.lockf(descriptor, fcntl.LOCK_EX | fcntl.LOCK_NB)
            file.unlink()
        os.close(descriptor)
