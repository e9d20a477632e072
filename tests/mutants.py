"""Rounds each single operation of the certified bound the wrong way, and tells which tests notice.

`python -m tests.mutants` (a minute or two) works on a copy of the source, in which each place asks the
variable MUTANT whether it is to be wrong, and runs the tests in interval.rs and certify.rs for each number.
The roundings to decimals are changed one by one, for test_certificates.py. A change that no test notices is a
failure. The source itself has no switch for this, which a release would have to carry.
"""

import os
import re
import shutil
import subprocess
import sys
import tempfile
from collections.abc import Iterator
from pathlib import Path

HOME = Path(__file__).parent.parent

SWITCH = """
/// Which place is wrong.
pub(crate) fn mutant() -> usize {
    static NUMBER: std::sync::LazyLock<usize> =
        std::sync::LazyLock::new(|| std::env::var("MUTANT").map_or(0, |number| number.parse().unwrap()));
    *NUMBER
}

impl Interval {
    pub(crate) fn end(self, number: usize, is_high: bool) -> f64 {
        if (mutant() == number) == is_high { self.low } else { self.high }
    }

    fn rounded(number: usize, low: f64, high: f64) -> Self {
        match mutant().wrapping_sub(number) {
            0 => Self::new(low.next_up(), high.next_up()),
            1 => Self::new(low.next_down(), high.next_down()),
            2 => Self::new(low, high.next_up()),
            3 => Self::new(low.next_down(), high),
            _ => Self::outward(low, high),
        }
    }
}
"""

ROUNDED = "Self::rounded({number}, "
"""A low end that is rounded up, a high one that is rounded down, and both rounded to nearest."""


def otherwise(wrong: str) -> str:
    """Give what stands for an expression that may be wrong."""
    return f"(if crate::certify::interval::mutant() == {{number}} {{{{ {wrong} }}}} else {{{{ {{right}} }}}})"


RULES = [
    ("interval", r"Self::outward\(", ROUNDED, 4),
    ("interval", r"self\.low > other\.high", otherwise("self.high > other.low"), 1),
    ("pairs", r"\.low\(\)", ".end({number}, false)", 1),
    ("pairs", r"forth\.min\(back\)", otherwise("forth.max(back)"), 1),
    ("bound", r"\.low\(\)", ".end({number}, false)", 1),
    ("bound", r"\.high\(\)", ".end({number}, true)", 1),
    ("bound", r"edges\[before\]\.min\(edges\[i\]\)", otherwise("edges[before].max(edges[i])"), 1),
    ("bound", r"Interval::max", "|a: Interval, b: Interval| " + otherwise("a.min(b)"), 1),
]
"""Module, what is changed there, to what, and into how many mutants."""

DECIMALS = [(r"=up\(", "=down("), (r"=down\(", "=up("), (r"digits, ROUND_CEILING", "digits, ROUND_FLOOR")]

APART = ("0.5 * x.", "u.high() > 0.1", "refusal(curve", "Self::rounded")
"""Of lines on which no bound hangs: an exact half, how many terms a series has, a message."""


def switched(folder: Path) -> dict[int, str]:
    """Put switches into the Rust of a copy; return the lines that each number makes wrong."""
    numbers: dict[int, str] = {}
    for module, pattern, change, count in RULES:
        path = folder / f"rust/certify/{module}.rs"

        def change_it(
            match: re.Match[str], change: str = change, count: int = count, path: Path = path
        ) -> str:
            text = match.string
            line = text[text.rfind("\n", 0, match.start()) + 1 : text.find("\n", match.end())].strip()
            if any(words in line for words in APART):
                return match[0]
            first = len(numbers) + 1
            numbers.update({first + k: f"{path.name}: {match[0]} in {line} ({k})" for k in range(count)})
            right = match[0].replace("Interval::max", "a.max(b)")
            return change.format(number=first, right=right)

        path.write_text(re.sub(pattern, change_it, path.read_text()))
    with (folder / "rust/certify/interval.rs").open("a") as source:
        source.write(SWITCH)
    return numbers


def unnoticed_in_rust(folder: Path) -> Iterator[str]:
    """Give the places that may be rounded the wrong way and no test notices."""
    target = os.environ.get("CARGO_TARGET_DIR", str(HOME / "target"))
    environment = os.environ | {"CARGO_TARGET_DIR": target, "PROPTEST_MAX_SHRINK_ITERS": "0"}
    numbers = switched(folder)
    for number, place in {0: "nothing", **numbers}.items():
        command = ["cargo", "test", "--release", "--quiet", "--test", "interval", "--test", "certify"]
        done = subprocess.run(
            command, cwd=folder, env=environment | {"MUTANT": str(number)}, capture_output=True, check=False
        )
        if done.returncode != 0 and (number == 0 or b"could not compile" in done.stderr):
            raise SystemExit(done.stderr.decode() + done.stdout.decode())
        if number:
            print("noticed" if done.returncode else "unnoticed", place, sep="\t", flush=True)
        if number and done.returncode == 0:
            yield place


def unnoticed_in_decimals(folder: Path) -> Iterator[str]:
    """Give those of the decimals."""
    path = folder / "python/sono/certificates.py"
    right = path.read_text()
    tests = [sys.executable, "-m", "pytest", "-q", "-n", "0", "-x", "tests/test_certificates.py"]
    for pattern, wrong in DECIMALS:
        for match in re.finditer(pattern, right):
            path.write_text(right[: match.start()] + wrong + right[match.end() :])
            environment = os.environ | {"PYTHONPATH": str(folder / "python")}
            done = subprocess.run(tests, cwd=folder, env=environment, capture_output=True, check=False)
            place = right[right.rfind("\n", 0, match.start()) + 1 : right.find("\n", match.end())].strip()
            print("noticed" if done.returncode else "unnoticed", place, sep="\t", flush=True)
            if done.returncode == 0:
                yield place
    path.write_text(right)


def main() -> int:
    """Try all; return the exit code."""
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name, "sono")
        shutil.copytree(
            HOME, folder, ignore=shutil.ignore_patterns("target", ".git", ".hypothesis", "__pycache__")
        )
        unnoticed = [*unnoticed_in_decimals(folder), *unnoticed_in_rust(folder)]
    print(f"{len(unnoticed)} unnoticed")
    return int(bool(unnoticed))


if __name__ == "__main__":
    sys.exit(main())
