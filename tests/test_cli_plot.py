"""`sono plot`: files and messages."""

import re
import sys
from pathlib import Path

import pytest
from conftest import Sono

import sono as package
from sono.figures.plot import sheet

pytest.importorskip("matplotlib")

ROWS = "knot\tn\tl_p\tl_c\tl_a\n" + "".join(
    f"3_1\t{n}\t{32.743 - 0.66 * (32.7 / n) ** 2}\t{32.743 + 2.6 * (32.7 / n) ** 2}\t32.743\n"
    for n in (240, 480, 960, 1920)
)

SEARCH = "knot\tl_a\thits\n6_1\t56.7\t13\n6_1\t56.8\t4\n5_1\t47.2\t8\n"

MAGIC = {".png": b"\x89PNG", ".svg": b"<?xml", ".pdf": b"%PDF"}


@pytest.fixture
def quick(monkeypatch: pytest.MonkeyPatch) -> None:
    """Draw ropes of fewer dots."""
    monkeypatch.setattr("sono.figures.plot.knot.PIXELS", 60)


def labels(path: str) -> str:
    """The letters of an SVG, which are drawn, from the comments beside them."""
    return " ".join(re.findall(r"<!-- (.*?) -->", Path(path).read_text()))


@pytest.mark.parametrize("suffix", sheet.SUFFIXES)
def test_the_suffix_is_the_format(quick: None, sono: Sono, suffix: str) -> None:
    result = sono("plot", "knot", "3_1", "Hopf", "-o", f"x{suffix}")
    assert (result.exit_code, result.output) == (0, "")
    assert Path(f"x{suffix}").read_bytes().startswith(MAGIC[suffix])


@pytest.mark.parametrize("kind", ["contacts", "curvature"])
def test_each_rope_has_a_panel_with_its_name(sono: Sono, kind: str) -> None:
    assert sono("plot", kind, "Hopf", "3_1.txt", "m3_1", "-o", "x.svg", "--style", "dark").exit_code == 0
    shown = labels("x.svg")
    assert all(name in shown for name in ("Hopf", "3_1", "m3_1", "arclength / R"))
    assert sheet.PAPER["dark"][0].lower() in Path("x.svg").read_text().lower()


@pytest.mark.parametrize("kind", ["model", "atlas"])
def test_kinds_that_need_no_file(sono: Sono, kind: str) -> None:
    result = sono("plot", kind, "-o", "x.svg")
    assert (result.exit_code, result.output) == (0, "")
    assert "edge length" in labels("x.svg") or "crossing number" in labels("x.svg")


@pytest.mark.parametrize("format", ["tsv", "csv", "jsonl", "json"])
def test_convergence_of_a_table(sono: Sono, format: str) -> None:
    Path("rows.tsv").write_text(ROWS)
    columns = "knot,n,l_p,l_c,l_a"
    table = sono("compare", "rows.tsv", "-q", "--format", format, "--columns", columns).stdout
    result = sono("plot", "convergence", "-", "-o", "x.svg", input=table)
    assert (result.exit_code, result.stderr) == (0, "")
    assert "32.743" in labels("x.svg")


def test_convergence_of_files_names_and_tables_at_once(sono: Sono) -> None:
    Path("rows.csv").write_text(ROWS.replace("\t", ","))
    for n in (60, 90):
        package.write(f"c{n}.json", package.tighten("3_1", n))
    result = sono("plot", "convergence", "rows.csv", "c60.json", "c90.json", "3_1", "-o", "x.png")
    assert (result.exit_code, result.stderr) == (0, "")


def test_minima_of_each_knot(sono: Sono) -> None:
    result = sono("plot", "minima", "-", "-o", "x.svg", input=SEARCH)
    assert (result.exit_code, result.stderr) == (0, "")
    assert all(text in labels("x.svg") for text in ("6_1", "5_1", "13", "published"))


def test_one_wrong_file_spoils_nothing(quick: None, folder: Path, sono: Sono) -> None:
    (folder / "bad.txt").write_text("0 0 0\n2 2 0\n2 0 0\n0 2 0\n")
    result = sono("plot", "knot", "bad.txt", "3_1.txt", "absent.txt", "-o", "x.png")
    assert result.exit_code == 1
    first, second = result.stderr.splitlines()
    assert first.startswith("sono: bad.txt:1: the curve crosses itself")
    assert second.startswith("sono: absent.txt: cannot be read")
    assert (folder / "x.png").read_bytes().startswith(MAGIC[".png"])


WRONG = [
    (["knot", "absent.txt"], "absent.txt: cannot be read: No such file or directory", 1),
    (["knot", "T(2,103)"], "the atlas has no rope of 'T(2,103)'; `sono tighten 'T(2,103)' -o", 1),
    (["convergence", "3_1.txt"], "takes 3 lengths of edges, and these are 1; tighten the knot at more n", 1),
    (["convergence", "3_1", "4_1", "5_1"], "the rows are of 3_1 and 4_1 and 5_1; give those of one knot", 1),
    (["convergence", "empty.tsv"], "empty.tsv: there is no row in it", 1),
    (["convergence", "lengths.tsv"], "lengths.tsv: a row has no n or no L_p; `sono measure` writes both", 1),
    (["minima", "rows.tsv"], "rows.tsv: a row has no hits or no L_a; `sono search` writes both", 1),
    (["minima", "3_1.txt"], "3_1.txt:1: has no column knot; give a table that sono wrote", 1),
    (["convergence", "nothing.tsv"], "nothing.tsv: a row has no n or no L_p", 1),
    (["atlas", "unnamed.tsv"], "no row has an L_a and a name that tells its crossing number", 1),
    (["atlas", "empty.tsv"], "empty.tsv: there is no row in it", 1),
    (["atlas", "3_1.txt"], "3_1.txt:1: has no column knot", 1),
    (["knot"], "give knot a FILE or a NAME", 2),
    (["minima"], "give minima a FILE", 2),
    (["model", "3_1"], "model takes no FILE", 2),
    (["contacts", "Hopf", "--beads"], "--beads are those of a knot", 2),
    (["graph", "3_1"], "'graph' is not one of", 2),
]


@pytest.mark.parametrize(("arguments", "message", "code"), WRONG, ids=lambda value: str(value)[:40])
def test_wrong_calls(folder: Path, sono: Sono, arguments: list[str], message: str, code: int) -> None:
    (folder / "rows.tsv").write_text(ROWS)
    (folder / "empty.tsv").write_text("knot\tn\tl_p\tl_c\tl_a\n")
    (folder / "lengths.tsv").write_text("knot\tl_a\n3_1\t32.7\n")
    (folder / "nothing.tsv").write_text("knot\tn\tl_p\n3_1\t0\t32.7\n")
    (folder / "unnamed.tsv").write_text("knot\tl_a\nmine\t32.7\n")
    result = sono("plot", *arguments, "-o", "x.png")
    assert result.exit_code == code
    assert message in result.stderr
    assert code == 2 or len(result.stderr.splitlines()) == 1
    assert not (folder / "x.png").exists()


@pytest.mark.parametrize("output", ["x.jpg", "x", "x.png.gz", "folder/"])
def test_a_suffix_of_no_picture(sono: Sono, output: str) -> None:
    result = sono("plot", "model", "-o", output)
    assert result.exit_code == 2
    assert "the suffixes are: .png, .svg, .pdf" in result.stderr


def test_nothing_is_overwritten(folder: Path, sono: Sono) -> None:
    (folder / "x.svg").write_text("mine")
    result = sono("plot", "model", "-o", "x.svg")
    assert result.exit_code == 2
    assert "x.svg exists; --force overwrites it" in result.stderr
    assert (folder / "x.svg").read_text() == "mine"
    assert sono("plot", "model", "-o", "x.svg", "--force").exit_code == 0
    assert sono("plot", "model", "-o", "absent/x.svg").exit_code == 1


def test_standard_output_is_a_png(sono: Sono) -> None:
    result = sono("plot", "model", "-o", "-")
    assert result.exit_code == 0
    assert result.stdout_bytes.startswith(MAGIC[".png"])


def test_too_many_ropes(folder: Path, sono: Sono) -> None:
    frame = "3\n\nC 0 0 0\nC 1 0 0\nC 0 1 0\n"
    (folder / "many.xyz").write_text(37 * frame)
    result = sono("plot", "knot", "many.xyz", "-q", "-o", "x.png")
    assert result.exit_code == 1
    assert "these are 37 ropes, and a picture shows 36 at most; FILE:KEY is one" in result.stderr


def test_names_that_are_formulas_or_long(quick: None, folder: Path, sono: Sono) -> None:
    rows = (folder / "3_1.txt").read_bytes()
    for name in ("$x^", 60 * "long", "三葉"):
        (folder / f"{name}.txt").write_bytes(rows)
    names = sorted(path.name for path in folder.glob("*.txt"))
    result = sono("plot", "knot", *names, "-o", "x.png")
    assert (result.exit_code, result.stderr) == (0, "")


def test_without_the_extra(sono: Sono, monkeypatch: pytest.MonkeyPatch) -> None:
    for name in [name for name in sys.modules if name.split(".")[0] == "matplotlib"]:
        monkeypatch.setitem(sys.modules, name, None)
    result = sono("plot", "model", "-o", "x.png")
    assert result.exit_code == 2
    assert "pictures are drawn by matplotlib; pip install 'sono[plot]'" in result.stderr
