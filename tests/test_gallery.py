"""The gallery shows what the atlas has, with pictures that are there, and small."""

import re

import make_gallery
import pytest

import sono

pytestmark = pytest.mark.skipif(not make_gallery.PAGE.exists(), reason="needs the source tree")

NAMES = [name for ropes in make_gallery.SHOWN.values() for name in ropes]


def test_the_page_is_that_of_the_atlas() -> None:
    assert make_gallery.PAGE.read_text(encoding="utf-8") == make_gallery.page(), (
        "write it anew: python -m tests.make_gallery"
    )


def test_each_rope_has_a_small_picture_and_no_other_is_there() -> None:
    files = {make_gallery.picture_of(name) for name in NAMES}
    assert files == set(make_gallery.PICTURES.iterdir())
    assert len(files) == len(NAMES)
    for file in files:
        data = file.read_bytes()
        assert data.startswith(b"\x89PNG"), file.name
        assert len(data) <= 12_000, file.name


@pytest.mark.parametrize("name", ["3_1", "Hopf"])
def test_the_figures_are_those_of_the_rope(name: str) -> None:
    measures = sono.measure(sono.start(name, known=True))
    found = re.search(rf"<b>{name}</b><br>L_a ([\d.]+)<br>L_c ([\d.]+)<", make_gallery.page())
    assert found
    assert measures.l_a
    assert measures.l_c
    assert abs(float(found[1]) - measures.l_a) <= 5.1e-5
    assert float(found[2]) <= measures.l_c + 1e-4
