"""Libraries of codes: each line a curve, drawn when it is wanted, wrong ones by themselves."""

from pathlib import Path

import pytest
from conftest import QUICK, Sono

from sono import formats, read_all, starts
from sono.formats import FormatError, codes
from sono.invariants import fingerprint

TREFOIL = "X[1,5,2,4] X[3,1,4,6] X[5,3,6,2]"
EIGHT = "[[4,2,5,1],[8,6,1,5],[6,3,7,4],[2,7,3,8]]"


@pytest.mark.parametrize(
    ("name", "content", "knots"),
    [
        ("k.txt", TREFOIL, {"": "3_1"}),
        ("k.txt", f"# a comment\n\n{EIGHT} # another\n", {"": "4_1"}),
        ("k", f"3_1: {TREFOIL}\nfour\t{EIGHT}\n", {"3_1": "3_1", "four": "4_1"}),
        (
            "k.txt",
            "PD[X[1,5,2,4], X[3,1,4,6], X[5,3,6,2]]\n(4,2,3,1) (2,4,1,3)",
            {"1": "3_1", "2": "L2a1{1}"},
        ),
        (
            "k.txt",
            "gauss: 1 -2 3 -1 2 -3\nDT:4 6 2\nmine: dt : cacbca",
            {"1": "3_1", "2": "3_1", "mine": "3_1"},
        ),
        ("k.dt", "4 6 2\na: [4, 6, 8, 2]\na\t(6,8)(2,4)", {"1": "3_1", "a.2": "4_1", "a.3": "dt:(6,8)(2,4)"}),
        ("k.gauss", "1 -2 3 -1 2 -3", {"": "3_1"}),
        ("k", f"[]\n{EIGHT}", {"1": "0_1", "2": "4_1"}),
        ("k.pd", "1,5,2,4 3,1,4,6 5,3,6,2\n3_1#3_1: pd: Loop[1]", {"1": "3_1", "3_1#3_1": "0_1"}),
    ],
)
def test_codes_are_read(folder: Path, name: str, content: str, knots: dict[str, str]) -> None:
    Path(name).write_text(content)
    found = read_all(name)
    assert list(found) == list(knots)
    for key, knot in knots.items():
        assert fingerprint(found[key]) == fingerprint(starts.start(knot)), key
        assert sum(map(len, formats.read(f"{name}:{key}" if key else name).components)) > 10


@pytest.mark.parametrize(
    "content", ["1 2 3\n4 5 6\n7 8 10\n", "[[1,2,3],[4,5,6],[7,8,10]]", "x: y\n", "", "C:\n"]
)
def test_what_is_no_code(content: str) -> None:
    assert not codes.recognises(content)


BROKEN = [
    *(
        ("k.dt", code)
        for code in ("4 x 2", "4 6", "4 6 3", "4 4 2", "4 6 100", "{", "4.5 6 2", "zz", "[4 6 2", "-")
    ),
    *(
        ("k.gauss", code)
        for code in ("1 -2 -1 2", "1 2 3", "1 -1 -1", "a b", "O1U2", "1 -2 3 -1 2 -3 4", "1|2")
    ),
    *(
        ("k.pd", code)
        for code in ("X[1,5,2,4]", "X[1,2,3]", "(1,5,2,4) (3,1,4,6) (5,3,6,9)", "1,2,2,1,3", "X[1,1,1,1]")
    ),
    *(("k.txt", code) for code in ("pd:", "dt: ", "gauss: |x", "pd: 3_1")),
]


@pytest.mark.parametrize(("name", "code"), BROKEN)
def test_broken_codes_give_one_clear_line(folder: Path, name: str, code: str) -> None:
    kind = name[2:] if name != "k.txt" else "pd"
    Path(name).write_text(f"# a library\ngood: {kind}: {TREFOIL if kind == 'pd' else '1 -1'}\n{code}\n")
    *_, raw = formats.raws(name)[1]
    with pytest.raises(FormatError, match=rf"^{name}:3: (PD|DT|Gauss) code ") as caught:
        len(raw.chains)
    assert str(caught.value).isprintable()


def test_an_empty_library(folder: Path) -> None:
    Path("k.pd").write_text("# nothing\n")
    with pytest.raises(FormatError, match=r"^k.pd:1: the file holds no codes; give one a line"):
        formats.read("k.pd")


def test_a_library_is_a_batch(folder: Path, sono: Sono) -> None:
    Path("lib.txt").write_text(f"one: {TREFOIL}\nwrong: dt: 4 x 2\n{EIGHT}\n")
    result = sono("tighten", "lib.txt", "-n", "60", *QUICK)
    assert result.exit_code == 1
    assert [row.split("\t")[0] for row in result.stdout.splitlines()[1:]] == ["lib:one", "lib:3"]
    assert "lib.txt:2: DT code '4 x 2': not readable" in result.stderr
    assert Path("lib.one.n60.txt").exists()
    assert Path("lib.3.n60.txt").exists()
    named = sono("identify", "lib.txt", "--columns", "file,knot")
    assert named.stdout == "file\tknot\nlib.txt:one\t3_1\nlib.txt:3\t4_1\n"
    piped = sono("identify", "-", "--columns", "knot", input=f"{TREFOIL}\n{EIGHT}\n")
    assert piped.stdout == "knot\n3_1\n4_1\n"
