"""Tables: the exact text of each format, and that a row is out before the next one is computed."""

import csv
import io
import json
import math
from contextlib import suppress
from pathlib import Path

import pytest

from sono.formats import FormatError
from sono.tables import COLUMNS, DEFAULT, FORMATS, Row, key_of, read, writer

TREFOIL: Row = {
    "knot": "3_1",
    "n": 120,
    "dl": 0.2724306812345678,
    "l_p": 32.69168123456789,
    "l_c": 32.94095,
    "l_a": 32.741534,
    "seconds": 1.5,
}
FAILED: Row = {"knot": "a|b & 100%\t", "n": 60, "dl": None, "status": "stuck"}


def table(format: str, *rows: Row, columns: tuple[str, ...] = DEFAULT) -> str:
    stream = io.StringIO()
    with writer(format, columns, stream) as rows_of:
        for row in rows:
            rows_of.row(row)
    return stream.getvalue()


def test_text() -> None:
    assert table("table", TREFOIL, FAILED, {**TREFOIL, "knot": "a_much_longer_name"}).split("\n") == [
        "Ropelength is length over the RADIUS of the rope (R = 1).",
        "knot               n          dl          L_p          L_c          L_a",
        "3_1              120  0.27243068    32.691681    32.940950    32.741534",
        "a|b & 100%        60           -            -            -            -",
        "a_much_longer_name     120  0.27243068    32.691681    32.940950    32.741534",
        "",
    ]


def test_tsv_and_csv_keep_every_digit() -> None:
    assert table("tsv", TREFOIL, FAILED) == (
        "knot\tn\tdl\tl_p\tl_c\tl_a\n"
        "3_1\t120\t0.2724306812345678\t32.69168123456789\t32.94095\t32.741534\n"
        "a|b & 100% \t60\t-\t-\t-\t-\n"
    )
    assert table("csv", TREFOIL, FAILED) == (
        "knot,n,dl,l_p,l_c,l_a\n"
        "3_1,120,0.2724306812345678,32.69168123456789,32.94095,32.741534\n"
        "a|b & 100% ,60,,,,\n"
    )


@pytest.mark.parametrize(("format", "delimiter"), [("tsv", "\t"), ("csv", ",")])
def test_names_do_not_break_tsv_and_csv(format: str, delimiter: str) -> None:
    content = table(format, {"file": 'a\tb\nc,"d"', "n": 3}, columns=("file", "n"))
    assert content.count("\n") == 2
    assert list(csv.reader(io.StringIO(content), delimiter=delimiter)) == [
        ["file", "n"],
        ['a b c,"d"', "3"],
    ]


def test_json_lines() -> None:
    lines = table("jsonl", TREFOIL, FAILED).splitlines()
    assert json.loads(lines[0]) == {key: TREFOIL[key] for key in DEFAULT}
    assert json.loads(lines[1]) == {
        "knot": "a|b & 100%\t",
        "n": 60,
        "dl": None,
        "l_p": None,
        "l_c": None,
        "l_a": None,
    }


def test_a_json_array() -> None:
    assert json.loads(table("json")) == []
    lines = table("jsonl", TREFOIL, FAILED, TREFOIL).splitlines()
    assert json.loads(table("json", TREFOIL, FAILED, TREFOIL)) == list(map(json.loads, lines))


def test_a_column_goes_by_its_key_or_its_header() -> None:
    for column in COLUMNS.values():
        for name in (column.key, column.header, column.key.upper(), f" {column.header} "):
            assert key_of(name) == column.key


@pytest.mark.parametrize(
    "text",
    [
        "knot\tL_a\tL_c(fine)\tcolour\n3_1\t32.7\t-\tred\n\n",
        "knot,l_a,l_c_fine\n3_1,32.7,-\n",
        '{"knot": "3_1", "L_a": 32.7, "l_c_fine": null, "colour": []}\n\n',
        '[{"knot": "3_1",\n "l_a": 32.7, "L_c(fine)": null}]',
    ],
)
def test_either_spelling_is_read(text: str, tmp_path: Path) -> None:
    (tmp_path / "table").write_text(text)
    assert read(str(tmp_path / "table")) == [{"knot": "3_1", "l_a": 32.7, "l_c_fine": None}]


def test_json_has_no_infinity() -> None:
    assert table("jsonl", {"sr": math.inf}, columns=("sr",)) == '{"sr": null}\n'


def test_markdown() -> None:
    assert table("md", TREFOIL, FAILED) == (
        "Ropelength is length over the RADIUS of the rope (R = 1).\n"
        "\n"
        "| knot | n | dl | L_p | L_c | L_a |\n"
        "| :--- | ---: | ---: | ---: | ---: | ---: |\n"
        "| 3_1 | 120 | 0.27243068 | 32.691681 | 32.940950 | 32.741534 |\n"
        "| a\\|b & 100%  | 60 | - | - | - | - |\n"
    )


def test_latex() -> None:
    assert table("latex", TREFOIL, FAILED) == (
        "% Ropelength is length over the RADIUS of the rope (R = 1).\n"
        "\\begin{tabular}{lrrrrr}\n"
        "\\hline\n"
        "knot & $n$ & $dl$ & $L_p$ & $L_c$ & $L_a=(4 L_p+L_c)/5$ \\\\\n"
        "\\hline\n"
        "$3_1$ & 120 & 0.27243068 & 32.691681 & 32.940950 & 32.741534 \\\\\n"
        "a|b \\& 100\\%  & 60 & - & - & - & - \\\\\n"
        "\\hline\n"
        "\\end{tabular}\n"
    )


@pytest.mark.parametrize(
    ("name", "shown"),
    [
        ("7_1", "$7_1$"),
        ("m8_20.n480", "$m8_{20}$"),
        ("8_18.dl0.05", "$8_{18}$"),
        ("11n_34", "$11n_{34}$"),
        ("3_1#m3_1.n960.best", r"$3_1\#m3_1$"),
        ("6^2_13", "$6^2_{13}$"),
        ("T(3,-7)", "$T(3,-7)$"),
        (r"L6a4{0,1}", r"$L6a4\{0,1\}$"),
        ("my_rope", r"my\_rope"),
        ("3_1#mine", r"3\_1\#mine"),
    ],
)
def test_latex_typesets_names(name: str, shown: str) -> None:
    assert table("latex", {"knot": name}, columns=("knot",)).splitlines()[5] == shown + r" \\"


def test_latex_of_no_rows_is_nothing() -> None:
    assert table("latex") == ""


def test_latex_escapes_names() -> None:
    row = table("latex", {"knot": r"\~^&%$#_{}"}, columns=("knot",)).splitlines()[5]
    assert row == r"\textbackslash{}\textasciitilde{}\textasciicircum{}\&\%\$\#\_\{\} \\"


def test_precision_of_every_column() -> None:
    row: Row = {key: 7 if column.spec == "d" else 1.23456789012 for key, column in COLUMNS.items()}
    cells = dict(
        zip(COLUMNS, table("md", row, columns=tuple(COLUMNS)).splitlines()[4].split("|")[1:], strict=False)
    )
    expected = {
        "n": "7",
        "components": "7",
        "dl": "1.23456789",
        "l_a": "1.234568",
        "dispersion": "1.2e+00",
        "overlap": "1.2e+00",
        "min_rad": "1.234567890",
        "r_s": "1.234567890",
        "sweeps": "7",
        "seconds": "1.23",
        "l_a_difference": "+1.2346",
    }
    assert {key: cells[key].strip() for key in expected} == expected


@pytest.mark.parametrize("format", ["tsv", "csv", "jsonl", "json"])
def test_a_table_is_read_as_it_was_written(format: str, tmp_path: Path) -> None:
    rows: list[Row] = [TREFOIL, {"knot": "m3_1", "n": 7, "l_a": None, "seconds": 2.0}]
    columns = ("knot", "n", "dl", "l_a", "seconds")
    (tmp_path / "table").write_text(table(format, *rows, columns=columns))
    assert read(str(tmp_path / "table")) == [{key: row.get(key) for key in columns} for row in rows]


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("", "table:1: has no column knot"),
        ("n\tL_a\n3\t4\n", "table:1: has no column knot"),
        ("knot\tn\n3_1\tx\n", "table:2: 'x' in the column n is no whole number"),
        ("knot\tn\n3_1\n", "table:2: does not fit the header: it has 1 cells for 2 columns"),
        ("knot\tl_a\n3_1\tnan\n", "table:2: 'nan' in the column l_a is no number"),
        ("knot\tsr\n3_1\tnan\n", "table:2: 'nan' in the column sr is no number"),
        ("knot\tl_a\n3_1\t1e999\n", "table:2: '1e999' in the column l_a is no number"),
        ('{"knot": "3_1", "file": 7}\n', "table:1: 7 in the column file is no text"),
        (f"knot\tn\n3_1\t{'9' * 5000}\n", r"table:2: '9{26}\.\.\. in the column n is no whole number"),
        ('{"knot": "3_1"}\n{"knot": \n', "table:2: is no JSON; give a table that sono wrote as tsv, csv"),
        ('{"knot": "3_1", "l_a": "x"}\n', "table:1: 'x' in the column l_a is no number"),
        ('{"knot": "3_1", "l_a": [1]}\n', r"table:1: \[1\] in the column l_a is no number"),
        ('{"knot": "3_1", "n": 1.5}\n', "table:1: 1.5 in the column n is no whole number"),
        ('{"knot": "3_1", "l_c": NaN}\n', "table:1: nan in the column l_c is no number"),
        ('{"knot": 31}\n', "table:1: is no row with a knot"),
        ('[\n{"knot": "3_1"},\n{"knot" "4_1"}\n]\n', "table:3: is no JSON"),
        ('[{"knot": "3_1"}, 7]', "table: row 2: is no row with a knot"),
        ("[" * 100_000, "table:1: is no JSON"),
    ],
)
def test_no_table(text: str, message: str, tmp_path: Path) -> None:
    (tmp_path / "table").write_text(text)
    with pytest.raises(FormatError, match=message):
        read(str(tmp_path / "table"))


class Flushed(io.StringIO):
    """Remembers what had been flushed."""

    seen = ""

    def flush(self) -> None:
        self.seen = self.getvalue()


@pytest.mark.parametrize("format", FORMATS)
def test_rows_are_out_as_soon_as_they_are_finished(format: str) -> None:
    stream = Flushed()
    rows = writer(format, DEFAULT, stream)
    rows.header()
    rows.row(TREFOIL)
    assert stream.seen.count("120") == 1
    assert stream.seen.endswith("\n")
    rows.row(TREFOIL)
    assert stream.seen.count("120") == 2
    rows.close()
    assert stream.seen == table(format, TREFOIL, TREFOIL)


def test_failure_leaves_a_complete_table() -> None:
    stream = io.StringIO()
    with suppress(RuntimeError), writer("latex", DEFAULT, stream) as rows:
        rows.row({"knot": "3_1"})
        raise RuntimeError
    assert stream.getvalue().endswith("\\end{tabular}\n")


@pytest.mark.parametrize("format", FORMATS)
def test_names_that_are_not_utf_8_can_be_printed(format: str) -> None:
    table(format, {"file": "knot\udcff"}, columns=("file",)).encode()


def test_unknown_names_are_answered_with_the_known_ones() -> None:
    with pytest.raises(
        ValueError, match="unknown table format 'xls'; the formats are: table, tsv, csv, jsonl, json, md"
    ):
        writer("xls", DEFAULT, io.StringIO())
    with pytest.raises(
        ValueError, match="unknown column 'xyz'; the columns are: knot, n, components, dl, l_p"
    ):
        writer("table", ["xyz"], io.StringIO())
    with pytest.raises(ValueError, match=r"unknown column 'l_q'; did you mean l_[pac]"):
        writer("table", ["l_q"], io.StringIO())
