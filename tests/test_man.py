"""The man pages say what the helps say, in troff that is taken without a word."""

import shutil
import subprocess

import make_man
import pytest

from sono.cli import COMMANDS

PAGES = dict(make_man.pages())

each_page = pytest.mark.parametrize("name", PAGES)


@pytest.mark.skipif(not make_man.FOLDER.is_dir(), reason="needs the source tree")
def test_the_pages_are_those_of_the_helps() -> None:
    there = {path.stem: path.read_text(encoding="utf-8") for path in make_man.FOLDER.iterdir()}
    assert there == PAGES, "write them anew: python -m tests.make_man"


def test_each_command_has_a_page() -> None:
    assert set(PAGES) == {"sono", *(f"sono-{name}" for name in COMMANDS)}
    assert all(f"sono\\-{name}(1)" in PAGES["sono"] for name in COMMANDS)


@each_page
@pytest.mark.skipif(not shutil.which("groff"), reason="needs groff")
def test_troff_has_no_complaint(name: str) -> None:
    command = ["groff", "-man", "-ww", "-Wbreak", "-Kutf8", "-Tutf8", "-P-cbou"]
    done = subprocess.run(command, input=PAGES[name], capture_output=True, encoding="utf-8", check=True)
    assert done.stderr == ""
    assert all(part in done.stdout for part in ("NAME", "SYNOPSIS", "OPTIONS", "-h, --help"))


@pytest.mark.parametrize(
    ("text", "troff"),
    [(".x", "\\&.x"), ("'x", "\\&'x"), ("a\\b", "a\\eb"), ("--all", "\\-\\-all"), ("a\n  b", "a b")],
)
def test_text_is_no_request(text: str, troff: str) -> None:
    assert make_man.escaped(text) == troff
