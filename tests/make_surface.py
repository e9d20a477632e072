"""Writes down all that 1.x keeps, `tests/surface.txt`: `python -m tests.make_surface`, if a change is meant.

docs/stability.md says what may change, and when.
"""

import ast
import inspect
import json
import textwrap
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import click

import sono
from sono import formats, tables
from sono.cli import COMMANDS, main
from sono.figures import solidfiles

PAGE = Path(__file__).parent / "surface.txt"
SCHEMAS = ("certificate", "curve", "record")


def surface() -> str:
    """Give the page."""
    parts = {
        "commands": commands(),
        "tables": [f"--format {' '.join(tables.FORMATS)}", *columns()],
        "files": files(),
        "JSON": [line for name in SCHEMAS for line in fields(name, schema(name))],
        "Python": python(),
    }
    return "\n\n".join(f"# {title}\n" + "\n".join(lines) for title, lines in parts.items()) + "\n"


def commands() -> Iterator[str]:
    """Give a line for each argument and option of each command."""
    group = click.Context(main, info_name="sono")
    for name in COMMANDS:
        command = main.get_command(group, name)
        assert command
        yield from sorted(f"sono {name} {parameter(param)}" for param in command.params)
    yield from sorted(f"sono {parameter(param)}" for param in main.params)


def parameter(param: click.Parameter) -> str:
    """Write how it is called, what it takes, and what it is if it is not given."""
    spelling = "/".join(param.opts) if isinstance(param, click.Option) else param.make_metavar(CONTEXT)
    if isinstance(param, click.Option) and param.is_flag:
        return spelling
    takes = "|".join(param.type.choices) if isinstance(param.type, click.Choice) else param.type.name
    marks = ["repeatable"] * param.multiple + ["required"] * param.required
    if isinstance(param.default, str | int | float) and not isinstance(param.default, bool):
        marks.append(f"[{param.default}]")
    return " ".join([spelling, f"<{takes}>", *marks])


CONTEXT = click.Context(main)


def columns() -> Iterator[str]:
    """Give each column's key and header, and the type of its values."""
    for column in tables.COLUMNS.values():
        yield f"{column.key} ({column.header}): {column.kind.__name__}"


def files() -> Iterator[str]:
    """Give the formats of curves, and of solids."""
    yield f"read: {' '.join(sorted({*formats.READERS, *formats.BINARY}))}"
    yield f"written: {' '.join(sorted(formats.WRITERS))}"
    suffixes = (f"{suffix}={name}" for suffix, name in sorted(formats.SUFFIXES.items()) if suffix)
    yield f"suffixes: {' '.join(suffixes)}"
    yield f"solids: {' '.join(solidfiles.FORMATS)}"


def schema(name: str) -> Any:
    """Read a schema in the package."""
    return json.loads(
        (Path(sono.__file__).parent / "data" / f"{name}.schema.json").read_text(encoding="utf-8")
    )


def fields(place: str, node: Any) -> Iterator[str]:
    """Give the place of each field of JSON, whether it must be there, and what it may hold."""
    for name, child in node.get("properties", {}).items():
        holds = child.get("const", child.get("enum", child.get("type", child.get("$ref", "?"))))
        yield f"{place}.{name}{'' if name in node.get('required', ()) else '?'}: {json.dumps(holds)}"
        yield from fields(f"{place}.{name}", child)
    if isinstance(node.get("items"), dict):
        yield from fields(f"{place}[]", node["items"])
    for name, child in node.get("$defs", {}).items():
        yield from fields(f"{place}#{name}", child)


def python() -> Iterator[str]:
    """Give each public name, functions with their arguments, classes with what they offer."""
    for name in sorted({*sono.__all__} - {"__version__"}):
        public = getattr(sono, name)
        if inspect.ismodule(public):
            for inner in sorted(listed(public)):
                yield f"sono.{name}.{signature(getattr(public, inner))}"
        elif inspect.isclass(public):
            yield from methods(name, public)
        else:
            yield f"sono.{signature(public)}"


def listed(module: Any) -> list[str]:
    """Return the names that a module offers."""
    own = inspect.getmembers(module, inspect.isfunction)
    public = [name for name, that in own if that.__module__ == module.__name__ and not name.startswith("_")]
    return list(getattr(module, "__all__", public))


def methods(name: str, public: type) -> Iterator[str]:
    """Give a class and its bases, and each field, property and method of it, inherited or not."""
    yield f"sono.{name}({', '.join(base.__name__ for base in public.__bases__)})"
    found: dict[str, str] = {}
    for ancestor in reversed([kind for kind in public.__mro__ if kind.__module__.startswith("sono.")]):
        if ancestor.__module__ != "sono._core":
            found |= dict(members(ancestor))
    yield from (f"sono.{name}.{line}" for line in found.values())


def members(public: type) -> Iterator[tuple[str, str]]:
    """Give each public member of a class by its name, as its source has it."""
    for node in parsed(public).body:
        if isinstance(node, ast.AnnAssign) and isinstance(node.target, ast.Name):
            line = ast.unparse(node).split(" = ")[0] + (" = ..." if node.value else "")
            name = node.target.id
        elif isinstance(node, ast.FunctionDef) and not marked(node, "classmethod"):  # they are sono's own
            name, line = node.name, head(node)
            if marked(node, "property") and node.returns:
                line = f"{name}: {ast.unparse(node.returns)}"
        else:
            continue
        if not name.startswith("_") or name == "__init__":
            yield name, line


def marked(node: ast.FunctionDef, mark: str) -> bool:
    return mark in map(ast.unparse, node.decorator_list)


def signature(public: Any) -> str:
    """Write a function's head as its source has it."""
    return head(parsed(inspect.unwrap(public)))


def head(node: Any) -> str:
    returned = f" -> {ast.unparse(node.returns)}" if node.returns else ""
    return f"{node.name}({ast.unparse(node.args)}){returned}"


def parsed(public: Any) -> Any:
    """Return the syntax tree of a function or class."""
    return ast.parse(textwrap.dedent(inspect.getsource(public))).body[0]


if __name__ == "__main__":
    PAGE.write_text(surface(), encoding="utf-8")
