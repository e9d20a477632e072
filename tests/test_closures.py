"""Torus knots, closed braids, chains and arc presentations: their types and shapes."""

import numpy as np
import pytest

from sono.invariants import fingerprint
from sono.starts import start
from sono.starts.arcs import Strokes, grid, shuffled
from sono.starts.braids import braid
from sono.starts.torus import chain, torus

UNKNOT = fingerprint(chain(1))
TREFOIL: Strokes = [(0, 2), (1, 3), (2, 4), (0, 3), (1, 4)]
FIGURE_EIGHT: Strokes = [(0, 2), (1, 3), (2, 5), (0, 4), (3, 5), (1, 4)]
HOPF: Strokes = [(0, 2), (1, 3), (0, 2), (1, 3)]


def test_too_few_vertices() -> None:
    with pytest.raises(ValueError, match="at least 3 vertices"):
        torus(2, 3, n=2)


@pytest.mark.parametrize(("p", "q", "components"), [(2, 3, 1), (2, 4, 2), (6, 9, 3), (4, 4, 4), (1, 1, 1)])
def test_torus_components(p: int, q: int, components: int) -> None:
    curve = torus(p, q)
    assert len(curve) == components
    assert [len(component) for component in torus(p, q, n=50)] == [50] * components


@pytest.mark.parametrize(("p", "q"), [(2, 5), (3, 4), (5, 2), (4, 7)])
def test_torus_symmetry(p: int, q: int) -> None:
    turn = 2 * np.pi / q
    rotation = np.array([[np.cos(turn), np.sin(turn), 0], [-np.sin(turn), np.cos(turn), 0], [0, 0, 1]])
    points = np.vstack(torus(p, q))
    distance = np.linalg.norm((points @ rotation)[:, None] - points, axis=2)
    assert distance.min(axis=1).max() < 1e-13


@pytest.mark.parametrize(
    ("word", "components"),
    [([], 1), ([1], 1), ([2], 2), ([1, 3], 2), ([1, 1], 2), ([1, 2, 3], 1), ([1, -2] * 3, 3)],
)
def test_braid_components(word: list[int], components: int) -> None:
    assert len(braid(word)) == components


def test_braid_relations() -> None:
    assert fingerprint(braid([1, 2, 1, 1, 2])) == fingerprint(braid([2, 1, 2, 1, 2]))
    assert fingerprint(braid([1, 1, 1, 3, -3, 2, 3])) == fingerprint(start("3_1"))
    assert fingerprint(braid([1, 1, -1])) == UNKNOT


def test_far_crossings_share_a_sector() -> None:
    assert sum(map(len, braid([1, 3] * 4))) < sum(map(len, braid([1, 2] * 3 + [1, 3])))


def test_chain_rings_are_round() -> None:
    for ring in chain(4):
        np.testing.assert_allclose(np.linalg.norm(ring - ring.mean(axis=0), axis=1), 3, rtol=1e-12)


def test_grids_have_their_types() -> None:
    assert fingerprint(grid(TREFOIL)) == fingerprint(start("3_1"))
    assert sorted(map(len, grid(HOPF))) == [len(component) for component in grid(HOPF)]
    assert fingerprint(grid(HOPF)) in (fingerprint(start("Hopf")), fingerprint(start("T(2,-2)")))


def test_a_grid_holds_a_rope() -> None:
    points = np.vstack(grid(TREFOIL))
    corners = points[(points % 2 == 0).all(axis=1)]
    distance = np.linalg.norm(corners[:, None] - corners, axis=2)
    assert distance[distance > 0].min() == 2


@pytest.mark.parametrize("seed", range(20))
def test_moves_keep_the_type(seed: int) -> None:
    assert fingerprint(grid(shuffled(TREFOIL, seed))) == fingerprint(start("3_1"))


@pytest.mark.parametrize("seed", range(10))
@pytest.mark.parametrize("more", [1, 3])
def test_steps_keep_the_type(seed: int, more: int) -> None:
    stepped = shuffled(FIGURE_EIGHT, seed, more)
    assert len(stepped) == len(FIGURE_EIGHT) + more
    assert fingerprint(grid(stepped)) == fingerprint(start("4_1"))
    assert fingerprint(grid(shuffled(TREFOIL, seed, more))) == fingerprint(start("3_1"))


def test_moves_follow_the_seed() -> None:
    assert shuffled(FIGURE_EIGHT, 1) == shuffled(FIGURE_EIGHT, 1)
    assert len({tuple(shuffled(FIGURE_EIGHT, seed)) for seed in range(20)}) > 10


@pytest.mark.parametrize("strokes", [[(0, 0), (1, 1)], [(0, 1), (0, 1), (0, 2)], [(0, 2), (0, 1)]])
def test_no_arc_presentation(strokes: Strokes) -> None:
    with pytest.raises(ValueError, match="two ends of strokes"):
        grid(strokes)
