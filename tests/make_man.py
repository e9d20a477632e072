"""Writes the man pages of `sono` and its commands from their helps: `python -m tests.make_man`."""

import re
from collections.abc import Iterator
from pathlib import Path

import click

from sono.cli import COMMANDS, main

FOLDER = Path(__file__).parent.parent / "packaging" / "data" / "share" / "man" / "man1"

EXIT = [
    ("0", "All that was asked for was done."),
    ("1", "A file failed, or the answer of verify or certify --check is not yes."),
    ("2", "The call was wrong."),
    ("130", "Ctrl-C ended it."),
]


def pages() -> Iterator[tuple[str, str]]:
    """Give the name of each page, and the page."""
    group = click.Context(main, info_name="sono", **main.context_settings)
    listed = [(f"sono-{name}(1)", what) for name, what in COMMANDS.items()]
    also = ", ".join(name for name, _ in listed)
    more = [*section("COMMANDS", listed), *section("EXIT STATUS", EXIT)]
    yield "sono", page(group, "pull knots tight as ropes of radius 1", more, also)
    for name, what in COMMANDS.items():
        command = main.get_command(group, name)
        assert command
        yield f"sono-{name}", page(click.Context(command, info_name=name, parent=group), what, [], "sono(1)")


def page(ctx: click.Context, what: str, more: list[str], also: str) -> str:
    """Write the page of a command that does so much, with further sections, and pages to see also."""
    title = ctx.command_path.replace(" ", "-")
    records = [
        param.get_help_record(ctx) for param in ctx.command.get_params(ctx) if isinstance(param, click.Option)
    ]
    lines = [
        f'.TH {title.upper()} 1 "" "sono" "sono manual"',
        *(".SH NAME", f"{title} \\- {escaped(what[0].lower() + what[1:].rstrip('.'))}"),
        *(".SH SYNOPSIS", f".B {ctx.command_path}", escaped(" ".join(ctx.command.collect_usage_pieces(ctx)))),
        *(".SH DESCRIPTION", *description(ctx.command.help or "")),
        *section("OPTIONS", [record for record in records if record]),
        *more,
        *(".SH SEE ALSO", escaped(also)),
    ]
    return "\n".join(lines) + "\n"


def description(text: str) -> Iterator[str]:
    r"""Write the paragraphs of a help; one that begins with \b keeps its lines."""
    for paragraph in re.split(r"\n\s*\n", text.strip()):
        lines = [line.strip() for line in paragraph.splitlines()]
        plain = lines[0] == "\b"
        yield ".PP"
        yield from [".nf", *map(escaped, lines[1:]), ".fi"] if plain else [escaped(" ".join(lines))]


def section(title: str, entries: list[tuple[str, str]]) -> list[str]:
    """Write a section of entries, each a term and what it is."""
    return [
        f".SH {title}",
        *(line for term, what in entries for line in (".TP", f".B {escaped(term)}", escaped(what))),
    ]


def escaped(text: str) -> str:
    """Write text so that troff takes it as it is."""
    text = " ".join(text.split()).replace("\\", "\\e").replace("-", "\\-")
    return "\\&" + text if text.startswith((".", "'")) else text


if __name__ == "__main__":
    FOLDER.mkdir(parents=True, exist_ok=True)
    for path in FOLDER.glob("*.1"):
        path.unlink()
    for name, text in pages():
        (FOLDER / f"{name}.1").write_text(text, encoding="utf-8")
