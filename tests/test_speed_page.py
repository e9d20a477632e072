"""The page of what things cost has each table in its place; what these say is for no test."""

import re

import bench_page
import beside
import pytest

pytestmark = pytest.mark.skipif(not bench_page.PAGE.is_file(), reason="needs the source tree")

OTHERS = {"names", "crossing-numbers", "tubes"}


def test_each_table_has_its_place() -> None:
    page = bench_page.PAGE.read_text(encoding="utf-8")
    found = dict(
        re.findall(r"<!-- ([\w-]+): made by tests.bench -->\n(.*?)\n<!-- end of \1 -->", page, re.DOTALL)
    )
    assert set(found) == {*bench_page.TABLES, *OTHERS}
    for name, table in found.items():
        lines = table.splitlines()
        assert len(lines) > 2, name
        assert len({line.count("|") for line in lines}) == 1, name


def test_a_table_is_put_in_the_place_of_another() -> None:
    page = "a\n<!-- x: made by tests.bench -->\nold\n<!-- end of x -->\nb\n"
    table = bench_page.markdown([["n", "s"], ["1", "2"]])
    assert table == "| n | s |\n|---|---|\n| 1 | 2 |"
    filled = bench_page.filled(page, "x", table)
    assert filled == page.replace("old", table)
    assert bench_page.filled(filled, "x", "old") == page
    with pytest.raises(ValueError, match="no place for the table y"):
        bench_page.filled(page, "y", table)


def test_answers_are_summed_up() -> None:
    names = ["3_1", "±3_1", "m3_1", "4_1", None]
    kind = {"program": "p 1", "task": "name", "kind": "a", "knot": "3_1"}
    answers = [{**kind, "seconds": float(second), "found": found} for second, found in enumerate(names)]
    _, row = beside.rows("name", answers)
    assert row == ["p 1", "a", "2.000", "4.00", "1 of 5 by name and hand, 2 by name"]
