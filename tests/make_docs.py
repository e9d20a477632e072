"""Writes the generated parts of docs/ from the code: `python tests/make_docs.py`.

They are the pages of commands, of Python and of schemas, and tables between `<!-- generated: NAME -->` and
`<!-- end -->`.
"""

import json
import re
from collections.abc import Callable, Iterator
from importlib import resources
from pathlib import Path
from typing import Any

import click
import make_docs_python as api
from make_man import EXIT

from sono import formats
from sono.cli import COMMANDS, main
from sono.tightening.settings import default_settings

DOCS = Path(__file__).parent.parent / "docs"

BEFORE = {
    "convert": "sono start 8_18 --known -o 8_18.n960.txt",
    "export": "sono start L6a1 --known -o tight.txt",
    "identify": "sono start 8_18 -o mystery.txt",
    "measure": "sono start 3_1 --known -o trefoil.n480.txt",
    "tighten": "sono start 3_1 -o trefoil.txt",
    "verify": "sono start 8_18 --known -o 8_18.n960.txt",
    "view": "sono start 3_1 -o trefoil.txt; sono tighten trefoil.txt -n 15,60",
}
"""What makes the files that examples of a command take."""

CHANGED = {
    "sono": "120,240,480 -> 60; n480 -> n60",
    "report": "report atlas -> report 3_1; 3_1 4_1 5_1 -n 120,240 -> 3_1 Hopf -n 120",
    "plot": "240,480,960,1920 -> 90,120,240; plot knot 3_1 L6a4 -> plot curvature 3_1",
    "search": "8_4 --time-limit 60 -> 3_1 --trials 1; 6_1 9_1 --trials 64 -> 4_1 --trials 1",
    "tighten": "8_18 -n 960 -> 3_1 -n 120; 120,240,480 -> 60,120; -n 240 -> -n 60",
    "view": "n60.txt trefoil.n480.txt -> n60.txt",
}
"""What of the examples the tests change, so that they are done in no time."""


CONTENTS = {
    "brackets": "rows or lists in brackets, as Python and Mathematica print them",
    "codes": "[PD, DT or Gauss codes](names.md#codes), one a line, each a curve",
    "coords": "what KnotPlot's command coords prints",
    "csv": "a header and rows, also with semicolons, and with a column that tells components apart",
    "fseries": "Fourier series in Fremlin's files",
    "gro": "GRO of GROMACS, a frame after the other",
    "ideal": "Fourier series of ideal knots in Gilbert's XML",
    "json": "a curve with all that is known of it: [its schema](schemas.md#curve); also plain lists",
    "knotplot": "KnotPlot's binary files",
    "lammps": "LAMMPS data, chains along their bonds",
    "lammpstrj": "LAMMPS dump, a frame after the other",
    "mmcif": "mmCIF, read as PDB is; needs the extra molecules",
    "npy": "NumPy: (n, 3), or (k, n, 3) for k components",
    "npz": "NumPy: an archive of arrays, each a component",
    "obj": "Wavefront OBJ: vertices, and lines that join them",
    "pdb": "PDB: CA or P atoms, or beads along their bonds, chain by chain; written with the closing bond",
    "pkf": "PKF of libbiarc: nodes and tangents",
    "text": "rows of x y z, also with an index or element column, or a header that names the columns",
    "vect": "Geomview VECT, ASCII",
    "xyz": "molecular XYZ, also extended, a frame after the other",
}
"""What is in a file of each format."""


def pages() -> Iterator[tuple[str, str]]:
    """Give the path in docs/ of each generated page, and the page."""
    group = click.Context(main, info_name="sono", **main.context_settings)
    for name, what in COMMANDS.items():
        command = main.get_command(group, name)
        assert command
        ctx = click.Context(command, info_name=name, parent=group)
        yield f"reference/commands/{name}.md", command_page(ctx, name, what)
    yield "reference/commands/index.md", index_page(group)
    yield "reference/python.md", api.page()
    yield "reference/schemas.md", schemas_page()
    for path in sorted(DOCS.rglob("*.md")):
        text = path.read_text(encoding="utf-8")
        if (filled := fill(text)) != text or "<!-- generated: " in text:
            yield path.relative_to(DOCS).as_posix(), filled


def command_page(ctx: click.Context, name: str, what: str) -> str:
    """Write the page of a command that does so much."""
    options = [param for param in ctx.command.get_params(ctx) if isinstance(param, click.Option)]
    return "\n".join(
        [
            f"# sono {name}\n\n{what}\n",
            f"```text\nsono {name} {' '.join(ctx.command.collect_usage_pieces(ctx))}\n```\n",
            *description(ctx.command.help or "", name),
            "## Options\n",
            table(("option", "what it does"), (_option(param, ctx) for param in options)),
            "Exit codes are those of [all commands](../exit-codes.md).\n",
        ]
    )


def _option(param: click.Option, ctx: click.Context) -> tuple[str, str]:
    """Give an option and its help, with its default in italics."""
    term, help = param.get_help_record(ctx) or ("", "")
    help = re.sub(r", of: .*?\.(?=$|  )", ": [any](../tables.md) of these.", help, flags=re.DOTALL)
    help, _, default = help.partition("  [")
    text = re.sub(r"\\\[any\\\]", "[any]", api.escaped(help))
    return code(term), text + (f" *[{default.removesuffix(']')}]*" if default else "")


def index_page(group: click.Context) -> str:
    """Write the page of all commands."""
    rows = ((f"[sono {name}]({name}.md)", what) for name, what in COMMANDS.items())
    return "\n".join(
        [
            "# Commands\n",
            *description(main.help or "", "sono"),
            table(("command", "what it does"), rows),
            "`sono COMMAND --help` says what these pages say, and so do the man pages.\n",
        ]
    )


def description(text: str, name: str) -> Iterator[str]:
    r"""Write the paragraphs of a help; one that begins with \b keeps its lines, and may be an example."""
    for paragraph in re.split(r"\n\s*\n", text.strip()):
        lines = [line.strip() for line in paragraph.splitlines()]
        if lines[0] != "\b":
            yield api.escaped(" ".join(lines)) + "\n"
        elif lines[1].startswith("sono "):
            yield example("\n".join(lines[1:]), name)
        else:
            kind = "sh" if lines[1].startswith("source") else "text"
            untried = "<!-- not run: it changes the shell -->\n" if kind == "sh" else ""
            yield f"{untried}```{kind}\n" + "\n".join(lines[1:]) + "\n```\n"


def example(text: str, name: str) -> str:
    """Write examples, with what the tests do before them and change in them."""
    changes = [part for part in CHANGED.get(name, "").split("; ") if part and part.split(" -> ")[0] in text]
    before = f"<!-- before it the test runs: {BEFORE[name]} -->\n" if name in BEFORE else ""
    changed = f"<!-- the test runs this with: {'; '.join(changes)} -->\n" if changes else ""
    return f"{before}{changed}```sh\n{text}\n```\n"


def schemas_page() -> str:
    """Write the page of the JSON schemas: a table of the fields of each, and the schema."""
    parts = [
        "# JSON schemas\n",
        "JSON that `sono` writes keeps to these schemas ([JSON Schema](https://json-schema.org) 2020-12).",
        "They are in the package, in `sono/data/`.\n",
    ]
    for path in sorted(resources.files("sono").joinpath("data").iterdir(), key=lambda path: path.name):
        if path.name.endswith(".schema.json"):
            text = path.read_text(encoding="utf-8")
            schema = json.loads(text)
            parts += [f"## {path.name.removesuffix('.schema.json').capitalize()}\n", f"{schema['title']}.\n"]
            parts += [
                table(("field", "type", "what it is"), _properties(schema)),
                f"```json\n{text.strip()}\n```\n",
            ]
    return "\n".join(parts)


def _properties(schema: dict[str, Any]) -> Iterator[tuple[str, str, str]]:
    for name, field in schema["properties"].items():
        kind = field.get("type", "")
        kind = " or ".join(kind) if isinstance(kind, list) else kind
        yield (
            code(name),
            kind or code(json.dumps(field["const"])) if "const" in field else kind,
            api.escaped(field.get("description", "")),
        )


def formats_table() -> str:
    """Write which formats are read and written, and by which suffixes."""
    names = sorted({*formats.READERS, *formats.BINARY, *formats.WRITERS})
    return table(("format", "suffix", "read", "written", "what is in it"), map(_format, names))


def _format(name: str) -> tuple[str, ...]:
    suffixes = [suffix or "none" for suffix, key in formats.SUFFIXES.items() if key == name]
    read = name in formats.READERS or name in formats.BINARY or name in formats.SUFFIXES.values()
    shown = ", ".join(code(suffix) if suffix != "none" else suffix for suffix in suffixes) or "any"
    return code(name), shown, "yes" if read else "", "yes" if name in formats.WRITERS else "", CONTENTS[name]


def settings_table() -> str:
    """Write the settings of the engines with their defaults."""
    rows = ((code(name), f"{value:g}") for name, value in default_settings().items())
    return table(("setting", "default"), rows)


def exit_table() -> str:
    """Write the exit codes."""
    return table(("exit code", "meaning"), EXIT)


def torus_types() -> str:
    """List the torus types of the atlas, in short where q goes from p to a largest one."""
    atlas = resources.files("sono").joinpath("data", "atlas", "torus.tsv").read_text(encoding="utf-8")
    types = [(int(p), int(q)) for p, q in re.findall(r"^T\((\d+),(\d+)\)", atlas, re.MULTILINE)]
    several = {p: sorted(q for first, q in types if first == p) for p, q in types if p != q}
    texts = []
    for p, along in several.items():
        whole = along == [*range(p, along[-1] + 1)]
        shown = [f"`T({p},{q})`" for q in ((p, along[-1]) if whole else along)]
        texts.append((" to " if whole else ", ").join(shown))
    squares = ", ".join(str(p) for p, q in types if p == q and p not in several)
    return f"{'; '.join(texts)}; and `T(p,p)` for p = {squares}."


REGIONS: dict[str, Callable[[], str]] = {
    "exit codes": exit_table,
    "formats": formats_table,
    "settings": settings_table,
    "torus types": torus_types,
}


def fill(text: str) -> str:
    """Fill the generated tables of a page."""
    return re.sub(
        r"(<!-- generated: ([\w ]+) -->\n).*?(<!-- end -->)",
        lambda match: f"{match[1]}\n{REGIONS[match[2]]()}\n{match[3]}",
        text,
        flags=re.DOTALL,
    )


def table(head: tuple[str, ...], rows: Any) -> str:
    """Write a table of Markdown."""
    lines = [head, ("---",) * len(head), *rows]
    return "".join("| " + " | ".join(line) + " |\n" for line in lines)


def code(text: str) -> str:
    """Write code that may stand in a table."""
    return f"<code>{text.replace('<', '&lt;').replace('|', '&#124;<wbr>')}</code>"


if __name__ == "__main__":
    for path, text in pages():
        target = DOCS / path
        target.parent.mkdir(parents=True, exist_ok=True)
        target.write_text(text, encoding="utf-8")
