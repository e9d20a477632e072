"""Files of several curves: each is a row and a job of its own, and one that is wrong stays with itself."""

import os
from collections.abc import Sequence
from pathlib import Path

import pytest
from conftest import QUICK, Sono

import sono as package
from sono import formats, starts
from sono.formats import FormatError, Raw, text
from sono.jobs import sources


class Frames:
    """Plain text, in which a line FRAME KEY begins each curve."""

    def recognises(self, content: str) -> bool:
        return content.startswith("FRAME")

    def read(self, content: str, name: str) -> Sequence[Raw]:
        parts = [part.partition("\n") for part in content.split("FRAME ")[1:]]
        return [Raw(text.read(rows, name)[0].chains, key) for key, _, rows in parts]


@pytest.fixture
def frames(folder: Path, monkeypatch: pytest.MonkeyPatch) -> str:
    """A file of three curves, the second of which is wrong."""
    monkeypatch.setattr(formats, "READERS", {"frames": Frames(), **formats.READERS})
    trefoil = text.write(starts.start("3_1"), [])
    Path("run.txt").write_text(f"FRAME 1\n{trefoil}FRAME b/2\n0 0 0\nFRAME 3\n{trefoil}")
    return "run.txt"


def test_measure_gives_a_row_each(frames: str, sono: Sono) -> None:
    result = sono("measure", frames, "3_1.txt")
    assert result.exit_code == 1
    assert [row.split("\t")[0] for row in result.stdout.splitlines()[1:]] == ["run:1", "run:3", "3_1"]
    assert result.stderr.startswith("sono: run.txt:1: the component that starts here has too few vertices")
    one = sono("measure", f"{frames}:3")
    assert (one.exit_code, one.stdout.splitlines()[1]) == (0, result.stdout.splitlines()[2])
    none = sono("measure", f"{frames}:4")
    assert (none.exit_code, none.stderr) == (
        1,
        "sono: run.txt: holds no curve '4'; there are: 1, b/2, 3\n",
    )


def test_each_is_tightened_by_itself(frames: str, sono: Sono) -> None:
    result = sono("tighten", frames, "-n", "60", "-o", "out/", *QUICK)
    assert result.exit_code == 1
    assert [row.split("\t")[0] for row in result.stdout.splitlines()[1:]] == ["run:1", "run:3"]
    assert sorted(os.listdir("out")) == ["run.1.n60.txt", "run.3.n60.txt"]
    again = sono("tighten", frames, "-n", "60", "-o", "out/", *QUICK, "--resume", "-j", "2")
    assert again.stdout.splitlines()[1].startswith("run:1")


def test_standard_input_and_shards(frames: str, sono: Sono) -> None:
    content = Path(frames).read_text()
    piped = sono("tighten", "-", "-n", "60", "--shard", "3/3", *QUICK, input=content)
    assert (piped.exit_code, piped.stderr) == (0, "")
    assert [row.split("\t")[0] for row in piped.stdout.splitlines()[1:]] == ["stdin:3"]
    assert Path("stdin.3.n60.txt").exists()
    assert sono("measure", "--", "-:3", input=content).stdout.splitlines()[1].startswith("stdin:3")


@pytest.mark.slow
def test_each_is_searched_for_by_itself(frames: str, sono: Sono) -> None:
    Path("list").write_text(f"{frames}\n")
    result = sono("search", "--list", "list", "--trials", "1", "--checkpoint", "c")
    assert "run.1.tight.txt" in os.listdir(".")
    assert sorted({row.split("\t")[0] for row in result.stdout.splitlines()[1:]}) == ["run:1", "run:3"]


def test_the_calls(frames: str) -> None:
    assert package.read(f"{frames}:1").n == package.read("3_1.txt").n
    with pytest.raises(FormatError, match=r"run.txt: holds 3 curves; run.txt:1 is one, of: 1, b/2, 3"):
        package.read(frames)
    with pytest.raises(FormatError, match="too few vertices"):
        package.read_all(frames)
    assert list(package.read_all(f"{frames}:3")) == ["3"]
    assert list(package.read_all("3_1.txt")) == [""]


def test_keys_are_made_safe_for_names_of_files(frames: str) -> None:
    assert [source.stem for source in sources.curves(frames)] == ["run.1", "run.b_2", "run.3"]


def test_a_plain_file_is_read_when_its_turn_comes(frames: str, monkeypatch: pytest.MonkeyPatch) -> None:
    (plain,) = sources.curves("3_1.txt")
    assert plain.found is None
    assert all(source.found for source in sources.curves(frames))
    os.mkfifo("pipe")
    assert formats.may_hold_several("pipe")
    assert formats.may_hold_several("nowhere.txt")
