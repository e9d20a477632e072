"""Names of knots and links, against the names they were drawn by and against Regina."""

import json
import re
from itertools import permutations, product

import numpy as np
import pytest

import sono
from sono import _core
from sono.curve import Components, Floats
from sono.invariants.crossings import crossings, diagram, linking_matrix, planar_diagram
from sono.invariants.diagrams import (
    Gauss,
    alexander_polynomial,
    as_crossings,
    gauss_code,
    homfly_polynomial,
    shortened,
    written,
)
from sono.invariants.signatures import signature
from sono.naming import identify
from sono.naming.known import SAME_AS_MIRROR, key, mirrored, sharing
from sono.naming.letters import packed, unpacked
from sono.starts import start, table
from sono.starts.drawing import mirror
from sono.starts.scramble import scramble

NAMES = ["0_1", "3_1", "m3_1", "4_1", "8_17", "m9_42", "10_71", "m10_71", "L6a4{0,0}", "L4a1{0}", "mL7n1{1}"]
SUMS = {
    "3_1#3_1": "3_1#3_1",
    "3_1#m3_1": "3_1#m3_1",
    "4_1#8_20#m5_2": "4_1#m5_2#8_20",
    "m4_1#0_1": "4_1",
    "Hopf#Hopf": "L2a1{1}#L2a1{1}",
    "5_1#Hopf": "L2a1{1}#5_1",
}
TYPES = table("types")
# K14n16551 and K14n4749, which share HOMFLY polynomials and signatures with knots of the table: PD codes from
# SnapPy's table of knots, that of J. Hoste, M. Thistlethwaite and J. Weeks (The first 1,701,936 knots, 1998).
LARGER = {
    "13n_2853": "pd:(3,1,4,28),(1,11,2,10),(11,3,12,2),(4,19,5,20),(26,6,27,5),(6,18,7,17),(16,8,17,7),"
    "(8,24,9,23),(14,9,15,10),(12,21,13,22),(22,13,23,14),(24,16,25,15),(18,26,19,25),(20,27,21,28)",
    "12a_786": "pd:(3,1,4,28),(1,7,2,6),(7,3,8,2),(4,16,5,15),(16,6,17,5),(17,8,18,9),(9,20,10,21),"
    "(19,10,20,11),(11,18,12,19),(25,12,26,13),(13,24,14,25),(21,14,22,15),(27,23,28,22),(23,27,24,26)",
}


def polygon(seed: int, n: int) -> Floats:
    return np.random.default_rng(seed).normal(size=(n, 3))


def turned(curve: Components) -> list[Components]:
    """Return a link with its components in another order, and then all reversed."""
    return [curve[::-1], [component[::-1] for component in curve]]


@pytest.mark.parametrize("name", NAMES)
def test_names_of_starts(name: str) -> None:
    found = identify(start(name))
    assert (found.name, found.known) == (name, "proven")
    assert all(identify(curve).name == name for curve in turned(start(name)))


@pytest.mark.parametrize("name", SUMS)
def test_sums_are_named_by_their_parts(name: str) -> None:
    found = identify(start(name))
    assert (found.name, found.proven) == (SUMS[name], True)


@pytest.mark.parametrize("name", ["L8a21{1,0,0}", "L9a53{0,1}", "L9n20{0,0}", "L9n27{0,1}"])
def test_variants_of_links_are_oriented_like_the_first(name: str) -> None:
    """These share linking numbers, signatures and HOMFLY polynomials with other orientations."""
    assert {identify(start(name, variant)).names for variant in (0, 1, 18)} == {(name,)}


def test_parts_that_are_apart() -> None:
    trefoil, circle, rings = start("3_1"), start("unknot"), start("Hopf")
    apart = [*trefoil, circle[0] + 50, *(ring + 100 for ring in rings), circle[0] - 50]
    found = identify(apart)
    assert (found.name, found.components, found.determinant) == ("0_1+0_1+L2a1{1}+3_1", 5, 0)
    assert found.linking == (0, 0, 0, 0, 0, 0, 0, 1, 0, 0)
    assert found.circles == 2
    # A link under which another one lies is not linked with it either.
    over = [component * (1, 1, 0.2) + (0.3, 0.1, 40) for component in start("4_1")]
    assert identify([*trefoil, *over]).name == "3_1+4_1"


@pytest.mark.parametrize("name", ["P(3,5,7)", "C(5,4,5)", "P(2,4,6)", "P(3,5,7)#P(-3,5,7)"])
def test_what_the_table_has_not(name: str) -> None:
    found = identify(start(name))
    assert (found.names, found.name, found.known) == ((), None, "not in the table")
    assert found.homfly


@pytest.mark.parametrize("wanted", LARGER)
def test_invariants_do_not_name_what_may_be_larger_than_the_table(wanted: str) -> None:
    curve = start(LARGER[wanted])
    for seen, name in ((curve, wanted), (mirror(curve), f"m{wanted}")):
        found = identify(seen)
        assert (found.names, found.known, found.crossings) == ((), "undecided", 14)
        assert found.may_be == (name,)
    assert identify(start(wanted)).proven


@pytest.mark.parametrize(
    ("name", "expected"),
    [
        ("9_1#P(3,5,7)", "9_1#?"),
        ("Hopf#P(3,5,7)", "L2a1{1}#?"),
        ("P(3,5,7)#m3_1#P(-3,5,7)", "m3_1#?#?"),
        ("P(3,5,7)#mT(2,15)", "mT(2,15)#?"),
    ],
)
def test_sums_name_the_parts_that_have_names(name: str, expected: str) -> None:
    found = identify(start(name))
    assert (found.name, found.known, found.may_be) == (expected, "not in the table", ())


def test_parts_that_are_apart_name_those_that_have_names() -> None:
    larger, far = start(LARGER["12a_786"]), [component + 100 for component in start("m5_2")]
    found = identify([*larger, *far])
    assert (found.name, found.known, found.may_be) == ("m5_2+?", "undecided", ("m5_2+12a_786",))
    found = identify([*start("P(3,5,7)"), *far, far[0] + 100, np.eye(3) - 100])
    assert (found.name, found.known, found.may_be) == ("0_1+m5_2+m5_2+?", "not in the table", ())
    assert identify([*start("P(3,5,7)"), start("P(-3,5,7)")[0] + 100]).name is None


def test_links_show_the_smallest_diagram_that_was_met() -> None:
    curve = scramble(start("Borromean"), 1, swirls=12)
    assert len(shortened(gauss_code(diagram(curve)))[1]) > 6
    found = identify(curve)
    assert (found.name, found.known, found.crossings, len(found.pd)) == ("L6a4{0,0}", "proven", 6, 6)


def test_linking_numbers_are_in_the_order_of_the_curve() -> None:
    link = start("L8a16{0,0}")
    for order in permutations(range(3)):
        curve = [link[number] for number in order]
        expected = linking_matrix(diagram(curve))[np.triu_indices(3, 1)]
        assert identify(curve).linking == tuple(expected.tolist())


def test_what_is_too_entangled() -> None:
    found = identify([polygon(1, 90)])
    assert found.crossings > 40
    assert (found.known, found.homfly, found.alexander) == ("undecided", None, None)
    with pytest.raises(sono.TooEntangledError):
        identify([polygon(1, 140)])


@pytest.mark.parametrize("name", ["3_1", "m4_1", "Hopf", "T(2,4)"])
def test_scrambled(name: str) -> None:
    expected = identify(start(name))
    for seed in range(2):
        found = identify(scramble(start(name), seed, swirls=6))
        assert (found.name, found.proven, found.homfly) == (expected.name, True, expected.homfly)


@pytest.mark.parametrize("seed", range(12))
def test_homfly_polynomials_of_random_polygons(seed: int) -> None:
    regina = pytest.importorskip("regina")
    curve = [polygon(seed, 14 + seed)]
    link = regina.Link.fromPD(planar_diagram(crossings(curve)))
    link.simplify()
    assert identify(curve).homfly == str(link.homflyAZ())


@pytest.mark.parametrize("name", [*NAMES[1:], *SUMS, "T(3,7)"])
def test_the_pd_code_is_of_the_same_hand(name: str) -> None:
    regina = pytest.importorskip("regina")
    found = identify(start(name))
    link = regina.Link.fromPD(list(found.pd))
    assert link.size() == found.crossings
    assert str(link.homflyAZ()) == found.homfly


def test_homfly_polynomials_of_the_tables() -> None:
    regina = pytest.importorskip("regina")
    for row in TYPES[::60]:
        gauss = unpacked(row["diagram"].rstrip(SAME_AS_MIRROR))
        polynomial = homfly_polynomial(gauss)
        assert polynomial
        link = regina.Link.fromPD(planar_diagram(as_crossings(gauss)))
        assert written(polynomial) == str(link.homflyAZ()), row["name"]
        assert key(polynomial) == row["key"]


def test_alexander_polynomials() -> None:
    known = {
        "3_1": "t^2 - t + 1",
        "4_1": "t^2 - 3 t + 1",
        "10_153": "t^6 - t^5 - t^4 + 3 t^3 - t^2 - t + 1",
        "Hopf": "t - 1",
        "8_19#m3_1": None,
    }
    for name, expected in known.items():
        found = identify(start(name))
        assert expected is None or found.alexander == expected
        assert found.alexander
        formula = re.sub(r"(\d) t", r"\1 * t", found.alexander).replace("^", "**")
        assert abs(eval(formula, {"t": -1})) == found.determinant
    assert alexander_polynomial({(1, -1): 1, (-1, -1): -1}) == "0"


def test_letters_of_diagrams() -> None:
    for row in TYPES[::97]:
        letters = row["diagram"].rstrip(SAME_AS_MIRROR)
        assert packed(unpacked(letters)) == letters
    with pytest.raises(ValueError, match="14 crossings are too many; 13 are the most"):
        packed(gauss_code(crossings(start("T(2,14)"))))


@pytest.mark.slow  # it reads KnotInfo
def test_types_of_the_table() -> None:
    assert [sum(row["name"].startswith(kind) for row in TYPES) for kind in ("11a_", "13n_")] == [367, 5110]
    mutants = {type.name for type in sharing(homfly_polynomial(gauss_code(diagram(start("11n_34")))) or {})}
    assert {"11n_34", "11n_42"} <= mutants
    assert [identify(start(name)).names for name in ("11n_34", "m11n_42")] == [("11n_34",), ("m11n_42",)]


WRONG: list[Gauss] = [
    ([[1, -1], [2]], [True, True]),
    ([[1, 2, -1, -2]], [True, True]),  # a virtual trefoil, which no sphere has
    ([[1, 1]], [True]),
    ([[1, -3]], [True, True]),
    ([[0, -1]], [True]),
]


@pytest.mark.parametrize(("gauss", "call"), list(product(WRONG, [shortened, homfly_polynomial])))
def test_codes_of_no_diagram(gauss: Gauss, call: type) -> None:
    with pytest.raises(ValueError, match="the Gauss code is that of no diagram"):
        call(gauss)


def test_moves_make_no_other_knot() -> None:
    trefoil, mutant = unpacked("fjb"), unpacked(row_of("11n_34"))
    assert _core.meeting(trefoil, [mirrored(trefoil), trefoil], 1000) == 1
    others = [mirrored(mutant), unpacked(row_of("11n_42")), mirrored(unpacked(row_of("11n_42")))]
    assert _core.meeting(mutant, others, 3000) is None


def row_of(name: str) -> str:
    return next(row["diagram"] for row in TYPES if row["name"] == name).rstrip(SAME_AS_MIRROR)


def test_records_are_plain() -> None:
    found = sono.identify("Whitehead")
    assert json.loads(json.dumps(found.to_dict()))["names"] == ["L5a1{0}"]
    assert found == sono.identify(sono.start("5^2_1"))
    assert found.linking == (0,)


@pytest.mark.slow
def test_all_knots_and_links_of_the_tables_or_their_mirror_images() -> None:
    names = [row["knot"] for row in table("knots")] + [row["link"] for row in table("links")]
    for number, name in enumerate(names):
        curve, plain = start(name), name.split("{")[0]
        if number % 2:
            found = identify(curve)
            assert found.name == name if "{" not in name else found.name and found.name.split("{")[0] == plain
        else:
            found = identify(mirror(curve))
            assert found.name
            assert found.name.split("{")[0] in (plain, f"m{plain}")
        assert found.proven
        assert found.signature == (1 if number % 2 else -1) * signature(diagram(curve), -1)
