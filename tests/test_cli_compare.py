"""`sono compare`: published ropelengths beside ours."""

import math
from pathlib import Path

import pytest
from conftest import QUICK, Sono

import sono as package
from sono import formats, starts, tables
from sono.starts.drawing import mirror
from sono.tables import published, reference

ATLAS = Path(package.__file__).parent / "data" / "atlas" / "knots.tsv"

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
    assert link["published"] == pytest.approx(8 * math.pi)
    assert (link["kind"], chiral["kind"]) == ("exact", "bound")
    counted, coarse = result.stderr.splitlines()
    assert coarse.endswith("the error of the limit exceeds the difference: 8_4, m3_1")
    assert counted == "sono: of 2 rows L_a is at most the published value in 1, L_c in 1, the limit in 1"


def test_a_name_of_nothing_published(sono: Sono) -> None:
    result = sono("compare", "-", "--columns", "published,kind", input="knot\tL_a\nT(7,3)\t80\nmine\t1.5\n")
    assert result.stdout == "published\tkind\n-\t-\n-\t-\n"
    assert result.stderr.startswith("sono: no ropelength is published under the names T(7,3), mine; `sono id")
    assert result.stderr.count("\n") == 1


@pytest.mark.parametrize(
    ("names", "length", "kind"),
    [
        (
            ("Hopf", "hopf link", "L2a1", "L2a1{0}", "2^2_1", "T(2,2)", "T(2,-2)", "chain2", "-1 -1"),
            25.1327,
            "exact",
        ),
        (("chain3", "Hopf#Hopf", "mHopf#L2a1"), 41.6991, "exact"),
        (("Borromean", "6^3_2", "L6a4{1,0}", "6.3.2"), 58.0060, "critical"),
        (("6^3_3", "L6n1", "L6n1{0,1}", "mL6n1", "T(3,3)", "T(-3,3)"), 50.35, "numerical"),
        (("T(24,19)", "T(19,24)", "T(-19,24)"), 949.5, "numerical"),
        (("3_1#m3_1", "m3_1#3_1", "square", "T(2,3)#T(2,-3)"), 57.0876, "numerical"),
        (("granny", "m3_1#m3_1", "K3a1#trefoil"), 57.0557, "numerical"),
        (("4_1#3_1", "m3_1#m4_1", "5/2#3_1"), 65.2554, "numerical"),
        (("11a_367", "T(2,11)", "K11a367", "m11a367"), 91.8, "bound"),
    ],
    ids=lambda value: value[0] if isinstance(value, tuple) else None,
)
def test_names_are_matched_by_what_they_name(
    sono: Sono, names: tuple[str, ...], length: float, kind: str
) -> None:
    rows = "".join(f"{name}.tight\t{length}\n" for name in names)
    result = sono("compare", "-", "--columns", "published,kind", "-q", input=f"knot\tL_a\n{rows}")
    found = [line.split("\t") for line in result.stdout.splitlines()[1:]]
    assert len(found) == len(names)
    assert {what for _, what in found} == {kind}
    assert len({value for value, _ in found}) == 1
    assert float(found[0][0]) == pytest.approx(length, abs=0.01 if kind != "bound" else 10)


def test_each_published_value_on_its_own(sono: Sono) -> None:
    columns = "l_a,published,kind,printed,per,source"
    result = sono("compare", "-", "--all", "--columns", columns, input="knot\tL_a\nT(2,3)\t32.74\nfoo\t1.0\n")
    *rows, last = [line.split("\t") for line in result.stdout.splitlines()[1:]]
    assert [row[2] for row in rows] == ["bound", "bound", "numerical", "estimate", "estimate"]
    assert [row[0] for row in rows] == 5 * ["32.74"]
    assert rows[0][1] == "32.7436"
    assert rows[2][1:5] == ["32.745722", "numerical", "16.372861", "diameter"]
    assert rows[3][1] == "32.742934477"
    assert last == ["1.0", "-", "-", "-", "-", "-"]
    assert "of 1 rows L_a is at most" in result.stderr
    wrong = sono("compare", "-", "--all", "--published", "mine.tsv", input=TABLE)
    assert (wrong.exit_code, "--all or --published" in wrong.stderr) == (2, True)


def _claims(sono: Sono, table: str) -> list[str]:
    lines = sono("compare", "-", input=table).stderr.splitlines()
    return [line for line in lines if "shorter than" in line or "estimate of the limit" in line]


def test_what_was_checked_of_a_record(sono: Sono) -> None:
    rows = (
        "T(4,4)\t77.3\t77.4\nT(-25,26)\t1340\t1341\n8_4\t71.4\t71.4\nT(5,5)\t108.9\t110\nT(4,4)\t77.3\t77.4\n"
    )
    claims = _claims(sono, f"knot\tL_a\tL_c\n{rows}")
    assert [line.split(";")[0] for line in claims] == [
        "sono: shorter than Klotz 2026: T(4,4)",
        "sono: shorter than Klotz, Maldonado 2021: T(-25,26)",
    ]
    assert "DataTightLinksKlotz26.txt of July 2026" in claims[0]
    assert "77.977" in claims[0]


def test_only_a_rope_is_shorter(sono: Sono) -> None:
    head = "knot\tn\tl_a\tl_c\tl_c_fine\tn_fine\n"
    # 58.0060 is printed of L6a4, and 109.00 of T(5,5): what rounds to that is not below it.
    assert not _claims(sono, f"{head}L6a4\t4640\t58.00598\t58.00674\t-\t-\n")
    assert not _claims(sono, f"{head}L6a4\t290\t57.9922\t58.18986\t-\t-\n")
    assert not _claims(sono, f"{head}T(5,5)\t5000\t108.996\t108.997\t-\t-\n")
    below = _claims(
        sono, f"{head}T(5,5)\t5000\t108.98\t109.001\t-\t-\nT(5,5)\t900\t108\t109.3\t109.1\t1800\n"
    )
    assert [line.split(";")[0] for line in below] == [
        "sono: the estimate of the limit is below Klotz 2026: T(5,5)"
    ]


def test_of_what_is_exact_no_limit_is_below(sono: Sono) -> None:
    result = sono("compare", "-", input="knot\tn\tl_a\tl_c\nHopf\t251\t25.12755\t25.14876\n")
    assert (result.exit_code, result.stderr) == (0, "")


def test_the_sources_are_listed(sono: Sono) -> None:
    result = sono("compare", "--sources")
    assert result.exit_code == 0
    for source in reference.sources().values():
        assert f"{source.source}\n  {source.citation}\n  over the {source.per}: " in result.stdout
    assert sono("compare").exit_code == 2


def test_a_link_of_another_type_than_its_name(folder: Path, sono: Sono) -> None:
    shaken = [component[::-1] for component in starts.start("chain3")[::-1]]
    formats.write("chain3.txt", [shaken[1], shaken[0][::-1], shaken[2]])
    formats.write("6^3_3.txt", mirror(starts.start("L6n1{0,1}"))[::-1])
    formats.write("Hopf.txt", starts.start("4^2_1"))
    formats.write("6^3_2.txt", starts.start("6^3_1"))
    formats.write("Whitehead.txt", starts.start("5^2_1", variant=3))
    files = ("chain3.txt", "6^3_3.txt", "Hopf.txt", "6^3_2.txt", "Whitehead.txt")
    table = sono("measure", *files, "--columns", "knot,n,l_a,file").stdout
    doubts = [
        line for line in sono("compare", "-", input=table).stderr.splitlines() if "another type" in line
    ]
    assert [line.split(":")[1] for line in doubts] == [" Hopf", " 6^3_2"]


def test_a_link_shorter_than_can_be(sono: Sono) -> None:
    table = "knot\tL_a\tL_c\nHopf\t25.1\t25.1\nchain5\t74.8\t74.84\nT(3,3)\t48.0\t50\n"
    doubts = [line for line in sono("compare", "-", input=table).stderr.splitlines() if "this type" in line]
    assert doubts == [
        "sono: Hopf: is shorter than any rope of this type can be: is it of this type?",
        "sono: T(3,3): is 5% shorter than published: is it of this type?",
    ]


def test_the_finer_level_counts_for_l_c(folder: Path, sono: Sono) -> None:
    Path("fine.tsv").write_text("knot\tL_a\tL_c\tL_c(fine)\n8_4\t71.45\t71.69\t71.46\n")
    result = sono("compare", "fine.tsv", "--columns", "l_c_difference", "-q")
    assert float(result.stdout.splitlines()[1]) == pytest.approx(-0.0104)
    assert result.stderr == ""


def test_another_table_to_compare_with(folder: Path, sono: Sono) -> None:
    Path("mine.tsv").write_text("knot\tL_a\nHopf\t25.0\n")
    result = sono("compare", "-", "--published", "mine.tsv", input=TABLE)
    assert "Hopf\t60\t25.1\t-\t-\t-\t25.0\tmine.tsv\t0.1" in result.stdout
    Path("mirror.tsv").write_text("knot\tL_a\nm3_1\t32.7\n")
    result = sono("compare", "mirror.tsv", "--published", "mirror.tsv", "-q", "--columns", "l_a_difference")
    assert result.stdout == "l_a_difference\n0.0\n"


def test_a_pipe_from_measure(folder: Path, sono: Sono) -> None:
    result = sono("compare", "-", input=sono("measure", "3_1.txt").stdout)
    assert result.exit_code == 0
    assert result.stdout.splitlines()[1].startswith("3_1\t69\t")


@pytest.mark.parametrize(
    "name", ["8_4.tight", "m8_4.n359", "M8_4", "8_4.n359.best2", "8_4.dl0.05", "8_4.dl1", "8_4"]
)
def test_files_names_are_understood(sono: Sono, name: str) -> None:
    result = sono("compare", "-", "--columns", "published", input=f"knot\tL_a\n{name}\t71.45\n")
    assert result.stdout == "published\n71.4704\n"


def test_measure_says_which_file_so_that_its_type_is_compared(folder: Path, sono: Sono) -> None:
    formats.write("8_20.txt", starts.start("9_42"))
    result = sono("compare", "-", input=sono("measure", "8_20.txt").stdout)
    assert "8_20: the curve in 8_20.txt is of another type than 8_20" in result.stderr


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
    knots = [row["knot"] for row in starts.table("knots")]
    assert set(knots) < set(table)
    assert {table[knot]["source"] for knot in knots} == {"ACPR 2011", "KnotInfo 2026.11.2"}
    assert {table[knot]["kind"] for knot in knots} == {"bound"}
    # Table 1 of Ashton, Cantarella, Piatek and Rawdon.
    assert [table[knot]["published"] for knot in ("3_1", "4_1", "8_18")] == [32.7436, 42.0887, 74.9063]


def test_a_curve_of_another_type_than_its_name(folder: Path, sono: Sono) -> None:
    formats.write("4_1.txt", starts.start("5_2"))
    formats.write("m3_1.txt", starts.start("3_1"))  # whose mirror image is as long
    formats.write("own.txt", starts.start("5_2"))
    columns = "knot,n,l_a,file"
    table = sono("measure", "4_1.txt", "m3_1.txt", "3_1.txt", "own.txt", "--columns", columns).stdout
    assert sono("compare", "-", "-q", input=table).stderr == ""
    result = sono("compare", "-", input=table)
    assert result.exit_code == 0
    doubts = [line for line in result.stderr.splitlines() if "type" in line]
    assert doubts == ["sono: 4_1: the curve in 4_1.txt is of another type than 4_1"]


def test_a_record_that_is_none(folder: Path, sono: Sono) -> None:
    starts.start("3_1")
    result = sono("compare", "-", input="knot\tl_a\n4_1\t32.7\n9_1\t75.3\n")
    assert "sono: 4_1: is 22% shorter than published: is it of this type?" in result.stderr
    assert "9_1" not in result.stderr


def test_a_file_called_like_a_knot_is_told(folder: Path, sono: Sono) -> None:
    formats.write("4_1", starts.start("3_1"))
    formats.write("stick", starts.start("3_1"))
    line = ("tighten", "4_1", "5_2", "stick", "./4_1", "-n", "60", "--force", "--columns", "knot,l_a", *QUICK)
    result = sono(*line[:4], *line[5:])
    assert 32 < float(result.stdout.split()[3]) < 33
    note = "sono: 4_1: is a file here, which is taken, and not the knot of this name; `sono start 4_1`"
    assert [text for text in result.stderr.splitlines() if "is a file here" in text] == [f"{note} draws that"]
    assert "is a file here" not in sono("tighten", "./4_1", *line[5:]).stderr
    assert note in sono("search", "4_1", "--trials", "1").stderr
    assert "is a file here" not in sono("search", "4_1", "--trials", "1", "--force", "-q").stderr


def test_the_limit_of_the_trefoil_is_within_its_error() -> None:
    # L_p and L_c of the README's tables, and the best published estimate of the trefoil's ropelength.
    for n, l_p, l_c in [
        (120, 32.691005, 32.939913),
        (240, 32.730395, 32.791877),
        (480, 32.739828, 32.755154),
        (960, 32.742168, 32.745995),
        (3840, 32.74288674, 32.74312583),
    ]:
        row: tables.Row = {"knot": "3_1", "n": n, "l_a": (4 * l_p + l_c) / 5, "l_c": l_c}
        once = published.extrapolated(row)
        twice = published.extrapolated({**row, "n_fine": 7680, "l_c_fine": 32.74298246})
        errors = [float(found["limit_error"] or 0) for found in (once, twice)]
        for found, error in zip((once, twice), errors, strict=True):
            assert abs(float(found["limit"] or 0) - 32.742934477) < error
        assert n > 480 or errors[1] < 0.02 * errors[0]


@pytest.mark.parametrize(
    ("knot", "limit", "levels"),
    [
        # n, L_p and L_c of tight ropes on edges of 0.2, 0.1, 0.05 and 0.025, and of 0.0125 for L6a4.
        (
            "Hopf",
            8 * math.pi,
            [
                (125, 25.09050056, 25.19865905),
                (251, 25.12224766, 25.14876404),
                (503, 25.13012719, 25.13669542),
                (1005, 25.13208636, 25.13372758),
            ],
        ),
        (
            "L6a4",
            58.00604,
            [
                (290, 57.94278527, 58.18986032),
                (580, 57.99082789, 58.05152699),
                (1160, 58.00214389, 58.01728174),
            ],
        ),
        (
            "6^3_3",
            50.3376,
            [
                (251, 50.28356396, 50.49908335),
                (503, 50.32491623, 50.37775906),
                (1007, 50.33401046, 50.34707921),
            ],
        ),
        (
            "T(2,4)",
            40.00922,
            [
                (200, 39.97674203, 40.13991817),
                (400, 40.00147761, 40.04185990),
                (800, 40.00724478, 40.01726792),
            ],
        ),
        (
            "4_1",
            42.08582,
            [
                (210, 42.04700506, 42.22220591),
                (421, 42.07626904, 42.11946199),
                (842, 42.08344843, 42.09421379),
            ],
        ),
        (
            "10_139",
            72.87669,
            [
                (364, 72.81281624, 73.12559258),
                (729, 72.86184307, 72.93935785),
                (1457, 72.87298088, 72.89232759),
            ],
        ),
    ],
    ids=lambda value: value if isinstance(value, str) else None,
)
def test_beads_in_grooves_are_within_the_error(
    knot: str, limit: float, levels: list[tuple[int, float, float]]
) -> None:
    for n, l_p, l_c in levels:
        found = published.extrapolated({"knot": knot, "n": n, "l_a": (4 * l_p + l_c) / 5, "l_c": l_c})
        assert abs(float(found["limit"] or 0) - limit) <= float(found["limit_error"] or 0)


@pytest.mark.parametrize("family", ["knots", "links", "composites", "torus"])
def test_one_level_of_every_family_covers_what_two_tell(family: str) -> None:
    rows = [row for row in tables.read(str(ATLAS.with_name(f"{family}.tsv"))) if row["n_fine"]]
    finer = [row for row in rows if float(row["n_fine"] or 0) > 3 * float(row["n"] or 0)]
    for row in finer:
        twice = published.extrapolated(row)
        once = published.extrapolated({key: row[key] for key in ("knot", "n", "l_a", "l_c")})
        apart = abs(float(once["limit"] or 0) - float(twice["limit"] or 0))
        assert apart <= float(once["limit_error"] or 0), row["knot"]
    assert len(finer) > 10


def test_one_level_estimates_what_two_levels_tell() -> None:
    if not ATLAS.exists():
        pytest.skip("needs the source tree")
    rows = [row for row in tables.read(str(ATLAS)) if float(row["n_fine"] or 0) > 5 * float(row["n"] or 0)]
    within = below = 0
    for row in rows:
        twice = published.extrapolated(row)
        once = published.extrapolated({key: row[key] for key in ("knot", "n", "l_a", "l_c")})
        limit, error = float(twice["limit"] or 0), float(once["limit_error"] or 0)
        within += abs(float(once["limit"] or 0) - limit) <= error
        below += float(row["l_a"] or 0) < limit
        assert float(twice["limit_error"] or 0) < 0.05 * error
    assert within >= 0.99 * len(rows)
    assert below >= 0.85 * len(rows)


def test_edges_too_coarse_to_tell(folder: Path, sono: Sono) -> None:
    # 8_18 on edges of 0.37 and 0.04; 74.9063 is published.
    coarse = "8_18\t200\t74.80304916\t75.68405809\n"
    fine = "8_18.n1920\t1920\t74.90273390\t74.91199079\n"
    result = sono("compare", "-", "--format", "jsonl", input=f"knot\tn\tl_a\tl_c\n{coarse}{fine}")
    assert "sono: 1 rows have edges too coarse to tell which is shorter" in result.stderr
    assert result.stderr.endswith("the difference: 8_18\n")
    Path("rows").write_text(result.stdout)
    first, second = tables.read("rows")
    assert published.is_too_coarse(first)
    assert not published.is_too_coarse(second)
