"""The page of a rope, without a browser: what is in it, and that nothing can break out of it."""

import base64
import json
import os
import re
import signal
import time
from dataclasses import replace
from html.parser import HTMLParser
from importlib import resources
from itertools import accumulate
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from conftest import Sono, Spawn
from numpy.typing import NDArray

import sono as package
from sono.figures import packing
from sono.figures.plot.sheet import COLOURS
from sono.figures.turning import facing, turned
from sono.figures.view import WEAKEST, curvature, page, titled

EVIL = "</script><script>alert(1)</script><img src=x onerror=alert(2)> $title ${data} & \"'"
"""Whatever a file may be called, or say."""


class Tags(HTMLParser):
    """Collects the tags of a page, and the text of each script and title."""

    def __init__(self, html: str) -> None:
        super().__init__()
        self.tags: list[tuple[str, dict[str, str | None]]] = []
        self.texts: list[tuple[str, str]] = []
        self.feed(html)

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        self.tags.append((tag, dict(attrs)))

    def handle_data(self, data: str) -> None:
        self.texts.append((self.tags[-1][0] if self.tags else "", data))

    @property
    def data(self) -> list[dict[str, Any]]:
        """The curves."""
        at = next(k for k, (tag, _) in enumerate(self.texts) if tag == "script")
        found: list[dict[str, Any]] = json.loads(self.texts[at][1])
        return found


def decoded(text: str, kind: str) -> NDArray[Any]:
    return np.frombuffer(base64.b64decode(text, validate=True), kind)


def wholes(text: str) -> list[int]:
    """Return numbers of base 128, one after the other, whose last digits are below 128."""
    found, number, place = [], 0, 0
    for byte in base64.b64decode(text, validate=True):
        number += byte % 128 * 128**place
        place += 1
        if byte < 128:
            found.append(number)
            number = place = 0
    assert not place
    return found


def placed(data: dict[str, Any]) -> NDArray[np.float64]:
    """Return the vertices (n, 3) of a rope: steps from a corner, by their third differences."""
    folded = np.array(wholes(data["vertices"])).reshape(-1, 3)
    third = np.where(folded % 2, -(folded + 1) // 2, folded // 2)
    steps = third.cumsum(axis=0).cumsum(axis=0).cumsum(axis=0)
    return np.asarray(data["corner"] + data["step"] * steps)


def paired(text: str, n: int) -> list[list[int]]:
    """Return pairs of vertices, by differences."""
    return [[key // n, key % n] for key in accumulate(wholes(text))]


@pytest.fixture(scope="module")
def borromean() -> str:
    return page([("rings", package.start("Borromean", known=True))], "Rings")


def test_components_have_the_colours_of_plots_and_prints() -> None:
    script = resources.files("sono").joinpath("data", "view", "colours.js").read_text()
    listed = re.search(r"COMPONENTS = \[(.*?)\]", script)
    assert listed is not None
    assert [f"#{one.upper()}" for one in re.findall("[0-9a-f]{6}", listed[1])] == [*COLOURS["light"]]


def test_a_page_needs_nothing_else(borromean: str) -> None:
    assert not re.search(r"https?:|//[a-z]+\.[a-z]|@import|url\(|\bimport\b|fetch|XMLHttp", borromean)
    for tag, attributes in Tags(borromean).tags:
        assert "src" not in attributes
        assert tag != "link" or attributes["href"] == "data:,"
    assert "default-src 'none'" in borromean


def test_the_data_are_the_rope(borromean: str) -> None:
    curve = package.start("Borromean", known=True)
    rope = [component / package.measure(curve).r_s for component in curve]
    (data,) = Tags(borromean).data
    assert data["sizes"] == list(map(len, curve))
    np.testing.assert_allclose(placed(data), np.concatenate(rope), atol=1e-6)
    forces = package.forces(rope)
    strong = forces.pressing > WEAKEST * forces.pressing.max()
    assert 0 < strong.sum() <= len(strong)
    assert paired(data["pairs"], len(np.concatenate(rope))) == forces.contacts[strong].tolist()
    assert data["strongest"] == forces.pressing.max()
    pressing = decoded(data["pressing"], "<u2") / 65535 * data["strongest"]
    np.testing.assert_allclose(pressing, forces.pressing[strong], atol=1e-5 * data["strongest"])
    np.testing.assert_allclose(decoded(data["curvature"], "<u2") / 65535, curvature(rope), atol=1e-5)
    assert dict(data["rows"])["L_p"] == f"{package.measure(curve).l_p:.6f}"
    assert data["type"].startswith("L6a4")


@pytest.mark.parametrize("n", [2, 3, 127, 130, 1000, 65_536, 100_000, 1_000_000])
@pytest.mark.parametrize("count", [0, 1, 2, 3000])
def test_pairs_are_those_that_were_packed(n: int, count: int) -> None:
    random = np.random.default_rng(n + count)
    pairs = np.unique(np.sort(random.integers(0, n, (count, 2)), axis=1), axis=0)
    text = packing.pairs(pairs, n)
    assert paired(text, n) == pairs.tolist()
    assert len(text) <= 4 / 3 * 6 * len(pairs) + 4
    ends = np.array([[0, 0], [0, n - 1], [n - 1, n - 1]])
    assert paired(packing.pairs(ends, n), n) == ends.tolist()


@pytest.mark.parametrize("size", [1e-9, 1, 1e6])
@pytest.mark.parametrize("n", [3, 4, 50, 3000])
def test_vertices_are_where_they_were(n: int, size: float) -> None:
    points = size * np.random.default_rng(n).normal(size=(n, 3))
    found = placed(packing.vertices(points))
    np.testing.assert_allclose(found, points, atol=np.ptp(points, axis=0).max() / 2**24)


def test_vertices_of_a_smooth_curve_take_little() -> None:
    angle = np.linspace(0, 2 * np.pi, 2000, endpoint=False)
    circle = np.column_stack([np.cos(angle), np.sin(angle), 0 * angle])
    assert len(packing.vertices(circle)["vertices"]) < 4 / 3 * 3.1 * 2000


@pytest.mark.parametrize("seed", range(3))
def test_contacts_go_with_what_they_bear_in_whatever_order(
    seed: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    rope = package.start("L6a4", known=True)
    forces = package.forces(rope)
    order = np.random.default_rng(seed).permutation(len(forces.pressing))
    turned_over = replace(forces, contacts=forces.contacts[order], pressing=forces.pressing[order])
    monkeypatch.setattr("sono.figures.view.forces", lambda _: turned_over)
    (data,) = Tags(page([("rings", rope)], "Rings")).data
    found = paired(data["pairs"], sum(map(len, rope)))
    assert found == sorted(found)
    pressing = decoded(data["pressing"], "<u2") / 65535 * data["strongest"]
    known = {(i, j): force for (i, j), force in zip(forces.contacts.tolist(), forces.pressing, strict=True)}
    np.testing.assert_allclose(pressing, [known[i, j] for i, j in found], atol=1e-5 * data["strongest"])


def test_a_curve_without_contacts() -> None:
    angle = np.arange(50) * np.pi / 25
    ellipse = np.column_stack([2 * np.cos(angle), 1.5 * np.sin(angle), 0 * angle])  # which its bends hold
    (data,) = Tags(page([("ring", ellipse)], "Ring")).data
    assert data["pairs"] == data["pressing"] == ""


@pytest.mark.parametrize("scale", [1e-6, 0.5, 1e5])
def test_any_scale_is_shown_at_radius_1(scale: float) -> None:
    trefoil = package.start("3_1", known=True)[0]
    (one,), (other,) = (Tags(page([("", k * trefoil)], "t")).data for k in (1, scale))
    np.testing.assert_allclose(placed(one), placed(other), atol=2e-6)
    assert one["name"] == one["type"] == "3_1"
    assert float(dict(other["rows"])["R_s as given"]) == pytest.approx(scale, rel=1e-6)


def test_curvature_is_that_of_the_inscribed_arcs() -> None:
    trefoil = package.start("3_1", known=True)
    assert 1 / curvature(trefoil).max() == pytest.approx(package.measure(trefoil).min_rad)
    angle = np.linspace(0, 2 * np.pi, 50, endpoint=False)
    circle = 3 * np.column_stack([np.cos(angle), np.sin(angle), 0 * angle])
    np.testing.assert_allclose(curvature([circle]), 1 / (3 * np.cos(np.pi / 50)))


def test_names_do_not_break_out() -> None:
    tags = Tags(page([(EVIL, package.start("3_1", known=True))], EVIL))
    assert tags.data[0]["name"] == EVIL
    assert not [tag for tag, attributes in tags.tags if tag == "img" or "onerror" in attributes]
    assert sum(tag == "script" for tag, _ in tags.tags) == 2
    assert ("title", EVIL) in tags.texts


@pytest.mark.parametrize("name", ["\ud800.txt", "a\u202etxt", "a\x1b[31m", "\u2028", "Ω ∞", ""])
def test_any_name_can_be_written(name: str, tmp_path: Path) -> None:
    package.view({name: "3_1"}).save(tmp_path / "page.html")
    html = (tmp_path / "page.html").read_text(encoding="utf-8")
    assert not re.search("[\x1b\u202e\u2028]", html)
    assert len(Tags(html).data) == 1


def test_a_page_is_small() -> None:
    rope = package.tighten("3_1", 500)
    assert len(rope.view().html.encode()) < 80_000


@pytest.mark.slow
def test_a_page_of_a_fine_rope_is_small(tmp_path: Path) -> None:
    package.write(tmp_path / "rope.txt", package.tighten("3_1", 2000).curve)
    html = page([("rope", package.read(tmp_path / "rope.txt"))], "Rope")
    assert len(Tags(html).data[0]["pressing"]) > 20_000
    assert len(html.encode()) < 150_000


def test_titles() -> None:
    assert titled(["a"]) == "a"
    assert titled(["a", "b", "c"]) == "a and 2 more"
    assert titled([""]) == "Rope"


def turn(seed: int) -> NDArray[np.float64]:
    """Return a rotation by chance."""
    q = np.linalg.qr(np.random.default_rng(seed).normal(size=(3, 3)))[0]
    return np.asarray(q * np.linalg.det(q))


@pytest.mark.parametrize("name", ["4_1", "Borromean", "7_4"])
def test_several_curves_are_turned_alike(name: str) -> None:
    curve = package.start(name, known=True)
    other = [component[::-1] @ turn(1).T + 5.0 for component in package.refine(curve, 333)]
    here, there = turned([curve, other])
    assert np.linalg.det(there) == pytest.approx(1)
    # A symmetry of the knot may lie between the two; it keeps their boxes.
    boxes = [
        np.ptp(np.concatenate(list(parts)) @ frame.T, axis=0)
        for parts, frame in ((curve, here), (other, there))
    ]
    np.testing.assert_allclose(boxes[0], boxes[1], atol=0.2)


def test_no_ring_of_the_borromean_ones_is_seen_from_its_edge() -> None:
    for ring in facing(list(package.start("Borromean", known=True))):
        normal = np.linalg.svd(ring - ring.mean(axis=0))[2][2]
        assert 0.4 < abs(normal[2]) < 0.75
    (frame,) = turned([package.start("Borromean", known=True)])
    assert np.linalg.det(frame) == pytest.approx(1)  # a picture is no mirror image
    widest = np.vstack(facing(list(package.start("3_1", known=True))))
    assert np.ptp(widest, axis=0).argmin() == 2


def test_a_curve_of_another_kind_is_turned_too() -> None:
    frames = turned([package.start("3_1"), package.start("Hopf"), package.start("4_1")])
    assert all(np.linalg.det(frame) == pytest.approx(1) for frame in frames)


def test_the_command(sono: Sono, folder: Path) -> None:
    assert sono("view", "3_1.txt").stderr.startswith("sono: 3_1.html: ")
    (data,) = Tags((folder / "3_1.html").read_text()).data
    assert data["name"] == data["type"] == "3_1"
    assert data["sizes"] == [len(package.start("3_1")[0])]  # the file's, not the atlas's
    again = sono("view", "3_1.txt")
    assert again.exit_code == 2
    assert "--force" in again.stderr
    assert sono("view", "3_1.txt", "--force", "-q").stderr == ""


def test_the_command_takes_names_and_several(sono: Sono, folder: Path) -> None:
    done = sono("view", "4_1", "3_1.txt", "Hopf", "-o", "-")
    assert [data["name"] for data in Tags(done.stdout).data] == ["4_1", "3_1", "Hopf"]
    assert done.stderr == ""
    assert not list(folder.glob("*.html"))


def test_what_takes_long_is_told(sono: Sono, monkeypatch: pytest.MonkeyPatch) -> None:
    def slow(*given: Any) -> str:
        time.sleep(0.5)
        return page(*given)

    monkeypatch.setattr("sono.cli.each.LONG", 0)
    monkeypatch.setattr("sono.figures.view.page", slow)
    said = sono("view", "3_1", "Hopf", "-o", "page.html").stderr
    count = sum(len(part) for name in ("3_1", "Hopf") for part in package.start(name, known=True))
    assert said.splitlines()[0] == f"sono: the forces in ropes of {count} vertices take a while"
    assert said.count("\n") == 2
    assert sono("view", "3_1", "-o", "page.html", "--force", "-q").stderr == ""


@pytest.mark.slow
@pytest.mark.skipif(os.name != "posix", reason="needs Unix signals")
def test_ctrl_c_does_not_wait_for_what_takes_long(spawn: Spawn, folder: Path) -> None:
    process = spawn("view", "T(30,60)", "-o", "page.html")
    assert process.stderr
    assert "take a while" in process.stderr.readline()
    begun = time.monotonic()
    process.send_signal(signal.SIGINT)
    assert process.wait() == 130
    assert time.monotonic() < begun + 10  # five times what it takes where nothing else runs
    assert not (folder / "page.html").exists()


def test_a_wrong_file_spoils_only_itself(sono: Sono, folder: Path) -> None:
    (folder / "bad.txt").write_text("0 0 0\n1 0 0\nx\n")
    (folder / "flat.txt").write_text("0 0 0\n1 0 0\n1 1 0\n0 0 0\n1 1 1\n")
    done = sono("view", "bad.txt", "nosuch.txt", "flat.txt", "3_1.txt", "-o", "page.html")
    assert done.exit_code == 1
    assert [line.split(":")[1].strip() for line in done.stderr.splitlines()] == [
        "bad.txt", "nosuch.txt", "flat.txt", "page.html",
    ]  # fmt: skip
    assert len(Tags((folder / "page.html").read_text()).data) == 1


def test_no_page_without_a_curve(sono: Sono, folder: Path) -> None:
    done = sono("view", "T(2,103)", "nosuch")
    assert done.exit_code == 1
    assert "`sono tighten 'T(2,103)' -o rope.txt` makes one" in done.stderr
    assert not list(folder.glob("*.html"))


@pytest.mark.parametrize("output", ["page.png", "page", "folder/", "3_1.txt"])
def test_a_page_is_called_so(sono: Sono, folder: Path, output: str) -> None:
    before = sorted(folder.iterdir())
    done = sono("view", "3_1", "--force", "-o", output)
    assert done.exit_code == 2
    assert "a page is called .html" in done.stderr
    assert sorted(folder.iterdir()) == before


def test_a_folder_in_the_way(sono: Sono, folder: Path) -> None:
    (folder / "page.html").mkdir()
    done = sono("view", "3_1", "-o", "page.html")
    assert done.exit_code == 1
    assert "cannot be written" in done.stderr


def test_what_python_is_given() -> None:
    tight = package.tighten("3_1", 60)
    assert tight.view() == package.view(tight) == package.view(tight.curve)
    frame = tight.view()._repr_html_()
    assert frame.startswith("<iframe")
    assert Tags(Tags(frame).tags[0][1]["srcdoc"] or "").data[0]["type"] == "3_1"
    with pytest.raises(ValueError, match="no rope"):
        package.view("T(2,103)")
    with pytest.raises(ValueError, match="give a rope"):
        package.view()
    with pytest.raises(package.CurveError):
        package.view([[0, 0, 0], [1, 0, 0], [2, 0, 0], [1, 0, 0]])
