"""The starting conformations: their knot types, their shapes, and the files in knots/ made from them."""

import math
from pathlib import Path

import numpy as np
import pytest

from sono.curve import Components, Floats
from sono.invariants import fingerprint
from sono.invariants.crossings import diagram
from sono.invariants.polynomials import alexander
from sono.starts import names, start, table
from sono.starts.braids import braid
from sono.starts.drawing import mirror
from sono.starts.spelling import summands
from sono.starts.torus import chain, torus

KNOTS = Path(__file__).parent.parent / "knots"
FILES = {
    "3_1": "3_1",
    "4_1": "4_1",
    "5_1": "5_1",
    "7_1": "7_1",
    "8_19": "8_19",
    "9_1": "9_1",
    "T(2,59)": "t_2_59",
    "Hopf": "hopf",
    "chain3": "chain3",
}
UNKNOT = fingerprint(chain(1))
TEN = "1 1 2 -1 -3 2 -3 4 -3 4"


def turning_angles(component: Floats) -> Floats:
    edges = np.roll(component, -1, axis=0) - component
    edges /= np.linalg.norm(edges, axis=1, keepdims=True)
    degrees: Floats = np.degrees(np.arccos(np.clip((edges * np.roll(edges, 1, axis=0)).sum(axis=1), -1, 1)))
    return degrees


def ropelength(curve: Components) -> float:
    """Length over rope radius, by brute force: the least of MinRad and half the distance of far vertices."""
    lengths = [np.linalg.norm(np.roll(component, -1, axis=0) - component, axis=1) for component in curve]
    radius = min(
        float((np.minimum(s, np.roll(s, 1)) / 2 / np.tan(np.radians(turning_angles(component) / 2))).min())
        for s, component in zip(lengths, curve, strict=True)
    )
    for i, one in enumerate(curve):
        for two in curve[i:]:
            distance = np.linalg.norm(one[:, None] - two, axis=2)
            if one is two:
                place = np.cumsum(lengths[i]) - lengths[i]
                arc = abs(place[:, None] - place)
                distance[np.minimum(arc, lengths[i].sum() - arc) < math.pi] = np.inf
            radius = min(radius, float(distance.min()) / 2)
    return float(sum(s.sum() for s in lengths)) / radius


def test_names_have_their_types() -> None:
    assert fingerprint(start("0_1")) == fingerprint(start("unknot")) == UNKNOT
    assert fingerprint(start("3_1")) == fingerprint(braid([1, 1, 1])) == fingerprint(torus(3, 2))
    assert fingerprint(start("4_1")) == fingerprint(braid([-1, 2, -1, 2]))
    assert fingerprint(start("5_1")) == fingerprint(braid([1] * 5))
    assert fingerprint(start("7_1")) == fingerprint(braid([1] * 7))
    assert fingerprint(start("8_19")) == fingerprint(braid([1, 1, 1, 2, 1, 1, 1, 2]))
    assert fingerprint(start("9_1")) == fingerprint(braid([1] * 9))
    assert fingerprint(start("Hopf")) == fingerprint(start("2^2_1")) == fingerprint(braid([1, 1]))
    assert fingerprint(start("chain3")) == fingerprint([braid([1, 1, 2, 2])[k] for k in (0, 1, 2)])


def test_the_notations_agree_on_every_knot() -> None:
    for number, name in enumerate(row["knot"] for row in table("knots")):
        assert fingerprint(start(name)) == fingerprint(start(name, 1 + number % 5)), name
        if number % 5 == 0:
            assert fingerprint(start(name)) == fingerprint(start(name, -number % 8 - 1)), name


def test_mirror_images() -> None:
    for variant in (0, 3):
        np.testing.assert_array_equal(start("m8_20", variant)[0], mirror(start("8_20", variant))[0])
    np.testing.assert_array_equal(start("M3_1")[0], mirror(start("3_1"))[0])


@pytest.mark.slow
def test_variants_differ_but_not_in_type() -> None:
    # Braids and chains are scrambled, which takes seconds.
    for name, many in (("8_18", 4), ("T(2,4)", 4), ("1 1 1 2 2 2", 3), ("chain3", 2)):
        starts = [start(name, variant) for variant in range(many)]
        assert len({curve[0].tobytes() for curve in starts}) == many
        assert len({fingerprint(curve) for curve in starts}) == 1
    tabled = [start("8_20", variant) for variant in (0, 5, 21, 37, 53, -1, -2, -3, -1000001)]
    assert len({curve[0].tobytes() for curve in tabled}) == len(tabled)
    assert len({fingerprint(curve) for curve in tabled}) == 1
    with pytest.raises(ValueError, match="has no planar diagram"):
        start("chain3", -1)


def test_confused_names_are_those_of_knotinfo() -> None:
    """Determinants from KnotInfo: 10_83 and 10_86 are often swapped, the last four often one further."""
    known = {"10_83": 83, "10_86": 85, "10_161": 5, "10_162": 35, "10_163": 51, "10_164": 45, "10_165": 39}
    assert {name: round(alexander(diagram(start(name)), -1)) for name in known} == known


def test_spelling_does_not_matter() -> None:
    for spelling in ("T(2,5)", " t( 2 , 5 ) "):
        np.testing.assert_array_equal(start(spelling)[0], torus(2, 5)[0])
    for spelling in ("1 -2 1 -2", "1, -2, 1, -2"):
        np.testing.assert_array_equal(start(spelling)[0], start("4_1")[0])
    np.testing.assert_array_equal(start("hopf")[1], start("L2A1")[1])


def test_negative_torus_types_are_mirror_images() -> None:
    assert fingerprint(start("T(2,-3)")) == fingerprint(mirror(start("3_1"))) != fingerprint(start("3_1"))
    assert fingerprint(start("T(-2,-3)")) == fingerprint(start("3_1"))


@pytest.mark.parametrize(
    ("name", "message"),
    [
        ("hopff", "did you mean 'Hopf'"),
        ("31", "did you mean '3_1'"),
        ("10_166", "10_166 is 10_165"),
        ("14a_1", "tables end"),
        ("11a_9999", "one of 11a_1 to 11a_367"),
        ("m3_2", "unknown knot 'm3_2'"),
        ("quipu", "known are 3_1 to 10_165"),
        ("T(0,3)", "must not be zero"),
        ("T(2,0)", "must not be zero"),
        ("chain0", "at least one ring"),
        ("1 0 1", "must not be 0"),
    ],
)
def test_bad_names(name: str, message: str) -> None:
    with pytest.raises(ValueError, match=message):
        start(name)


@pytest.mark.parametrize(
    "name",
    [*names()[::10], *("Hopf", "chain3", "T(2,59)", "T(3,2)", "T(3,3)", "T(4,5)", "1 1", "2 -2", "1 1 1 -3")],
)
def test_starts_are_smooth_and_deterministic(name: str) -> None:
    curve = start(name)
    for component, again in zip(curve, start(name), strict=True):
        assert component.dtype == np.float64
        np.testing.assert_array_equal(component, again)
        assert turning_angles(component).max() < 20


# One crossing more than the diagram has, for the closure of the rope.
@pytest.mark.parametrize(
    ("name", "crossings"),
    [
        *[("3_1", 3), ("4_1", 4), ("5_1", 5), ("7_1", 7), ("8_19", 8), ("9_1", 9), ("T(2,59)", 59)],
        *[("Hopf", 2), ("chain3", 4), ("1 1 1", 3), ("1 -2 1 -2 1 -2", 6), ("T(3,5)", 10), (TEN, 10)],
    ],
)
def test_starts_are_short_for_their_thickness(name: str, crossings: int) -> None:
    assert ropelength(start(name)) < 30 * (crossings + 1)


@pytest.mark.parametrize("name", FILES)
def test_files_are_the_starts_to_six_decimals(name: str) -> None:
    text = (KNOTS / f"{FILES[name]}.txt").read_text(encoding="utf-8")
    header, body = text.split("\n", 1)
    assert header.startswith(f"# {name}: ")
    assert header.removesuffix(name).removesuffix(f'"{name}"').endswith("made by: sono start ")
    for block, component in zip(body.split("\n\n"), start(name), strict=True):
        rows = [row.split() for row in block.splitlines()]
        np.testing.assert_allclose(np.array(rows, np.float64), component, rtol=0, atol=5.01e-7)


@pytest.mark.parametrize(
    ("name", "knot"),
    [
        ("Conway knot", "11n_34"),
        ("mConway", "m11n_34"),
        ("Kinoshita–Terasaka", "11n_42"),
        ("Kinoshita-Terasaka knot", "11n_42"),
        ("KT", "11n_42"),
    ],
)
def test_famous_mutants(name: str, knot: str) -> None:
    assert [str(part) for part in summands(name)] == [knot]
