"""Knots lifted from planar diagrams: of the type of the diagram, whatever its outer face and weights."""

import numpy as np
import pytest

from sono import measure
from sono.invariants import fingerprint
from sono.invariants.crossings import crossings
from sono.starts import start
from sono.starts.diagrams import Diagram, from_codes
from sono.starts.planar import lifted

TREFOIL = from_codes([(1, 5, 2, 4), (3, 1, 4, 6), (5, 3, 6, 2)])
FIGURE_EIGHT = from_codes([(4, 2, 5, 1), (8, 6, 1, 5), (6, 3, 7, 4), (2, 7, 3, 8)])


@pytest.mark.parametrize("seed", range(12))
def test_the_type_is_that_of_the_diagram(seed: int) -> None:
    assert fingerprint(lifted(TREFOIL, seed)) == fingerprint(start("3_1"))
    assert fingerprint(lifted(FIGURE_EIGHT, seed)) == fingerprint(start("4_1"))


@pytest.mark.parametrize(("diagram", "writhe"), [(TREFOIL, 3), (FIGURE_EIGHT, 0)])
def test_seen_from_above_it_has_the_writhe_of_the_diagram(diagram: Diagram, writhe: int) -> None:
    found = crossings(lifted(diagram, 1), np.array([0.01, 0.02, 1.0]))
    assert found.sign.sum() == writhe


def test_strands_are_apart() -> None:
    (points,) = lifted(FIGURE_EIGHT, 1)
    edges = np.linalg.norm(np.roll(points, -1, axis=0) - points, axis=1)
    assert edges.max() <= 0.6
    place = np.cumsum(edges)
    arc = abs(place[:, None] - place)
    arc = np.minimum(arc, edges.sum() - arc)
    distance = np.linalg.norm(points[:, None] - points, axis=2)
    assert distance[arc > 4].min() > 0.5


def test_where_every_outer_face_leaves_others_flat_the_shortest_rope_is_taken() -> None:
    # With that of the most even lines it is 10,409 radii long, and jams when it collapses.
    assert measure(start("10_6", -12)).l_p < 3000


def test_seeds_differ() -> None:
    assert len({lifted(TREFOIL, seed)[0].tobytes() for seed in range(15)}) == 15


def test_long_rows_of_twists_are_made_even() -> None:
    # By Tutte's method alone the drawing of the most even lines is 5,300 and 270,000 radii long.
    assert measure(start("P(5,-7,9)")).l_p < 3000
    assert measure(start("P(9,-11,13)")).l_p < 10_000


def test_what_rounding_would_spoil_is_refused() -> None:
    with pytest.raises(ValueError, match="cannot be drawn with room for a rope"):
        start("P(-30,31,33)")
