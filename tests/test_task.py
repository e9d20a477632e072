"""Jobs of a batch: rows as they come, checkpoints as they should be, disks full at the worst time."""

import errno
from collections import Counter
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from sono import formats, starts
from sono._core import PanicError
from sono.formats import FormatError
from sono.jobs import checkpoints, curvefiles, task
from sono.jobs import tighten as batch
from sono.jobs.sources import Source
from sono.jobs.tighten import Job
from sono.tightening import Progress, Run, Stopped
from sono.tightening.plan import Stage
from sono.tightening.targets import Target

pytestmark = pytest.mark.usefixtures("slices")

QUICK = {"anneal_sweeps": 5000, "seed": 0}


@pytest.fixture
def job(folder: Path) -> Job:
    """A job with two targets and a checkpoint."""
    outputs: dict[Target, str] = {40: "40.txt", 60: "60.txt"}
    return Job(Source("3_1.txt"), "knot", outputs, QUICK, trials=2, checkpoint=Path("knot.json"))


@pytest.fixture(scope="module")
def whole(tmp_path_factory: pytest.TempPathFactory) -> dict[Target, bytes]:
    """What the files hold that the job writes when nothing stops it."""
    made = tmp_path_factory.mktemp("whole")
    formats.write(made / "3_1.txt", starts.start("3_1"))
    outputs: dict[Target, str] = {n: str(made / f"{n}.txt") for n in (40, 60)}
    list(batch.run(Job(Source(str(made / "3_1.txt")), "knot", outputs, QUICK, trials=2), nothing))
    return {n: Path(path).read_bytes() for n, path in outputs.items()}


def nothing(progress: Progress) -> None:
    """Watch a run, and let it go on."""


class StopAt:
    """Stops a run at the first look in a certain stage on the way to a certain n."""

    def __init__(self, stage: str, target: int) -> None:
        self.where = (stage, target)

    def __call__(self, progress: Progress) -> None:
        if (progress.stage, progress.target) == self.where:
            raise Stopped("enough")


def test_rows_come_when_their_files_are_written(job: Job) -> None:
    results = batch.run(job, nothing)
    first = next(results)
    assert first.row
    assert (first.row["n"], first.row["file"], first.row["status"], first.trouble) == (
        40,
        "40.txt",
        "tight",
        None,
    )
    assert Path("40.txt").exists()
    assert not Path("60.txt").exists()
    assert [result.row and result.row["n"] for result in results] == [60]
    assert not Path("knot.json").exists()


def test_a_shape_of_edges_that_are_short_enough_serves_the_next_n(job: Job) -> None:
    fine = replace(job, outputs={60: "60.txt", 120: "120.txt"})
    results = list(batch.run(fine, StopAt("collapse", 120)))
    assert [result.row and result.row["status"] for result in results] == ["tight", "tight"]
    assert [result.note is None for result in results] == [False, True]


@pytest.mark.parametrize(
    ("stage", "target"), [("collapse", 40), ("trial", 40), ("polish", 40), ("anneal", 60), ("polish", 60)]
)
def test_resumed_after_any_stage(job: Job, whole: dict[Target, bytes], stage: str, target: int) -> None:
    *_, last = batch.run(job, StopAt(stage, target))
    assert last.trouble
    assert last.trouble.startswith("knot: enough; the best state so far, n = ")
    assert last.trouble.endswith(f"is in {target}.best.txt; --resume goes on from here")
    rows = [result.row for result in batch.run(replace(job, resume=True), nothing)]
    assert [row and row["status"] for row in rows] == ["tight", "tight"]
    assert {n: Path(f"{n}.txt").read_bytes() for n in job.outputs} == whole


def test_a_failed_trial_is_not_forgotten(job: Job, monkeypatch: pytest.MonkeyPatch) -> None:
    begin = Run._engine

    def engine(self: Run, stage: Stage, n: int) -> Any:
        if stage == "trial" and self.plan.shapes:
            raise PanicError("index out of bounds")
        return begin(self, stage, n)

    monkeypatch.setattr(Run, "_engine", engine)
    job = replace(job, outputs={60: "60.txt"})
    list(batch.run(job, StopAt("polish", 60)))
    (result,) = batch.run(replace(job, resume=True), nothing)
    assert result.row
    assert (result.row["trials"], result.row["status"]) == (2, "tight")
    assert result.note
    assert "1 trials at n = 60" in result.note
    assert "1 failed: index out of bounds" in result.note


def test_killed_between_result_and_checkpoint(job: Job) -> None:
    next(batch.run(job, nothing))
    assert Path("knot.json").exists()
    written = Path("40.txt").read_bytes()
    rows = [result.row for result in batch.run(replace(job, resume=True), nothing)]
    assert [row and row["n"] for row in rows] == [40, 60]
    assert Path("40.txt").read_bytes() == written


def test_a_lost_result_is_made_again(job: Job) -> None:
    list(batch.run(job, StopAt("polish", 60)))
    written = Path("40.txt").read_bytes()
    Path("40.txt").unlink()
    assert all(result.trouble is None for result in batch.run(replace(job, resume=True), nothing))
    assert Path("40.txt").read_bytes() == written


@pytest.mark.slow
def test_checkpoints_follow_the_run(job: Job, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(task, "SAVE_EVERY", 0)
    stages = set()

    def look(progress: Progress) -> None:
        plan = checkpoints.load(Path("knot.json"), task.KIND)["run"]["plan"]
        stages.add(plan["trial"]["stage"] if plan["trial"] else plan["rungs"][0][0])

    list(batch.run(job, look))
    assert {"collapse", "anneal", "trial", "polish"} <= stages


@contextmanager
def full(path: Any) -> Iterator[None]:
    """Stands in for `atomic` on a full disk."""
    raise OSError(errno.ENOSPC, "No space left on device")
    yield


def make_disk(monkeypatch: pytest.MonkeyPatch, write: Any) -> None:
    for module in (formats, formats.files):
        monkeypatch.setattr(module, "atomic", write)


def test_a_disk_that_fills_up(job: Job, monkeypatch: pytest.MonkeyPatch) -> None:
    def fill_and_stop(progress: Progress) -> None:
        if progress.target == 60:
            make_disk(monkeypatch, full)
            StopAt("polish", 60)(progress)

    first, second = batch.run(job, fill_and_stop)
    assert first.trouble is None
    assert second.row
    assert (second.row["status"], second.row["file"]) == ("stopped", None)
    assert second.trouble == (
        "knot: enough; 60.best.txt: cannot be written: No space left on device"
        "; knot.json: cannot be written: No space left on device"
    )
    assert Path("knot.json").exists()  # as it was at the beginning
    monkeypatch.undo()


@pytest.mark.slow
def test_a_disk_that_is_full_for_a_while(job: Job, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(task, "SAVE_EVERY", 0)

    with_room = formats.atomic

    def full_during_the_anneal(progress: Progress) -> None:
        make_disk(monkeypatch, full if progress.stage == "anneal" else with_room)

    assert [result.trouble for result in batch.run(job, full_during_the_anneal)] == [None, None]


def test_too_entangled_a_curve_fails_as_a_whole(job: Job) -> None:
    formats.write("3_1.txt", [np.random.default_rng(0).normal(size=(1200, 3))])
    (result,) = batch.run(job, nothing)
    assert result.row is None
    assert result.trouble
    assert result.trouble.startswith("3_1.txt: the curve is so entangled that")


def test_the_row_of_a_coarse_rope_is_one_for_the_next(job: Job) -> None:
    few, enough = batch.run(replace(job, outputs={12: "12.txt", 60: "60.txt"}), nothing)
    assert few.row is None
    assert few.trouble
    assert "12 vertices are too few" in few.trouble
    assert enough.trouble is None
    assert not Path("12.txt").exists()


def test_files_of_a_job(job: Job) -> None:
    assert job.files() == ["40.txt", "60.txt", "knot.json"]
    assert Job(Source("-"), "stdin", {40: "-"}, QUICK).files() == []


def test_measured_says_where(folder: Path) -> None:
    formats.write("crossing.txt", [np.array([[0, 0, 0], [2, 2, 0], [2, 0, 0], [0, 2, 0]])], ["8"])
    with pytest.raises(FormatError, match=r"^crossing\.txt:2: the curve crosses itself"):
        curvefiles.measured("crossing.txt")


def test_100_000_vertices(folder: Path) -> None:
    t = 2 * np.pi * np.arange(100_000) / 100_000
    rho = 2 + 0.8 * np.cos(3 * t)
    knot = np.column_stack([rho * np.cos(2 * t), rho * np.sin(2 * t), 0.8 * np.sin(3 * t)])
    formats.write("fine.txt", [knot])
    _, measures = curvefiles.measured("fine.txt")
    assert measures.n == 100_000
    (result,) = batch.run(Job(Source("fine.txt"), "fine", {60: "60.txt"}, QUICK), nothing)
    assert result.row
    assert result.row["status"] == "tight"


@pytest.mark.parametrize("name", ["circle", "triangle"])
def test_the_simplest_curves(folder: Path, name: str) -> None:
    triangle = [np.array([[0.0, 0, 0], [1, 0, 0], [0, 1, 0]])]
    formats.write("flat.txt", starts.start("unknot") if name == "circle" else triangle)
    (result,) = batch.run(Job(Source("flat.txt"), name, {40: "40.txt"}, QUICK), nothing)
    assert result.trouble is None
    assert result.row
    assert result.row["l_p"] == pytest.approx(2 * np.pi, rel=0.01)


def test_ends_that_disagree_are_told() -> None:
    assert "sono search" in task._disagreement(Counter({"95.1": 2, "94.7": 1, "101.2": 4}))
    assert task._disagreement(Counter({"95.1": 1, "94.7": 2})) == ""
    assert task._disagreement(Counter({"94.7": 1})) == ""
    assert task._disagreement(Counter()) == ""
