"""The invariants against values from the literature, and against what must not change them."""

import cmath
import json
import math

import numpy as np
import pytest

from sono.curve import Floats
from sono.invariants import fingerprint, homfly
from sono.invariants.crossings import crossings, diagram, linking_matrix, simplify
from sono.invariants.identify import ORDERS
from sono.invariants.polynomials import alexander, alexander_modulo
from sono.invariants.signatures import signature
from sono.starts import start, table
from sono.starts.braids import braid
from sono.starts.drawing import mirror
from sono.starts.scramble import scramble
from sono.starts.torus import chain, torus

ROOTS = [cmath.exp(2j * math.pi / k) for k in (2, 3, 5)]

# Coefficients of Delta, highest power first (KnotInfo, "Alexander Polynomial"), and the classical signature.
KNOTS = {
    "unknot": ([1], 0),
    "3_1": ([1, -1, 1], -2),
    "4_1": ([1, -3, 1], 0),
    "5_1": ([1, -1, 1, -1, 1], -4),
    "7_1": ([1, -1, 1, -1, 1, -1, 1], -6),
    "8_19": ([1, -1, 0, 1, 0, -1, 1], -6),
    "9_1": ([1, -1, 1, -1, 1, -1, 1, -1, 1], -8),
    "T(2,59)": ([(-1) ** k for k in range(59)], -58),
    "1 -2 1 -2 1 -2 1 -2": ([1, -5, 10, -13, 10, -5, 1], 0),  # 8_18
}
DETERMINANTS = {"3_1": 3, "4_1": 5, "5_1": 5, "7_1": 7, "8_19": 3, "9_1": 9, "T(2,59)": 59}
SOME = ["3_1", "4_1", "8_19", "T(2,4)", "T(3,3)", "chain3", "1 -2 1 -2 1 -2"]


def rotation(seed: int) -> Floats:
    q: Floats = np.linalg.qr(np.random.default_rng(seed).normal(size=(3, 3)))[0]
    q[0] *= np.linalg.det(q)
    return q


@pytest.mark.parametrize("name", KNOTS)
def test_alexander_polynomial(name: str) -> None:
    found = diagram(start(name))
    for t in ROOTS:
        assert alexander(found, t) == pytest.approx(abs(np.polyval(KNOTS[name][0], t)), abs=1e-9)


@pytest.mark.parametrize("name", DETERMINANTS)
def test_determinant(name: str) -> None:
    assert alexander(diagram(start(name)), -1) == pytest.approx(DETERMINANTS[name], rel=1e-9)


@pytest.mark.parametrize("name", KNOTS)
def test_signature(name: str) -> None:
    curve = start(name)
    assert signature(diagram(curve), -1) == KNOTS[name][1]
    assert signature(diagram(mirror(curve)), -1) == -KNOTS[name][1]


@pytest.mark.parametrize(("q", "expected"), [(3, (-2, -2, -2)), (5, (-4, -4, -2)), (9, (-8, -6, -4))])
def test_levine_tristram(q: int, expected: tuple[int, ...]) -> None:
    # For T(2,q) it is minus twice the number of zeros exp(i pi (2k-1)/q) of Delta on the arc from 1 to t.
    found = diagram(torus(2, q))
    assert tuple(signature(found, t) for t in ROOTS) == expected


def test_links() -> None:
    hopf = diagram(start("Hopf"))
    assert linking_matrix(hopf).tolist() == [[0, 1], [1, 0]]
    assert linking_matrix(diagram(mirror(start("Hopf"))))[0, 1] == -1
    assert [alexander(hopf, t) for t in ROOTS] == pytest.approx([abs(t - 1) for t in ROOTS])
    assert signature(hopf, -1) == -1
    assert linking_matrix(diagram(chain(3))).tolist() == [[0, 1, 0], [1, 0, 1], [0, 1, 0]]
    assert alexander(diagram(chain(3)), -1) == pytest.approx(4)
    assert linking_matrix(diagram(torus(2, 6)))[0, 1] == 3


def test_borromean_rings_are_linked_without_linking_numbers() -> None:
    rings = diagram(braid([1, -2, 1, -2, 1, -2]))
    assert not linking_matrix(rings).any()
    assert alexander(rings, -1) == pytest.approx(16)


def test_split_link() -> None:
    assert fingerprint([*start("3_1"), start("3_1")[0] + 20.0]) == ((0,), (-4, -4, -4), (0.0, 0.0, 0.0))
    assert fingerprint(braid([2])) == ((0,), (0, 0, 0), (0.0, 0.0, 0.0))


@pytest.mark.parametrize("name", SOME)
def test_unchanged_by_motion_and_start_vertex(name: str) -> None:
    curve = start(name)
    expected = fingerprint(curve)
    for seed in range(3):
        turn = rotation(seed)
        moved = [np.roll(3.7 * component @ turn + (5, -60, 2), 7 * seed, axis=0) for component in curve]
        assert fingerprint(moved) == expected


@pytest.mark.parametrize("name", SOME)
def test_unchanged_by_the_view(name: str) -> None:
    reduced = simplify(start(name))
    expected = fingerprint(start(name))
    for direction in np.random.default_rng(1).normal(size=(5, 3)):
        found = crossings(reduced, direction)
        assert linking_matrix(found)[np.triu_indices(len(reduced), 1)].tolist() == list(expected[0])
        assert tuple(signature(found, t) for t in ROOTS) == expected[1]
        assert tuple(alexander_modulo(found, k) for k in ORDERS) == expected[2]


@pytest.mark.parametrize("name", SOME)
def test_mirror(name: str) -> None:
    linking, signatures, delta = fingerprint(start(name))
    expected = tuple(-x for x in linking), tuple(-x for x in signatures), delta
    assert fingerprint(mirror(start(name))) == expected


@pytest.mark.parametrize("name", SOME)
def test_unchanged_by_scrambling(name: str) -> None:
    assert fingerprint(scramble(start(name), seed=1, swirls=10)) == fingerprint(start(name))


def test_simplify_keeps_the_type_of_random_polygons() -> None:
    knotted = 0
    for seed in range(30):
        corners = np.random.default_rng(seed).normal(size=(24, 3))
        halves = np.stack([corners, (corners + np.roll(corners, -1, axis=0)) / 2], axis=1).reshape(-1, 3)
        raw, reduced = crossings([corners]), diagram([halves])
        knotted += alexander(reduced, -1) > 1.5
        for t in ROOTS:
            assert alexander(reduced, t) == pytest.approx(alexander(raw, t), rel=1e-6, abs=1e-6)
            assert signature(reduced, t) == signature(raw, t)
    assert knotted > 10


def test_simplify_leaves_little() -> None:
    assert [len(component) for component in simplify(start("unknot"))] == [3]
    assert len(simplify(start("3_1"))[0]) < 10
    assert len(simplify(torus(2, 59))[0]) < 2.5 * 59


def test_the_wrong_type_is_noticed() -> None:
    prints = [
        fingerprint(start(name)) for name in ("unknot", "3_1", "T(2,-3)", "4_1", "5_1", "7_1", "8_19", "9_1")
    ]
    assert len(set(prints)) == len(prints)


def test_homfly_polynomials_are_those_of_knotinfo() -> None:
    """Those of the planar diagrams in KnotInfo; the starts are drawn from other notations."""
    regina = pytest.importorskip("regina")
    knotinfo = {row["name"]: row for row in pytest.importorskip("database_knotinfo").link_list()}
    names = [row["knot"] for row in table("knots")]
    for number, name in enumerate([*names[:20], *names[20::7], "12n_242"]):
        known = regina.Link.fromPD(json.loads(knotinfo[name]["pd_notation"]))
        assert homfly(start(name, number % 2)) == str(known.homflyAZ()), name


def test_homfly_polynomials_of_links_and_mirror_images() -> None:
    pytest.importorskip("regina")
    assert homfly(start("m3_1")) != homfly(start("3_1"))
    assert homfly(start("Hopf")) == homfly(braid([1, 1])) != homfly(mirror(start("Hopf")))
    assert homfly(chain(1)) == "1"
    assert homfly([*chain(1), *start("m3_1")]) != homfly(start("m3_1"))
    # The skein relation: the unlink of two has (alpha - 1/alpha)/z.
    assert homfly([chain(1)[0], chain(1)[0] + 100]) == "x y^-1 - x^-1 y^-1"
