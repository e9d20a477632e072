"""The group: what holds for every command."""

import os
import signal
import subprocess
import sys
from importlib.metadata import version
from pathlib import Path

import pytest
from conftest import QUICK, Sono, Spawn

import sono as package
from sono.cli import COMMANDS

posix = pytest.mark.skipif(os.name != "posix", reason="needs Unix signals and devices")


def test_help_names_every_command(sono: Sono) -> None:
    result = sono("--help")
    assert result.exit_code == 0
    assert all(f"  {name} " in result.output for name in COMMANDS)


@pytest.mark.parametrize("command", COMMANDS)
def test_each_command_has_a_help(sono: Sono, command: str) -> None:
    result = sono(command, "-h")
    assert result.exit_code == 0
    assert result.output.startswith(f"Usage: main {command} [OPTIONS]")


def test_help_waits_for_no_large_module() -> None:
    script = (
        "import sys; from sono.cli import COMMANDS, main\n"
        "for name in ('', *COMMANDS): main([*filter(None, [name]), '--help'], standalone_mode=False)\n"
        "sys.exit(' '.join({'numpy', 'rich', 'sono._core'} & set(sys.modules)))"
    )
    done = subprocess.run([sys.executable, "-c", script], capture_output=True, text=True, check=False)
    assert done.stderr.strip() == ""
    assert done.stdout.count("Usage:") == 1 + len(COMMANDS)


def test_version(sono: Sono) -> None:
    assert version("sono") == package.__version__
    assert package.__version__ in sono("--version").output


def test_public_names() -> None:
    assert {*package._HOMES, *package._MODULES, "__version__"} == {*package.__all__} == {*dir(package)}
    for name in package._HOMES:
        assert getattr(package, name).__name__ == name
    with pytest.raises(AttributeError, match="no attribute 'loosen'"):
        _ = package.loosen


@pytest.mark.parametrize("arguments", [["loosen"], ["measure"], ["measure", "--fast", "x"], ["tighten"]])
def test_usage_errors(sono: Sono, arguments: list[str]) -> None:
    result = sono(*arguments)
    assert result.exit_code == 2
    assert result.stdout == ""
    assert "Usage:" in result.stderr


COMMAND_LINES = [
    ["measure", "3_1.txt", "3_1.txt"],
    ["start", "3_1"],
    ["tighten", "3_1.txt", "Hopf.txt", "-n", "60", *QUICK],
    ["tighten", "3_1.txt", "-n", "60", "-o", "-", *QUICK],
]
each_command = pytest.mark.parametrize("arguments", COMMAND_LINES, ids=lambda a: " ".join(a[:5]))


@posix
@each_command
def test_nobody_reads_the_output(spawn: Spawn, arguments: list[str]) -> None:
    reading, writing = os.pipe()
    os.close(reading)
    process = spawn(*arguments, "--quiet" if arguments[0] != "start" else "--force", stdout=writing)
    os.close(writing)
    assert process.communicate()[1] == ""
    assert process.returncode == 1


@posix
@each_command
def test_no_room_for_the_output(spawn: Spawn, arguments: list[str]) -> None:
    if not os.path.exists("/dev/full"):
        pytest.skip("needs /dev/full")
    with open("/dev/full", "w") as full:
        process = spawn(*arguments, stdout=full)
    _, stderr = process.communicate()
    assert stderr.endswith("sono: the output cannot be written: No space left on device\n")
    assert "Traceback" not in stderr
    assert process.returncode == 1


@posix
@pytest.mark.skipif(not os.path.exists("/dev/full"), reason="needs /dev/full")
@pytest.mark.parametrize("arguments", [["--help"], ["--version"], ["tighten", "-h"], ["start", "--list"]])
@pytest.mark.parametrize("to", [">/dev/full", ">&-"])
def test_no_room_for_the_help(arguments: list[str], to: str) -> None:
    done = in_a_shell(" ".join(arguments), to)
    why = "No space left on device" if to == ">/dev/full" else "standard output is closed"
    assert done.stderr == f"sono: the output cannot be written: {why}\n"
    assert done.returncode == 1


def in_a_shell(arguments: str, redirection: str) -> "subprocess.CompletedProcess[str]":
    """Run `sono ARGUMENTS` with the streams that a shell gives it."""
    line = (
        f"{sys.executable} -c 'from sono.cli import main; main(prog_name=\"sono\")' {arguments} {redirection}"
    )
    return subprocess.run(line, shell=True, capture_output=True, text=True, check=False)


@posix
@pytest.mark.parametrize(
    ("arguments", "redirection", "code", "stdout", "stderr"),
    [
        ("measure 3_1.txt", ">&-", 1, "", "the output cannot be written: standard output is closed"),
        ("start 3_1", ">&-", 1, "", "the output cannot be written: standard output is closed"),
        (
            f"tighten 3_1 -n 60 {' '.join(QUICK)}",
            ">&-",
            1,
            "",
            "the output cannot be written: standard output",
        ),
        (f"tighten 3_1 -n 60 {' '.join(QUICK)}", "2>&-", 0, "3_1\t60", ""),
        (f"tighten 3_1 -n 60 {' '.join(QUICK)}", "<&- 2>&-", 0, "3_1\t60", ""),
        (f"tighten 3_1 -n 60 -o - -q {' '.join(QUICK)}", "<&-", 0, "# 3_1: tight", ""),
        ("measure - 3_1.txt", "<&-", 1, "3_1\t69", "<stdin>: cannot be read: standard input is closed"),
        ("tighten - -n 60", "<&-", 1, "", "<stdin>: cannot be read: standard input is closed"),
        ("compare -", "<&-", 1, "", "<stdin>: cannot be read: standard input is closed"),
        ("search --list -", "<&-", 2, "", "-: cannot be read: standard input is closed"),
        ("measure absent", "2>&-", 1, "", ""),
        ("measure absent", "2>/dev/full", 1, "", ""),
        ("absent", "2>/dev/full", 2, "", ""),
        ("measure 3_1.txt", "<&- >&- 2>&-", 1, "", ""),
    ],
)
def test_streams_that_are_closed(
    folder: Path, arguments: str, redirection: str, code: int, stdout: str, stderr: str
) -> None:
    done = in_a_shell(arguments, redirection)
    assert done.returncode == code
    assert stdout in done.stdout
    assert stderr in done.stderr
    assert "Traceback" not in done.stderr


@posix
def test_control_characters_of_names_do_not_reach_a_terminal(folder: Path, sono: Sono, spawn: Spawn) -> None:
    name = "a\x1b[31m\x07\x9b\u202eb"
    (folder / f"{name}.txt").write_bytes((folder / "3_1.txt").read_bytes())
    (folder / f"{name}.bad").write_text("x")
    safe = r"a\x1b[31m\x07\x9b\u202eb"
    for format in ("table", "tsv", "csv", "md", "latex", "jsonl", "json"):
        result = sono("measure", f"{name}.txt", f"{name}.bad", f"{name}.absent", "--format", format)
        assert not set(result.output) & {"\x1b", "\x07", "\x9b", "\u202e"}
        assert f"sono: {safe}.bad:1: " in result.stderr
    for wrong in (["measure", f"--{name}"], [name], ["search", "--list", name], ["start", name]):
        result = sono(*wrong)
        assert result.exit_code == 2
        assert not set(result.output) & {"\x1b", "\x07", "\x9b", "\u202e"}
    ours, theirs = os.openpty()
    process = spawn("tighten", f"{name}.txt", "-n", "60", *QUICK, stderr=theirs)
    assert process.wait() == 0
    os.write(theirs, b"end")
    shown = b""
    while not shown.endswith(b"end"):
        shown += os.read(ours, 1 << 16)
    assert rb"a\x1b[31m" in shown
    assert b"\x1b[31m" not in shown
    assert "\x1b" not in (folder / f"{name}.n60.txt").read_text()
    os.close(theirs)
    os.close(ours)


@posix
def test_ctrl_c_while_waiting_for_input(spawn: Spawn) -> None:
    process = spawn("measure", "-", stdin=subprocess.PIPE)
    assert process.stdin
    assert process.stdout
    assert process.stdout.readline().startswith("knot\t")  # now it reads
    process.send_signal(signal.SIGINT)
    assert process.wait() == 130
    assert "Traceback" not in process.communicate()[1]


def test_a_name_that_the_terminal_cannot_show(folder: Path, spawn: Spawn) -> None:
    (folder / "3_1.txt").rename(folder / "三葉.txt")
    process = spawn("measure", "三葉.txt", env=os.environ | {"PYTHONIOENCODING": "ascii"})
    stdout, stderr = process.communicate()
    assert stdout.splitlines()[1].startswith(r"\u4e09\u8449" + "\t")
    assert (stderr, process.returncode) == ("", 0)


@posix
def test_a_pipeline(folder: Path) -> None:
    sono = f"{sys.executable} -c 'from sono.cli import main; main()'"
    line = f"{sono} start 3_1 | {sono} tighten - -n 60 -o - -q {' '.join(QUICK)} | {sono} measure -"
    done = subprocess.run(line, shell=True, capture_output=True, text=True, check=False)
    assert done.stderr == ""
    header, row = done.stdout.splitlines()
    assert header.split("\t")[:4] == ["knot", "n", "dl", "l_p"]
    assert row.split("\t")[:2] == ["stdin", "60"]
