"""Fourier series of knots, in Gilbert's and in Fremlin's files: sampled so finely that the type is sure."""

from collections.abc import Iterator, Mapping, Sequence
from contextlib import suppress

import numpy as np
import pytest
from knots import Floats, damaged, hopf, trefoil

from sono import formats, measure
from sono.formats import FormatError, VertexFile
from sono.formats.fourier import polygons
from sono.formats.vertices import Raw
from sono.invariants import fingerprint


def series(curve: Floats, highest: int) -> tuple[Floats, Floats]:
    """The coefficients A and B, each (highest + 1, 3), of a curve that has no higher harmonics."""
    waves = np.fft.rfft(curve, axis=0)[: highest + 1] / len(curve)
    a, b = 2 * waves.real, -2 * waves.imag
    a[0] /= 2
    return a.round(6) + 0.0, b.round(6) + 0.0


TREFOIL = series(trefoil(), 5)
HOPF = [series(ring, 1) for ring in hopf()]


def coefficients(a: Floats, b: Floats) -> str:
    """As in Gilbert's files, where the constant is twice the middle."""
    a = a * np.array([2.0, *[1.0] * (len(a) - 1)])[:, None]
    vectors = [[",".join(f"{x: .6f}" for x in vector) for vector in pair] for pair in zip(a, b, strict=True)]
    return "".join(
        f'  <Coeff I="{i:>3}" A="{x}" B="{y}" />\n'
        for i, (x, y) in enumerate(vectors)
        if np.any([a[i], b[i]])
    )


def knot(one: tuple[Floats, Floats], key: str = "3:1:1", more: str = 'L="91.45" D=" 2.000"') -> str:
    return f'<AB Id="{key}" Conway="3" {more}>\n{coefficients(*one)}</AB>\n'


def link(parts: Sequence[tuple[Floats, Floats]], inner: str = "STRING") -> str:
    strings = "".join(
        f'<{inner} I="{i}" L=" 18.849556">\n{coefficients(*part)}</{inner}>\n'
        for i, part in enumerate(parts, 1)
    )
    return f'<TL Id="L2a1" Conway="2" D=" 3.000000">\n{strings}</TL>\n'


def data(*knots: str) -> str:
    return f'<DATA Title="Database of Ideal Knots" Author="">\n{"".join(knots)}</DATA>\n'


def read(content: str, name: str = "ideal.txt") -> list[VertexFile]:
    return formats.parse(name, content.encode())


def raw(content: str, format: str = "ideal") -> Raw:
    (only,) = formats.READERS[format].read(content, "k")
    return only


def all_of(content: str) -> list[VertexFile]:
    return [VertexFile.checked("k", raw) for raw in formats.READERS["ideal"].read(content, "k")]


def test_a_knot_of_gilbert() -> None:
    (curve,) = read(data(knot(TREFOIL)))
    assert np.allclose(curve.components[0], trefoil(512), atol=2e-5)
    assert curve.doubts() == [
        "ideal.txt:2: the Fourier series was sampled at 512 points for each component",
        "ideal.txt:2: the file says L = 91.45 at the diameter 2: 91.45 over the radius",
    ]
    assert curve.where(0, 100) == "ideal.txt:2"


@pytest.mark.parametrize("inner", ["STRING", "Component"])
def test_a_link_of_gilbert(inner: str) -> None:
    (curve,) = read(data(link(HOPF, inner)))
    assert [np.allclose(a, b, atol=2e-5) for a, b in zip(curve.components, hopf(512), strict=True)] == [
        True,
        True,
    ]
    assert "L = 37.6991 at the diameter 3: 25.1327 over the radius" in curve.doubts()[-1]
    assert measure(curve.components).l_p == pytest.approx(8 * np.pi, rel=1e-4)


def test_a_database_holds_curves_by_their_ids() -> None:
    found = read(data(knot(TREFOIL), link(HOPF), knot(TREFOIL, "K11a1"), knot(TREFOIL)))
    assert [curve.key for curve in found] == ["3:1:1", "L2a1", "K11a1", "3:1:1.2"]
    # The first files had no element around them all, and numbers without quotes.
    bare = (knot(TREFOIL) + knot(TREFOIL, "K11a1")).replace('I="  1"', "I= 1")
    for content in (bare, bare.replace('"', "'"), data(bare).replace("\n", " ")):
        assert [curve.key for curve in read(content)] == ["3:1:1", "K11a1"]


def test_comments_and_declarations_are_read_over() -> None:
    (curve,) = read('<?xml version="1.0"?>\n<!-- <AB Id="0"> -->\n' + data(knot(TREFOIL)))
    assert curve.where(0, 0) == "ideal.txt:4"


def rows(a: Floats, b: Floats) -> str:
    table = np.stack([a, b], axis=2).reshape(len(a), 6)[1:]
    return "".join("".join(f"{x:12.6f}" for x in row) + "\n" for row in table.tolist())


FSERIES = "% Knot 3_1 (trefoil knot)\n" + rows(*TREFOIL)


def test_a_knot_of_fremlin() -> None:
    for name, content in (("k.fseries", FSERIES), ("k.txt", FSERIES), ("k.fseries", rows(*TREFOIL))):
        (curve,) = read(content, name)
        assert np.allclose(curve.components[0], trefoil(512), atol=2e-5)
    (moved,) = read(" % Knot\n % shortened\n   1.0  2.0  3.0\n" + rows(*TREFOIL) + "\n% the end\n\n", "k.txt")
    assert np.allclose(moved.components[0], trefoil(512) + np.array([1, 2, 3]), atol=2e-5)
    assert moved.comments == ["Knot", "shortened", "the end"]
    assert moved.doubts() == ["k.txt: the Fourier series of 5 harmonics was sampled at 512 points"]


def test_fine_detail_is_sampled_finely() -> None:
    """A long knot wound 200 times round a trefoil needs more points than the trefoil."""
    t = 2 * np.pi * np.arange(4096) / 4096
    wound = trefoil(4096) + 0.3 * np.column_stack([np.cos(200 * t), np.sin(200 * t), np.zeros_like(t)])
    (curve,) = polygons([series(wound, 201)])
    assert len(curve) > 1000
    assert fingerprint([curve]) == fingerprint([wound])
    assert fingerprint([curve]) == fingerprint([trefoil()])


@pytest.mark.parametrize("shape", ["twice round", "a point", "a line", "crossed", "huge"])
def test_curves_that_meet_themselves_are_refused(shape: str) -> None:
    t = 2 * np.pi * np.arange(64) / 64
    curves: Mapping[str, list[Floats]] = {
        "twice round": [np.column_stack([np.cos(2 * t), np.sin(2 * t), 0 * t])],
        "a point": [np.zeros((64, 3))],
        "a line": [np.column_stack([np.cos(t), 0 * t, 0 * t])],
        "crossed": [np.column_stack([np.sin(t), np.sin(2 * t), 0 * t])],
        "huge": [1e200 * trefoil(64)],
    }
    with pytest.raises(ValueError, match="the curve meets itself, or nearly"):
        polygons([series(curve, 5) for curve in curves[shape]])


IDEAL = data(knot(TREFOIL), link(HOPF))


def malformed() -> Iterator[tuple[str, str, str]]:
    yield "empty", "", ":1: the file holds no knot with an Id"
    yield "no knots", data(), ":1: the file holds no knot with an Id"
    yield "plain rows", "0 0 0\n1 0 0\n", ":1: the file holds no knot with an Id"
    yield "no Id", IDEAL.replace(' Id="3:1:1"', ""), ":3: this Coeff is in no knot with an Id"
    yield "cut off", IDEAL[: IDEAL.index("</AB>")], ":2: this ab is not ended; complete the file"
    yield (
        "cut in a tag",
        IDEAL[: IDEAL.index("</AB>") - 20],
        r":\d+: a tag begins here that is not ended by >",
    )
    yield "not ended", IDEAL.replace("</AB>\n", ""), r":\d: the ab on line 2 is still open; end it first"
    yield "an odd quote", IDEAL.replace('I="  2"', 'I="  2'), r":\d: a tag begins here that is not ended by >"
    yield "a tag in a tag", IDEAL.replace(" />\n", "\n", 1), ":3: a tag begins here that is not ended by >"
    yield "no A", IDEAL.replace(" A=", " C=", 1), ":3: A is '', but should be three numbers: x,y,z"
    yield "no B", IDEAL.replace(" B=", " C=", 1), ":3: B is '', but should be three numbers: x,y,z"
    yield "no I", IDEAL.replace('I="  1"', "", 1), ":3: I is '', but should be a whole number up to 4096"
    yield "I of words", IDEAL.replace('I="  1"', 'I="one"', 1), ":3: I is 'one', but should be"
    yield "I below zero", IDEAL.replace('I="  1"', 'I=" -1"', 1), ":3: I is '-1', but should be"
    yield "I too high", IDEAL.replace('I="  1"', 'I="99999"', 1), ":3: I is '99999', but should be"
    yield "I twice", IDEAL.replace('I="  2"', 'I="  1"', 1), ":4: the harmonic 1 comes twice"
    yield "two numbers", IDEAL.replace('A="', 'A="0.0,0.0" F="', 1), ":3: A is '0.0,0.0', but should be"
    yield "words", IDEAL.replace('A="', 'A="a, b, c" F="', 1), ":3: A is 'a, b, c', but should be"
    yield "decimal commas", IDEAL.replace('A="', 'A="0,5, 0,5, 0,5" F="', 1), ":3: A is '0,5, 0,5, 0,5', but"
    yield "not finite", IDEAL.replace('A="', 'A="nan,0,0" F="', 1), ":2: the curve meets itself, or nearly"
    yield "no Coeff", data('<AB Id="0">\n</AB>\n'), ":2: this ab has no Coeff above 0"
    yield "a still string", IDEAL.replace('I="  1" A', 'I="  0" A', 9), r":\d+: .*"
    yield (
        "a circle twice",
        data(knot((np.zeros((3, 3)), TREFOIL[1][:3]))),
        ":2: the curve meets itself, or nearly",
    )


@pytest.mark.parametrize(("content", "message"), [pytest.param(b, c, id=a) for a, b, c in malformed()])
def test_what_is_wrong_with_gilberts_is_said_in_one_line(content: str, message: str) -> None:
    with pytest.raises(FormatError, match=rf"^k{message}") as caught:
        all_of(content)
    assert "\n" not in str(caught.value)


def malformed_fseries() -> Iterator[tuple[str, str, str]]:
    nothing = ":1: the file holds no rows of six numbers"
    lines = FSERIES.splitlines(keepends=True)
    yield "empty", "", nothing
    yield "comments alone", "% Knot\n%\n", nothing
    yield "a middle alone", "% Knot\n0 0 0\n", nothing
    yield "plain rows", "0 0 0\n1 0 0\n0 1 0\n", ":2: 3 columns; give six: cos and sin of x, of y and of z"
    yield "five columns", FSERIES.replace("    0.000000\n", "\n", 1), r":\d: 5 columns; give six"
    yield (
        "seven columns",
        FSERIES.replace("\n", " 0\n", 2).replace("knot) 0", "knot)"),
        ":2: 7 columns; give six",
    )
    yield "two columns first", "% k\n0 0\n" + rows(*TREFOIL), ":2: 2 columns; give six"
    yield "a middle late", FSERIES + "0 0 0\n", ":7: 3 columns; give six"
    yield "cut off", FSERIES[:-14], ":6: 5 columns; give six"
    yield (
        "words",
        FSERIES.replace("% Knot", "Knot"),
        ":1: 'Knot' is not a number; begin lines that are comments",
    )
    yield "another comment", FSERIES.replace("% Knot", "# Knot"), ":1: '#' is not a number; begin lines"
    yield "commas", FSERIES.replace("    0.0", ", 0.0"), r":\d: '.*,' is not a number"
    yield "decimal commas", FSERIES.replace("0.0", "0,0"), ":2: '0,0.*' is not a number"
    yield "two series", FSERIES + FSERIES, ":8: a second series begins here; give each a file of its own"
    yield "a blank line", "".join([*lines[:3], "\n", *lines[3:]]), ":5: a second series begins here"
    yield "a comment within", "".join([*lines[:3], "% more\n", *lines[3:]]), ":5: a second series begins here"
    yield "not finite", FSERIES.replace("0.000000", "nan", 1), ":2: the curve meets itself, or nearly"
    yield "infinite", FSERIES.replace("0.000000", "inf", 1), ":2: the curve meets itself, or nearly"
    yield "huge", FSERIES.replace("0.000000", "1e300", 1), ":2: the curve meets itself, or nearly"
    yield "still", "% k\n0 0 0 0 0 0\n", ":2: the curve meets itself, or nearly"
    yield "flat", "% k\n1 0 0 0 0 0\n", ":2: the curve meets itself, or nearly"


@pytest.mark.parametrize(
    ("content", "message"), [pytest.param(b, c, id=a) for a, b, c in malformed_fseries()]
)
def test_what_is_wrong_with_fremlins_is_said_in_one_line(content: str, message: str) -> None:
    with pytest.raises(FormatError, match=rf"^k{message}") as caught:
        raw(content, "fseries")
    assert "\n" not in str(caught.value)


@pytest.mark.filterwarnings("error")
@pytest.mark.parametrize(("format", "content"), [("ideal", data(knot(TREFOIL))), ("fseries", FSERIES)])
def test_damaged_files_raise_nothing_else(format: str, content: str) -> None:
    for text in damaged(content, 60):
        with suppress(FormatError):
            formats.READERS[format].read(text, "k")
