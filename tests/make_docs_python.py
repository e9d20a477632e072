"""Writes the reference of what `import sono` offers from its docstrings, as Markdown."""

import ast
import inspect
import re
import sys
import textwrap
from collections.abc import Iterator
from typing import Any

import sono

MODULES = ("model", "plot")

HEAD = """# Python

What `import sono` offers. Curves are arrays (n, 3) of vertices, or sequences of them, one for each component;
a knot's name stands for a curve wherever `Rope` is written. Lengths are in radii of the rope unless something
else is said, and ropelength is length over the **radius**. `help(sono.tighten)` says the same as this page.
"""


def page() -> str:
    """Write the page."""
    names = [name for name in sono.__all__ if name != "__version__" and name not in MODULES]
    calls = sorted(name for name in names if not isinstance(getattr(sono, name), type))
    kinds = sorted(set(names) - set(calls))
    parts = [HEAD, "## Calls\n", *(_entry(f"sono.{name}", getattr(sono, name)) for name in calls)]
    parts += ["## Records and errors\n", *(_entry(f"sono.{name}", getattr(sono, name)) for name in kinds)]
    for name in MODULES:
        module = getattr(sono, name)
        public = getattr(module, "__all__", None) or _functions(module)
        parts += [f"## sono.{name}\n", prose(module.__doc__)]
        parts += [_entry(f"sono.{name}.{each}", getattr(module, each)) for each in public]
    return "\n".join(parts)


def _functions(module: Any) -> list[str]:
    found = inspect.getmembers(module, inspect.isfunction)
    return [name for name, call in found if call.__module__ == module.__name__ and not name.startswith("_")]


def _entry(name: str, thing: Any) -> str:
    """Write what a public name is: its call, its docstring, and of a class the fields and methods."""
    heading = f"### {name}\n"
    if not isinstance(thing, type):
        return "\n".join([heading, _code(_signature(name, thing)), prose(thing.__doc__)])
    if issubclass(thing, Exception):
        base = thing.__bases__[0].__name__
        return "\n".join([heading, _code(f"class {name}({base})"), prose(thing.__doc__)])
    fields = [f"    {field}" for field in _fields(thing)]
    parts = [heading, _code("\n".join([f"class {name}:", *fields]) if fields else f"class {name}")]
    parts.append(prose(thing.__doc__))
    for method, call in _methods(thing):
        parts += [f"#### {name}.{method}\n", _code(_signature(method, call)), prose(inspect.getdoc(call))]
    return "\n".join(parts)


def _fields(kind: type) -> list[str]:
    """Give the annotated names of a record as they are written."""
    if not kind.__module__.startswith("sono."):
        return []
    (body,) = ast.parse(textwrap.dedent(inspect.getsource(kind))).body
    assert isinstance(body, ast.ClassDef)
    written = (node for node in body.body if isinstance(node, ast.AnnAssign))
    return [ast.unparse(node) for node in written if not ast.unparse(node.target).startswith("_")]


def _methods(kind: type) -> Iterator[tuple[str, Any]]:
    """Give the public methods and properties that sono wrote, its own first, then those of its bases."""
    seen = set()
    for base in kind.__mro__:
        for name, member in vars(base).items():
            call = member.fget if isinstance(member, property) else getattr(member, "__func__", member)
            if name.startswith("_") or name in seen or not inspect.isfunction(call):
                continue
            seen.add(name)
            if call.__module__.startswith("sono.") and call.__doc__:
                yield name, call


def _signature(name: str, call: Any) -> str:
    """Give the call as its source has it, on a line or with a line for each argument."""
    (node,) = ast.parse(textwrap.dedent(inspect.getsource(call))).body
    assert isinstance(node, ast.FunctionDef)
    known = vars(sys.modules[call.__module__])
    for default in node.args.defaults, node.args.kw_defaults:
        default[:] = [_resolved(value, known) for value in default]
    result = f" -> {ast.unparse(node.returns)}" if node.returns else ""
    if any(
        ast.unparse(decorator).endswith(("property", "cached_property")) for decorator in node.decorator_list
    ):
        return f"{name}{result}"
    arguments = re.sub(r"^(self|cls)(, |$)", "", ast.unparse(node.args))
    arguments = re.sub(r"(?<=[\w\]])=(?=\S)", " = ", arguments)
    line = f"{name}({arguments}){result}"
    if len(line) <= 90:
        return line
    split = re.sub(r", (?=\*{0,2}\w+:|\*,)", ",\n    ", arguments)
    return f"{name}(\n    {split},\n){result}"


def _resolved(default: Any, known: dict[str, Any]) -> Any:
    """Give the value of a default that is a name, or an ellipsis if it is a function."""
    if not isinstance(default, ast.Name):
        return default
    value = known[default.id]
    return ast.Constant(... if callable(value) else value)


def _code(text: str) -> str:
    return f"```py\n{text}\n```\n"


def prose(doc: str | None) -> str:
    """Write a docstring in Markdown: examples are code, and what HTML would take for its own is escaped."""
    parts = []
    for paragraph in re.split(r"\n\s*\n", inspect.cleandoc(doc or "").strip()):
        if paragraph.startswith(">>> "):
            parts.append(f"```pycon\n{example(paragraph)}\n```\n")
        elif paragraph.startswith("    "):
            parts.append(f"```text\n{textwrap.dedent(paragraph)}\n```\n")
        else:
            parts.append(escaped(paragraph) + "\n")
    return "\n".join(parts)


def example(text: str) -> str:
    """Write an example so that it runs anywhere: with imports, and calls by their full names."""
    calls = "|".join(name for name in sono.__all__ if not name.startswith("_"))
    text = re.sub(
        r"(?m)^(>>> .*|\.\.\. .*)$",
        lambda line: re.sub(rf"(?<![\w.\"'])({calls})\(", r"sono.\1(", line[0]),
        text,
    )
    used = [name for name in ("math", "sono") if f"{name}." in text]
    return (
        "".join(f">>> import {name}\n" for name in used if not re.search(rf"import .*\b{name}\b", text))
        + text
    )


def escaped(text: str) -> str:
    """Escape what Markdown would take for its own, but for code between backticks."""
    pieces = re.split(r"(`[^`]*`)", text)
    pieces[::2] = [re.sub(r"([*\[\]])", r"\\\1", piece).replace("<", "&lt;") for piece in pieces[::2]]
    return re.sub(r"docs/(\w+/\w+\.md)", r"[\1](../\1)", "".join(pieces))
