"""`sono compare`: published ropelengths beside ours."""

from pathlib import Path

import pytest
from conftest import Sono

from sono import library, published, tables

TABLE = "knot\tn\tL_a\tL_c\n8_4\t359\t71.45\t71.69\nm3_1\t164\t32.75\t32.7\nHopf\t60\t25.1\t-\n"


def test_the_differences_have_their_signs(folder: Path, sono: Sono) -> None:
    result = sono("compare", "-", "--format", "json", input=TABLE)
    assert result.exit_code == 0
    Path("rows").write_text(result.stdout)
    chiral, mirrored, link = tables.read("rows")
    assert (chiral["published"], chiral["source"]) == (71.4704, "ACPR 2011")
    assert chiral["l_a_difference"] == pytest.approx(-0.0204)
    assert chiral["l_c_difference"] == pytest.approx(0.2196)
    assert mirrored["l_a_difference"] == pytest.approx(0.0064)
    assert link["published"] is None
    counted, unknown = result.stderr.splitlines()
    assert counted == "sono: of 2 rows L_a is at most the published value in 1, L_c in 1"
    assert unknown == "sono: of 1 rows no ropelength is published under the name they have"


def test_the_finer_level_counts_for_l_c(folder: Path, sono: Sono) -> None:
    Path("fine.tsv").write_text("knot\tL_a\tL_c\tL_c(fine)\n8_4\t71.45\t71.69\t71.46\n")
    result = sono("compare", "fine.tsv", "--columns", "l_c_difference", "-q")
    assert float(result.stdout.splitlines()[1]) == pytest.approx(-0.0104)
    assert result.stderr == ""


def test_another_table_to_compare_with(folder: Path, sono: Sono) -> None:
    Path("mine.tsv").write_text("knot\tL_a\nHopf\t25.0\n")
    result = sono("compare", "-", "--published", "mine.tsv", input=TABLE)
    assert "Hopf\t60\t25.1\t-\t25.0\tmine.tsv\t0.1" in result.stdout
    Path("mirror.tsv").write_text("knot\tL_a\nm3_1\t32.7\n")
    result = sono("compare", "mirror.tsv", "--published", "mirror.tsv", "-q", "--columns", "l_a_difference")
    assert result.stdout == "l_a_difference\n0.0\n"


def test_a_pipe_from_measure(folder: Path, sono: Sono) -> None:
    result = sono("compare", "-", input=sono("measure", "3_1.txt").stdout)
    assert result.exit_code == 0
    assert result.stdout.splitlines()[1].startswith("3_1\t69\t")


@pytest.mark.parametrize("name", ["8_4.tight", "m8_4.n359", "M8_4", "8_4.n359.best2", "8_4"])
def test_files_names_are_understood(sono: Sono, name: str) -> None:
    result = sono("compare", "-", "--columns", "published", input=f"knot\tL_a\n{name}\t71.45\n")
    assert result.stdout == "published\n71.4704\n"


def test_a_table_to_compare_with_needs_lengths(folder: Path, sono: Sono) -> None:
    Path("mine.tsv").write_text("knot\tn\nHopf\t60\n")
    result = sono("compare", "-", "--published", "mine.tsv", input=TABLE)
    assert (result.exit_code, result.stdout) == (1, "")
    assert "mine.tsv: has no column published, nor L_a" in result.stderr


def test_no_table(folder: Path, sono: Sono) -> None:
    result = sono("compare", "3_1.txt")
    assert result.exit_code == 1
    assert "3_1.txt:1: has no column knot" in result.stderr


def test_a_table_that_is_not_there_does_not_stop_the_others(folder: Path, sono: Sono) -> None:
    Path("mine.tsv").write_text(TABLE)
    alone = sono("compare", "mine.tsv")
    result = sono("compare", "nowhere.tsv", "mine.tsv")
    assert (result.exit_code, result.stdout) == (1, alone.stdout)
    assert "nowhere.tsv: cannot be read" in result.stderr


def test_long_cells_are_read(sono: Sono) -> None:
    knot = 200_000 * "x"
    result = sono("compare", "-", "--columns", "knot", input=f"knot\tL_a\n{knot}\t71.45\n")
    assert (result.exit_code, result.stdout) == (0, f"knot\n{knot}\n")


def test_columns_go_by_their_heads_too(sono: Sono) -> None:
    result = sono("compare", "-", "--columns", "L_a-published,l_a", input="knot\tL_a\n8_4\t71.4704\n")
    assert result.stdout.splitlines()[0] == "l_a_difference\tl_a"


def test_the_published_table_has_every_knot() -> None:
    table = published.table()
    assert list(table) == [row["knot"] for row in library.table("knots")]
    assert {row["source"] for row in table.values()} == {"ACPR 2011", "KnotInfo 2026.11.2"}
    # Table 1 of Ashton, Cantarella, Piatek and Rawdon.
    assert [table[knot]["published"] for knot in ("3_1", "4_1", "8_18")] == [32.7436, 42.0887, 74.9063]
