"""Every sample is read, goes through every format that is written, and fails clearly however it is damaged.

A file that is put into `samples/` is tested here without another line.
"""

import importlib.util
import re
from collections.abc import Callable, Iterator
from pathlib import Path

import numpy as np
import pytest

from sono import formats
from sono.formats import FormatError, VertexFile

SAMPLES = [
    path
    for path in sorted((Path(__file__).parent / "samples").iterdir())
    if path.suffix != ".md" and (path.suffix != ".cif" or importlib.util.find_spec("gemmi"))
]

samples = pytest.mark.parametrize("path", SAMPLES, ids=lambda path: str(path.name))

ROUNDED = {"pdb", "fseries"}
"""Formats that do not keep every digit."""


def parsed(path: Path, data: bytes) -> list[VertexFile]:
    return formats.parse(path.name, data, "direct")


@samples
def test_it_is_read(path: Path) -> None:
    curves = formats.read_all(path, close="direct")
    assert all(len(component) >= 10 for curve in curves for component in curve.components)
    keys = [curve.key for curve in curves]
    assert len(set(keys)) == len(keys)
    if len(curves) > 1:
        assert formats.may_hold_several(str(path))
        one = formats.read(f"{path}:{keys[-1]}", close="direct")
        assert bits(one) == bits(curves[-1])


def bits(curve: VertexFile) -> list[bytes]:
    return [component.tobytes() for component in curve.components]


TEXTS = [path for path in SAMPLES if path.suffix != ".gz" and b"\0" not in path.read_bytes()]


@pytest.mark.parametrize("mark", [b"", b"\xef\xbb\xbf"], ids=["", "BOM"])
@pytest.mark.parametrize("end", [b"\n", b"\r\n"], ids=["LF", "CRLF"])
@pytest.mark.parametrize("path", TEXTS, ids=lambda path: str(path.name))
def test_it_is_the_same_as_windows_writes_it(path: Path, end: bytes, mark: bytes) -> None:
    data = path.read_bytes().replace(b"\r\n", b"\n")
    one, other = parsed(path, data), parsed(path, mark + data.replace(b"\n", end))
    assert [(curve.key, bits(curve)) for curve in one] == [(curve.key, bits(curve)) for curve in other]


@samples
@pytest.mark.parametrize("format", sorted(set(formats.WRITERS) - ROUNDED))
def test_it_goes_through_a_format(path: Path, format: str, tmp_path: Path) -> None:
    for curve in formats.read_all(path, close="direct"):
        if format == "npy" and len({len(component) for component in curve.components}) > 1:
            continue
        suffix = next(suffix for suffix, known in formats.SUFFIXES.items() if suffix and known == format)
        there = tmp_path / f"k{suffix}"
        formats.write(there, curve.components, curve.comments)
        again = formats.read_all(there)
        assert [component for part in again for component in bits(part)] == bits(curve)


DAMAGES: dict[str, Callable[[bytes], bytes]] = {
    "nothing": lambda data: b"",
    "a blank line": lambda data: b"\n",
    "the first byte": lambda data: data[:1],
    "the first line": lambda data: data.split(b"\n")[0],
    "a tenth": lambda data: data[: len(data) // 10],
    "a half": lambda data: data[: len(data) // 2],
    "less than the last line": lambda data: data[: data.rstrip().rfind(b"\n")],
    "less than the last number": lambda data: data.rstrip()[:-3],
    "no first line": lambda data: data.partition(b"\n")[2],
    "no second line": lambda data: b"\n".join(data.split(b"\n")[:1] + data.split(b"\n")[2:]),
    "a line twice": lambda data: data.replace(line(data), line(data) * 2, 1),
    "no line in the middle": lambda data: data.replace(line(data), b"", 1),
    "the middle backwards": lambda data: data.replace(line(data), line(data)[::-1], 1),
    "a word": lambda data: put(data, b"nought"),
    "not a number": lambda data: put(data, b"nan"),
    "an infinite number": lambda data: put(data, b"1e999"),
    "a long number": lambda data: put(data, b"9" * 5000),
    "a decimal comma": lambda data: put(data, b"1,5"),
    "a missing number": lambda data: put(data, b""),
    "two numbers": lambda data: put(data, b"1 2"),
    "a byte that is no text": lambda data: put(data, b"\xff\xfe"),
    "a zero byte": lambda data: put(data, b"\0"),
    "a control sequence": lambda data: put(data, b"\x1b[31m"),
    "another file": lambda data: data[: len(data) // 2] + b"\x93NUMPY VECT {[ ITEM: ATOMS",
    "twice": lambda data: data + data,
}


def line(data: bytes) -> bytes:
    """The line in the middle."""
    lines = data.splitlines(keepends=True)
    return lines[len(lines) // 2]


def put(data: bytes, word: bytes) -> bytes:
    """Put something in the place of a number in the middle."""
    numbers = [*re.finditer(rb"-?\d+\.\d+", data)]
    start, end = numbers[len(numbers) // 2].span() if numbers else (len(data) // 2, len(data) // 2 + 1)
    return data[:start] + word + data[end:]


CURE = "(; |: | should | which )"
"""What stands before the cure."""


def complaint(path: Path, data: bytes) -> str | None:
    """Say what is wrong with the message of a damaged file, if it has one."""
    try:
        parsed(path, data)
    except FormatError as error:
        clear = re.match(rf"{re.escape(path.name)}(\[\w+\])?:\d+: .+{CURE}.+$", str(error))
        return None if clear and str(error).isprintable() else str(error)
    return None


@samples
@pytest.mark.parametrize("damage", DAMAGES)
def test_damage_gives_a_curve_or_one_clear_line(path: Path, damage: str) -> None:
    name, data = formats.load(path)
    assert complaint(path.with_name(Path(formats.unpacked(name)).name), DAMAGES[damage](data)) is None


def damaged(data: bytes) -> Iterator[bytes]:
    """Files cut off at every place, and some with other bytes; the same ones every time."""
    step = max(1, len(data) // 400)
    yield from (data[:cut] for cut in range(0, len(data), step))
    draw = np.random.default_rng(0)
    for _ in range(300):
        place, length = draw.integers(len(data)), draw.integers(8)
        yield data[:place] + draw.bytes(int(draw.integers(8))) + data[place + length :]


@samples
def test_any_damage_gives_a_curve_or_one_clear_line(path: Path) -> None:
    name, data = formats.load(path)
    there = path.with_name(Path(formats.unpacked(name)).name)
    assert [fault for content in damaged(data) if (fault := complaint(there, content))] == []
