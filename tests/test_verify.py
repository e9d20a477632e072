"""Whether two curves are the same knot or link: proven, by invariants, or undecided."""

from itertools import permutations
from pathlib import Path

import numpy as np
import pytest
from conftest import Sono
from test_identify import LARGER, polygon

import sono as package
from sono import formats
from sono.invariants.crossings import diagram
from sono.invariants.diagrams import Gauss, gauss_code, shortened
from sono.naming import sameness, verify
from sono.naming.primes import pieces_of
from sono.starts import start
from sono.starts.drawing import mirror

SAME = ["0_1", "3_1", "m9_42", "8_17", "L5a1", "L6a4", "3_1#m4_1", "3_1#8_17", "Hopf#Hopf"]
SLOWER = [pytest.param(name, marks=pytest.mark.slow) for name in ("T(3,7)", "9_1#T(2,15)")]


@pytest.mark.parametrize("name", [*SAME, *SLOWER])
def test_other_conformations_are_proven_the_same(name: str) -> None:
    found = verify(start(name), start(name, 5))
    assert (found.verdict, found.known, found.differs) == ("same", "proven", None)
    assert found.name == found.other_name == package.identify(name).name


@pytest.mark.parametrize("name", ["3_1", "m8_19", "10_71", "Hopf", "3_1#3_1", *SLOWER])
def test_mirror_images_are_told_apart(name: str) -> None:
    curve = start(name)
    found = verify(curve, mirror(curve))
    assert (found.verdict, found.known) == ("mirror images", "proven")
    assert verify(mirror(curve), curve).verdict == "mirror images"
    assert verify(mirror(curve), mirror(start(name, 3))).verdict == "same"


@pytest.mark.parametrize("name", ["0_1", "4_1", "8_17", "3_1#m3_1", "L6a4"])
def test_what_is_its_own_mirror_image_is_the_same(name: str) -> None:
    found = verify(start(name), mirror(start(name)))
    assert (found.verdict, found.known) == ("same", "proven")


@pytest.mark.parametrize(
    ("one", "other", "known", "differs"),
    [
        ("0_1", "3_1", "proven", "signatures"),
        ("3_1", "Hopf", "proven", "components"),
        ("5_1", "10_132", "proven", "signatures"),
        ("Hopf", "Whitehead", "proven", "linking numbers"),
        ("3_1#3_1", "3_1#m3_1", "proven", "signatures"),
        ("11n_34", "0_1", "proven", "HOMFLY polynomials"),
        ("11n_34", "11n_42", "proven", "names in the table"),
        ("11n_34", "m11n_42", "proven", "HOMFLY polynomials"),
        ("T(3,7)", "T(2,13)", "proven", "signatures"),
        ("P(3,5,7)", "8_19", "invariants", "signatures"),
        ("8_20", "10_140", "proven", "HOMFLY polynomials"),
        ("4_1", "6_3", "proven", "Alexander polynomials"),
    ],
)
def test_different_ones(one: str, other: str, known: str, differs: str) -> None:
    for pair in ((one, other), (other, one)):
        found = verify(*map(start, pair))
        assert (found.verdict, found.known, found.differs) == ("different", known, differs)


@pytest.mark.slow
@pytest.mark.parametrize("name", LARGER)
def test_what_shares_invariants_with_a_type_of_the_table(name: str) -> None:
    """These are different, but nothing here tells."""
    larger = start(LARGER[name])
    found = verify(start(name), larger)
    assert (found.verdict, found.known, found.other_name) == ("undecided", "undecided", None)
    found = verify(larger, start(LARGER[name], 3))
    assert (found.verdict, found.known) == ("same", "proven")


def test_orders_and_orientations_of_links() -> None:
    link = start("L8a16{0,0}")
    for order in permutations(range(3)):
        curve = [link[number] for number in order]
        assert verify(link, curve).verdict == "same"
        assert verify(link, [component[::-1] for component in curve]).verdict == "same"
    hopf = start("Hopf")
    assert verify(hopf, [hopf[0], hopf[1][::-1]]).verdict == "mirror images"
    whitehead = start("T(2,4)")
    assert verify(whitehead, [whitehead[0], whitehead[1][::-1]]).verdict == "different"


def test_pieces_that_are_apart() -> None:
    trefoil, eight, circle = start("3_1"), start("4_1"), start("0_1")
    one = [*trefoil, eight[0] + 50, circle[0] + 100]
    other = [circle[0], eight[0] - 50, trefoil[0] + 100]
    assert (verify(one, other).verdict, verify(one, other).known) == ("same", "proven")
    assert verify(one, mirror(one)).verdict == "mirror images"
    assert verify(one, [*trefoil, eight[0] + 50, trefoil[0] + 100]).verdict == "different"
    joined = [*start("3_1#4_1"), circle[0] + 50, circle[0] - 50]
    assert verify(one, joined).verdict == "different"


def test_sums_of_links_depend_on_components() -> None:
    """A trefoil in one ring of a Whitehead link or in the other: parts do not tell the whole, moves do."""
    found = verify(start("3_1#Whitehead"), start("3_1#Whitehead", 3))
    assert found.verdict == "same"
    primes = pieces_of(gauss("3_1#Whitehead"))
    assert not sameness._tells_the_whole(primes)
    assert sameness._tells_the_whole(pieces_of(gauss("3_1#8_17")))
    assert not sameness._tells_the_whole(pieces_of(gauss("8_17#8_17")))


def gauss(name: str) -> Gauss:
    return shortened(gauss_code(diagram(start(name))))


@pytest.mark.slow
def test_without_moves_invariants_tell(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(sameness, "_meets", lambda one, other: False)
    found = verify(start("P(3,5,7)"), start("P(3,5,7)", 2))
    assert (found.verdict, found.known, found.differs) == ("same", "invariants", None)
    found = verify(start("P(3,5,7)"), start("mP(3,5,7)"))
    assert (found.verdict, found.known) == ("mirror images", "invariants")


def test_what_is_too_entangled() -> None:
    curve = [polygon(1, 90)]
    found = verify(curve, [curve[0] + 1e-9 * polygon(2, 90)])
    assert found.verdict in ("same", "undecided")
    assert found.known != "invariants"
    assert verify(curve, start("3_1")).verdict == "different"
    with pytest.raises(package.TooEntangledError):
        verify([polygon(1, 140)], start("3_1"))


def test_the_public_call() -> None:
    assert package.verify("3_1", package.tighten("3_1", 60)).verdict == "same"
    found = package.verify(package.start("Hopf"), "3_1")
    assert found == package.verify("Hopf", package.start("3_1"))
    assert found.to_dict()["verdict"] == "different"
    with pytest.raises(ValueError, match="the curve crosses itself"):
        package.verify([[0, 0, 0], [2, 2, 0], [2, 0, 0], [0, 2, 0]], "3_1")


@pytest.mark.parametrize(
    ("one", "other", "verdict", "code"),
    [
        ("3_1.txt", "3_1.txt", "same\tproven\t-", 0),
        ("3_1.txt", "T(2,3)", "same\tproven\t-", 0),
        ("m3_1", "3_1.txt", "mirror images\tproven\t-", 1),
        ("3_1.txt", "Hopf.txt", "different\tproven\tcomponents", 1),
        ("-", "3_1", "same\tproven\t-", 0),
        ("4_1", "-", "different\tproven\tsignatures", 1),
    ],
)
def test_a_row_and_a_code(folder: Path, sono: Sono, one: str, other: str, verdict: str, code: int) -> None:
    result = sono("verify", one, other, input=(folder / "3_1.txt").read_text())
    assert result.stdout.splitlines() == [
        "file\tother\tverdict\tknown\tdiffers",
        f"{one}\t{other}\t{verdict}",
    ]
    assert (result.exit_code, result.stderr) == (code, "")


def test_undecided_is_no_success(folder: Path, sono: Sono) -> None:
    (folder / "larger.pd").write_text(LARGER["12a_786"].removeprefix("pd:"))
    result = sono("verify", "12a_786", "larger.pd", "--columns", "verdict,knot,other_knot")
    assert result.stdout.splitlines()[1] == "undecided\t12a_786\t-"
    assert result.exit_code == 1


def test_wrong_files(folder: Path, sono: Sono) -> None:
    (folder / "crossing.txt").write_text("# 8\n0 0 0\n2 2 0\n2 0 0\n0 2 0\n")
    (folder / "two.gauss").write_text("1 -2 3 -1 2 -3\n-1 2 -3 1 -2 3\n")
    formats.write(folder / "tangle.txt", [np.random.default_rng(1).normal(size=(140, 3))])
    for arguments, message in {
        ("crossing.txt", "3_1"): "crossing.txt:2: the curve crosses itself",
        ("3_1", "missing.txt"): "missing.txt: ",
        ("3_1", "nonsense"): "nonsense: no such file, nor a knot",
        ("two.gauss", "3_1"): "two.gauss: holds 2 curves; give one of them, such as two.gauss:1",
        ("3_1", "tangle.txt"): "3_1, tangle.txt: the curve has over 1000 crossings",
    }.items():
        result = sono("verify", *arguments)
        assert (result.exit_code, result.stdout) == (1, "")
        assert result.stderr.startswith(f"sono: {message}")
        assert len(result.stderr.splitlines()) == 1
    assert sono("verify", "two.gauss:1", "3_1").exit_code in (0, 1)


@pytest.mark.parametrize("arguments", [[], ["3_1"], ["3_1", "3_1", "3_1"], ["-", "-"]])
def test_wrong_arguments(sono: Sono, arguments: list[str]) -> None:
    result = sono("verify", *arguments)
    assert (result.exit_code, result.stdout) == (2, "")
