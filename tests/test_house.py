"""Each room imports what its first lines say it may, and no two rooms import each other."""

import ast
import re
from pathlib import Path

import pytest

import sono

HOME = Path(sono.__file__).parent
ROOMS = sorted(path.parent for path in HOME.glob("*/__init__.py"))


def imported(room: Path) -> set[str]:
    """Return the names of the rooms and modules of sono that a room's modules import, wherever they do."""
    found: set[str] = set()
    for path in room.rglob("*.py"):
        for node in ast.walk(ast.parse(path.read_text())):
            if isinstance(node, ast.ImportFrom) and node.module == "sono":
                found |= {alias.name for alias in node.names}
            elif isinstance(node, ast.ImportFrom) and (node.module or "").startswith("sono."):
                found.add((node.module or "").split(".")[1])
    return found - {room.name, "_core"}


def allowed(room: Path) -> set[str]:
    text = ast.get_docstring(ast.parse((room / "__init__.py").read_text())) or ""
    sentences = re.findall(r"May import ([^.]*)\.", text)
    return set(re.findall(r"`(\w+)`", " ".join(sentences)))


@pytest.mark.parametrize("room", ROOMS, ids=lambda room: str(room.name))
def test_a_room_imports_what_it_says(room: Path) -> None:
    assert imported(room) == allowed(room)


def test_no_arrow_points_back() -> None:
    arrows = {room.name: imported(room) for room in ROOMS}

    def reached(room: str, seen: frozenset[str] = frozenset()) -> set[str]:
        return {room}.union(*(reached(to) for to in arrows.get(room, set()) - seen))

    for room, direct in arrows.items():
        assert not any(room in reached(to) for to in direct), room


RUST = Path(__file__).parent.parent / "rust"


@pytest.mark.skipif(not RUST.is_dir(), reason="needs the source tree")
def test_only_the_bindings_name_python_and_the_engines_are_siblings() -> None:
    other = {"sono": "polish", "polish": "sono"}
    for path in RUST.rglob("*.rs"):
        folder, text = path.relative_to(RUST).parts[0], path.read_text()
        assert "pyo3::" not in text or folder == "python", path
        uses = set(re.findall(r"^\s*(?:pub )?use crate::(\w+)", text, re.MULTILINE))
        engines = {"sono", "polish", "python"} if folder not in other else {other[folder], "python"}
        assert not engines & uses or folder in ("python", "lib.rs"), path
