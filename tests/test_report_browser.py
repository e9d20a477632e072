"""A report in headless Chromium, from a folder: its table sorts and searches, and opens a rope's page."""

import json
from collections.abc import Iterator
from pathlib import Path
from typing import Any
from urllib.parse import quote

import pytest
from click.testing import CliRunner
from test_view_browser import CHROMIUM, FIRST_PICTURE, SOFTWARE, Seen, not_back, share

from sono.cli import main

sync_api = pytest.importorskip("playwright.sync_api", reason="needs playwright")

pytestmark = [pytest.mark.slow, pytest.mark.skipif(not CHROMIUM, reason="needs Chromium on the PATH")]

NAMES = (
    "3_1",
    "4_1",
    "5_2",
    "8_18",
    "8_20",
    "10_100",
    "10_124",
    "L5a1",
    "L8n3",
    "3_1#4_1",
    "T(3,4)",
    "T(2,7)",
)

TYPED = """(text) => new Promise((done) => {
  const words = document.getElementById("words"), begun = performance.now();
  words.value = text;
  words.dispatchEvent(new Event("input"));
  document.body.offsetHeight;
  done(performance.now() - begun);
})"""
"""Types a text, and returns the milliseconds until the table has been laid out anew."""


@pytest.fixture(scope="module")
def site(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("report") / "site"
    done = CliRunner().invoke(main, ["report", *NAMES, "-o", str(folder), "--title", "Some", "-q"])
    assert done.exit_code == 0, done.stderr
    return folder


@pytest.fixture(scope="module")
def large(site: Path) -> Path:
    """The table of 3,000 ropes, most of which have no page."""
    folder = site.parent / "large"
    (folder / "assets").mkdir(parents=True)
    (folder / "index.html").write_bytes((site / "index.html").read_bytes())
    for path in (site / "assets").iterdir():
        (folder / "assets" / path.name).write_bytes(path.read_bytes())
    data = json.loads((site / "assets" / "ropes.js").read_text().partition("= ")[2].removesuffix(";\n"))
    some = data["ropes"]
    data["ropes"] = [some[k % len(some)] | {"knot": f"K{k}", "l_a": 3000.0 - k} for k in range(3000)]
    (folder / "assets" / "ropes.js").write_text(f"const report = {json.dumps(data)};\n")
    return folder


@pytest.fixture(scope="module")
def chromium() -> Iterator[Any]:
    with sync_api.sync_playwright() as driver:
        browser = driver.chromium.launch(executable_path=CHROMIUM, args=SOFTWARE)
        yield browser
        browser.close()


@pytest.fixture
def tab(chromium: Any) -> Iterator[Any]:
    """An empty page; what it complains of, or asks for that is not in the folder, fails the test."""
    complaints: list[str] = []
    page = chromium.new_page(viewport={"width": 1300, "height": 700})
    page.on("console", lambda message: complaints.append(message.text))
    page.on("pageerror", lambda error: complaints.append(str(error)))
    page.on("requestfailed", lambda request: complaints.append(request.url))
    page.on("request", lambda request: complaints.append(request.url) if "http" in request.url[:5] else None)
    yield page
    page.close()
    assert complaints == []


def opened(tab: Any, folder: Path) -> Any:
    tab.goto((folder / "index.html").as_uri())
    tab.wait_for_selector("#rows tr")
    return tab


def names(tab: Any) -> list[str]:
    return [str(text) for text in tab.locator("#rows th").all_inner_texts()]


def column(tab: Any, key: str) -> list[str]:
    return [str(text) for text in tab.locator(f"#rows td.{key}").all_inner_texts()]


def test_the_table(site: Path, tab: Any) -> None:
    opened(tab, site)
    assert names(tab) == list(NAMES)
    assert tab.locator("#count").inner_text() == "12 of 12 ropes"
    assert tab.locator("#rows tr").first.get_attribute("aria-rowindex") == "2"
    assert tab.locator("table").get_attribute("aria-rowcount") == "13"
    assert column(tab, "published")[0] == "32.7436"
    assert column(tab, "crossings")[3] == "8"
    assert tab.locator("td.l_a_difference.less").count() > 5


def test_columns_sort_both_ways_and_what_has_no_value_is_last(site: Path, tab: Any) -> None:
    opened(tab, site)
    for key in ("l_a", "published"):
        for times, direction in ((1, "ascending"), (2, "descending")):
            tab.locator(f"th[data-key={key}] button").click()
            values = [float(text) for text in column(tab, key) if text != "–"]
            assert values == sorted(values, reverse=times == 2)
            assert all(text == "–" for text in column(tab, key)[len(values) :])
            assert tab.locator(f"th[data-key={key}]").get_attribute("aria-sort") == direction
            assert tab.locator("th[aria-sort]").count() == 1
    tab.locator("th[data-key=knot] button").click()
    found = names(tab)
    assert found.index("3_1") < found.index("4_1") < found.index("8_18") < found.index("10_100")


def test_filters_and_what_the_address_keeps(site: Path, tab: Any) -> None:
    opened(tab, site)
    tab.keyboard.press("/")
    tab.keyboard.type("8_")
    assert names(tab) == ["8_18", "8_20", "T(3,4)"]  # T(3,4) is of the type 8_19
    tab.locator("#family").select_option("knots")
    assert names(tab) == ["8_18", "8_20"]
    tab.locator("th[data-key=l_a] button").click()
    assert names(tab) == ["8_20", "8_18"]
    tab.reload()
    tab.wait_for_selector("#rows tr")
    assert names(tab) == ["8_20", "8_18"]
    tab.locator("#words").fill("nothing is called so")
    assert names(tab) == []
    tab.get_by_role("button", name="Show all").click()
    assert len(names(tab)) == 12
    tab.locator("#crossings").select_option("10")
    assert names(tab) == ["10_124", "10_100"]
    tab.locator("#crossings").select_option("")
    tab.locator("#beside").select_option("l_c")
    assert all(text.startswith("-") for text in column(tab, "l_c_difference"))
    tab.locator("#beside").select_option("none")
    assert set(column(tab, "published")) == {"–"}


def test_a_picture_opens_the_page_of_its_rope(site: Path, tab: Any) -> None:
    opened(tab, site)
    picture = tab.locator("#rows tr").nth(8).locator(".picture svg")
    assert picture.locator("path").count() > 3
    picture.click()
    tab.wait_for_url("**/L8n3.html")
    tab.evaluate(FIRST_PICTURE)
    seen = Seen(tab)
    assert seen.text("#name") == tab.title() == "L8n3"
    assert 0.1 < share(not_back(seen.picture())) < 0.8
    assert tab.locator("#warning").is_hidden()
    tab.keyboard.press("t")
    for name in ("3_1#4_1", "T(3,4)"):  # whose addresses are not their names
        tab.locator("a[rel=next]").click()
        tab.wait_for_url(f"**/{quote(name)}.html")
        tab.evaluate(FIRST_PICTURE)
        assert seen.text("#name") == name
    tab.get_by_role("link", name="All ropes").click()
    tab.wait_for_selector("#rows tr")


def test_arrow_keys_go_from_name_to_name(large: Path, tab: Any) -> None:
    opened(tab, large)
    tab.locator("#rows th a").first.focus()
    for _ in range(40):
        tab.keyboard.press("ArrowDown")
    assert tab.evaluate("document.activeElement.textContent") == "K40"
    box, view = (tab.locator(of).bounding_box() for of in ("#rows a:focus", "#scroller"))
    assert view["y"] < box["y"] < view["y"] + view["height"]
    for _ in range(50):
        tab.keyboard.press("ArrowUp")
    assert tab.evaluate("document.activeElement.textContent") == "K0"


def test_three_thousand_ropes(large: Path, tab: Any) -> None:
    opened(tab, large)
    assert tab.locator("#count").inner_text() == "3,000 of 3,000 ropes"
    assert tab.locator("#rows tr").count() < 40
    tab.locator("#scroller").evaluate("(view) => (view.scrollTop = view.scrollHeight)")
    tab.wait_for_selector("text=K2999")
    assert tab.locator("#rows tr").count() < 40
    assert tab.locator("#rows tr").last.get_attribute("aria-rowindex") == "3001"
    waits = [tab.evaluate(TYPED, text) for text in ("k", "k2", "k29", "k2", "")]
    assert sorted(waits)[2] < 100  # milliseconds; some 10 where nothing else runs
    tab.locator("th[data-key=l_a] button").click()
    assert names(tab)[0] == "K2999"


@pytest.mark.parametrize("width", [1300, 390])
@pytest.mark.parametrize("scheme", ["light", "dark"])
def test_narrow_and_wide_light_and_dark(site: Path, tab: Any, width: int, scheme: str) -> None:
    tab.set_viewport_size({"width": width, "height": 700})
    tab.emulate_media(color_scheme=scheme)
    for page in (site / "index.html", site / "knots" / "3_1.html"):
        tab.goto(page.as_uri())
        tab.wait_for_load_state()
        assert tab.evaluate("document.documentElement.scrollWidth") <= width
        back = tab.evaluate("getComputedStyle(document.body).backgroundColor")
        light = int(back.removeprefix("rgb(").partition(",")[0])
        assert light > 200 if scheme == "light" else light < 60
    tab.goto((site / "index.html").as_uri())
    roles = (
        ("searchbox", "Name"),
        ("combobox", "Family"),
        ("combobox", "Crossings"),
        ("combobox", "Published"),
    )
    for role, name in (*roles, ("button", "Light or dark"), ("columnheader", "published"), ("link", "8_18")):
        assert tab.get_by_role(role, name=name, exact=True).is_visible(), name
