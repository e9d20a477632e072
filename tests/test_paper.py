"""The paper's printed tables: what they say of themselves, and how well its toroidal model describes them."""

import csv
from decimal import Decimal
from itertools import pairwise
from pathlib import Path
from typing import NamedTuple

import pytest

from sono import model


class Printed(NamedTuple):
    knot: str
    n: int
    dl: Decimal
    l_p: Decimal
    l_c: Decimal
    l_a: Decimal


def printed_rows() -> list[Printed]:
    with (Path(__file__).parent / "paper" / "tables.csv").open() as stream:
        return [Printed(row[0], int(row[1]), *map(Decimal, row[2:])) for row in list(csv.reader(stream))[1:]]


ROWS = printed_rows()
each_row = pytest.mark.parametrize("row", ROWS, ids=lambda row: f"{row.knot}-{row.n}")


def rounding(value: Decimal) -> Decimal:
    """Half a unit of the last printed digit."""
    exponent = value.as_tuple().exponent
    assert isinstance(exponent, int)
    return Decimal(1).scaleb(exponent) / 2


def weighted(row: Printed) -> Decimal:
    return (4 * row.l_p + row.l_c) / 5


def test_there_are_four_knots_and_seventeen_rows() -> None:
    assert len(ROWS) == 17
    assert {row.knot for row in ROWS} == {"3_1", "5_1", "7_1", "9_1"}


def test_r_s_is_1_within_the_printed_digits() -> None:
    """L_p = n dl / R_s with R_s = 1, but for one dl that is right to four decimals only."""
    wrong = [
        row for row in ROWS if abs(row.n * row.dl - row.l_p) > row.n * rounding(row.dl) + rounding(row.l_p)
    ]
    assert [(row.knot, row.n) for row in wrong] == [("9_1", 188)]
    (row,) = wrong
    assert row.dl == Decimal("0.40140")
    assert round(row.l_p / row.n, 6) == Decimal("0.401406")


def test_l_a_is_the_weighted_average_within_the_printed_digits() -> None:
    """L_a = (4 L_p + L_c)/5, but for one L_a whose last digit is one too low."""
    wrong = [row for row in ROWS if abs(weighted(row) - row.l_a) > rounding(row.l_a) + rounding(row.l_p)]
    assert [(row.knot, row.n) for row in wrong] == [("7_1", 308)]
    (row,) = wrong
    assert row.l_a == Decimal("61.40")
    assert weighted(row) == Decimal("61.405084")


@each_row
def test_l_p_underestimates_and_l_c_overestimates(row: Printed) -> None:
    assert row.l_p < weighted(row) < row.l_c


def test_l_p_rises_and_l_c_falls_with_n() -> None:
    for coarse, fine in pairwise(ROWS):
        if coarse.knot == fine.knot:
            assert coarse.l_p < fine.l_p
            assert coarse.l_c > fine.l_c


def test_upper_bounds_in_the_text_are_the_finest_l_c() -> None:
    """They are rounded to the nearest, which makes the bound of 9_1 too low by 0.0003."""
    finest = {row.knot: row.l_c for row in ROWS}
    text = {"3_1": "32.744", "5_1": "47.203", "7_1": "61.417", "9_1": "75.728"}
    assert {knot: str(round(l_c, 3)) for knot, l_c in finest.items()} == text
    assert [knot for knot, l_c in finest.items() if Decimal(text[knot]) < l_c] == ["9_1"]


@each_row
def test_model_gives_the_gap_between_l_c_and_l_p(row: Printed) -> None:
    """To leading order it is dl^2 (1/8 - mean(kappa^2)/12), and knots bend a little more than the model."""
    dl = float(row.dl)
    gap = float((row.l_c - row.l_p) / row.l_p)
    assert gap / (model.inscribed(dl) / model.raw(dl) - 1) == pytest.approx(0.97, abs=0.01)


@each_row
def test_model_leads_from_l_p_to_l_a(row: Printed) -> None:
    dl = float(row.dl)
    assert float(row.l_p) * model.true(dl) / model.raw(dl) == pytest.approx(float(row.l_a), rel=1.5e-4)
