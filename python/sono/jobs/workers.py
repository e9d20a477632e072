"""Where the trials of a search, or whole jobs, are done: threads of this machine, or a Dask cluster.

Both give the same results, since what they do are pure functions.
"""

import threading
from collections.abc import Callable
from concurrent.futures import CancelledError, Future, ThreadPoolExecutor
from contextlib import suppress
from heapq import heappop, heappush
from itertools import count as counting
from types import TracebackType
from typing import Any, Protocol, Self, TypeVar, cast

from sono.patience import awaited
from sono.tightening import Stopped

Result = TypeVar("Result")

POLL = 0.2
"""Seconds between two looks whether to stop waiting for the cluster."""

PATIENCE = 10
"""Seconds to wait for a scheduler to answer."""


class Workers(Protocol):
    """Do functions elsewhere."""

    count: int

    def submit(
        self, function: Callable[..., Result], *args: Any, watch: Callable[[], None], rank: int = 0
    ) -> Callable[[], Result]:
        """Begin a function; what is returned waits for its result. It raises `Stopped` if they are lost.

        Of what has not begun that of the least `rank` comes first. `watch` is called about ten times a second
        meanwhile; what it raises ends the work and the waiting.
        """


class Threads:
    """Threads of this process, as Rust releases the interpreter; functions get `watch` as last argument."""

    def __init__(self, count: int) -> None:
        """Keep so many threads."""
        self.count = count
        self.pool = ThreadPoolExecutor(count)
        self.lock = threading.Lock()
        self.order = counting()
        self.waiting: list[tuple[int, int, Callable[[], Any], Future[Any]]] = []

    def submit(
        self, function: Callable[..., Result], *args: Any, watch: Callable[[], None], rank: int = 0
    ) -> Callable[[], Result]:
        """Have a free thread do a function."""

        def call() -> Result:
            watch()  # it may be over before it has begun
            return function(*args, watch)

        future: Future[Result] = Future()
        with self.lock:
            heappush(self.waiting, (rank, next(self.order), call, future))
        self.pool.submit(self._do_the_next)
        return lambda: awaited(future, watch)

    def _do_the_next(self) -> None:
        with self.lock:
            _, _, call, future = heappop(self.waiting)
        try:
            future.set_result(call())
        except BaseException as error:
            future.set_exception(error)

    def __enter__(self) -> Self:
        """Return the workers."""
        return self

    def __exit__(self, *_: object) -> None:
        """Forget what has not begun."""
        self.pool.shutdown(wait=False, cancel_futures=True)


class Cluster:
    """The workers of a Dask scheduler, each of which needs this version of sono.

    A task whose worker is lost is done again by another one, up to three times unless the scheduler is
    configured otherwise (`distributed.scheduler.allowed-failures`).
    """

    def __init__(self, address: str) -> None:
        """Connect to a scheduler. Raises `ValueError` if there is none, or no dask.distributed."""
        try:
            from distributed import Client
        except ImportError:
            raise ValueError("a cluster needs an extra: pip install 'sono[cluster]'") from None
        try:
            self.client = cast(Any, Client(address, timeout=PATIENCE))  # type: ignore[no-untyped-call]
        except (OSError, ValueError) as error:
            raise ValueError(f"{address}: no Dask scheduler answers there: {error}") from error
        threads: dict[str, int] = self.client.nthreads()
        self.count = max(sum(threads.values()), 1)

    def submit(
        self, function: Callable[..., Result], *args: Any, watch: Callable[[], None], rank: int = 0
    ) -> Callable[[], Result]:
        """Begin a function on some worker."""
        from distributed.comm.core import CommClosedError

        future = self.client.submit(function, *args, pure=False, priority=-rank)

        def wait() -> Result:
            try:
                while True:
                    with suppress(TimeoutError):
                        result: Result = future.result(timeout=POLL)
                        return result
                    watch()
            except (CommClosedError, CancelledError) as error:  # nobody else cancels it
                raise Stopped("the cluster was lost") from error
            except BaseException as error:
                future.cancel()
                if isinstance(error, OSError):  # here it would mean that standard output is full
                    raise RuntimeError(f"on the cluster: {error}") from error
                raise

        return wait

    def __enter__(self) -> Self:
        """Return the workers."""
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        """Leave the scheduler."""
        self.client.close()
