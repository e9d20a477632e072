"""What other systems than the one under test do: names of files, encodings, ends of lines."""

import io
import os
import subprocess
import sys
from pathlib import Path

import click
import pytest
from conftest import QUICK, Sono

from sono import formats, starts
from sono.cli import convert, streams
from sono.jobs.sources import Source

SPELLINGS = [
    *["5/2", "3_1*", "3_1\\#4_1", "gauss:1 -2 | 2 -1", "pd:X[1,5,2,4] X[3,1,4,6] X[5,3,6,2]", "5:2:1"],
    *["T(2,3)", "L5a1{1}", "4^{2}_1", "!3_1", "dt:[[6,8],[2,4]]", "1 -2\t1 -2", "P(-2, 3, 7)", "3_1^*"],
]


@pytest.mark.parametrize("name", SPELLINGS)
def test_files_of_knots_have_names_that_any_system_takes(folder: Path, name: str) -> None:
    assert starts.knows(name)
    stem = Source(name).stem
    assert not set(stem) & set('<>:"/\\|?*\t\n')
    assert stem == stem.strip()


def test_other_knots_have_other_files(folder: Path) -> None:
    stems = [Source(name).stem for name in (*SPELLINGS, *starts.names())]
    assert len(set(stems)) == len(stems)


def test_where_case_does_not_matter_no_rope_is_written_over_another(
    folder: Path, sono: Sono, monkeypatch: pytest.MonkeyPatch
) -> None:
    given = ["one/a.xyz", "two/A.xyz"]
    for path in given:
        (folder / path).parent.mkdir()
        formats.write(folder / path, starts.start("3_1"))
    monkeypatch.setattr(os.path, "normcase", str.lower)
    result = sono("tighten", *given, "-n", "60", "-o", "out/", *QUICK)
    assert (result.exit_code, result.stdout) == (2, "")
    assert "out/a.n60.txt would be written 2 times" in result.stderr
    with pytest.raises(click.UsageError, match=r"a\.xyz would be written twice"):
        convert._plan([Source(path) for path in given], "out/", "xyz")


@pytest.mark.parametrize("mark", ["", "\ufeff"])
@pytest.mark.parametrize("end", ["\n", "\r\n"])
def test_a_list_as_editors_write_it(folder: Path, sono: Sono, mark: str, end: str) -> None:
    (folder / "list.txt").write_bytes(end.join([f"{mark}3_1.txt", "Hopf  # a link", ""]).encode())
    result = sono("tighten", "--list", "list.txt", "-n", "60", *QUICK)
    assert (result.exit_code, [row.split("\t")[0] for row in result.stdout.splitlines()[1:]]) == (
        0,
        ["3_1", "Hopf"],
    )


def test_a_pipe_holds_what_a_file_would() -> None:
    there = io.BytesIO()
    stream = io.TextIOWrapper(there, encoding="cp1252", errors="backslashreplace", newline="\r\n")
    streams.as_files_are(stream)
    stream.write("三葉 é\n")
    stream.flush()
    assert there.getvalue() == "三葉 é\n".encode()


@pytest.mark.slow
def test_no_file_depends_on_the_encoding_of_the_system(folder: Path) -> None:
    """Python warns where a text file is opened without saying how, and a warning is an error here."""
    commands = [
        ["tighten", "3_1.txt", "-n", "60", "--checkpoint", "state", "--contacts", "forces.tsv", *QUICK],
        [
            "tighten",
            "3_1.txt",
            "-n",
            "60",
            "--checkpoint",
            "state",
            "--contacts",
            "forces.tsv",
            "--resume",
            *QUICK,
        ],
        *(
            ["convert", "3_1.n60.txt", f"knot{suffix}"]
            for suffix in (".obj", ".json", ".csv", ".vect", ".xyz.gz")
        ),
        *(["measure", f"knot{suffix}"] for suffix in (".obj", ".json", ".csv", ".vect", ".xyz.gz")),
        ["identify", "knot.obj"],
        ["certify", "8_18", "-o", "proofs"],
        ["certify", "--check", "proofs/8_18.certificate.json", "proofs/8_18.txt"],
        ["search", "3_1", "--trials", "1", "--time-limit", "10", "--checkpoint", "state"],
    ]
    script = (
        "import sys; from sono.cli import main\n"
        "for line in sys.argv[1:]:\n"
        "    try: main(line.split('|'))\n"
        "    except SystemExit as end: assert not end.code, (line, end.code)\n"
    )
    warned = ["-X", "warn_default_encoding", "-W", "error::EncodingWarning"]
    lines = ["|".join(command) for command in commands]
    done = subprocess.run(
        [sys.executable, *warned, "-c", script, *lines], capture_output=True, encoding="utf-8", check=False
    )
    assert done.returncode == 0, done.stderr
    assert "EncodingWarning" not in done.stderr
