"""Curves that are hardly meant: open chains are told, periodic boxes refused, and nothing else is."""

import numpy as np
import pytest
from numpy.typing import NDArray

from sono import starts
from sono.formats import FormatError, VertexFile, text
from sono.formats.doubts import closing_edge, jumps

Floats = NDArray[np.float64]

TREFOIL = starts.start("3_1")[0]


def parse_text(content: str) -> VertexFile:
    (raw,) = text.read(content, "k")
    return VertexFile.checked("k", raw)


def wrapped(curve: Floats, box: Floats, offset: Floats) -> tuple[Floats, NDArray[np.int64]]:
    """Wrap a curve into a box; return it, and the edges that jump through the box."""
    inside = np.mod(curve + offset, box)
    steps = [np.roll(v, -1, axis=0) - v for v in (curve, inside)]
    return inside, np.flatnonzero((abs(steps[0] - steps[1]) > 1e-6).any(axis=1))


def random_polygon(generator: np.random.Generator, n: int, kind: int) -> Floats:
    """Gaussian vertices, a random walk that closes, or vertices spread unevenly."""
    if kind == 0:
        return generator.normal(size=(n, 3))
    if kind == 1:
        steps = generator.normal(size=(n, 3))
        walk: Floats = np.cumsum(steps - steps.mean(axis=0), axis=0)
        return walk
    vertices: Floats = generator.uniform(size=(n, 3)) ** generator.uniform(0.2, 5) * generator.uniform(
        0.1, 1, 3
    )
    return vertices


def test_every_jump_through_a_box_is_found() -> None:
    generator = np.random.default_rng(1)
    seen = 0
    for trial in range(300):
        curve = random_polygon(generator, 200, 1) if trial % 2 else TREFOIL
        longest = np.linalg.norm(np.roll(curve, -1, axis=0) - curve, axis=1).max()
        box = np.maximum(generator.uniform(0.3, 1.1) * np.ptp(curve, axis=0), 5 * longest)
        inside, through = wrapped(curve, box, generator.uniform(size=3) * box)
        found, sizes = jumps([inside])
        assert found.tolist() == through.tolist()
        assert bool(sizes) == (len(through) > 0)
        assert all(size <= box["xyz".index(axis)] for axis, size in sizes.items())
        seen += len(through) > 0
    assert seen > 200


def test_jumps_in_a_link_are_found() -> None:
    rings = starts.start("Hopf")
    inside = [np.mod(ring + 0.4, [6.0, 6.0, 6.0]) for ring in rings]
    assert jumps(inside)[1]
    assert not jumps(rings)[1]


def test_the_jumps_are_named_with_their_lines() -> None:
    inside, through = wrapped(TREFOIL, np.array([5.0, 50.0, 50.0]), np.array([1.0, 20.0, 20.0]))
    with pytest.raises(FormatError) as caught:
        parse_text("# a comment\n" + text.write([inside], []))
    lines = ((through + 1) % len(inside) + 2).tolist()
    message = str(caught.value)
    assert message.startswith(f"k:{lines[0]}: a periodic box of about ")
    assert f"jumps {len(lines)} times, to the lines {', '.join(map(str, lines))}; unwrap it" in message


def test_polygons_and_sticks_jump_through_no_box() -> None:
    generator = np.random.default_rng(2)
    for n in range(4, 64):
        for kind in range(3):
            for _ in range(20):
                assert not jumps([random_polygon(generator, n, kind)])[1]


@pytest.mark.parametrize(
    ("name", "variant"),
    [
        *((name, variant) for name in ("4_1", "8_19", "10_165") for variant in (0, 1, -1)),
        *((name, 0) for name in ("chain3", "T(2,59)", "unknot")),
    ],
)
def test_the_library_is_beyond_doubt(name: str, variant: int) -> None:
    curve = starts.start(name, variant)
    assert not jumps(curve)[1]
    assert not any(map(closing_edge, curve))


def test_an_open_chain_is_told() -> None:
    walk = np.cumsum(np.random.default_rng(3).normal([0.5, 0, 0], size=(100, 3)), axis=0)
    chain = parse_text(text.write([TREFOIL, walk + 100], []))
    (doubt,) = chain.doubts()
    times = round(closing_edge(walk))
    assert times > 20
    there = "k:170: the edge that closes the curve, from here back to line 71"
    assert doubt.startswith(f"{there}, is {times} times the mean edge")


def test_closed_curves_are_no_open_chains() -> None:
    generator = np.random.default_rng(4)
    for n in range(3, 60):
        for kind in range(2):
            assert not closing_edge(random_polygon(generator, n, kind))
