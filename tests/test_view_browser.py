"""The page of a rope in headless Chromium, with WebGL2 in software: what one sees, and what one can do."""

import io
import shutil
from collections.abc import Callable, Iterator
from importlib import resources
from pathlib import Path
from typing import Any, TypeAlias

import numpy as np
import pytest
from numpy.typing import NDArray
from PIL import Image

import sono
from sono.figures import packing

sync_api = pytest.importorskip("playwright.sync_api", reason="needs playwright")

CHROMIUM = next(filter(None, map(shutil.which, ("chromium", "chromium-browser", "google-chrome"))), None)

SOFTWARE = ["--no-sandbox", "--use-gl=angle", "--use-angle=swiftshader", "--enable-unsafe-swiftshader"]

WIDE = {"width": 760, "height": 440}

FIRST_PICTURE = """new Promise((done) => {
  const look = () => (performance.getEntriesByName("drawn").length ? done() : requestAnimationFrame(look));
  look();
})"""
"""Waits for it; playwright's own waiting needs eval, which the page forbids."""

TELL: dict[str, Callable[[Any], str]] = {
    "console": lambda message: str(message.text),
    "pageerror": str,
    "dialog": lambda dialog: str(dialog.message),
    "request": lambda request: "" if request.url.startswith("data:") else str(request.url),
}
"""What a page may say or ask for, and how that is told."""

pytestmark = [pytest.mark.slow, pytest.mark.skipif(not CHROMIUM, reason="needs Chromium on the PATH")]

Picture: TypeAlias = NDArray[np.int16]
Open: TypeAlias = Callable[..., "Seen"]

NO_WEBGL = """
const other = HTMLCanvasElement.prototype.getContext;
HTMLCanvasElement.prototype.getContext = function (kind, ...more) {
  return kind === "webgl2" ? null : other.call(this, kind, ...more);
};
"""


class Seen:
    """A page in the browser."""

    def __init__(self, page: Any) -> None:
        self.page = page

    def drawn(self) -> None:
        """Wait until what has been asked for is on the screen."""
        self.page.evaluate("new Promise((r) => requestAnimationFrame(() => requestAnimationFrame(r)))")

    def press(self, *keys: str) -> None:
        for key in keys:
            self.page.keyboard.press(key)
        self.drawn()

    def picture(self, of: str = "#rope") -> Picture:
        """Return the pixels (height, width, 3) of an element."""
        self.drawn()
        png = self.page.screenshot(clip=self.box(of))
        return np.asarray(Image.open(io.BytesIO(png)).convert("RGB"), np.int16)

    def box(self, of: str) -> Any:
        """Return where an element is, once it can be seen."""
        self.page.locator(of).scroll_into_view_if_needed()
        return self.page.locator(of).bounding_box()

    def text(self, of: str) -> str:
        return str(self.page.locator(of).inner_text())

    def measures(self) -> dict[str, str]:
        rows = self.page.locator("#measures tr").all_inner_texts()
        return dict(row.split("\t") for row in rows)

    def point_at(self, of: str, x: float, y: float) -> None:
        box = self.box(of)
        self.page.mouse.move(box["x"] + x, box["y"] + y)
        self.drawn()


@pytest.fixture(scope="module")
def chromium() -> Iterator[Any]:
    with sync_api.sync_playwright() as driver:
        browser = driver.chromium.launch(executable_path=CHROMIUM, args=SOFTWARE)
        yield browser
        browser.close()


@pytest.fixture(scope="module")
def tab(chromium: Any) -> Any:
    """The page of most tests: another one takes a second to begin."""
    return chromium.new_page(viewport=WIDE)


@pytest.fixture
def opened(chromium: Any, tab: Any, tmp_path: Path) -> Iterator[Open]:
    """Show ropes; whatever the page complains of, or asks others for, fails the test."""
    complaints: list[str] = []
    contexts: list[Any] = []
    listeners: list[tuple[Any, str, Any]] = []
    path = tmp_path / "page.html"

    def own(before: str, more: dict[str, Any]) -> Any:
        contexts.append(chromium.new_context(**({"viewport": WIDE} | more)))
        page = contexts[-1].new_page()
        if before:
            page.add_init_script(before)
        return page

    def show(*ropes: Any, before: str = "", theme: str = "light", **more: Any) -> Seen:
        sono.view(*ropes).save(path)
        page = own(before, more) if before or more else tab
        page.emulate_media(color_scheme=theme)
        for event, told in TELL.items():
            listeners.append((page, event, lambda it, told=told: complaints.append(told(it))))
            page.on(*listeners[-1][1:])
        page.goto(path.as_uri())
        page.evaluate(FIRST_PICTURE)
        return Seen(page)

    yield show
    for page, event, listener in listeners:
        page.remove_listener(event, listener)
    for context in contexts:
        context.close()
    assert [text for text in complaints if text not in (path.as_uri(), "")] == []


def not_back(picture: Picture) -> NDArray[np.bool_]:
    """Tell which pixels are not like the one at the lower left corner."""
    found: NDArray[np.bool_] = np.abs(picture - picture[-3, 2]).sum(axis=-1) > 40
    return found


def share(mask: NDArray[np.bool_]) -> float:
    return float(mask.mean())


def changed(one: Picture, other: Picture) -> NDArray[np.bool_]:
    return np.asarray(np.abs(one - other).sum(axis=-1) > 30)


def bluish(p: Picture) -> NDArray[np.bool_]:
    return np.asarray((p[..., 2] > p[..., 0] + 50) & (p[..., 1] < p[..., 2] - 20))


def orange(p: Picture) -> NDArray[np.bool_]:
    return np.asarray((p[..., 0] > p[..., 2] + 70) & (p[..., 1] > p[..., 2] + 35))


def green(p: Picture) -> NDArray[np.bool_]:
    return np.asarray((p[..., 1] > p[..., 0] + 35) & (p[..., 1] > p[..., 2] + 10))


def red(p: Picture) -> NDArray[np.bool_]:
    return np.asarray((p[..., 0] > p[..., 1] + 60) & (p[..., 0] > p[..., 2] + 40))


@pytest.mark.parametrize("before", ["", NO_WEBGL], ids=["WebGL2", "plain canvas"])
def test_each_component_has_its_colour(opened: Open, before: str) -> None:
    seen = opened("Borromean", before=before)
    for beads in (False, True):
        picture = seen.picture()
        assert 0.2 < share(not_back(picture)) < 0.8
        assert all(share(kind(picture)) > 0.02 for kind in (bluish, orange, green))
        assert seen.page.locator("#beads").get_attribute("aria-pressed") == str(beads).lower()
        seen.press("b")
    assert seen.page.locator("#warning").is_visible() == bool(before)
    assert seen.text("#legend").count("vertices") == 3
    before_turning = seen.picture()
    seen.press("ArrowLeft", "t")
    assert share(changed(seen.picture(), before_turning)) > 0.02


def test_beads_are_balls_of_radius_1(opened: Open) -> None:
    angle = np.arange(5) * 2 * np.pi / 5
    pentagon = np.column_stack([np.cos(angle), np.sin(angle), 0 * angle])
    seen = opened(pentagon)
    seen.page.evaluate("document.getElementById('tools').hidden = true")
    smooth = not_back(seen.picture())
    seen.press("b")
    mask = not_back(seen.picture())
    assert mask.sum() != smooth.sum()
    mask = mask[mask.any(axis=1)][:, mask.any(axis=0)]
    y, x = np.mgrid[-4:4:801j, -4:4:801j]
    disks = [np.hypot(x - a, y - b) < 1 for a, b, _ in pentagon / sono.measure(pentagon).r_s]
    expected = np.any(disks, axis=0)
    expected = expected[expected.any(axis=1)][:, expected.any(axis=0)]
    assert share(mask) == pytest.approx(share(expected), abs=0.03)


def test_pointing_at_the_rope_marks_the_map(opened: Open) -> None:
    seen = opened("4_1")
    map_before, rope_before = seen.picture("#map"), seen.picture()
    there = np.argwhere(not_back(rope_before)[90:300, 30:300])
    y, x = (int(k) for k in there[len(there) // 3] + np.array([90, 30]))
    seen.point_at("#rope", x, y)
    place, s, curvature, force = seen.text("#told tbody tr").split("\t")
    assert place.split("0:")[1].isdigit()
    assert 0 <= float(s) < 45
    assert 0 <= float(curvature) <= 1.01
    assert float(force) >= 0
    crossed = changed(seen.picture("#map"), map_before)
    assert crossed.sum(axis=0).max() > 100  # a column
    assert crossed.sum(axis=1).max() > 100  # and a row
    # The sleeve is where the mouse is, or hardly beside.
    assert red(seen.picture())[y - 12 : y + 13, x - 12 : x + 13].any()
    assert not red(rope_before).any()
    seen.point_at("#rope", 3, 430)
    assert seen.page.locator("#told").is_hidden()
    np.testing.assert_array_equal(seen.picture(), rope_before)


def test_pointing_tells_vertices_between_rings_apart(opened: Open) -> None:
    seen = opened(sono.tighten("3_1", 960))  # which has a ring for every third one
    places = set()
    for x in range(60, 300, 20):
        seen.point_at("#rope", x, 220)
        if seen.page.locator("#told").is_visible():
            places.add(int(seen.text("#told tbody tr").split("\t")[0].split(":")[1]))
    assert len({place % 3 for place in places}) == 3


def test_pointing_at_the_map_marks_the_rope(opened: Open) -> None:
    seen = opened("3_1")
    before, rope = seen.picture(), sono.start("3_1", known=True)
    forces = sono.forces(rope)
    i, j = forces.contacts[np.argmax(forces.pressing)]
    edges = np.linalg.norm(np.roll(rope[0], -1, axis=0) - rope[0], axis=1)
    s = np.concatenate([[0], np.cumsum(edges)])
    side = seen.box("#map")["width"] - 34
    seen.point_at("#map", 30 + side * s[i] / s[-1], 4 + side * (1 - s[j] / s[-1]))
    rows = [row.split("\t")[0].split("0:")[1] for row in seen.text("#told tbody").splitlines()]
    assert rows == [str(i), str(j)]
    assert f"pressing with {forces.pressing.max():.3f}" in seen.text("#told tfoot")
    assert 0.002 < share(changed(seen.picture(), before)) < 0.3
    seen.page.locator("#map").focus()
    seen.press("ArrowRight")
    assert seen.text("#told tbody").split("\t")[0].endswith(f"0:{i + 1}")


@pytest.mark.parametrize(("n", "count"), [(5, 0), (5, 1), (300, 2000), (66_000, 2000)])
def test_the_script_reads_what_was_packed(tab: Any, n: int, count: int) -> None:
    random = np.random.default_rng(n + count)
    vertices, curvature = random.normal(size=(n, 3)), random.random(n)
    pairs = np.unique(np.sort(random.integers(0, n, (count, 2)), axis=1), axis=0)
    pressing = random.random(len(pairs))
    data = {
        **packing.vertices(vertices),
        "sizes": [3, n - 3],
        "curvature": packing.shares(curvature, 1),
        "pairs": packing.pairs(pairs, n),
        "strongest": 2,
        "pressing": packing.shares(pressing, 2),
    }
    script = resources.files("sono").joinpath("data", "view", "curve.js").read_text()
    curve = tab.evaluate(
        f"""(data) => {{ {script}
        const curve = new Curve(data);
        return ["vertices", "curvature", "pairs", "pressing"].map((key) => Array.from(curve[key])); }}""",
        data,
    )
    for found, given in zip(curve, (vertices, curvature, pairs, pressing), strict=True):
        np.testing.assert_allclose(found, given.ravel(), atol=1e-4)


def test_the_slider_goes_through_the_curves(opened: Open) -> None:
    trefoils = {f"n = {n}": sono.tighten("3_1", n) for n in (30, 60, 120)}
    seen = opened(trefoils)
    seen.press("ArrowLeft", "ArrowUp", "b")
    first = seen.picture()
    for n, key in ((30, ""), (60, "]"), (120, "]"), (120, "]"), (60, "[")):
        seen.press(*filter(None, [key]))
        measures = trefoils[f"n = {n}"].measures
        assert seen.text("#name") == f"n = {n}"
        assert seen.measures()["n"] == str(n)
        assert float(seen.measures()["Lp"]) == pytest.approx(measures.l_p, abs=2e-6)
    slider = seen.page.locator("#which")
    slider.focus()
    seen.press("ArrowLeft")
    assert seen.text("#name") == slider.get_attribute("aria-valuetext") == "n = 30"
    np.testing.assert_array_equal(seen.picture(), first)  # the camera stayed


def test_keys(opened: Open) -> None:
    seen = opened("5_2")
    first = seen.picture()
    for key in ("ArrowLeft", "ArrowDown", "Shift+ArrowRight", "+", "-"):
        seen.press(key)
        assert share(changed(seen.picture(), first)) > 0.01, key
        seen.press("r")
    np.testing.assert_array_equal(seen.picture(), first)
    for label in ("curvature", "contact force", "arclength"):
        seen.press("c")
        assert seen.text("#of").startswith(label)
        assert share(changed(seen.picture(), first)) > 0.1
    seen.press("c", "?")
    assert seen.page.locator("#keys").is_visible()
    seen.press("Escape")
    assert seen.page.locator("#keys").is_hidden()
    np.testing.assert_array_equal(seen.picture(), first)


def test_mouse(opened: Open) -> None:
    seen = opened("3_1")

    def rope() -> NDArray[np.bool_]:
        return not_back(seen.picture())[90:360]  # without what lies over it

    def middle() -> float:
        return float(np.flatnonzero(rope().any(axis=0)).mean())

    size = share(rope())
    seen.point_at("#rope", 200, 200)
    seen.page.mouse.wheel(0, 400)
    assert share(rope()) < 0.8 * size
    before = middle()
    seen.page.mouse.down(button="right")
    seen.point_at("#rope", 230, 200)
    seen.page.mouse.up(button="right")
    assert middle() == pytest.approx(before + 30, abs=5)
    seen.page.locator("#reset").click()
    first = seen.picture()
    seen.point_at("#rope", 200, 200)
    seen.page.mouse.down()
    seen.point_at("#rope", 120, 230)
    seen.page.mouse.up()
    assert share(changed(seen.picture(), first)) > 0.05


def test_fingers(opened: Open) -> None:
    seen = opened("3_1", viewport={"width": 390, "height": 600}, has_touch=True)
    assert seen.page.evaluate("document.documentElement.scrollWidth") <= 390
    size = share(not_back(seen.picture()))
    touch = seen.page.context.new_cdp_session(seen.page)

    def fingers(kind: str, *places: tuple[float, float]) -> None:
        points = [{"x": x, "y": y, "id": k} for k, (x, y) in enumerate(places)]
        touch.send("Input.dispatchTouchEvent", {"type": kind, "touchPoints": points})

    fingers("touchStart", (120, 200), (270, 200))
    for k in range(1, 6):
        fingers("touchMove", (120 + 10 * k, 200), (270 - 10 * k, 200))
    fingers("touchEnd")
    pinched = seen.picture()
    assert share(not_back(pinched)) < 0.7 * size
    fingers("touchStart", (200, 200))
    fingers("touchMove", (150, 240))
    fingers("touchEnd")
    assert share(changed(seen.picture(), pinched)) > 0.02
    assert seen.page.evaluate("scrollY") == 0


def test_light_and_dark(opened: Open) -> None:
    light = opened("3_1").picture()
    assert light[-3, 2].min() > 200
    dark = opened("3_1", theme="dark")
    assert dark.picture()[-3, 2].max() < 60
    assert dark.picture("aside")[2, 2].max() < 60
    dark.press("d")
    np.testing.assert_array_equal(dark.picture(), light)


def test_all_that_can_be_used_has_a_name(opened: Open) -> None:
    seen = opened("3_1", "4_1")
    names = [
        node.get_attribute("aria-label") or node.inner_text()
        for node in seen.page.get_by_role("button").all()
    ]
    assert len(names) == 5
    assert all(names)
    for role, name in (
        ("combobox", "Colour"),
        ("slider", "Curve"),
        ("img", "Map"),
        ("img", "The rope. Drag"),
    ):
        assert seen.page.get_by_role(role, name=name).count() == 1
    focused = set()
    for _ in range(9):
        seen.press("Tab")
        focused.add(seen.page.evaluate("document.activeElement.id"))
    assert {"rope", "beads", "thin", "colour", "reset", "theme", "help", "which", "map"} <= focused


def test_a_name_is_only_text(opened: Open) -> None:
    evil = "</script><script>alert(1)</script><img src=x onerror=alert(2)>"
    seen = opened({evil: "3_1"})
    assert seen.text("#name") == seen.page.title() == evil
    assert seen.page.locator("img").count() == 0


def test_a_notebook_shows_it(tab: Any) -> None:
    tab.set_content(sono.view("3_1")._repr_html_())
    frame = tab.frames[1]
    frame.evaluate(FIRST_PICTURE)
    assert frame.locator("#name").inner_text() == "3_1"
    assert share(bluish(Seen(tab).picture("iframe"))) > 0.05
