"""The prime links to 9 crossings: their names, and that braid, arcs and diagram of a row are one link."""

import json
import re
import sys
from itertools import pairwise, product

import pytest

import sono
from sono.curve import Components
from sono.invariants import fingerprint, homfly
from sono.invariants.crossings import diagram, linking_matrix
from sono.starts import has_variants, knotinfo, start, table
from sono.starts.links import link_names, oriented_like
from sono.starts.spelling import spelled
from sono.starts.tabled import table_row

ROWS = table("links")
LINKS = list(dict.fromkeys(row["link"].split("{")[0] for row in ROWS))


def test_there_are_130_by_two_names_each() -> None:
    assert len(LINKS) == 130
    rolfsens = {row["rolfsen"]: row["link"].split("{")[0] for row in ROWS}
    assert len(rolfsens) == len(set(rolfsens.values())) == 130
    per_table = [
        (8, 3, 10), (8, 4, 3), (9, 2, 61), (9, 3, 21), (9, 4, 1), (8, 2, 16), (7, 2, 8), (7, 3, 1),
        (6, 2, 3), (6, 3, 3), (5, 2, 1), (4, 2, 1), (2, 2, 1),
    ]  # fmt: skip
    assert sum(many for _, _, many in per_table) == 130
    for crossings, components, many in per_table:
        numbers = [re.fullmatch(rf"{crossings}\^{components}_(\d+)", name) for name in rolfsens]
        assert sorted(int(match[1]) for match in numbers if match) == list(range(1, many + 1))


@pytest.mark.parametrize(
    ("name", "link"),
    [
        ("Whitehead", "L5a1"),
        ("5.2.1", "L5a1"),
        ("l5A1", "L5a1"),
        ("borromean", "L6a4"),
        ("6^3_2", "L6a4"),
        ("6^3_1", "L6a5"),
        ("6^3_3", "L6n1"),
        ("7^2_7", "L7n1"),
        ("8^4_1", "L8a21"),
        (" 4^2_1 ", "L4a1"),
    ],
)
def test_one_link_has_many_names(name: str, link: str) -> None:
    row = table_row(spelled(name))
    assert row
    assert row["link"].split("{")[0] == link
    assert fingerprint(start(name)) == fingerprint(start(link))


def test_well_known_links_are_what_they_are() -> None:
    borromean = start("Borromean")
    assert linking_matrix(diagram(borromean)).tolist() == [[0] * 3] * 3
    apart = [component + shift for shift in (0, 99) for component in start("chain1")]
    assert all(homfly([one, other]) == homfly(apart) for one, other in pairwise(borromean))
    assert linking_matrix(diagram(start("Whitehead")))[0, 1] == 0
    assert homfly(start("6^3_3")) in [homfly(c) for c in _turned(start("T(3,3)"))]
    assert abs(linking_matrix(diagram(start("L4a1")))[0, 1]) == 2
    assert homfly(start("L2a1{1}")) == homfly(start("Hopf")) != homfly(start("L2a1{0}"))


def _turned(curve: Components) -> list[Components]:
    both: list[Components] = [curve, [component * (1, 1, -1) for component in curve]]
    return [
        [component[::turn] for component, turn in zip(one, turns, strict=True)]
        for one in both
        for turns in product((1, -1), repeat=len(curve))
    ]


@pytest.mark.parametrize("row", ROWS[::7], ids=lambda row: str(row["link"]))
def test_braid_diagram_and_arcs_are_one_oriented_link(row: dict[str, str]) -> None:
    regina = pytest.importorskip("regina")
    drawn = start(row["link"])
    codes = [tuple(map(int, code.split(","))) for code in row["pd"].split()]
    assert homfly(drawn) == str(regina.Link.fromPD(codes).homflyAZ())
    assert homfly(start(row["link"], 5)) == homfly(drawn)
    assert fingerprint(start(row["link"], 18)) == fingerprint(drawn)


@pytest.mark.parametrize("row", ROWS[3::12], ids=lambda row: str(row["link"]))
def test_a_link_has_variants_from_its_diagram_as_from_its_arcs(row: dict[str, str]) -> None:
    drawn = start(row["link"])
    for variant in (-1, -2, 7):
        again = start(row["link"], variant)
        assert fingerprint(again) == fingerprint(drawn)
        assert homfly(again) == homfly(drawn)
    assert has_variants(row["link"])
    assert start(row["link"], -1)[0].tobytes() != start(row["link"], -2)[0].tobytes()


@pytest.mark.parametrize(
    "name", ["L10a1", "L10a121{1}", "L10n99{0,0,0}", "L10n113", "mL11a548", "l11N459", "L11a5#L11n7{1}"]
)
def test_links_of_10_and_11_crossings_are_those_of_linkinfo(name: str) -> None:
    rows = pytest.importorskip("database_knotinfo").link_list(proper_links=True)
    drawn = start(name)
    for variant in (3, -1):
        again = start(name, variant)
        assert (fingerprint(again), homfly(again)) == (fingerprint(drawn), homfly(drawn))
    for row in rows:
        if row["name"] == name:
            linking = json.loads(row["linking_matrix"].replace("{", "[").replace("}", "]"))
            found = linking_matrix(diagram(drawn)).tolist()
            assert sorted(map(sorted, found)) == sorted(map(sorted, linking))


def test_without_linkinfo_the_extra_is_named(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "database_knotinfo", None)
    knotinfo.links.cache_clear()
    with pytest.raises(ValueError, match=r"links of more than 9 crossings is an extra; .*sono\[knotinfo\]"):
        start("L10a1")


def test_another_link_is_not_oriented_like_the_model() -> None:
    with pytest.raises(ValueError, match="another link"):
        oriented_like(start("L4a1"), start("L5a1"))


def test_links_tighten_by_name() -> None:
    for name in ("5^2_1", "mL6a4", "L6n1{0,1}"):
        tight = sono.tighten(name, 120, trials=1)
        assert tight.converged
        assert fingerprint(tight.curve) == fingerprint(start(name))


def test_wrong_names_are_helped() -> None:
    assert set(LINKS) < set(link_names())
    for wrong in ("L5a2", "9^2_62", "L9a99", "Whitehaed"):
        with pytest.raises(ValueError, match=r"did you mean|there is only"):
            start(wrong)
