"""The glossary and the bibliography leave nothing out, and pictures are where pages look for them."""

import csv
import re
from pathlib import Path

import pytest

import sono
from sono.tables.columns import COLUMNS

DOCS = Path(__file__).parent.parent / "docs"

pytestmark = pytest.mark.skipif(not DOCS.is_dir(), reason="needs the source tree")

PAGES = sorted(DOCS.rglob("*.md")) if DOCS.is_dir() else []


def test_the_glossary_has_each_column() -> None:
    text = (DOCS / "glossary.md").read_text(encoding="utf-8")
    assert [key for key in COLUMNS if f"`{key}`" not in text] == []
    known = {*COLUMNS, *(column.header for column in COLUMNS.values())}
    columns = re.findall(r"^\| ([^|]+) \|", text, re.MULTILINE)
    assert {name for cell in columns for name in re.findall(r"`([^`]+)`", cell)} <= known


def test_the_bibliography_has_each_source_of_published_ropelengths() -> None:
    text = (DOCS / "bibliography.md").read_text(encoding="utf-8")
    rows = re.findall(r"^\| ([^|]+) \| ([^|]+) \| (radius|diameter) \|", text, re.MULTILINE)
    told = {name: (reference, per) for name, reference, per in rows}
    sources = (Path(sono.__file__).parent / "data" / "sources.tsv").read_text(encoding="utf-8")
    lines = [line for line in sources.splitlines() if not line.startswith("#")]
    for source in csv.DictReader(lines, delimiter="\t"):
        name = source["source"].removesuffix(", T(24,19)")
        reference, per = told[name]
        assert per == source["per"], name
        assert source["citation"].split(",")[0] in reference, name


@pytest.mark.parametrize("page", PAGES, ids=[page.relative_to(DOCS).as_posix() for page in PAGES])
def test_pictures_are_there(page: Path) -> None:
    text = page.read_text(encoding="utf-8")
    for picture in re.findall(r"!\[[^\]]*\]\(([^)\s]+)\)|<img src=\"([^\"]+)\"", text):
        assert (page.parent / "".join(picture)).is_file(), picture
