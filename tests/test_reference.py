"""The reference table: its names, kinds and sources, radius and diameter, chains of any length."""

import math
from itertools import pairwise

import pytest
from hypothesis import given
from hypothesis import strategies as st

from sono import starts
from sono.tables import published, reference

ROWS = starts.table("published")


def test_every_name_is_known_and_is_the_one_that_is_looked_up() -> None:
    for row in ROWS:
        assert starts.knows(row["knot"]), row
        assert starts.canonical(row["knot"]) == row["knot"], row


def test_every_row_cites_a_source_and_has_a_kind() -> None:
    sources = reference.sources()
    assert {row["source"] for row in ROWS} | {reference.CHAINS} == set(sources)
    assert {row["kind"] for row in ROWS} | {"exact"} == set(reference.RANKS)
    for source in sources.values():
        assert source.per in reference.FACTORS
        assert len(source.citation) > 30
        assert source.place
        assert source.checked


def test_what_was_printed_over_the_diameter_is_doubled_and_nothing_else() -> None:
    seen = set()
    for name in {row["knot"] for row in ROWS}:
        for value in reference.values(name):
            assert value["published"] == {"radius": 1, "diameter": 2}[str(value["per"])] * float(
                value["printed"] or 0
            )
            seen.add(value["per"])
    assert seen == {"radius", "diameter"}


def test_values_of_one_knot_are_near_each_other() -> None:
    # Radius and diameter, or two knots, are not mixed up.
    for name in {row["knot"] for row in ROWS}:
        lengths = sorted(float(value["published"] or 0) for value in reference.values(name))
        assert lengths[-1] < 1.005 * lengths[0], name
        # The least of any nontrivial knot is above 31.32 (Denne, Diao, Sullivan, 2006), of a link 8 pi.
        assert lengths[0] > 25.13


def test_torus_links_grow() -> None:
    lengths = [float(published.table()[f"T({q},{q})"]["published"] or 0) for q in range(4, 21)]
    assert all(one < other for one, other in pairwise(lengths))
    for q, length in enumerate(lengths, 4):
        # C^(3/4), with the best and the worst coefficients in the table of A. Klotz.
        assert 10.8 < length / (q * (q - 1)) ** 0.75 < 12.2


@given(st.integers(2, 10**6))
def test_chains_are_circles_and_stadiums(rings: int) -> None:
    row = published.table()[f"chain{rings}"]
    assert row["published"] == pytest.approx(8 * math.pi + (rings - 2) * (4 * math.pi + 4))
    assert (row["kind"], row["source"]) == ("exact", "CKS 2002")


def test_the_unknot_is_a_circle_and_nothing_else_is() -> None:
    for name in ("unknot", "0_1", "chain1", "T(5,1)"):
        assert published.table()[name]["published"] == 2 * math.pi
    assert published.table().get("chain0") is None
    assert "chain" not in published.table()


def test_no_rope_is_compared_with_an_estimate() -> None:
    table = published.table()
    assert {"exact", "bound", "numerical", "critical"} >= {row["kind"] for row in table.values()}
    assert table["3_1"]["published"] == 32.7436
    assert len(table) == len({row["knot"] for row in ROWS})


@pytest.mark.slow
def test_the_bounds_of_knotinfo_are_those_of_its_database() -> None:
    knotinfo = pytest.importorskip("database_knotinfo")
    theirs = {row["name"]: row["ropelength"] for row in knotinfo.link_list()[1:] if row["ropelength"]}
    ours = {
        row["knot"]: row["printed"] for row in ROWS if row["source"] in ("ACPR 2011", "KnotInfo 2026.11.2")
    }
    assert len(ours) == 2977
    assert {knot: float(length) for knot, length in ours.items()} == {
        knot: float(length) for knot, length in theirs.items()
    }
