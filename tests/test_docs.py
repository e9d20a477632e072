"""The documentation is true: what it says is run, what is generated is up to date, and the site builds."""

import os
import re
import shutil
import subprocess
import sys
from contextlib import suppress
from pathlib import Path

import pytest

if os.name != "posix":
    pytest.skip("needs a shell", allow_module_level=True)

import make_docs
import pages

from sono import tables
from sono.cli import COMMANDS

HOME = pages.DOCS.parent
PAGES = sorted([*pages.DOCS.rglob("*.md"), HOME / "README.md"]) if pages.DOCS.is_dir() else []

pytestmark = pytest.mark.skipif(not PAGES, reason="needs the source tree")


def named(page: Path) -> str:
    return page.relative_to(HOME).as_posix()


each_page = pytest.mark.parametrize("page", PAGES, ids=named)


def found(page: Path) -> list[pages.Block]:
    return list(pages.blocks(page.read_text(encoding="utf-8")))


@pytest.mark.slow
@pytest.mark.parametrize(
    "page", [page for page in PAGES if found(page) and page.name != "python.md"], ids=named
)
def test_what_a_page_says_is_so(page: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    # The examples on the page of Python are those of docstrings, which test_doctests runs.
    folder = tmp_path / "reader"
    folder.mkdir()
    monkeypatch.chdir(folder)
    monkeypatch.setenv("MPLBACKEND", "Agg")
    reader = pages.Reader(folder)
    reader.fetch(page)
    for block in found(page):
        if not block.skipped:
            reader.do(block, named(page))


@each_page
def test_blocks_are_of_kinds_that_are_run_or_show_something(page: Path) -> None:
    text = page.read_text(encoding="utf-8")
    assert text.count("```") == 2 * len(found(page))
    assert {block.kind for block in found(page)} <= {"sh", "console", "python", "pycon", "py", "text", "json"}
    assert {block.skipped for block in found(page)} <= {None, *pages.REASONS}
    shown = [block.text for block in found(page) if block.kind == "text"]
    assert not any(re.match(r"\$ |>>> ", text) for text in shown), "a text that looks as if it were run"


def test_generated_parts_are_those_of_the_code() -> None:
    for path, text in make_docs.pages():
        there = (pages.DOCS / path).read_text(encoding="utf-8")
        assert there == text, f"{path}: write it anew: python tests/make_docs.py"
    commands = {path.stem for path in pages.DOCS.glob("reference/commands/*.md")}
    assert commands == {"index", *COMMANDS}


def test_each_column_and_each_setting_is_told() -> None:
    text = (pages.DOCS / "reference" / "tables.md").read_text(encoding="utf-8")
    told = re.findall(r"^\| `(\w+)` \| (.*?) \|", text, re.MULTILINE)
    assert told == [(key, column.header) for key, column in tables.COLUMNS.items()]


@each_page
def test_links_lead_somewhere(page: Path) -> None:
    text = re.sub(r"```.*?```|`[^`]*`", "", page.read_text(encoding="utf-8"), flags=re.DOTALL)
    for link in re.findall(r"\]\(([^)\s]+)\)", text):
        path, _, _ = link.partition("#")
        if path and ":" not in path:
            assert (page.parent / path).exists(), link


@pytest.fixture(scope="module")
def site(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The documentation as a site."""
    zensical = shutil.which("zensical", path=Path(sys.executable).parent)
    if not zensical:
        pytest.skip("needs sono[docs]")
    folder = tmp_path_factory.mktemp("docs")
    for name in ("mkdocs.yml", "CHANGELOG.md"):
        shutil.copy(HOME / name, folder)
    shutil.copytree(pages.DOCS, folder / "docs")
    command = [zensical, "build", "--strict", "--clean"]
    done = subprocess.run(command, cwd=folder, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stdout + done.stderr
    return folder / "site"


@pytest.mark.slow
def test_the_site_needs_no_network(site: Path) -> None:
    for page in site.rglob("*.html"):
        text = page.read_text(encoding="utf-8")
        assert not re.search(r"<(?:script|link|img|iframe)[^>]*(?:src|href)=\"?(?:https?:)?//", text), page


@pytest.mark.slow
def test_the_site_is_searched_from_a_disk(site: Path) -> None:
    sync_api = pytest.importorskip("playwright.sync_api", reason="needs playwright")
    from test_view_browser import CHROMIUM

    if not CHROMIUM:
        pytest.skip("needs Chromium on the PATH")
    with sync_api.sync_playwright() as playwright:
        browser = playwright.chromium.launch(executable_path=CHROMIUM, args=["--no-sandbox"])
        page = browser.new_page()
        asked: list[str] = []
        page.on("request", lambda request: asked.append(request.url))
        page.goto((site / "reference" / "names.html").as_uri())
        for _ in range(20):  # keys are heard when the page's script has begun, some time after it is there
            page.keyboard.press("/")
            with suppress(sync_api.TimeoutError):
                page.wait_for_function("document.activeElement !== document.body", timeout=3_000)
                break
        page.keyboard.type("bracelet", delay=50)  # as hands do: an answer comes between two letters
        page.get_by_text("For a bracelet").first.wait_for(timeout=60_000)
        assert all(url.startswith(("file:", "data:", "blob:", "about:")) for url in asked)
        browser.close()


@pytest.mark.parametrize(
    ("want", "got", "alike"),
    [
        ("3_1  480  32.74", "3_1\t480\t32.739828", True),
        ("3_1  480  32.74", "3_1 480 32.75", False),
        ("480", "481", False),
        ("1.2e-9", "7.7e-10", True),
        ("1.2e-9", "1.2e-3", False),
        ("took 2.5 s", "took 11.25 s", True),
        ("a\n...\nz", "a b c\nz", True),
        ("a\n...\nz", "a b c\n", False),
        ("a", "a b", False),
        ("a b", "a", False),
        ("0.0682", "0.0682x", False),
    ],
)
def test_outputs_are_compared_word_by_word(want: str, got: str, alike: bool) -> None:
    assert pages.same(want, got) == alike
