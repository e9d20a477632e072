"""The README's commands work one after the other, as they stand there."""

import os
import re
import subprocess
import sys
from pathlib import Path

import pytest

README = Path(__file__).parent.parent / "README.md"


@pytest.mark.slow
@pytest.mark.skipif(os.name != "posix" or not README.exists(), reason="needs a shell and the source tree")
def test_the_trefoils_of_the_readme(tmp_path: Path) -> None:
    *_, block = re.findall(r"## Using it\n+```sh\n(.*?)```", README.read_text(), re.DOTALL)
    lines = [line for line in block.splitlines() if re.search(r"trefoil|3_1", line)]
    assert len(lines) == 5
    sono = tmp_path / "bin" / "sono"
    sono.parent.mkdir()
    sono.write_text(f"#!/bin/sh\nexec {sys.executable} -c 'from sono.cli import main; main()' \"$@\"\n")
    sono.chmod(0o755)
    path = f"{sono.parent}{os.pathsep}{os.environ['PATH']}"
    for line in lines:
        line = line.replace("| column -t", "")  # which not every machine has
        done = subprocess.run(
            line, shell=True, cwd=tmp_path, env=os.environ | {"PATH": path}, capture_output=True, check=False
        )
        assert done.returncode == 0, (line, done.stderr)
