"""The toroidal model against its geometry: in coordinates, and in decimals of 60 digits."""

from decimal import Decimal, localcontext
from itertools import count

import numpy as np
import pytest

from sono import model

GRID = [
    float(dl)
    for dl in (*np.logspace(-12, -1, 45), *np.linspace(0.11, 1.99, 48), *(2 - np.logspace(-12, -3, 10)))
]
FUNCTIONS = [model.raw, model.inscribed, model.true, model.average, model.weight, model.weight_series]


def arcsin(x: Decimal) -> Decimal:
    total = term = x
    for k in count(1):
        term *= x * x * (2 * k - 1) ** 2 / (2 * k * (2 * k + 1))
        if total + term == total:
            return total
        total += term
    raise AssertionError


def exact(edge: float | Decimal) -> tuple[Decimal, Decimal, Decimal]:
    """dL_c, dL and a to about 30 digits from the geometry, without the closed forms of the paper."""
    with localcontext(prec=60):
        dl = Decimal(edge)
        r = 2 * (dl / 4) / arcsin(dl / 4)  # the mean of 2 cos over (0, phi) is 2 sin(phi)/phi
        sine = dl / 2 / r
        alpha = 2 * arcsin(sine)
        rad = dl * (1 - sine**2).sqrt() / (2 * sine)
        inscribed = alpha * rad / (1 - dl**2 / 4).sqrt()
        return inscribed, 2 * alpha, (inscribed - 2 * alpha) / (2 * alpha - dl)


def relative_error(value: float, reference: Decimal) -> float:
    return float(abs(Decimal(float(value)) / reference - 1))


@pytest.mark.parametrize("dl", GRID)
def test_every_length_keeps_its_digits(dl: float) -> None:
    inscribed, true, weight = exact(dl)
    assert relative_error(model.inscribed(dl), inscribed) < 1e-15
    assert relative_error(model.true(dl), true) < 1e-15
    assert relative_error(model.weight(dl), weight) < 2e-15


@pytest.mark.parametrize("dl", [0.1, 0.5, 1.0, 1.9])
def test_geometry_in_coordinates(dl: float) -> None:
    """Beads that touch an axis of beads at the mean distance, measured as the definitions say."""
    hill = np.linspace(0, np.arcsin(dl / 4), 20001)
    r = np.trapezoid(2 * np.cos(hill), hill) / hill[-1]
    step = 2 * np.arcsin(dl / 2 / r)
    beads = r * np.column_stack([np.cos(step * np.arange(3)), np.sin(step * np.arange(3))])
    edges = np.diff(beads, axis=0)
    assert np.linalg.norm(edges, axis=1) == pytest.approx(dl, rel=1e-8)
    turning = np.arccos(edges[0] @ edges[1] / dl**2)
    rad = dl / (2 * np.tan(turning / 2))
    assert rad == pytest.approx(np.linalg.norm(beads[:2].mean(axis=0)), rel=1e-8)
    assert model.inscribed(dl) == pytest.approx(rad * turning / np.sqrt(1 - dl**2 / 4), rel=1e-8)
    assert model.true(dl) == pytest.approx(2 * turning, rel=1e-8)


def test_expansion_of_the_weight() -> None:
    small = Decimal("1e-9")
    first = (exact(small)[2] - 4) / small**2
    assert abs(first - Decimal(353) / 480) < Decimal("1e-17")


@pytest.mark.parametrize("dl", [1e-3, 1e-2, 0.1, 0.3])
def test_series_is_short_of_the_weight_by_the_fourth_order(dl: float) -> None:
    # 0.159 is read off exact(); the paper stops before it.
    assert model.weight(dl) - model.weight_series(dl) == pytest.approx(0.159 * dl**4, rel=0.05, abs=4e-15)


def test_weight_where_the_paper_plots_it() -> None:
    assert model.weight(1.0) == pytest.approx(4.93983101764830, rel=1e-14)
    assert model.weight(1.5) == pytest.approx(7.29573590628463, rel=1e-14)


def test_weight_rises_from_4() -> None:
    assert model.weight(1e-200) == pytest.approx(4, rel=1e-15)
    assert (np.diff(model.weight(np.linspace(0.01, 1.99, 199))) > 0).all()


@pytest.mark.parametrize("dl", [1e-3, 0.1, 1.0, 1.9, 1.999])
def test_the_truth_lies_between(dl: float) -> None:
    assert model.raw(dl) == dl
    assert model.raw(dl) < model.true(dl) < model.inscribed(dl)
    a = model.weight(dl)
    assert (a * model.raw(dl) + model.inscribed(dl)) / (a + 1) == pytest.approx(model.true(dl), rel=1e-14)


def test_average_is_right_to_the_fifth_order() -> None:
    dl = np.array([0.1, 0.2, 0.4])
    error = model.average(dl) - model.true(dl)
    assert error / dl**5 == pytest.approx(353 / 480 / 5 / 48, rel=0.1)


def test_arrays_keep_their_shape_and_numbers_stay_numbers() -> None:
    dl = np.array([[0.1, 0.2], [1.0, 1.9]])
    for function in FUNCTIONS:
        values = function(dl)
        assert values.shape == dl.shape
        assert values[1, 0] == function(1.0)
        assert isinstance(function(1.0), float)


@pytest.mark.parametrize("dl", [0.0, -0.1, 2.0, 3.0, np.nan, np.inf])
def test_edge_lengths_outside_are_refused(dl: float) -> None:
    for function in FUNCTIONS:
        with pytest.raises(ValueError, match="between 0 and 2"):
            function(dl)
        with pytest.raises(ValueError, match="between 0 and 2"):
            function(np.array([1.0, dl]))
