"""Checkpoint files: what is read is what was saved, and nothing else is taken for it."""

import json
import random
from pathlib import Path

import numpy as np
import pytest

from sono import starts
from sono.curve import packed, unpacked
from sono.formats import FormatError
from sono.jobs import checkpoints
from sono.jobs.checkpoints import load, save

STATE = {"seconds": 0.1 + 0.2, "n": [1, 2], "curve": packed(starts.start("Hopf")), "none": None}


def test_what_is_read_is_what_was_saved(tmp_path: Path) -> None:
    save(tmp_path / "a.json", "test", STATE)
    assert load(tmp_path / "a.json", "test") == STATE


def test_curves_keep_every_bit() -> None:
    curve = [np.random.default_rng(0).normal(size=(n, 3)) * 10.0**n for n in (3, 5)]
    again = unpacked(json.loads(json.dumps(packed(curve))))
    assert again
    assert all(map(np.array_equal, again, curve))
    assert unpacked(packed(None)) is None
    for wrong in ("?", "AAAA", "AAAAAAAAAAA="):  # no base64, no number, one number
        with pytest.raises(ValueError, match=r"base64|padding|buffer|reshape"):
            unpacked([wrong])


@pytest.mark.parametrize("content", ["", "[]", "{}", '"x"', "\xff", "null", "1e999", "[" * 100_000])
def test_what_is_none(tmp_path: Path, content: str) -> None:
    path = tmp_path / "a.json"
    path.write_text(content, encoding="latin-1")
    with pytest.raises(FormatError, match=r"a\.json: is no checkpoint, or an old or damaged one; remove it"):
        load(path, "test")


def test_those_of_others(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    path = tmp_path / "a.json"
    save(path, "test", STATE)
    with pytest.raises(FormatError, match="is no checkpoint of a search"):
        load(path, "search")
    monkeypatch.setattr(checkpoints, "VERSION", 10**6)
    with pytest.raises(FormatError, match="another version of sono"):
        load(path, "test")
    with pytest.raises(FormatError, match=r"nowhere\.json: cannot be read: No such file"):
        load(tmp_path / "nowhere.json", "test")


def test_a_damaged_byte_is_noticed(tmp_path: Path) -> None:
    path = tmp_path / "a.json"
    save(path, "test", STATE)
    whole = path.read_bytes()
    draw = random.Random(1)
    for _ in range(500):
        place = draw.randrange(len(whole))
        path.write_bytes(whole[:place] + bytes([draw.randrange(256)]) + whole[place + 1 :])
        try:
            assert load(path, "test") == STATE  # white space, or the byte as it was
        except FormatError:
            continue
    path.write_bytes(whole[: len(whole) // 2])
    with pytest.raises(FormatError):
        load(path, "test")


def test_one_that_cannot_be_written(tmp_path: Path) -> None:
    with pytest.raises(FormatError, match="cannot be written"):
        save(tmp_path / "no" / "folder.json", "test", STATE)
