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
            _lock_bytes(descriptor, place, 1)
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
            with suppress(OSError):  # somebody else still uses it
                _lock_bytes(descriptor, 0, 0)
                file.unlink()
            os.close(descriptor)
        self._open = {}


if sys.platform == "win32":
    import msvcrt

    def _lock_bytes(descriptor: int, place: int, count: int) -> None:
        """Lock so many bytes, 0 being all that follow. Raises `OSError` where another process has one."""
        os.lseek(descriptor, place, os.SEEK_SET)
        msvcrt.locking(descriptor, msvcrt.LK_NBLCK, count or 2**31 - 1)

else:
    import fcntl

    def _lock_bytes(descriptor: int, place: int, count: int) -> None:
        """Lock so many bytes, 0 being all that follow. Raises `OSError` where another process has one."""
        fcntl.lockf(descriptor, fcntl.LOCK_EX | fcntl.LOCK_NB, count, place)
