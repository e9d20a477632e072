"""The header of a rope's file: what the comments ahead of its vertices say, written and parsed.

    # 3_1: tight, rope radius R_s = 1
    # n 480  dl 0.06820798  L_p 32.73982811  L_c 32.75515377  L_a 32.74289325  (length over radius)
    # method both  trials 4  settings {"seed": 0}
    # residual 1.9e-12  mu 1.0e-11  excess 2.4e-08
    # input and settings: 8f0b1c...

A rope that was searched for has another third line, and no settings:

    # searched: variant -3, seed 0, met in 5 of 64 trials, 32 s of 60 s
    # input: 3_1
"""

import json
import re
from dataclasses import dataclass
from typing import Any, Self

from sono.curve import Measures
from sono.printing import printable

TIGHT, SETTLED, STUCK, STOPPED = "tight", "settled", "stuck", "stopped"
"""What became of a rope: forces in balance, SONO's tolerance reached, neither, or not yet."""

_TITLE = re.compile(r"^# (.*): (\w+), rope radius R_s = 1$", re.MULTILINE)
_FIGURES = re.compile(r"^# (n \d+  dl .*  \(length over radius\))$", re.MULTILINE)
_MADE = re.compile(r"^# method (\S+)  trials (\d{1,18})  settings (\{.*\})$", re.MULTILINE)
_WORK = r"met in (\d{1,18}) of (\d{1,18}) trials, (\d{1,18}) s(?: of (\d+(?:\.\d+)?(?:e[+-]?\d{1,3})?) s)?"
_SEARCHED = re.compile(
    rf"^# searched: variant (-?\d{{1,18}}), seed (\d{{1,18}})(?:, {_WORK})?$",
    re.MULTILINE,
)
_ORIGIN = re.compile(r"^# input(?: and settings)?: (.+)$", re.MULTILINE)


@dataclass(frozen=True)
class Made:
    """How a rope was tightened."""

    method: str
    trials: int
    settings: dict[str, Any]

    @classmethod
    def of(cls, method: str, trials: str, settings: str) -> Self | None:
        """Read the words of its line."""
        try:
            return cls(method, int(trials), json.loads(settings))
        except (ValueError, RecursionError):
            return None


@dataclass(frozen=True)
class Searched:
    """Where a search found a rope: in how many of its trials, and after how many seconds it ended.

    `limit` are the seconds that it had, if that is why it ended. The atlas keeps variant and seed alone.
    """

    variant: int
    seed: int
    hits: int = 0
    trials: int = 0
    seconds: float = 0.0
    limit: float | None = None

    def line(self) -> str:
        """Write it."""
        begin = f"searched: variant {self.variant}, seed {self.seed}"
        if not self.trials:
            return begin
        limit = f" of {self.limit:g} s" if self.limit else ""
        return f"{begin}, met in {self.hits} of {self.trials} trials, {self.seconds:.0f} s{limit}"

    @classmethod
    def found(cls, text: str) -> Self | None:
        """Find it in a file's text."""
        if not (line := _SEARCHED.search(text)):
            return None
        variant, seed, hits, trials, seconds = (int(number or 0) for number in line.groups()[:5])
        limit = float(line[6]) if line[6] else None
        return cls(variant, seed, hits=hits, trials=trials, seconds=seconds, limit=limit)


@dataclass(frozen=True)
class Header:
    """What is known of a rope besides its vertices.

    `status` is one of those above, and `figures` what the rope measures, as the file has it. `physics` are
    the polish's figures that are known, and `origin` tells what the rope was made from. Of `made` and
    `searched` there is one, or none.
    """

    name: str
    status: str
    figures: str
    made: Made | None = None
    searched: Searched | None = None
    physics: tuple[tuple[str, float], ...] = ()
    origin: str | None = None

    @classmethod
    def of(cls, name: str, status: str, measures: Measures, **more: Any) -> Self:
        """Make the header of a rope that measures so much."""
        return cls(name, status, figures(measures), **more)

    def lines(self) -> list[str]:
        """Write the header, as comments ahead of the vertices."""
        name = printable(self.name.encode(errors="replace").decode())  # a file's name need not be text
        lines = [f"{name}: {self.status}, rope radius R_s = 1", self.figures]
        physics = "  ".join(f"{key} {value:.1e}" for key, value in self.physics)
        if self.made:
            settings = json.dumps(self.made.settings)
            lines += [f"method {self.made.method}  trials {self.made.trials}  settings {settings}"]
            physics = physics or "not polished"
        if self.searched:
            lines += [self.searched.line()]
        lines += [physics] if physics else []
        of_settings = " and settings" if self.made else ""
        return lines + ([f"input{of_settings}: {self.origin}"] if self.origin else [])


def parse(text: str) -> Header:
    """Read the header of a rope's file; what it does not say is empty, or None."""
    title, measured, made = (pattern.search(text) for pattern in (_TITLE, _FIGURES, _MADE))
    origin = _ORIGIN.search(text)
    return Header(
        title[1] if title else "",
        title[2] if title else "",
        measured[1] if measured else "",
        Made.of(*made.groups()) if made else None,
        Searched.found(text),
        origin=origin[1] if origin else None,
    )


def figures(m: Measures) -> str:
    """Write what a rope measures."""
    l_c, l_a = (f"{value:.8f}" if value is not None else "-" for value in (m.l_c, m.l_a))
    return f"n {m.n}  dl {m.dl:.8f}  L_p {m.l_p:.8f}  L_c {l_c}  L_a {l_a}  (length over radius)"
