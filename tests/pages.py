"""Runs what pages of the documentation say, block after block, in one folder for each page.

A block `sh` is a script; in `console` a line `$ COMMAND` is followed by what it writes to a terminal, with
`...` for any lines; `python` is run as it is or, with `>>>`, as a doctest; `pycon` needs nothing before it.
Files that a page links to are there. A comment directly above a block may say

    <!-- the test runs this with: --time-limit 8h -> --time-limit 3; 64 -> 2 -->
    <!-- before it the test runs: sono start 3_1 -o mystery.txt -->
    <!-- not run: it installs packages -->
"""

import doctest
import os
import pty
import re
import shutil
import subprocess
import sys
import tempfile
from collections.abc import Iterator
from dataclasses import dataclass, field
from itertools import zip_longest
from pathlib import Path
from typing import Any

DOCS = Path(__file__).parent.parent / "docs"

REASONS = {
    "it changes the shell",
    "it installs packages",
    "it needs a cluster",
    "it takes minutes",
}
"""Why a block may stay untried."""

_BLOCK = re.compile(r"((?:^<!--(?:(?!-->).)*-->\n+)*)^```(\w+)[^\n]*\n(.*?)^```$", re.MULTILINE | re.DOTALL)
_NUMBER = re.compile(r"([-+−]?\d+(?:\.\d+)?(?:e[-+]?\d+)?)")
_SECONDS = re.compile(r"\d+(?:\.\d+)?(?= (?:s|seconds?)\b)")


@dataclass(frozen=True)
class Block:
    """A block of a page: its `kind`, its `text`, and what the comments above it say."""

    kind: str
    text: str
    before: str
    skipped: str | None
    changes: list[tuple[str, str]]

    def run_text(self) -> str:
        """Give the text with its changes, each of which must find something to change."""
        text = self.text
        for old, new in self.changes:
            assert old in text, f"{old!r} is not in the block:\n{text}"
            text = text.replace(old, new)
        return text


def blocks(page: str) -> Iterator[Block]:
    """Give the blocks of a page."""
    for comments, kind, text in _BLOCK.findall(page):
        said = dict(
            re.findall(
                r"<!-- (not run|before it the test runs|the test runs this with): (.*?) -->", comments, re.S
            )
        )
        changes = [part.split(" -> ") for part in said.get("the test runs this with", "").split("; ") if part]
        yield Block(
            kind,
            text,
            said.get("before it the test runs", ""),
            said.get("not run"),
            [(old, new) for old, new in changes],
        )


def same(want: str, got: str) -> bool:
    """Tell whether two outputs are the same word by word, but for spaces, last digits and seconds."""
    first, *rest = (part.split() for part in re.split(r"(?m)^\s*\.\.\.$", _SECONDS.sub("0.0", want)))
    words = _SECONDS.sub("0.0", got).split()
    at = len(first)
    if not _alike(first, words[:at]):
        return False
    for part in rest[:-1]:
        fits = (k for k in range(at, len(words) + 1) if _alike(part, words[k : k + len(part)]))
        at = next(fits, len(words)) + len(part)
    return _alike(rest[-1], words[max(at, len(words) - len(rest[-1])) :]) if rest else at == len(words)


def _alike(want: list[str], got: list[str]) -> bool:
    pairs = zip_longest(want, got, fillvalue="")
    return all(
        all(_near(x, y) for x, y in zip_longest(_NUMBER.split(a), _NUMBER.split(b), fillvalue=""))
        for a, b in pairs
    )


def _near(want: str, got: str) -> bool:
    """Tell whether two pieces of text are equal, or numbers with a point that are near each other."""
    if want == got:
        return True
    if not (_NUMBER.fullmatch(want) and _NUMBER.fullmatch(got) and re.search("[.e]", want)):
        return False
    a, b = (float(text.replace("−", "-")) for text in (want, got))
    digits, _, power = want.partition("e")
    half = 0.501 * 10.0 ** (int(power or 0) - len(digits.partition(".")[2]))
    return abs(a - b) <= max(1e-4 * abs(a), half) or max(abs(a), abs(b)) < 1e-6


class _Checker(doctest.OutputChecker):
    def check_output(self, want: str, got: str, flags: int) -> bool:
        return same(want, got) or super().check_output(want, got, flags)


@dataclass
class Reader:
    """Somebody who does what a page says, in a `folder`, with the `sono` of this Python."""

    folder: Path
    names: dict[str, Any] = field(default_factory=lambda: {"__name__": "__main__"})

    def __post_init__(self) -> None:
        """Make `sono` and `python` commands."""
        self.bin = Path(tempfile.mkdtemp(prefix="bin", dir=self.folder.parent))
        for name, arguments in (("sono", " -c 'from sono.cli import run; run()'"), ("python", "")):
            command = self.bin / name
            command.write_text(f'#!/bin/sh\nexec {sys.executable}{arguments} "$@"\n')
            command.chmod(0o755)

    def fetch(self, page: Path) -> None:
        """Have the files that a page links to."""
        for link in re.findall(r"\]\(([^)#:]+)\)", page.read_text(encoding="utf-8")):
            source = page.parent / link
            if source.suffix not in (".md", ".html", ".png", ".svg") and source.is_file():
                shutil.copy(source, self.folder)

    def do(self, block: Block, where: str) -> None:
        """Do what a block says; it fails if that fails, or gives another output."""
        if block.before:
            self._script(block.before)
        text = block.run_text()
        if block.kind == "sh":
            self._script(text)
        elif block.kind == "console":
            self._session(text)
        elif block.kind == "pycon":
            self._examples(text, where, {})
        elif block.kind == "python" and ">>> " in text:
            self._examples(text, where, self.names)
        elif block.kind == "python":
            exec(compile(text, where, "exec"), self.names)

    def _script(self, text: str) -> None:
        code, output, errors = self._run(text)
        assert code == 0, f"{text}\nended with {code}:\n{output}{errors}"

    def _session(self, text: str) -> None:
        assert text.startswith("$ "), "begin a console with a command"
        for part in re.split(r"(?m)^\$ ", text)[1:]:
            command, want = re.fullmatch(r"((?:[^\n]*\\\n)*[^\n]*)\n?(.*)", part, re.DOTALL).groups()  # type: ignore[union-attr]
            _, output, errors = self._run(command)
            told = [line for line in want.splitlines() if line.startswith("sono: ")]
            shown = "".join(line for line in want.splitlines(True) if not line.startswith("sono: "))
            assert same(shown, output), f"$ {command}\n{output}"
            assert same("\n".join(sorted(told)), "\n".join(sorted(errors.splitlines()))), (
                f"$ {command}\n{errors}"
            )

    def _examples(self, text: str, where: str, names: dict[str, Any]) -> None:
        test = doctest.DocTestParser().get_doctest(text, names, where, where, 0)
        failures: list[str] = []
        doctest.DocTestRunner(_Checker(), verbose=False).run(test, out=failures.append, clear_globs=False)
        names |= test.globs
        assert not failures, "".join(failures)

    def _run(self, script: str) -> tuple[int, str, str]:
        """Run a script whose standard output is a terminal; give its exit code, output and messages."""
        ours, theirs = pty.openpty()
        paths = f"{self.bin}{os.pathsep}{Path(sys.executable).parent}{os.pathsep}{os.environ['PATH']}"
        more = {"PATH": paths, "COLUMNS": "200", "TERM": "dumb", "MPLBACKEND": "Agg"}
        with tempfile.TemporaryFile("w+", encoding="utf-8") as errors:
            process = subprocess.Popen(
                ["bash", "-e", "-c", script],
                cwd=self.folder,
                env=os.environ | more,
                stdin=subprocess.DEVNULL,
                stdout=theirs,
                stderr=errors,
            )
            os.close(theirs)
            output = b"".join(iter(lambda: _some(ours), b""))
            os.close(ours)
            code = process.wait()
            errors.seek(0)
            return code, output.decode().replace("\r\n", "\n"), errors.read()


def _some(terminal: int) -> bytes:
    try:
        return os.read(terminal, 65536)
    except OSError:  # as Linux says that the other end is closed
        return b""
