"""One file of a batch: read, tighten, write each result as it is ready, keep the rest when stopped."""

import hashlib
import json
import math
import os
import re
import tempfile
import time
from collections import Counter
from collections.abc import Callable, Iterator
from contextlib import suppress
from dataclasses import dataclass, field, replace
from functools import partial
from itertools import chain, count, islice
from pathlib import Path
from typing import Any

from sono import formats
from sono._core import CurveError, Measures, PanicError
from sono.formats import FormatError, VertexFile, is_stream
from sono.invariants.identify import fingerprint
from sono.jobs import checkpoints, contacts, sources
from sono.jobs.workers import Workers
from sono.tables import Row, printable
from sono.tightening.run import (
    TRIALS,
    KnotTypeError,
    Method,
    Progress,
    Run,
    Stopped,
    Tight,
    default_settings,
    forces,
    measure,
)

KIND = "tightening"
"""What checkpoints of this module call themselves."""

SAVE_EVERY = 10.0
"""Seconds between two checkpoints."""

UNFINISHED = 100
"""Unfinished ropes beside an output that are looked for, to be removed when it is tight,"""

SUPERSEDED = 1e-4
"""unless their L_c is shorter by more than this share."""

GROWTH = 1.15
"""By this factor at most, as far as is known, a rope with an L_c is longer than one too coarse for it."""

TIGHT, SETTLED, STUCK, STOPPED = "tight", "settled", "stuck", "stopped"
"""What became of a rope: forces in balance, SONO's tolerance reached, neither, or not yet."""

PHYSICS = ("residual", "mu", "excess")
"""What the polish alone can tell."""

KEPT_RESIDUAL = 1e-6
"""Residual up to which a file counts as a tight rope. Fitted to vertices alone it is seldom below 1e-7:
contacts just out of touch, which at mu = 1e-11 bear that much, are left out."""


@dataclass(frozen=True)
class Job:
    """Tighten the curve in `source` ("-" is standard input) at each n of `outputs`.

    `name` is the curve's name in tables. `outputs` says where the vertices for each n go, and `forces` where
    those between them, if they are wanted; "-" is standard output. `time_limit` is in seconds. `checkpoint`
    is the file that keeps the state of the run. With `resume` a run goes on from its checkpoint, and outputs
    that are there are not computed again.
    """

    source: str
    name: str
    outputs: dict[int, str]
    settings: dict[str, Any]
    method: Method = "both"
    trials: int = TRIALS
    forces: dict[int, str] = field(default_factory=dict)
    time_limit: float | None = None
    checkpoint: Path | None = None
    resume: bool = False

    def files(self) -> list[str]:
        """Return the files that the job writes."""
        paths = [*self.outputs.values(), *self.forces.values()]
        outputs = [path for path in paths if not is_stream(path)]
        return [*outputs, os.fspath(self.checkpoint)] if self.checkpoint else outputs

    def results(self, show: Callable[[float, str], None]) -> "Iterator[Result]":
        """Do the job, giving each row when its vertices are on the disk.

        `show` is told how far the run is, from 0 to 1, and what it does; it may raise `Stopped`.
        """
        return run(self, partial(_told, show))

    def sent_to(self, workers: Workers) -> "SentJob":
        """Return the same job, to be done elsewhere."""
        return SentJob(self, workers)


@dataclass(frozen=True)
class SentJob:
    """A job whose computing is done by `workers`, perhaps on other machines; its files stay here."""

    job: Job
    workers: Workers

    @property
    def name(self) -> str:
        """The knot's name in tables."""
        return self.job.name

    def results(self, show: Callable[[float, str], None]) -> "Iterator[Result]":
        """Do the job, giving its rows when all of it has come back. `show` may raise `Stopped`."""
        job = self.job
        try:
            content = formats.load(job.source) if not sources.is_name(job.source) else None
            file = formats.parse(*content) if content else sources.read(job.source)
            kept = [n for n, output in job.outputs.items() if job.resume and os.path.isfile(output)]
            for n in kept:
                yield _kept(job, file, n)
            outputs = {n: output for n, output in job.outputs.items() if n not in kept}
            if not outputs:
                return
            sent = replace(job, outputs=outputs, resume=False)
            free = {path: free_name(path) for path in outputs.values()}
            waiting = self.workers.submit(_away, sent, content, free, watch=lambda: show(0, "on the cluster"))
            results, texts = waiting()
        except FormatError as error:
            yield Result(None, str(error))
            return
        except Stopped as why:
            yield Result(None, f"{job.name}: {why}; what the cluster had done of it is lost")
            return
        unwritten = set()
        for path, text in texts.items():
            try:
                formats.save(path, text)
            except FormatError as error:
                unwritten.add(path)
                yield Result(None, str(error))
        for result in results:
            lost = result.row and result.row["file"] in unwritten
            yield replace(result, row={**result.row, "file": None}) if result.row and lost else result


@dataclass(frozen=True)
class Result:
    """A row of the table, if there is one, and what the user should hear: `trouble`, or else a `note`.

    `trouble` is None if all that was asked for was done.
    """

    row: Row | None
    trouble: str | None = None
    note: str | None = None


def measured(source: str) -> tuple[VertexFile, Measures]:
    """Read and measure a curve file. Raises `FormatError` naming file and line."""
    file = formats.read(source)
    try:
        return file, measure(file.components)
    except CurveError as error:
        raise _located(error, file) from error


def as_row(name: str, file: str | None, measures: Measures, **more: Any) -> Row:
    """Make a row of the table."""
    keys = (key for key in dir(measures) if not key.startswith("_"))
    return {"knot": name, "file": file, **{key: getattr(measures, key) for key in keys}, **more}


def run(job: Job, watch: Callable[[Progress], None]) -> Iterator[Result]:
    """Do a job, giving each row when its vertices are on the disk; `watch` may raise `Stopped`."""
    try:
        file = sources.read(job.source)
        yield from (Result(None, note=doubt) for doubt in file.doubts())
        kept = [n for n, output in job.outputs.items() if job.resume and os.path.isfile(output)]
        for n in kept:
            yield _kept(job, file, n)
        if todo := set(job.outputs) - set(kept):
            yield from _Task(job, file, todo).results(watch)
    except FormatError as error:
        yield Result(None, str(error))


def _away(
    job: Job, content: tuple[str, str] | None, free: dict[str, str]
) -> "tuple[list[Result], dict[str, str]]":
    """Do a job far from its files: give its results, and what is to be written to them.

    `content` is the name and the text of its source, if that is a file; `free` says for each output where an
    unfinished rope is to go.
    """
    with tempfile.TemporaryDirectory() as folder:
        here: dict[str, str] = {}

        def moved(path: str) -> str:
            suffix = "" if path == "-" else Path(path).suffix
            temporary = os.path.join(folder, f"{len(here)}{suffix}")
            here[temporary] = path
            here[free_name(temporary)] = free.get(path, path)
            return temporary

        source = moved(content[0]) if content else job.source
        if content:
            formats.save(source, content[1])
        outputs = {n: moved(path) for n, path in job.outputs.items()}
        between = {n: moved(path) for n, path in job.forces.items()}
        done = [
            _named(result, here)
            for result in run(replace(job, source=source, outputs=outputs, forces=between), lambda _: None)
        ]
        written = [path for path in here if path != source and os.path.exists(path)]
        return done, {here[path]: formats.load(path)[1] for path in written}


def _named(result: "Result", names: dict[str, str]) -> "Result":
    """Put the files' own names into a result."""

    def named(text: Any) -> Any:
        for path, name in names.items():
            text = text.replace(path, name) if isinstance(text, str) else text
        return text

    row = result.row and {key: named(value) for key, value in result.row.items()}
    return Result(row, named(result.trouble), named(result.note))


def _told(show: Callable[[float, str], None], progress: Progress) -> None:
    status = progress.status
    if status is None:
        show(0, f"{progress.stage} n {progress.n}/{progress.target}")
        return
    trial = f"trial {progress.trial} " if progress.stage in ("collapse", "anneal", "trial") else ""
    what = f"{trial}{progress.stage} n {progress.n}/{progress.target} L_p {status.best.l_p:.5f}"
    show(status.progress, what)


def _kept(job: Job, file: VertexFile, n: int) -> Result:
    """Give the row of an output that is there from an earlier run of the same job."""
    output = job.outputs[n]
    try:
        rope, measures = measured(output)
        if measures.n != n:
            raise FormatError(f"{output}: has {measures.n} vertices, not n = {n}; move it away")
        comments = formats.load(output)[1].splitlines()
        if f"# {_origin(job, file)}" not in comments:
            other = "is of another curve, method or setting"
            raise FormatError(f"{output}: {other}; repeat those or move it away, or --force starts anew")
        if f"# {_figures(measures)}" not in comments:
            raise FormatError(f"{output}: is not as it was written; move it away, or --force starts anew")
        fitted = None if job.method == "sono" else forces(rope.components)
        if fitted and n in job.forces and not os.path.isfile(job.forces[n]):
            contacts.write(job.forces[n], rope.components, fitted)
    except FormatError as error:
        return Result(None, str(error))
    good = max(measures.dispersion, abs(1 - measures.r_s)) <= _tolerance(job)
    if fitted is None:
        return _judged(job, _rope_row(job, output, measures, SETTLED if good else STUCK))
    # Only the run itself could tell that mu was reached; that it says so is checked as far as may be.
    good = good and says_tight(output) and fitted.residual <= KEPT_RESIDUAL
    row = _rope_row(job, output, measures, TIGHT if good else STUCK, residual=fitted.residual)
    return _judged(job, row)


def says_tight(output: str) -> bool:
    """Tell whether the header of a written file says that the polish reached its end."""
    return says(output, TIGHT)


def says(output: str, status: str) -> bool:
    """Tell whether the header of a written file gives the rope this status."""
    header = re.compile(rf"^# .*: {status}, rope radius R_s = 1$", re.MULTILINE)
    return header.search(formats.load(output)[1]) is not None


class _Task:
    """A job under way: its run, and the checkpoint that keeps it."""

    def __init__(self, job: Job, file: VertexFile, todo: set[int]) -> None:
        """Begin, or go on from the checkpoint. Raises `FormatError`."""
        self.job = job
        self.file = file
        self.todo = todo
        self.identity = [_origin(job, file), *job.outputs]
        self.told: list[str] = []
        self.failed: dict[int, str] = {}
        self.run = self.restored() or self.begun()
        self.end = time.monotonic() + (job.time_limit or math.inf)

    def results(self, watch: Callable[[Progress], None]) -> Iterator[Result]:
        """Tighten at each n in turn. Raises `FormatError` if the curve cannot be tightened at all."""
        for known in self.failed.values():  # from before the run was stopped
            yield Result(None, known)
        try:  # at once, so that it is known before hours are spent
            self.save()
        except FormatError as error:
            yield Result(None, f"{error}; it goes on without a checkpoint")
        while self.run.targets:
            n = self.run.targets[0]
            try:
                tight = self.run.tighten(partial(self.look, watch))
            except Stopped as stopped:
                yield self.stopped(str(stopped))
                return
            except CurveError as error:
                trouble = _located(error, self.file)
                if error.needed is None:
                    raise trouble from error
                yield self.out_of_reach(n, str(trouble))
            except PanicError as error:
                yield self.out_of_reach(n, f"{self.job.name}: n = {n}: {_as_bug(error)}")
            except KnotTypeError as error:
                yield self.out_of_reach(n, f"{self.job.name}: n = {n}: {error}")
            else:
                if n in self.todo:
                    reached = SETTLED if self.job.method == "sono" else TIGHT
                    row, unwritten = self.deliver(n, tight, reached if tight.converged else STUCK)
                    if unwritten:
                        yield Result(row, unwritten + self.way_on())
                        return
                    self.tidy(self.job.outputs[n], tight)
                    yield _judged(self.job, row, self.noted(tight))
            self.run.next_target()
        if self.job.checkpoint:
            with suppress(OSError):
                self.job.checkpoint.unlink(missing_ok=True)

    def look(self, watch: Callable[[Progress], None], progress: Progress) -> None:
        """Between two slices, or while one takes longer: show, stop or save the run."""
        watch(progress)
        now = time.monotonic()
        if now > self.end:
            raise Stopped(f"the time limit of {self.job.time_limit:g} s was reached")
        if now > self.saved + SAVE_EVERY and self.run.at_rest:
            with suppress(FormatError):  # a full disk may have room again before the run is stopped
                self.save()

    def out_of_reach(self, n: int, trouble: str) -> Result:
        """Remember why there is no rope of n vertices."""
        self.failed[n] = trouble
        return Result(None, trouble)

    def stopped(self, why: str) -> Result:
        """Write the best state of the run. Raises `FormatError` for a curve that is none."""
        try:
            best = self.run.best()
        except CurveError as error:  # nobody had looked at it yet
            raise _located(error, self.file) from error
        output = free_name(self.job.outputs[self.run.targets[0]])
        row, unwritten = self.deliver_to(output, best, STOPPED)
        place = unwritten or f"the best state so far, n = {best.measures.n}, is in {output}"
        return Result(row, f"{self.job.name}: {why}; {place}{self.way_on()}")

    def noted(self, tight: Tight) -> str | None:
        """Say what the row does not: once for all n of a shape how it was found, and why there is no L_c."""
        tried = self.tried(tight)
        notes = [] if tried == self.told else tried
        self.told = tried
        measures = tight.measures
        if measures.l_c is None:
            enough = math.ceil(GROWTH * measures.l_p / (math.sqrt(2) * measures.r_s))
            notes += [
                f"edges of {measures.dl / measures.r_s:.3f} radii are too long for an inscribed knot; "
                f"about {enough} vertices have an L_c"
            ]
        return f"{self.job.name}: {'; '.join(notes)}" if notes else None

    def tried(self, tight: Tight) -> list[str]:
        """Say how the curve was made ready, which shapes the trials found, and which of them failed."""
        notes = []
        if tight.loosened:
            notes += ["as it is the curve holds only a thin rope; it was loosened first, by isotopic moves"]
        if len(tight.shapes) + len(tight.failed) > 1:
            found = Counter(f"{length:.4f}" for length in sorted(tight.shapes))
            hits = ", ".join(f"{length} ({times} of them)" for length, times in found.items())
            trials = f"{len(tight.shapes)} trials at n = {sum(map(len, self.run.shape or []))}"
            lost = "".join(f"; {times} failed: {why}" for why, times in Counter(tight.failed).items())
            length = "L_p" if self.run.shape and measure(self.run.shape).l_a is None else "L_a"
            notes += [f"{trials} ended at {length} {hits}; the best was taken{lost}"]
        return notes

    def deliver(self, n: int, tight: Tight, status: str) -> tuple[Row, str | None]:
        """Write what was asked for at n."""
        row, unwritten = self.deliver_to(self.job.outputs[n], tight, status)
        if unwritten is None and n in self.job.forces and tight.forces:
            try:
                contacts.write(self.job.forces[n], tight.curve, tight.forces)
            except FormatError as error:
                unwritten = str(error)
        return row, unwritten

    def deliver_to(self, output: str, tight: Tight, status: str) -> tuple[Row, str | None]:
        """Write vertices and measure what was written; if that fails, say why, and measure what there is."""
        measures, unwritten = tight.measures, None
        try:
            formats.write(output, tight.curve, _header(self.job, self.file, tight, status))
            # The file has every digit; reading it again would only make a stop wait.
            if not is_stream(output) and status != STOPPED:
                measures = measured(output)[1]
        except FormatError as error:
            unwritten = str(error)
        work = {"trials": _trials(tight), "seconds": tight.seconds} | {
            key: getattr(tight, key) for key in (*PHYSICS, "sweeps", "factorisations")
        }
        return _rope_row(self.job, None if unwritten else output, measures, status, **work), unwritten

    def tidy(self, output: str, tight: Tight) -> None:
        """Remove unfinished ropes of earlier runs beside a tight one, but none shorter or of another type."""
        if is_stream(output) or not tight.converged:
            return
        longer = (1 - SUPERSEDED) * (tight.measures.l_c or math.inf)
        for path in filter(os.path.exists, islice(_names_of_best(output), UNFINISHED)):
            with suppress(ValueError, OSError):
                file, measures = measured(path)
                same = says(path, STOPPED) and fingerprint(file.components) == fingerprint(tight.curve)
                if same and (measures.l_c or math.inf) >= longer:
                    os.unlink(path)

    def begun(self) -> Run:
        """Return the run at its beginning."""
        try:
            job = self.job
            return Run(self.file.components, list(self.todo), job.settings, job.method, job.trials)
        except ValueError as error:
            raise FormatError(f"{self.file.name}: {error}") from error

    def restored(self) -> Run | None:
        """Return the run as the checkpoint has it, if it is of use."""
        path = self.job.checkpoint
        if not (self.job.resume and path and path.exists()):
            return None
        state = checkpoints.load(path, KIND)
        try:
            same = state["identity"] == self.identity
            failed = {int(n): str(trouble) for n, trouble in state["failed"].items()}
            run = Run.restore(state["run"]) if same else None
        except (ValueError, LookupError, TypeError, AttributeError, PanicError) as error:
            raise FormatError(f"{path}: holds no state of a run ({error}); remove it") from error
        if run is None:
            raise FormatError(f"{path}: is of another curve, n or setting; repeat those or remove it")
        # An output that was written and then lost has to be made from the beginning.
        if not self.todo <= {*run.targets, *failed}:
            return None
        self.failed = failed
        return run

    def save(self) -> None:
        """Write the checkpoint, if there is to be one. Raises `FormatError`."""
        self.saved = time.monotonic()
        if self.job.checkpoint:
            state = {"identity": self.identity, "failed": self.failed, "run": self.run.state()}
            checkpoints.save(self.job.checkpoint, KIND, state)

    def way_on(self) -> str:
        """Save a run that ends early; return what to add to the message about it."""
        try:
            if self.run.at_rest:  # otherwise the last checkpoint is what there is
                self.save()
        except FormatError as error:
            return f"; {error}"
        return "; --resume goes on from here" if self.job.checkpoint else ""


def _located(error: CurveError, file: VertexFile) -> FormatError:
    """Say in which line, or in which two, of its file a curve is wrong."""
    places = [file.where(component, vertex or 0) for component, vertex in error.places]
    first, *others = places or [file.name]
    other = "".join(f" (the other: {place})" for place in others)
    return FormatError(f"{first}: {error}{other}")


def _as_bug(error: PanicError) -> str:
    return f"the core came upon a bug ({error}); please report it"


def _rope_row(job: Job, output: str | None, measures: Measures, status: str, **more: Any) -> Row:
    overlap = max(0.0, 2 - 2 * measures.sr)
    return as_row(job.name, output, measures, overlap=overlap, status=status, **more)


def _judged(job: Job, row: Row, note: str | None = None) -> Result:
    """Make the result of a row whose vertices are in their file."""
    if row["status"] != STUCK:
        return Result(row, note=note)
    why = f"did not settle to {_tolerance(job):g}"
    if job.method != "sono":
        why = "did not get tight"
        if row.get("mu") is not None:
            why += f": the polish ended at mu = {row['mu']:.1e} with the residual {row['residual']:.1e}"
    return Result(row, f"{job.name}: n = {row['n']} {why}; {row['file']} has its best", note)


def _tolerance(job: Job) -> float:
    return float((default_settings() | job.settings)["tolerance"])


def _trials(tight: Tight) -> int:
    return max(len(tight.shapes) + len(tight.failed), 1)


def _header(job: Job, file: VertexFile, tight: Tight, status: str) -> list[str]:
    physics = (f"{key} {value:.1e}" for key in PHYSICS if (value := getattr(tight, key)) is not None)
    return [
        *title(job.name, status, tight.measures),
        f"method {job.method}  trials {_trials(tight)}  settings {json.dumps(job.settings)}",
        "  ".join(physics) or "not polished",
        _origin(job, file),
    ]


def title(name: str, status: str, m: Measures) -> list[str]:
    """Return the comments that a file of a rope begins with."""
    name = printable(name.encode(errors="replace").decode())  # a file's name need not be text
    return [f"{name}: {status}, rope radius R_s = 1", _figures(m)]


def _figures(m: Measures) -> str:
    l_c, l_a = (f"{value:.8f}" if value is not None else "-" for value in (m.l_c, m.l_a))
    return f"n {m.n}  dl {m.dl:.8f}  L_p {m.l_p:.8f}  L_c {l_c}  L_a {l_a}  (length over radius)"


def free_name(output: str) -> str:
    """A name beside `output` for an unfinished result: NAME.best.txt, NAME.best2.txt, ..."""
    if is_stream(output):
        return output
    return next(name for name in _names_of_best(output) if not os.path.exists(name))


def _names_of_best(output: str) -> Iterator[str]:
    path = Path(output)
    return (os.fspath(path.with_suffix(f".best{k}{path.suffix}")) for k in chain([""], count(2)))


def _origin(job: Job, file: VertexFile) -> str:
    """Tell what a rope is made from: its curve, method and settings, as a digest."""
    return f"input and settings: {digest(file, job.method, job.trials, job.settings)}"


def digest(file: VertexFile, *settings: Any) -> str:
    """Return what tells a curve, and settings, from others."""
    found = hashlib.sha256(json.dumps(settings, sort_keys=True).encode())
    for component in file.components:
        found.update(component.tobytes() + b"end of component")
    return found.hexdigest()[:32]
