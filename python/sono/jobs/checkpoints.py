"""Checkpoints: states of runs and searches as JSON files, which tell when they are another's, old or damaged.

{"checkpoint": KIND, "version": VERSION, "crc": of the state's text, "state": {...}}
"""

import json
import os
import zlib
from pathlib import Path
from typing import Any

from sono import formats
from sono.formats import FormatError

VERSION = 9
"""Of the state's content; one that was written with another is refused."""


def save(path: Path, kind: str, state: dict[str, Any]) -> None:
    """Write a state, whole or not at all. Raises `FormatError`."""
    text = json.dumps(state)
    head = json.dumps({"checkpoint": kind, "version": VERSION, "crc": zlib.crc32(text.encode())})
    formats.save(os.fspath(path), f'{head[:-1]}, "state": {text}}}')


def load(path: Path, kind: str) -> dict[str, Any]:
    """Return the state in a file. Raises `FormatError`."""
    try:
        saved = json.loads(path.read_text(encoding="utf-8"))
        found, version = saved["checkpoint"], saved["version"]
        state, crc = saved["state"], saved["crc"]
    except OSError as error:
        raise FormatError(f"{path}: cannot be read: {error.strerror or error}") from error
    except (ValueError, LookupError, TypeError, RecursionError):
        raise FormatError(f"{path}: is no checkpoint, or an old or damaged one; remove it") from None
    if found != kind:
        raise FormatError(f"{path}: is no checkpoint of a {kind}; remove it")
    if version != VERSION:
        raise FormatError(f"{path}: was written by another version of sono; remove it or use that version")
    if not isinstance(state, dict) or zlib.crc32(json.dumps(state).encode()) != crc:
        raise FormatError(f"{path}: is damaged; remove it")
    return state
