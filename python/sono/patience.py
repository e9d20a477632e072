"""Waiting with an eye on the clock: long calls go to a thread of their own, and who waits for them may leave.

Most calls into the core take a slice of a tenth of a second, but some cannot be divided: on 200,000 vertices
beginning an engine or a Newton step takes seconds.
"""

import time
from collections.abc import Callable
from concurrent.futures import Future, ThreadPoolExecutor, wait
from typing import TypeVar

Result = TypeVar("Result")

LOOK = 0.1
"""Seconds between two looks while waiting."""

GRACE = 0.2
"""Seconds that a call gets to end by itself when nobody waits for it any longer."""


def patiently(call: Callable[[], Result], look: Callable[[], None] = lambda: None) -> Result:
    """Return what a call returns, and meanwhile look round.

    What `look` raises ends the waiting, and so does Ctrl-C; the call itself goes on until it is done.
    """
    pool = ThreadPoolExecutor(1)
    try:
        return awaited(pool.submit(call), look)
    finally:
        pool.shutdown(wait=False)


def within(seconds: float, call: Callable[[], Result]) -> Result | None:
    """Return what a call returns, or None if it takes longer."""
    end = time.monotonic() + seconds

    def look() -> None:
        if time.monotonic() > end:
            raise TimeoutError

    try:
        return patiently(call, look)
    except TimeoutError:
        return None


def awaited(future: "Future[Result]", look: Callable[[], None]) -> Result:
    """Wait for the result of a call under way, in the same manner."""
    try:
        while not wait([future], timeout=LOOK).done:
            look()
    except BaseException:
        wait([future], timeout=GRACE)
        raise
    return future.result()
