"""Any embedded polygon collapses to a rope of its own type, however thin, slack or entangled it is."""

from collections.abc import Callable
from contextlib import suppress
from typing import TypeAlias

import numpy as np
import pytest
from polygons import entangled, equilateral, gaussian, knotted_arc, lattice, meander

from sono import _core, starts, tighten
from sono._core import Collapse, CurveError
from sono.curve import Components, Floats
from sono.invariants import fingerprint
from sono.invariants.crossings import crossings, diagram
from sono.invariants.identify import ORDERS
from sono.invariants.polynomials import alexander_modulo
from sono.invariants.signatures import signature

Draw: TypeAlias = Callable[[int, int], Floats]
ROOTS = [np.exp(2j * np.pi / k) for k in ORDERS]


def collapsed(vertices: Floats) -> Collapse:
    collapse = Collapse([vertices], False, "{}")
    while collapse.advance(0.1)["outcome"] == "running":
        pass
    return collapse


@pytest.mark.parametrize("seed", range(40))
def test_the_type_is_that_of_the_polygon_as_it_was_given(seed: int) -> None:
    polygon = entangled(8 + seed // 2, seed)
    raw = crossings([polygon])
    for curve in (_core.simplify([polygon]), _core.loosen([polygon]), collapsed(polygon).best()):
        found = diagram(curve)
        assert [alexander_modulo(found, k) for k in ORDERS] == [alexander_modulo(raw, k) for k in ORDERS]
        assert [signature(found, t) for t in ROOTS] == [signature(raw, t) for t in ROOTS]


@pytest.mark.parametrize("draw", [gaussian, equilateral])
def test_random_walks_get_tight(draw: Draw) -> None:
    for n in (6, 17, 43, 80):
        polygon = draw(n, n)
        tight = tighten(polygon, 300, trials=2)
        assert tight.converged
        assert fingerprint(tight.curve) == fingerprint([polygon])


@pytest.mark.parametrize("exponent", range(1, 9))
@pytest.mark.parametrize("name", ["3_1", "m4_1", "8_19"])
def test_a_small_knot_in_a_long_loop_is_not_lost(name: str, exponent: int) -> None:
    tight = tighten(knotted_arc(name, 10.0**-exponent, exponent), 150, trials=2)
    assert tight.converged
    assert fingerprint(tight.curve) == fingerprint(starts.start(name))
    assert tight.measures.l_p < {"3_1": 33, "m4_1": 42.5, "8_19": 62}[name]


@pytest.mark.parametrize("draw", [meander, lattice])
def test_lattice_polygons_of_5000_steps_are_unknotted(draw: Draw) -> None:
    tight = tighten(draw(5000, 1), 60, trials=1)
    assert tight.measures.l_p == pytest.approx(2 * np.pi, rel=1e-3)


def test_sticks_of_a_knot_with_hundreds_of_crossings() -> None:
    polygon = entangled(50, 7)
    assert len(diagram([polygon]).sign) > 100
    collapse = collapsed(polygon)
    assert collapse.loosened()
    assert fingerprint(collapse.best()) == fingerprint([polygon])


@pytest.mark.parametrize("draw", [gaussian, equilateral, entangled])
def test_the_first_rope_on_a_polygon_has_its_type(draw: Draw) -> None:
    """Before any sweep, and without any loosening: corners are rounded and small knots not stepped over."""
    made = 0
    for n in range(5, 25):
        polygon = [draw(n, n)]
        with suppress(CurveError):  # too thin for it
            rope = Collapse(polygon, True, "{}").best()
            assert fingerprint(rope) == fingerprint(polygon)
            made += 1
    assert made >= 10


@pytest.mark.parametrize("size", [0.3, 0.1, 0.03, 0.01, 1e-3, 1e-4, 1e-5])
@pytest.mark.parametrize("name", ["3_1", "m4_1", "8_19"])
def test_the_first_rope_on_a_loop_has_its_small_knot(name: str, size: float) -> None:
    loop = [knotted_arc(name, size, 1)]
    if size >= 0.01:
        assert fingerprint(Collapse(loop, True, "{}").best()) == fingerprint(starts.start(name))
    else:
        with pytest.raises(CurveError, match="comes so close to itself"):
            Collapse(loop, True, "{}")


def test_a_thick_curve_is_collapsed_as_it_is() -> None:
    assert not collapsed(starts.start("8_18")[0]).loosened()


def test_links_keep_their_components_apart() -> None:
    small, large = entangled(12, 1), 1e5 * entangled(12, 2)
    for link in ([small, large + 3e6], [small, large + small.mean(axis=0)], [large, small + 1, 2 - small]):
        collapse = Collapse(link, False, "{}")
        while collapse.advance(0.1)["outcome"] == "running":
            pass
        assert fingerprint(collapse.best()) == fingerprint(link)


def test_a_saved_collapse_goes_on_as_if_it_had_never_stopped() -> None:
    def through(curve: Components, saved: set[int]) -> Components:
        collapse, slices = Collapse(curve, False, "{}"), 0
        while collapse.advance(1e-3)["outcome"] == "running":
            slices += 1
            if slices in saved:
                collapse = Collapse.restore(collapse.state())
        return collapse.best()

    polygon = [entangled(16, 3)]
    one, other = through(polygon, {1, 3, 40, 45}), through(polygon, set())
    assert all((a == b).all() for a, b in zip(one, other, strict=True))
