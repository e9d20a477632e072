"""What a file may hold: see `tests/fuzz.py`."""

from itertools import islice
from pathlib import Path

import pytest
from fuzz import complaint, mutants


@pytest.mark.filterwarnings("error")
def test_mutated_files_give_a_row_or_a_message(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    for number, content in enumerate(islice(mutants(0), 2500)):
        Path("k.txt").write_bytes(content)
        assert complaint("k.txt") is None, number
