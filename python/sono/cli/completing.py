"""What a shell offers where a file, a knot or columns are expected, as the metavar of a parameter says."""

import re
from glob import escape, glob
from typing import TypeAlias

import click
from click.shell_completion import CompletionItem
from click.types import StringParamType

from sono import tables

Items: TypeAlias = list[CompletionItem[str]]

_FILES = {"A", "B", "CERTIFICATE", "FILE", "IN", "OUT", "PATH", "TABLE"}
_NAMES = {"A", "B", "NAME"}
"""Words of metavars that stand for a file, and for a knot."""


class Completed(StringParamType):
    """Text that is completed as the words of a metavar say, FILE or NAME."""

    def __init__(self, words: set[str]) -> None:
        """Take the words of the metavar."""
        self.words = words

    def shell_complete(self, ctx: click.Context, param: click.Parameter, incomplete: str) -> Items:
        """Offer what begins like this; all names of knots at once would bury the files."""
        if "KEY" in self.words:
            return _columns(incomplete)
        knots = names(incomplete) if incomplete and self.words & _NAMES else []
        if (
            knots and self.words & _FILES
        ):  # bash shows names or files, so files are told as if they were names
            return [*map(CompletionItem, [*knots, *sorted(glob(f"{escape(incomplete)}*"))])]
        if knots or not self.words & {*_FILES, "FOLDER"}:
            return [*map(CompletionItem, knots)]
        return [CompletionItem(incomplete, type="file" if self.words & _FILES else "dir")]


def equip(command: click.Command) -> None:
    """Have the parameters of a command completed whose metavars say what they are."""
    for param in command.params:
        metavar = param.metavar or (param.name or "").upper()
        if param.type is click.STRING:
            # NAME=VALUE is the name of no knot.
            param.type = Completed(set(re.findall(r"\b[A-Z]+\b(?!=)", metavar)))


def names(incomplete: str) -> list[str]:
    """Return the names of knots that begin like this, mirror images and sums too.

    >>> names("3_1#mhop"), names("m8_2"), names("K")
    (['3_1#mHopf'], ['m8_2', 'm8_20', 'm8_21'], [])
    """
    from sono import starts  # here, since numpy would make options wait

    before, sign, part = incomplete.rpartition("#")
    begin = part.removeprefix("m").casefold()
    before += sign + "m" * part.startswith("m")
    return [before + name for name in starts.names() if name.casefold().startswith(begin)]


def _columns(incomplete: str) -> Items:
    """Offer the column after the last comma."""
    before, comma, begin = incomplete.rpartition(",")
    return [CompletionItem(before + comma + key) for key in tables.COLUMNS if key.startswith(begin)]
