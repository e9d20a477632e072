"""Bundles: torus knots and links whose strands fill the torus."""

import math

import numpy as np
import pytest

from sono._core import Collapse
from sono.curve import Components, Floats, measure
from sono.invariants import fingerprint
from sono.invariants.crossings import diagram, linking_matrix
from sono.starts import start
from sono.starts.bundles import MOST_STRANDS, _closed, _places, bundle
from sono.starts.torus import torus

SMALL = [
    (1, 1),
    (1, 4),
    (2, 2),
    (2, 3),
    (2, 8),
    (3, 3),
    (3, 7),
    (4, 5),
    (4, 6),
    (5, 5),
    (5, 8),
    (6, 4),
    (7, 5),
]


@pytest.mark.parametrize("variant", range(1, 9))
@pytest.mark.parametrize(("p", "q"), [*SMALL, (2, -5), (-3, 4), (-3, -5), (3, -6)])
def test_bundles_have_their_types(p: int, q: int, variant: int) -> None:
    assert fingerprint(bundle(p, q, variant)) == fingerprint(torus(p, q))


@pytest.mark.slow
@pytest.mark.parametrize("variant", range(1, 9))
@pytest.mark.parametrize(("p", "q"), [(7, 9), (9, 12), (8, 12)])
def test_thick_bundles_have_their_types(p: int, q: int, variant: int) -> None:
    assert fingerprint(bundle(p, q, variant)) == fingerprint(torus(p, q))


@pytest.mark.slow
@pytest.mark.parametrize("variant", [1, 2, 3, 6, 7])
@pytest.mark.parametrize(("p", "q"), [(25, 32), (12, 24), (24, 32), (18, 24), (20, 30), (14, 21)])
def test_components_of_large_bundles_link(p: int, q: int, variant: int) -> None:
    curve = bundle(p, q, variant)
    components = math.gcd(p, q)
    assert len(curve) == components
    assert len({len(component) for component in curve}) == 1
    if components > 1:
        linking = linking_matrix(diagram(curve))
        expected = p * q // components**2
        assert set(linking[~np.eye(components, dtype=bool)].round().astype(int)) == {expected}


@pytest.mark.parametrize(("p", "q", "variant"), [(12, 16, 3), (12, 18, 5), (10, 20, 1), (7, 7, 1)])
def test_symmetric_packings_turn_as_a_whole(p: int, q: int, variant: int) -> None:
    for component in bundle(p, q, variant):
        turned = component @ _turn(2 * np.pi * math.gcd(p, q) / q)
        assert np.linalg.norm(turned[:, None] - component, axis=2).min(axis=1).max() < 1.5


@pytest.mark.parametrize("n", [2, 3, 4, 7, 19, 25, 40])
@pytest.mark.parametrize("seed", range(3))
def test_the_curve_through_places_does_not_meet_itself(n: int, seed: int) -> None:
    random = np.random.default_rng(seed)
    corners = _closed(_places(n, (0.1, 0.2), 1), random)
    flat = np.column_stack([corners, np.zeros(len(corners))])
    x, y = corners.T
    assert (x * np.roll(y, -1) - y * np.roll(x, -1)).sum() > 0
    edges = list(zip(flat, np.roll(flat, -1, axis=0), strict=True))
    for i, (a, b) in enumerate(edges):
        for j, (c, d) in enumerate(edges):
            if (i - j) % len(edges) not in (0, 1, len(edges) - 1):
                assert _side(a, b, c) * _side(a, b, d) > 0 or _side(c, d, a) * _side(c, d, b) > 0


def test_variants_of_torus_types() -> None:
    for variant in (1, 2, 7):
        np.testing.assert_array_equal(start("T(4,6)", variant)[0], bundle(4, 6, variant)[0])
        assert len(start("mT(4,6)", variant)) == 2


@pytest.mark.slow
def test_types_of_variants() -> None:
    assert fingerprint(start("T(3,4)", -1)) == fingerprint(torus(3, 4)) != fingerprint(start("T(3,-4)", 1))
    assert fingerprint(start("T(2,5)#T(3,4)", 1)) == fingerprint(start("T(2,5)#T(3,4)"))


def test_bundles_of_too_many_strands() -> None:
    assert len(start(f"T({MOST_STRANDS},{MOST_STRANDS})", 1)) == MOST_STRANDS
    with pytest.raises(ValueError, match="301 strands; 300 are the most"):
        start("T(301,302)", 1)
    with pytest.raises(ValueError, match="must not be zero"):
        start("T(0,2)", 1)
    with pytest.raises(ValueError, match="would take over"):
        start("T(2,99999)", 1)


@pytest.mark.parametrize(("p", "q"), [(5, 5), (6, 6)])
def test_bundles_tighten_to_less_than_hollow_ones(p: int, q: int) -> None:
    tight = [_collapsed(start(f"T({p},{q})", variant)) for variant in (0, 1)]
    assert tight[1] < 0.98 * tight[0]


def _collapsed(curve: Components) -> float:
    """Return the ropelength of the jammed rope."""
    engine = Collapse(curve, False, "{}")
    while engine.advance(1)["outcome"] == "running":
        pass
    return measure(engine.best()).l_p


def _side(a: Floats, b: Floats, c: Floats) -> float:
    return float((b - a)[0] * (c - a)[1] - (b - a)[1] * (c - a)[0])


def _turn(angle: float) -> Floats:
    return np.array([[np.cos(angle), -np.sin(angle), 0], [np.sin(angle), np.cos(angle), 0], [0, 0, 1]])
