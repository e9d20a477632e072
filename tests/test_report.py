"""The pages of many ropes, without a browser: which files there are, and that what they say is so."""

import json
import re
import subprocess
import sys
import time
from collections.abc import Callable, Iterator
from html.parser import HTMLParser
from itertools import pairwise, product
from pathlib import Path
from typing import Any
from urllib.parse import unquote

import numpy as np
import pytest
from conftest import Sono
from numpy.typing import NDArray

import sono as package
from sono import starts
from sono.check_certificate import check
from sono.figures.thumbnail import EDGE, SIZE, drawing
from sono.figures.turning import principal
from sono.formats import read, write

Site = Callable[..., Path]


class Links(HTMLParser):
    """Collects what a page links to, and its texts."""

    def __init__(self, html: str) -> None:
        super().__init__()
        self.links: list[str] = []
        self.tags: list[str] = []
        self.text = ""
        self.feed(html)

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        self.tags.append(tag)
        self.links += [value for key, value in attrs if key in ("href", "src") and value]

    def handle_data(self, data: str) -> None:
        self.text += data


@pytest.fixture
def site(sono: Sono, folder: Path) -> Site:
    """Run `sono report` with arguments, and return the folder that it wrote."""

    def write_site(*given: str, code: int = 0) -> Path:
        done = sono("report", *given, "-o", "site", "-q")
        assert done.exit_code == code, done.stderr
        return folder / "site"

    return write_site


def report(site: Path) -> dict[str, Any]:
    """Return the data of the table."""
    text = (site / "assets" / "ropes.js").read_text(encoding="utf-8")
    found: dict[str, Any] = json.loads(text.removeprefix("const report = ").removesuffix(";\n"))
    return found


def rows(site: Path) -> dict[str, dict[str, Any]]:
    return {row["knot"]: row for row in report(site)["ropes"]}


def shown(path: Path) -> dict[str, Any]:
    """Return what the page of a rope shows."""
    text = path.read_text(encoding="utf-8").partition("textContent = ")[2].removesuffix(";\n")
    (found,) = json.loads(json.loads(text))
    return dict(found)


def test_every_link_is_there(site: Site) -> None:
    done = site("3_1", "4_1#m3_1", "T(2,5)", "Hopf", "3_1.txt")
    pages = sorted(done.rglob("*.html"))
    assert len(pages) == 6
    for page in pages:
        for link in Links(page.read_text(encoding="utf-8")).links:
            assert link == "data:," or (page.parent / unquote(link)).is_file(), (page, link)
    for row in report(done)["ropes"]:
        assert (done / unquote(row["page"])).is_file()
    assert {path.name for path in (done / "assets").iterdir()} == {
        *("view.js", "view.css", "index.js", "index.css", "ropes.js")
    }


def test_nothing_is_fetched(site: Site) -> None:
    done = site("3_1")
    for path in (done / "index.html", *(done / "assets").iterdir()):
        text = path.read_text(encoding="utf-8").replace('xmlns="http://www.w3.org/2000/svg"', "")
        assert not re.search(r"https?://|@import|url\(|\bimport\b|fetch\(|XMLHttp|\beval\b", text), path


def test_figures_are_those_of_the_vertices_as_written(site: Site) -> None:
    done = site("8_18", "L4a1", "3_1.txt")
    for name, row in rows(done).items():
        curve = read(done / f"{row['at']}.txt")
        m = package.measure(curve.components)
        assert (row["n"], row["dl"], row["l_p"], row["l_a"]) == (m.n, m.dl / m.r_s, m.l_p, m.l_a)
        data = shown(done / f"{row['at']}.js")
        assert dict(data["rows"])["L_p"] == f"{m.l_p:.6f}"
        assert row["type"] == data["type"] == package.identify(curve.components).name
        assert name in ("8_18", "L4a1", "3_1")
    knot = rows(done)["8_18"]
    assert (knot["family"], knot["crossings"], knot["published"]) == ("knots", 8, 74.9063)
    assert knot["l_a_difference"] == knot["l_a"] - knot["published"]
    assert knot["l_c_fine"] < knot["l_c"]


def test_vertices_are_those_that_start_writes(site: Site, sono: Sono) -> None:
    done = site("m8_20", "Hopf")
    for name, path in (("m8_20", "knots/m8_20.txt"), ("Hopf", "links/Hopf.txt")):
        sono("start", name, "--known", "-o", "other.txt", "--force")
        assert (done / path).read_bytes() == (done.parent / "other.txt").read_bytes()


def test_certificates_hold(site: Site) -> None:
    done = site("3_1", "3_1#3_1")
    for row in report(done)["ropes"]:
        base = done / row["at"]
        proven = check(f"{base}.certificate.json", f"{base}.txt")
        assert float(proven["l_c"]) <= row["l_c"] <= float(proven["l_c"]) + 1.1e-6
        assert row["l_c"] >= package.measure(read(f"{base}.txt").components).l_c


def test_a_rope_of_which_nothing_is_proven(site: Site, folder: Path) -> None:
    angle = np.arange(4) * np.pi / 2
    write(folder / "ring.txt", [np.column_stack([np.cos(angle), np.sin(angle), 0 * angle])])
    done = site("ring.txt")
    (row,) = report(done)["ropes"]
    assert row["l_c"] is None
    assert (row["type"], row["crossings"]) == ("0_1", 0)
    assert (row["family"], row["published"]) == ("knots", pytest.approx(2 * np.pi))
    assert not list(done.rglob("*.certificate.json"))
    assert "Proven bound" in (text := Links((done / "others" / "ring.html").read_text()).text)
    assert "None: " in text


def test_published_lengths_have_their_sources(site: Site) -> None:
    done = site("3_1")
    text = Links((done / "knots" / "3_1.html").read_text()).text
    assert "32.7436" in text
    assert "32.7457" in text  # of another source
    assert "ACPR 2011" in text
    assert "J. Knot Theory" in text or "Ashton" in text


def test_the_type_decides_and_not_the_name(sono: Sono, folder: Path) -> None:
    write(folder / "4_1.n100.txt", starts.start("5_1"))
    write(folder / "mine.txt", starts.start("6_2"))
    done = sono("report", "4_1.n100.txt", "mine.txt", "-o", "site")
    assert done.exit_code == 0
    assert "sono: 4_1.n100: is no 4_1 but 5_1, with which it is compared" in done.stderr
    found = rows(folder / "site")
    assert found["4_1.n100"]["crossings"] == 5
    assert found["4_1.n100"]["published"] == pytest.approx(47.2, abs=0.1)
    assert (found["mine"]["family"], found["mine"]["crossings"]) == ("knots", 6)
    assert found["mine"]["published"] > 50


def test_a_folder_is_its_files_of_curves(site: Site, folder: Path) -> None:
    results = folder / "tight"
    results.mkdir()
    for name in ("10_1", "3_1", "4_1"):
        write(results / f"{name}.n90.txt", starts.start(name))
    write(results / "rings.vect", starts.start("Hopf"))
    for other in (
        "3_1.certificate.json",
        "rows.tsv",
        "picture.png",
        ".hidden.txt",
        "README",
        "3_1.n90.contacts.tsv",
    ):
        (results / other).write_text("nothing\n")
    (results / "rows.csv").write_text("knot,n,l_a\n3_1,90,33.0\n")
    (results / "deeper").mkdir()
    done = site("tight")
    assert list(rows(done)) == ["3_1.n90", "4_1.n90", "10_1.n90", "rings"]


def test_what_tighten_writes(sono: Sono, site: Site) -> None:
    sono("tighten", "3_1", "4_1", "-n", "60", "-o", "tight/", "-q")
    found = rows(site("tight/"))
    assert list(found) == ["3_1.n60", "4_1.n60"]
    assert found["3_1.n60"]["type"] == "3_1"


def test_a_family_and_a_folder_of_its_name(sono: Sono, folder: Path) -> None:
    (folder / "torus").mkdir()
    write(folder / "torus" / "mine.txt", starts.start("3_1"))
    (folder / "composites").mkdir()
    done = sono("report", "composites", "torus/", "-o", "all")
    assert "composites: is of the atlas, and not the folder" in done.stderr
    assert done.exit_code == 0
    found = rows(folder / "all")
    assert list(found)[-1] == "mine"
    assert len(found) > 5
    assert {row["family"] for row in found.values()} == {"composites", "knots"}
    assert all(row["type"] == name for name, row in found.items() if name != "mine")


def test_several_curves_of_one_file_and_of_one_name(site: Site, folder: Path) -> None:
    for name in ("a", "b"):
        (folder / name).mkdir()
        write(folder / name / "3_1.txt", starts.start("3_1"))
    frames = 2 * "3\nframe\nA 0 0 0\nA 1 0 0\nA 0 1 0\n"
    (folder / "frames.xyz").write_text(frames)
    done = site("a", "b", "frames.xyz")
    pages = [row["at"] for row in report(done)["ropes"]]
    assert pages[:2] == ["knots/3_1", "knots/3_1-2"]
    assert len(set(pages)) == 4


def test_a_bad_file_is_a_row_less(sono: Sono, folder: Path) -> None:
    (folder / "bad.txt").write_text("0 0 0\n1 0 0\nx\n")
    (folder / "flat.txt").write_text("0 0 0\n1 0 0\n1 1 0\n0 0 0\n1 1 1\n")
    done = sono("report", "3_1", "bad.txt", "nosuch.txt", "flat.txt", "4_1", "-o", "site", "-q")
    assert done.exit_code == 1
    assert [line.split(":")[1].strip() for line in done.stderr.splitlines()] == [
        "bad.txt",
        "nosuch.txt",
        "flat.txt",
    ]
    assert list(rows(folder / "site")) == ["3_1", "4_1"]
    assert "../knots/4_1.html" in Links((folder / "site" / "knots" / "3_1.html").read_text()).links


def test_an_empty_folder(sono: Sono, folder: Path) -> None:
    (folder / "none").mkdir()
    done = sono("report", "none", "-o", "site")
    assert done.exit_code == 1
    assert done.stderr.startswith("sono: none: no file of a curve is in this folder")
    assert done.stderr.count("\n") == 1
    assert not (folder / "site").exists()


def test_a_report_is_not_overwritten(sono: Sono, folder: Path) -> None:
    assert (
        sono("report", "3_1", "-o", "site").stderr
        == f"sono: {Path('site', 'index.html')}: 1 rope, to be opened in a browser\n"
    )
    before = {path: path.read_bytes() for path in (folder / "site").rglob("*.*")}
    again = sono("report", "4_1", "-o", "site")
    assert again.exit_code == 2
    assert "--force" in again.stderr
    assert {path: path.read_bytes() for path in (folder / "site").rglob("*.*")} == before
    assert sono("report", "3_1", "-o", "site", "--force", "-q").stderr == ""
    assert {path: path.read_bytes() for path in (folder / "site").rglob("*.*")} == before


def test_a_file_in_the_way(sono: Sono, folder: Path) -> None:
    (folder / "site").mkdir()
    (folder / "site" / "knots").write_text("")
    done = sono("report", "3_1", "Hopf", "-o", "site", "-q")
    assert done.exit_code == 1
    assert "knots: cannot be made" in done.stderr
    assert list(rows(folder / "site")) == ["Hopf"]
    (folder / "file").write_text("")
    assert sono("report", "3_1", "-o", "file").exit_code == 2


EVIL = "<img src=x onerror=alert(1)> & \"'#%?"


def test_names_are_only_text(site: Site, folder: Path) -> None:
    write(folder / f"{EVIL}.txt", starts.start("3_1"))
    done = site(f"{EVIL}.txt", "--title", f"</title>{EVIL} $title")
    index = Links((done / "index.html").read_text(encoding="utf-8"))
    assert "img" not in index.tags
    assert f"</title>{EVIL} $title" in index.text
    (row,) = report(done)["ropes"]
    assert row["knot"] == EVIL
    page = Links((done / unquote(row["page"])).read_text(encoding="utf-8"))
    assert "img" not in page.tags
    assert EVIL in page.text
    assert "<" not in (done / "assets" / "ropes.js").read_text(encoding="utf-8")


@pytest.mark.slow
def test_jobs_make_the_same(sono: Sono, folder: Path) -> None:
    names = ("3_1", "4_1", "bad.txt", "Hopf")
    (folder / "bad.txt").write_text("x\n")
    for jobs in ("1", "2"):
        done = sono("report", *names, "-o", f"site{jobs}", "--title", "t", "-j", jobs, "-q")
        assert done.exit_code == 1
        assert done.stderr.startswith("sono: bad.txt:1: ")
    one, two = ({path.relative_to(folder / site): path.read_bytes() for path in (folder / site).rglob("*.*")}
                for site in ("site1", "site2"))  # fmt: skip
    assert one == two


@pytest.mark.slow
@pytest.mark.skipif(not Path("/proc").is_dir(), reason="looks for processes in /proc")
def test_no_process_outlives_a_report_that_is_killed(folder: Path) -> None:
    run = "from sono.cli import run; run()"
    command = [sys.executable, "-c", run, "report", "composites", "-o", "site", "-j", "2", "-q"]
    with subprocess.Popen(command, cwd=folder) as report:
        wait_for(lambda: list((folder / "site").rglob("*.txt")))
        workers = children(report.pid)
        report.kill()
    assert len(workers) >= 2
    wait_for(lambda: not any(Path(f"/proc/{worker}/cwd").exists() for worker in workers))


def children(process: int) -> list[str]:
    """Return the processes that one has begun."""
    return Path(f"/proc/{process}/task/{process}/children").read_text().split()


def wait_for(what: Callable[[], object], seconds: float = 120) -> None:
    end = time.monotonic() + seconds
    while not what():
        assert time.monotonic() < end
        time.sleep(0.1)


# The drawings


def lines(path: str) -> Iterator[NDArray[np.int64]]:
    """Give the points of each line of a path."""
    for line in path.removesuffix("z").split("M")[1:]:
        first, _, steps = line.partition("l")
        numbers = [*map(int, re.findall(r"-?\d+", f"{first} {steps}"))]
        yield np.cumsum(np.array(numbers).reshape(-1, 2), axis=0)


def nearest(points: NDArray[Any], pixels: NDArray[Any]) -> tuple[NDArray[Any], NDArray[Any]]:
    """Return how far each pixel is from the nearest point, and which that is."""
    apart = np.linalg.norm(pixels[:, None] - points[None, :, :2], axis=2)
    return apart.min(axis=1), apart.argmin(axis=1)


@pytest.mark.parametrize("name", ["Hopf", "Borromean", "L8n3", "L9a1", "T(2,4)", "T(4,4)"])
def test_what_is_nearer_to_the_eye_is_in_front(name: str) -> None:
    rope = list(package.start(name, known=True))
    frame = principal(np.concatenate(rope))
    seen = [component @ frame.T * [1, -1, 1] for component in rope]
    every = np.concatenate(seen)
    middle, wide = (every.max(axis=0) + every.min(axis=0)) / 2, np.ptp(every, axis=0)[:2].max()
    scale = (SIZE - 2 * EDGE) / (wide + 2)
    pixels = np.array(list(product(range(2, SIZE, 4), repeat=2)))
    there, painted = np.full((2, len(pixels)), -1)
    height = np.full(len(pixels), -np.inf)
    for c, component in enumerate(seen):
        points = (component - middle) * scale + [SIZE / 2, SIZE / 2, 0]
        for x, y, z in points:
            above = np.hypot(*(pixels - [x, y]).T) < 0.8 * scale
            there[above & (z > height)] = c
            height[above] = np.maximum(height[above], z)
    found = drawing(rope)
    for c, path in (pair for layer in found.layers for pair in layer):
        for line in lines(path):
            dense = np.concatenate([np.linspace(a, b, 8) for a, b in pairwise(line)] + [line])
            painted[nearest(dense, pixels)[0] < 0.9 * scale] = c
    seen_at = there >= 0
    assert seen_at.mean() > 0.3
    assert (painted == there)[seen_at].mean() > 0.92


@pytest.mark.parametrize("name", ["3_1", "8_18", "10_165", "Borromean", "T(2,5)", "3_1#4_1"])
def test_a_drawing_is_small_and_in_its_box(name: str) -> None:
    found = drawing(package.start(name, known=True))
    assert sum(len(path) for layer in found.layers for _, path in layer) < 3000
    for points in (line for layer in found.layers for _, path in layer for line in lines(path)):
        assert (points >= found.width / 2 - 1).all()
        assert (points <= SIZE - found.width / 2 + 1).all()


@pytest.mark.parametrize("scale", [1e-6, 1e5])
def test_a_drawing_is_of_any_scale(scale: float) -> None:
    rope = package.start("4_1", known=True)
    assert drawing([scale * component for component in rope]) == drawing(rope)


def test_a_loose_curve_and_a_coarse_one() -> None:
    assert drawing(starts.start("T(3,40)")).layers
    assert drawing([[0, 0, 0], [1, 0, 0], [0, 1, 0]]).layers
