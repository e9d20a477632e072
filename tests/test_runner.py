"""Jobs side by side: rows keep the order of the input, whoever ends first."""

import io
import threading
from collections.abc import Callable, Iterator
from dataclasses import dataclass, field

import pytest

from sono import tables
from sono.cli.runner import Batch
from sono.jobs.result import Result


@dataclass
class Slow:
    """A job that waits before each of its rows for what the test allows."""

    name: str
    rows: int
    after: threading.Event | None = None
    ended: threading.Event = field(default_factory=threading.Event)

    def results(self, show: Callable[[float, str], None]) -> Iterator[Result]:
        """Give the rows."""
        if self.after:
            assert self.after.wait(30)
        for n in range(self.rows):
            yield Result({"knot": self.name, "n": n}, f"{self.name} {n}: told at once")
        self.ended.set()


def run(work: list[Slow], jobs: int) -> list[str]:
    stream = io.StringIO()
    Batch(tables.writer("tsv", ("knot", "n"), stream), True).run(work, jobs)
    return stream.getvalue().splitlines()[1:]


@pytest.mark.parametrize("jobs", [2, 3, 64])
def test_rows_keep_the_order_of_the_input(jobs: int, capsys: pytest.CaptureFixture[str]) -> None:
    second, third = Slow("b", 2), Slow("c", 1)
    first = Slow("a", 3, after=second.ended if jobs == 2 else third.ended)
    assert run([first, second, third, Slow("none", 0), Slow("d", 1)], jobs) == [
        *("a\t0", "a\t1", "a\t2", "b\t0", "b\t1", "c\t0", "d\t0"),
    ]
    messages = capsys.readouterr().err.splitlines()
    assert messages[0] != "sono: a 0: told at once"
    assert len(messages) == 7


def test_a_table_that_cannot_be_written_ends_the_batch() -> None:
    class Full(io.StringIO):
        def write(self, text: str) -> int:
            if text.startswith("b"):
                raise OSError("No space left on device")
            return super().write(text)

    second = Slow("b", 1)
    first = Slow("a", 1, after=second.ended)
    with pytest.raises(OSError, match="No space"):
        Batch(tables.writer("tsv", ("knot", "n"), Full()), True).run([first, second], 2)
