"""Mutated vertex files through the parsers and `sono measure`: `python -m tests.fuzz COUNT [SEED]`.

Each must give a row of numbers, or a message that names the file, within seconds.
"""

import math
import os
import re
import subprocess
import sys
import tempfile
import time
from collections import Counter
from collections.abc import Iterator
from pathlib import Path

import numpy as np

from sono import starts
from sono.formats import FormatError, jsons, npy, npz, obj, text, vect, xyz
from sono.jobs import curvefiles
from sono.jobs.result import as_row

SLOW = 5.0
"""Seconds after which a file counts as a hang."""

CHUNK = 500
"""Files that one process measures."""

WORDS = (
    *(
        b"nan",
        b"inf",
        b"-Infinity",
        b"1e999",
        b"1e308",
        b"-1e308",
        b"1e-320",
        b"1e60",
        b"1e-60",
        b"0",
        b"-0.0",
    ),
    *(b"9" * 400, b"9" * 5000, b"1.0D+00", b"1.0-100", b"0x10", b"1_0", b"\xd9\xa1", b"1,2", b"1 2 3", b"1e"),
    *(b"x y z", b"C", b"v", b"l", b"{", b"[[", b"\x93NUMPY", b"PK\x03\x04", b'components="3 4"'),
    *(b"VECT", b"4VECT", b"VECT BINARY", b"-3", b"-60", b"99999999999999999999", b"0 0 0", b"# ", b"#"),
    *(
        b",",
        b"\t",
        b" ",
        b"\n",
        b"\n\n",
        b"\r",
        b"\r\n",
        b"\0",
        b"\xff",
        b"\xef\xbb\xbf",
        b"\x1b[31m",
        b"\xe2\x80\xa8",
    ),
)


def samples() -> list[bytes]:
    """Files of all kinds that are read."""
    trefoil, link = starts.start("3_1"), starts.start("Hopf")
    few = np.random.default_rng(1).normal(size=(7, 3)).round(3)
    closed = np.vstack([few, few[:1]])
    fortran = text.write([few], []).replace("\n", "D+00\n")
    return [
        content.encode()
        for content in (
            text.write(trefoil, ["a trefoil"]),
            text.write(link, []),
            vect.write(link, ["a link"]),
            vect.write([closed], []),
            text.write([few], []),
            text.write([few, few + 10, 1e-9 * few - 10], []),
            text.write([few], []).replace(" ", ", "),
            text.write([closed], []).replace("\n", "\r\n"),
            fortran,
            "0 0 0\n1 0 0\n0 1 0\n",
            xyz.write(link, ["a link"]),
            xyz.write([few], []).replace('components="7"', "Properties=species:S:1:pos:R:3"),
            obj.write(link, ["a link"]),
            jsons.write(trefoil, ["a trefoil"]),
            "index;x;y;z\n" + "".join(f"{i};{x};{y};{z}\n" for i, (x, y, z) in enumerate(few)),
            "".join(f"C {i} {x} {y} {z}\n" for i, (x, y, z) in enumerate(few)),
        )
    ] + [npy.packed(few), npz.write(link, ["a link"])]


def mutants(seed: int) -> Iterator[bytes]:
    """Files that have gone wrong, without end; the same ones for each seed."""
    random = np.random.default_rng(seed)
    originals = samples()
    while True:
        content = originals[random.integers(len(originals))]
        for _ in range(random.integers(1, 4)):
            content = _mutated(content, originals, random)
        yield content


def _mutated(content: bytes, originals: list[bytes], random: np.random.Generator) -> bytes:
    def place() -> int:
        return int(random.integers(len(content) + 1))

    def word() -> bytes:
        return WORDS[random.integers(len(WORDS))]

    match random.integers(9):
        case 0:  # a byte
            i = place()
            return content[:i] + bytes([random.integers(256)]) + content[i + 1 :]
        case 1:  # a piece is lost
            i, j = sorted((place(), place()))
            return content[:i] + content[min(j, i + int(random.integers(1, 40))) :]
        case 2:  # the end is lost
            return content[: place()]
        case 3:  # something is put in
            i = place()
            return content[:i] + word() + content[i:]
        case 4:  # a number becomes another one
            spans = [found.span() for found in re.finditer(rb"[-+.\deED]+", content)] or [(0, 0)]
            i, j = spans[random.integers(len(spans))]
            return content[:i] + word() + content[j:]
        case 5:  # lines come twice
            lines = content.split(b"\n")
            i = int(random.integers(len(lines)))
            return b"\n".join([*lines[:i], *lines[max(0, i - 2) : i + 1], *lines[i:]])
        case 6:  # lines change places
            lines = content.split(b"\n")
            i, j = random.integers(len(lines), size=2)
            lines[i], lines[j] = lines[j], lines[i]
            return b"\n".join(lines)
        case 7:  # the beginning of another file
            other = originals[random.integers(len(originals))]
            return other[: random.integers(len(other))] + content[place() :]
        case _:  # another scale
            return re.sub(
                rb"(\d)(\s)",
                rb"\1" + (b"e", b"E+", b"e-")[random.integers(3)] + b"%d" % random.integers(400) + rb"\2",
                content,
            )


def complaint(path: str) -> str | None:
    """Read and measure a file; say what must not happen if it does."""
    begun = time.perf_counter()
    try:
        file, measures = curvefiles.measured(path)
        file.doubts()
        row = as_row("k", path, measures)
        wrong = [key for key, value in row.items() if isinstance(value, float) and not _fit(key, value)]
        fault = f"{', '.join(wrong)} of {row}" if wrong else None
    except FormatError as error:
        fault = None if str(error).startswith(path) and str(error).isprintable() else f"message {error!r}"
    except Exception as error:
        fault = f"{type(error).__name__}: {error}"
    seconds = time.perf_counter() - begun
    return fault or (f"{seconds:.1f} s" if seconds > SLOW else None)


def _fit(key: str, value: float) -> bool:
    """Tell whether a figure may be shown. A curve without distant vertices has an infinite SR."""
    return math.isfinite(value) or (key == "sr" and value == math.inf)


def main(count: int, seed: int) -> int:
    """Put so many files through the command, some hundred at a time; return how many were amiss."""
    source = mutants(seed)
    faults = 0
    seen: Counter[str] = Counter()
    with tempfile.TemporaryDirectory() as folder:
        os.chdir(folder)
        for first in range(0, count, CHUNK):
            names = [f"{k}.txt" for k in range(min(CHUNK, count - first))]
            for name in names:
                Path(name).write_bytes(next(source))
            command = [
                sys.executable,
                "-c",
                "from sono.cli import main; main()",
                "measure",
                *names,
                "--columns",
            ]
            done = subprocess.run(
                [*command, "knot,n,dl,l_p,l_c,l_a,dispersion,min_rad,r_s"],
                capture_output=True,
                text=True,
                timeout=SLOW * 20,
                check=False,
            )
            if done.returncode not in (0, 1):
                print(
                    f"seed {seed}, files {first} to {first + CHUNK}: exit code {done.returncode}", flush=True
                )
                faults += 1
            rows, messages = done.stdout.splitlines()[1:], done.stderr.splitlines()
            seen["rows"] += len(rows)
            seen["messages"] += len(messages)
            wrong = [line for line in rows if re.search(r"\b(nan|inf)\b", line)]
            wrong += [line for line in messages if not re.match(r"sono: \d+\.txt:", line)]
            told = {line.split(":")[1].strip() for line in messages}
            wrong += [
                name
                for name in names
                if f"{name[:-4]}" not in {row.split("\t")[0] for row in rows} and name not in told
            ]
            faults += len(wrong)
            for line in wrong[:5]:
                print(f"seed {seed}, files {first} to {first + CHUNK}: {line}", flush=True)
    print(f"{count} files: {seen['rows']} rows, {seen['messages']} messages, {faults} amiss")
    return faults


if __name__ == "__main__":
    sys.exit(bool(main(int(sys.argv[1]), int(sys.argv[2]) if len(sys.argv) > 2 else 1)))
