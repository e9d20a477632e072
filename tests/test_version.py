"""`sono --version`, alone and with all that a report of a bug should say."""

import platform
import subprocess
import sys
from importlib import metadata

import pytest
from conftest import Sono

from sono import _core


def reported(sono: Sono, *arguments: str) -> dict[str, str]:
    result = sono(*arguments)
    assert (result.exit_code, result.stderr) == (0, "")
    return {
        name: what.strip() for name, _, what in (line.partition(" ") for line in result.stdout.splitlines())
    }


def test_one_line(sono: Sono) -> None:
    assert sono("--version").stdout.split() == ["main,", "version", metadata.version("sono")]


@pytest.mark.parametrize("arguments", [("--version", "--verbose"), ("--verbose", "--version")])
def test_all_that_a_report_should_say(sono: Sono, arguments: tuple[str, ...]) -> None:
    said = reported(sono, *arguments)
    assert said["sono"] == metadata.version("sono")
    assert said["core"].startswith(_core.about()[0])
    assert said["Python"].startswith(platform.python_version())
    assert said["numpy"] == metadata.version("numpy")
    assert {"platform", "threads", "click", "rich"} < set(said)


def test_the_core_is_of_this_version() -> None:
    version, build, processor, features = _core.about()
    assert version == metadata.version("sono")
    assert build in ("debug", "release")
    assert processor
    assert all(feature.islower() for feature in features)


def test_each_extra_but_that_of_tests_is_told(sono: Sono) -> None:
    extras = metadata.metadata("sono").get_all("Provides-Extra") or []
    said = " ".join(reported(sono, "--version", "--verbose").values())
    assert {extra for extra in extras if f"sono[{extra}]" in said} == {*extras} - {"test"}


def test_what_is_not_installed(sono: Sono, monkeypatch: pytest.MonkeyPatch) -> None:
    wants = [
        "numpy>=2",
        "absent-one>=1 ; extra == 'more'",
        'absent.two[x] ; python_version < "3" and extra == "b_2"',
    ]
    monkeypatch.setattr(metadata, "requires", lambda name: [*wants, "sono[more] ; extra == 'test'"])
    said = reported(sono, "--version", "--verbose")
    assert said["absent-one"] == "not installed, for sono[more]"
    assert said["absent.two"] == "not installed, for sono[b_2]"
    assert "sono[test]" not in " ".join(said.values())


def test_a_core_that_cannot_be_imported_is_told() -> None:
    script = "import sys; sys.modules['sono._core'] = None; from sono.cli import main; main()"
    command = [sys.executable, "-c", script, "--version", "--verbose"]
    done = subprocess.run(command, capture_output=True, text=True, check=True)
    assert "\ncore               cannot be imported: " in done.stdout


def test_verbose_goes_with_version(sono: Sono) -> None:
    result = sono("--verbose", "start", "3_1")
    assert (result.exit_code, result.stdout) == (2, "")
    assert "--version" in result.stderr
