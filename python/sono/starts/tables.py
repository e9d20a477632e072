"""The tables that are shipped with the package."""

import csv
from importlib import resources


def table(name: str) -> list[dict[str, str]]:
    """Return the rows of a table, "knots", "links", "published" or "sources"."""
    text = resources.files("sono").joinpath("data", f"{name}.tsv").read_text(encoding="utf-8")
    lines = [line for line in text.splitlines() if not line.startswith("#")]
    return list(csv.DictReader(lines, delimiter="\t"))
