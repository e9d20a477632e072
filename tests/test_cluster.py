"""Jobs on a Dask cluster: a real scheduler and two worker processes, one of which is killed at its work."""

import os
import signal
import subprocess
import sys
import time
from collections.abc import Callable, Iterator
from pathlib import Path

import pytest
from conftest import Sono, Spawn, vertices

from sono import tables
from sono.jobs import workers

pytest.importorskip("distributed")

QUICK = ("--trials", "1", "--set", "anneal_sweeps=5000")


def wait_for(true: Callable[[], bool], seconds: float = 60) -> None:
    end = time.monotonic() + seconds
    while not true():
        assert time.monotonic() < end, "waited too long"
        time.sleep(0.05)


class Cluster:
    """A scheduler and two workers of one thread, each a process."""

    def __init__(self, folder: Path) -> None:
        self.folder = folder
        self.address_file = folder / "scheduler.json"
        self.processes = [self.start("scheduler", "--port", "0", "--scheduler-file", str(self.address_file))]
        wait_for(self.address_file.exists)
        for _ in range(2):
            more = ("--nthreads", "1", "--no-nanny", "--scheduler-file", str(self.address_file))
            self.processes.append(self.start("worker", *more))
        from distributed import Client

        with Client(scheduler_file=str(self.address_file)) as client:  # type: ignore[no-untyped-call]
            client.wait_for_workers(2, timeout=60)
            self.address: str = client.scheduler.address

    def start(self, what: str, *arguments: str) -> subprocess.Popen[bytes]:
        command = [sys.executable, "-m", "dask", what, "--no-dashboard", "--host", "127.0.0.1", *arguments]
        with (self.folder / f"{what}.log").open("ab") as log:
            return subprocess.Popen(command, stdout=log, stderr=log, cwd=self.folder)

    def kill_a_worker(self) -> None:
        self.processes.pop().kill()

    def kill_the_scheduler(self) -> None:
        self.processes[0].kill()

    def close(self) -> None:
        for process in self.processes:
            process.kill()
            process.wait()


@pytest.fixture(scope="module")
def cluster(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Cluster]:
    cluster = Cluster(tmp_path_factory.mktemp("cluster"))
    yield cluster
    cluster.close()


@pytest.fixture
def doomed(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Cluster]:
    """A cluster of which a test may kill what it likes."""
    cluster = Cluster(tmp_path_factory.mktemp("doomed"))
    yield cluster
    cluster.close()


def rows(text: str) -> list[tables.Row]:
    Path("rows.tsv").write_text(text)
    return tables.read("rows.tsv")


def test_a_cluster_gives_what_threads_give(folder: Path, sono: Sono, cluster: Cluster) -> None:
    arguments = ("3_1.txt", "m3_1", "-", "nowhere.txt", "-n", "60,80", *QUICK)
    text = (folder / "Hopf.txt").read_text()
    far = sono(
        "tighten", *arguments, "--cluster", cluster.address, "-o", "far/", "--contacts", "far/", input=text
    )
    near = sono("tighten", *arguments, "-o", "near/", "--contacts", "near/", input=text)
    assert far.exit_code == near.exit_code == 1
    assert sorted(far.stderr.splitlines()) == sorted(near.stderr.splitlines())
    assert sorted(far.stdout.splitlines()) == sorted(near.stdout.splitlines())
    assert "nowhere.txt: cannot be read" in far.stderr
    names = sorted(os.listdir("near"))
    assert sorted(os.listdir("far")) == names
    assert len(names) == 12
    assert all(vertices(folder / "far" / name) == vertices(folder / "near" / name) for name in names)
    again = sono(
        "tighten", *arguments[:2], *arguments[4:], "--cluster", cluster.address, "-o", "far/", "--resume"
    )
    assert again.exit_code == 0
    assert len(rows(again.stdout)) == 4


def test_a_search_is_the_same_on_a_cluster(sono: Sono, cluster: Cluster) -> None:
    arguments = (
        "search",
        "3_1",
        "--trials",
        "2",
        "--columns",
        "knot,n,l_a,hits,variant",
    )
    far = sono(*arguments, "--cluster", cluster.address, "-o", "far.txt")
    assert far.exit_code == 0
    assert far.stdout == sono(*arguments, "-o", "near.txt").stdout
    assert vertices(Path("far.txt")) == vertices(Path("near.txt"))


@pytest.mark.slow
def test_a_killed_worker_loses_nothing(folder: Path, spawn: Spawn, doomed: Cluster) -> None:
    knots = ["3_1", "4_1", "5_1", "5_2", "6_1", "6_2"]
    process = spawn(
        "tighten", *knots, "-n", "100", "--trials", "2", "--cluster", doomed.address, "-o", "out/"
    )
    wait_for(lambda: any((folder / "out").glob("*.txt")))
    doomed.kill_a_worker()
    output, messages = process.communicate(timeout=300)
    assert process.returncode == 0, messages
    found = rows(output)
    assert sorted(str(row["knot"]) for row in found) == knots
    assert {row["status"] for row in found} == {"tight"}
    assert sorted(path.name for path in (folder / "out").iterdir()) == [f"{knot}.n100.txt" for knot in knots]


@pytest.mark.slow
def test_a_lost_cluster_leaves_the_best(folder: Path, spawn: Spawn, doomed: Cluster) -> None:
    process = spawn("search", "3_1", "--time-limit", "600", "--cluster", doomed.address)
    wait_for((folder / "3_1.tight.txt").exists)
    doomed.kill_the_scheduler()
    output, messages = process.communicate(timeout=120)
    assert process.returncode == 1
    assert "sono: 3_1: the cluster was lost; the best of" in messages
    assert rows(output)[0]["status"] == "stopped"
    assert vertices(folder / "3_1.tight.txt")


@pytest.mark.slow
def test_ctrl_c_leaves_the_cluster(folder: Path, spawn: Spawn, cluster: Cluster) -> None:
    process = spawn("search", "3_1", "--time-limit", "600", "--cluster", cluster.address)
    wait_for((folder / "3_1.tight.txt").exists)
    process.send_signal(signal.SIGINT)
    output, messages = process.communicate(timeout=60)
    assert process.returncode == 130
    assert "interrupted" in messages
    assert rows(output)[0]["status"] == "stopped"


def test_no_scheduler(sono: Sono, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(workers, "PATIENCE", 0.5)
    result = sono("tighten", "3_1", "--cluster", "tcp://127.0.0.1:1")
    assert result.exit_code == 2
    assert "tcp://127.0.0.1:1: no Dask scheduler answers there" in result.stderr


def test_no_checkpoints_on_a_cluster(sono: Sono) -> None:
    result = sono("tighten", "3_1", "--cluster", "tcp://127.0.0.1:1", "--checkpoint", "kept")
    assert result.exit_code == 2
    assert "--resume keeps what is finished" in result.stderr
