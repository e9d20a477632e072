"""A tightening under way: its run, its checkpoint, and what it writes."""

import json
import math
import os
import time
from collections import Counter
from collections.abc import Callable, Iterator
from contextlib import suppress
from functools import partial
from itertools import islice

from sono import formats
from sono._core import CurveError, PanicError
from sono.curve import measure
from sono.formats import FormatError, VertexFile, is_stream
from sono.formats.ropefile import SETTLED, STOPPED, STUCK, TIGHT, Header, Made
from sono.invariants import fingerprint
from sono.jobs import checkpoints, contacts, record
from sono.jobs.curvefiles import free_name, located, measured, names_of_best, rope_in
from sono.jobs.order import Order, judged, made_from, rope_row, shown
from sono.jobs.result import Result
from sono.tables import Row
from sono.tightening import KnotTypeError, Progress, Run, Stopped, Tight
from sono.tightening.targets import Target

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

PHYSICS = ("residual", "mu", "excess")
"""What the polish alone can tell."""


class Task:
    """A job under way: its run, and the checkpoint that keeps it."""

    def __init__(self, job: Order, file: VertexFile, todo: set[Target]) -> None:
        """Begin, or go on from the checkpoint. Raises `FormatError`."""
        self.job = job
        self.file = file
        self.todo = todo
        self.identity = [made_from(job, file), *job.outputs]
        self.records = record.Records(job, file) if job.record else None
        self.told: list[str] = []
        self.failed: dict[Target, str] = {}
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
                trouble = located(error, self.file)
                if error.needed is None:
                    raise trouble from error
                yield self.out_of_reach(n, str(trouble))
            except PanicError as error:
                yield self.out_of_reach(n, f"{self.job.name}: {shown(n)}: {_as_bug(error)}")
            except KnotTypeError as error:
                yield self.out_of_reach(n, f"{self.job.name}: {shown(n)}: {error}")
            else:
                if n in self.todo:
                    reached = SETTLED if self.job.method == "sono" else TIGHT
                    row, unwritten = self.deliver(n, tight, reached if tight.converged else STUCK)
                    if unwritten:
                        yield Result(row, unwritten + self.way_on())
                        return
                    self.tidy(self.job.outputs[n], tight)
                    yield judged(self.job, row, self.noted(tight))
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

    def out_of_reach(self, n: Target, trouble: str) -> Result:
        """Remember why there is no rope of n vertices, or of such edges."""
        self.failed[n] = trouble
        return Result(None, trouble)

    def stopped(self, why: str) -> Result:
        """Write the best state of the run. Raises `FormatError` for a curve that is none."""
        try:
            best = self.run.best()
        except CurveError as error:  # nobody had looked at it yet
            raise located(error, self.file) from error
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
        if tight.known:
            notes += ["begun with the atlas's rope; --start drawn begins with a loose one"]
        if tight.loosened:
            notes += ["as it is the curve holds only a thin rope; it was loosened first, by isotopic moves"]
        if len(tight.shapes) + len(tight.failed) > 1:
            found = Counter(f"{length:.4f}" for length in sorted(tight.shapes))
            hits = ", ".join(f"{length} ({times} of them)" for length, times in found.items())
            trials = f"{len(tight.shapes)} trials at n = {sum(map(len, self.run.shape or []))}"
            lost = "".join(f"; {times} failed: {why}" for why, times in Counter(tight.failed).items())
            length = "L_p" if self.run.shape and measure(self.run.shape).l_a is None else "L_a"
            notes += [f"{trials} ended at {length} {hits}; the best was taken{lost}{_disagreement(found)}"]
        return notes

    def deliver(self, n: Target, tight: Tight, status: str) -> tuple[Row, str | None]:
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
            if self.records and not is_stream(output):
                self.records.write(output, tight, status)
        except FormatError as error:
            unwritten = str(error)
        work = {"trials": _trials(tight), "seconds": tight.seconds} | {
            key: getattr(tight, key) for key in (*PHYSICS, "sweeps", "factorisations")
        }
        return rope_row(self.job, None if unwritten else output, measures, status, **work), unwritten

    def tidy(self, output: str, tight: Tight) -> None:
        """Remove unfinished ropes of earlier runs beside a tight one, but none shorter or of another type."""
        if is_stream(output) or not tight.converged:
            return
        longer = (1 - SUPERSEDED) * (tight.measures.l_c or math.inf)
        for path in filter(os.path.exists, islice(names_of_best(output), UNFINISHED)):
            with suppress(ValueError, OSError):
                file, measures, header = rope_in(path)
                unfinished = header.status == STOPPED
                same = unfinished and fingerprint(file.components) == fingerprint(tight.curve)
                if same and (measures.l_c or math.inf) >= longer:
                    record.remove(path)

    def begun(self) -> Run:
        """Return the run at its beginning."""
        try:
            job = self.job
            return Run(self.file.components, list(self.todo), job.settings, job.method, job.trials, job.shape)
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
            failed = {json.loads(n): str(trouble) for n, trouble in state["failed"].items()}
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


def _as_bug(error: PanicError) -> str:
    return f"the core came upon a bug ({error}); please report it"


def _trials(tight: Tight) -> int:
    return max(len(tight.shapes) + len(tight.failed), 1)


def _header(job: Order, file: VertexFile, tight: Tight, status: str) -> list[str]:
    physics = tuple((key, value) for key in PHYSICS if (value := getattr(tight, key)) is not None)
    made = Made(job.method, _trials(tight), job.settings)
    header = Header.of(
        job.name, status, tight.measures, made=made, physics=physics, origin=made_from(job, file)
    )
    return header.lines()


def _disagreement(found: Counter[str]) -> str:
    """Say what to do where the best of several ends was met but once: there may be a shorter one."""
    if len(found) < 2 or found[min(found, key=float)] > 1:
        return ""
    return "; these disagree, and the best was met but once: `sono search` tries more shapes"
