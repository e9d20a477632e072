"""What shells offer, and the scripts that make them ask."""

import os
import shutil
import subprocess
import sys
from pathlib import Path

import pytest
from click.shell_completion import BashComplete, CompletionItem, FishComplete, ShellComplete, ZshComplete
from conftest import Sono

from sono import starts
from sono.cli import COMMANDS, main
from sono.cli.completion import SHELLS


def offered(*words: str, by: type[ShellComplete] = BashComplete) -> list[CompletionItem[str]]:
    """What is offered for the last word."""
    return by(main, {}, "sono", "_SONO_COMPLETE").get_completions(list(words[:-1]), words[-1])


def values(*words: str) -> list[str]:
    return [item.value for item in offered(*words)]


def kinds(*words: str) -> list[str]:
    return [item.type for item in offered(*words)]


def test_commands_and_options() -> None:
    assert values("") == list(COMMANDS)
    assert values("ti") == ["tighten"]
    assert values("search", "--time") == ["--time-limit"]
    assert values("tighten", "--method", "p") == ["polish"]


@pytest.mark.parametrize("command", ["tighten", "search", "start", "verify", "certify", "atlas"])
def test_names_of_knots(folder: Path, command: str) -> None:
    assert values(command, "8_2") == ["8_2", "8_20", "8_21"]
    assert values(command, "m8_2") == ["m8_2", "m8_20", "m8_21"]
    assert values(command, "3_1#m3") == ["3_1#m3_1"]
    assert values(command, "whi") == ["Whitehead"]
    assert values(command, "l4") == ["L4a1"]


def test_all_names_are_offered() -> None:
    begins = {name[0] for name in starts.names()}
    assert {name for begin in begins for name in values("start", begin)} == set(starts.names())


@pytest.mark.parametrize("command", ["tighten", "search", "verify", "certify"])
def test_files_beside_names(folder: Path, command: str) -> None:
    assert values(command, "3_") == ["3_1", "3_1.txt"]
    assert values(command, "Hop") == ["Hopf", "Hopf.txt"]
    assert kinds(command, "") == kinds(command, "tight/") == ["file"]


def test_a_second_argument_is_completed_too() -> None:
    assert values("verify", "8_18", "9_4")[0] == values("tighten", "8_18", "-n", "60", "9_4")[0] == "9_4"


@pytest.mark.parametrize(
    "words",
    [
        *[
            ("measure", "3_"),
            ("identify", "3_"),
            ("convert", "3_"),
            ("convert", "a", "3_"),
            ("compare", "3_"),
        ],
        *[("tighten", "-o", "3_"), ("search", "--list", "3_"), ("start", "3_1", "--output", "3_")],
        *[("certify", "--check", "3_"), ("compare", "--published", "3_")],
    ],
)
def test_files_where_no_knot_is_meant(words: tuple[str, ...]) -> None:
    assert kinds(*words) == ["file"]


def test_folders() -> None:
    assert kinds("atlas", "--folder", "a") == kinds("tighten", "--checkpoint", "a") == ["dir"]
    assert kinds("certify", "-o", "a") == ["dir"]


def test_columns() -> None:
    assert {"l_p", "l_c", "l_a"} < set(values("measure", "--columns", "l_"))
    assert values("measure", "--columns", "knot,l_p") == ["knot,l_p"]


@pytest.mark.parametrize(
    "words", [("tighten", "--set", "3"), ("search", "--seed", "3"), ("start", "--braid", "1")]
)
def test_nothing_where_anything_may_be_meant(words: tuple[str, ...]) -> None:
    assert values(*words) == []


@pytest.mark.parametrize(
    "words", [("compare", "--sources", ""), ("tighten", "--shard", "9", ""), ("absent", "")]
)
def test_what_is_typed_wrong_or_runs_at_once_does_nothing(
    words: tuple[str, ...], capsys: pytest.CaptureFixture[str]
) -> None:
    offered(*words)
    assert capsys.readouterr() == ("", "")


@pytest.mark.parametrize("shell", SHELLS)
def test_a_script_asks_the_program(sono: Sono, shell: str) -> None:
    script = sono("completion", shell).stdout
    assert f"{shell}_complete" in script
    assert "_SONO_COMPLETE" in script
    assert values("completion", shell[:2]) == [shell]


def test_an_unknown_shell(sono: Sono) -> None:
    result = sono("completion", "csh")
    assert result.exit_code == 2
    assert "bash" in result.stderr


@pytest.mark.parametrize("by", [ZshComplete, FishComplete])
def test_other_shells_are_told_the_same(by: type[ShellComplete]) -> None:
    assert [item.value for item in offered("start", "8_2", by=by)] == values("start", "8_2")


@pytest.mark.skipif(not shutil.which("bash"), reason="needs bash")
def test_bash_completes(folder: Path, sono: Sono) -> None:
    (folder / "sono").write_text(
        f"#!/bin/sh\nexec {sys.executable} -c 'from sono.cli import run; run()' \"$@\"\n"
    )
    (folder / "sono").chmod(0o755)
    (folder / "script").write_text(sono("completion", "bash").stdout)
    asks = "source ./script; COMP_WORDS=(sono start 8_2); COMP_CWORD=2; _sono_completion sono"
    path = f"{folder}{os.pathsep}{os.environ['PATH']}"
    done = subprocess.run(
        ["bash", "--norc", "-c", f'{asks}; echo "${{COMPREPLY[@]}}"'],
        env=os.environ | {"PATH": path},
        capture_output=True,
        text=True,
        check=True,
    )
    assert done.stdout.split() == ["8_2", "8_20", "8_21"]


def test_options_wait_for_no_large_module() -> None:
    script = (
        "import sys; from click.shell_completion import BashComplete; from sono.cli import COMMANDS, main\n"
        "for name in COMMANDS: BashComplete(main, {}, 'sono', 'X').get_completions([name], '--')\n"
        "print(*{'numpy', 'rich', 'sono._core'} & set(sys.modules))"
    )
    done = subprocess.run([sys.executable, "-c", script], capture_output=True, text=True, check=True)
    assert done.stdout.strip() == ""
