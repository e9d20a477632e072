"""`cargo test`: the core's own tests, so that one command runs all."""

import subprocess
from pathlib import Path

import pytest


@pytest.mark.slow
def test_cargo_test() -> None:
    subprocess.run(["cargo", "test", "--release", "--quiet"], cwd=Path(__file__).parent.parent, check=True)
