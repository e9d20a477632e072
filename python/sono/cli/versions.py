"""What a report of a bug should say: versions of sono and of what it stands on, and the machine."""

import os
import platform
import re
from collections.abc import Iterator

import click

import sono


def show(ctx: click.Context, param: click.Parameter, value: bool) -> None:
    """Print the version, or with `--verbose` all that a report of a bug should say, and leave."""
    if not value or ctx.resilient_parsing:
        return
    if not ctx.params["verbose"]:
        click.echo(f"{ctx.find_root().info_name}, version {sono.__version__}")
    else:
        click.echo("\n".join(f"{name:<18} {what}" for name, what in report()))
    ctx.exit()


def report() -> Iterator[tuple[str, str]]:
    """Say what there is, and in which version."""
    from importlib import metadata  # here, since it takes a tenth of the time of a short command

    yield "sono", sono.__version__
    yield "core", _core()
    yield "Python", f"{platform.python_version()}, {platform.python_implementation()}"
    yield "platform", platform.platform()
    yield "threads", _threads()
    for requirement in metadata.requires("sono") or []:
        if needed := re.fullmatch(r"([\w.-]+)[^;]*(?:;.*extra == ['\"]([\w.-]+)['\"].*)?", requirement):
            name, extra = needed.groups()
            if extra != "test" and "sono[" not in requirement:
                yield name, _version(name) + (f", for sono[{extra}]" if extra else "")


def _core() -> str:
    """Describe the compiled core, or say why there is none."""
    try:
        from sono._core import about  # here, since --help need not wait for it
    except ImportError as error:
        return f"cannot be imported: {error}"
    version, build, processor, features = about()
    return f"{version}, {build}, {' '.join((processor, *features))}"


def _threads() -> str:
    """Say how many threads this process may use, and how many there are."""
    usable = len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count()
    return f"{usable} of {os.cpu_count()}"


def _version(package: str) -> str:
    from importlib import metadata

    try:
        return metadata.version(package)
    except metadata.PackageNotFoundError:
        return "not installed"
