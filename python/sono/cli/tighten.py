"""`sono tighten FILE...`: the paper's table of tight knots, and their vertices."""

import os
import sys
from collections.abc import Iterator
from itertools import chain, count
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from sono import tables
from sono.cli import options, places
from sono.cli.runner import Batch
from sono.jobs.locks import Taken

if TYPE_CHECKING:
    from sono.jobs.sources import Source
    from sono.jobs.tighten import Job
    from sono.tightening import Method
    from sono.tightening.targets import Target


def _numbers(ctx: click.Context, param: click.Parameter, value: str | None) -> "list[Target]":
    """Return numbers separated by commas in increasing order."""
    if value is None:
        return []
    from sono.tightening.settings import MOST

    try:
        numbers = sorted({int(number) for number in value.split(",")})
    except ValueError:
        raise click.BadParameter(f"{value!r}: give whole numbers such as 480 or 120,240,480") from None
    if numbers[0] < 3:
        raise click.BadParameter("a closed curve has at least 3 vertices")
    if numbers[-1] > MOST:
        raise click.BadParameter(f"{MOST:,} vertices are the most")
    return list(numbers)


def _lengths(ctx: click.Context, param: click.Parameter, value: str | None) -> "list[Target]":
    """Return lengths separated by commas in decreasing order."""
    if value is None:
        return []
    from sono.tightening.settings import LEAST_DL, MOST_DL

    try:
        lengths = sorted({float(length) for length in value.split(",")}, reverse=True)
    except ValueError:
        raise click.BadParameter(f"{value!r}: give lengths such as 0.1 or 0.4,0.2,0.1") from None
    if not all(LEAST_DL <= length <= MOST_DL for length in lengths):
        raise click.BadParameter(f"edges are {LEAST_DL:g} to {MOST_DL:g} radii long")
    return list(lengths)


@click.command("tighten")
@options.knots
@click.option(
    "-n",
    "numbers",
    metavar="N[,N...]",
    callback=_numbers,
    help="Vertices; a list gives a row each.  [default: 480]",
)
@click.option(
    "--dl",
    "lengths",
    metavar="DL[,DL...]",
    callback=_lengths,
    help="Or edges of this length, in radii, as far as N is a whole number.",
)
@click.option(
    "--method",
    type=click.Choice(["both", "sono", "polish"]),
    default="both",
    show_default=True,
    help="SONO to find a shape and the polish to make it exact, or one of them alone.",
)
@click.option(
    "--trials",
    type=click.IntRange(1),
    default=8,
    show_default=True,
    help="Shapes to find with the method both; the shortest is polished. The first 4 will do where they "
    "agree, or are longer than 150.",
)
@click.option(
    "--start",
    type=click.Choice(["known", "drawn"]),
    default="known",
    show_default=True,
    help="For a NAME, by the method both: polish the rope that the atlas has of it, or tighten a loose one.",
)
@options.output(
    "File or folder/ for the vertices, - for standard output.  [default: NAME.nN.txt, or NAME.dlDL.txt, here]"
)
@click.option(
    "--contacts",
    metavar="PATH",
    help="File or folder/ for the forces in the tight rope, as TSV; in a folder NAME.nN.contacts.tsv.",
)
@click.option(
    "--record", is_flag=True, help="Write NAME.nN.record.json beside the vertices: what proves their type."
)
@options.force
@click.option(
    "--seed", type=click.IntRange(0, 2**64 - 1), default=0, help="Seed of the anneals.  [default: 0]"
)
@options.time_limit("Stop each FILE after this time.")
@click.option(
    "--set",
    "pairs",
    multiple=True,
    metavar="NAME=VALUE",
    help="Change a setting, such as anneal_sweeps=400000 or last_mu=1e-9.",
)
@options.parallel("Knots tightened at the same time.")
@options.checkpoint("Keep the state of each run here.")
@options.resume("there")
@options.table((*tables.DEFAULT, "status"))
def command(
    sources: "list[Source]",
    numbers: "list[Target]",
    lengths: "list[Target]",
    pool: options.Pool,
    shown: options.Shown,
    **asked: Any,
) -> None:
    """Tighten each FILE (- for standard input), or the knot of that name, and write a row for each N or DL.

    Of a FILE that holds several curves, such as a trajectory, each is tightened; FILE:KEY is one of them.

    The rope has radius 1. L_p, L_c and L_a are what the written vertices measure. Where a run is stopped by
    Ctrl-C, SIGTERM or --time-limit, its best state is written to NAME.nN.best.txt, unless it is on a cluster.
    Standard input has the NAME stdin, or else stdin-2 and so on.

    \b
      sono tighten 8_18 -n 960
      sono tighten trefoil.txt -n 120,240,480
      sono start 3_1 | sono tighten - -n 240 --contacts forces.tsv
    """
    from sono.jobs.away import SentJob  # here, since numpy would make --help wait

    if numbers and lengths:
        raise click.UsageError("-n counts vertices, --dl says how long edges are; give one of them")
    if pool.cluster and asked["record"]:
        raise click.UsageError("--record cannot be had from a cluster; leave one of the two out")
    if pool.cluster and asked["checkpoint"]:
        raise click.UsageError("a checkpoint is of no use on a cluster; --resume keeps what is finished")
    work = _work(sources, numbers or lengths or [480], **asked)
    options.tell_of_shadows(sources, shown)
    table = shown.table("-" in (asked["output"], asked["contacts"]))
    with pool.workers() as workers:
        sent = [SentJob(job, workers) for job in work] if pool.cluster else work
        sys.exit(Batch(table, shown.quiet).run(sent, workers.count))


def _work(
    sources: "list[Source]",
    targets: "list[Target]",
    *,
    method: "Method",
    trials: int,
    start: str,
    output: str | None,
    contacts: str | None,
    record: bool,
    force: bool,
    seed: int,
    time_limit: float | None,
    pairs: tuple[str, ...],
    checkpoint: str | None,
    resume: bool,
) -> "list[Job]":
    """Make a job of each source, and its places ready."""
    from sono.jobs.curvefiles import free_name
    from sono.jobs.tighten import Job

    fresh = places.fresh(force, resume)
    if contacts and method == "sono":
        raise click.UsageError("--contacts needs the polish; use the method both or polish")
    if record and output == "-":
        raise click.UsageError("--record is written beside a file of vertices; name one with -o")
    if output == contacts == "-":
        raise click.UsageError("standard output cannot hold both vertices and contacts; name a file for one")
    same: dict[str, Any] = {"settings": _settings(seed, pairs), "method": method, "trials": trials}
    same |= {"time_limit": time_limit, "resume": resume, "known": start == "known", "record": record}
    work = [
        Job(
            source,
            source.name,
            outputs,
            **_beside(source.stem, outputs, contacts, checkpoint, len(sources)),
            **same,
        )
        for source, outputs in _plan(sources, targets, output, fresh)
    ]
    unfinished = (free_name(path) for job in work for path in job.outputs.values() if path != "-")
    places.prepare([path for job in work for path in job.files()], fresh, unfinished)
    return work


def _plan(
    sources: "list[Source]", targets: "list[Target]", output: str | None, fresh: bool
) -> "Iterator[tuple[Source, dict[Target, str]]]":
    """Say where the vertices of each source for each target go."""
    if output and places.names_one_file(output):
        if len(sources) * len(targets) > 1:
            raise click.UsageError(
                "-o names one file, but there are several results; name a folder (FOLDER/)"
            )
        places.check_suffix(output)
        yield sources[0], {targets[0]: output}
        return
    for source in sources:
        files = (
            {target: os.path.join(output or "", f"{stem}.{_label(target)}.txt") for target in targets}
            for stem in chain([source.stem], (f"{source.stem}-{number}" for number in count(2)))
        )
        # Nobody chose the name "stdin", so a pipe that is run again takes the next one.
        free = (paths for paths in files if _is_free(list(paths.values())))
        yield source, next(free if source.piped and fresh else files)


def _label(target: "Target") -> str:
    """Return what tells a target in the name of a file."""
    return f"n{target}" if isinstance(target, int) else f"dl{target:g}"


def _is_free(paths: list[str]) -> bool:
    """Tell whether none of the files is there, nor about to be written by another process."""
    try:
        places.claim(paths)
    except Taken:
        return False
    return not any(map(os.path.exists, paths))


def _forces(path: str | None, outputs: "dict[Target, str]", name: str, sources: int) -> "dict[Target, str]":
    """Say where the forces for each target go."""
    if path is None:
        return {}
    if not path:
        raise click.UsageError("--contacts needs the name of a file or folder/")
    if not places.names_one_file(path):
        stems = {
            target: f"{name}.{_label(target)}" if file == "-" else Path(file).stem
            for target, file in outputs.items()
        }
        return {target: os.path.join(path, f"{stem}.contacts.tsv") for target, stem in stems.items()}
    if len(outputs) * sources > 1:
        raise click.UsageError("--contacts names one file, but there are several results; name a folder/")
    if (suffix := Path(path).suffix.lower()) not in ("", ".tsv", ".txt", ".dat"):
        raise click.UsageError(f"{path}: {suffix} is no format for forces, which are written as .tsv")
    return dict.fromkeys(outputs, path)


def _beside(
    name: str, outputs: "dict[Target, str]", contacts: str | None, checkpoint: str | None, sources: int
) -> dict[str, Any]:
    """Say what a job writes beside its outputs."""
    kept = Path(checkpoint, f"{name}.checkpoint.json") if checkpoint else None
    return {"forces": _forces(contacts, outputs, name, sources), "checkpoint": kept}


def _settings(seed: int, pairs: tuple[str, ...]) -> dict[str, Any]:
    from sono.tightening.settings import check_settings, default_settings

    defaults = default_settings()
    settings = {}
    for pair in (f"seed={seed}", *pairs):
        name, _, value = pair.partition("=")
        try:
            settings[name] = _like(defaults.get(name), value)
            check_settings(settings)
        except ValueError as error:
            raise click.UsageError(f"--set {pair}: {error}") from error
    return settings


def _like(default: Any, value: str) -> Any:
    """Read a value that is of the kind of the default."""
    try:
        return value if default is None else type(default)(value)
    except ValueError:
        kind = "whole number" if isinstance(default, int) else "number"
        raise ValueError(f"{value!r} is no {kind}") from None
