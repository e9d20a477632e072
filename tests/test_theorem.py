"""The theorem of docs/explanation/theorem.md, seen on K_P itself: it is as thick as R_c, sampled wherever."""

import re
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st
from test_check_certificate import beds, bump, hopf, ring, stadium

import sono
from sono import check_certificate, check_thickness, starts

CURVES: dict[str, Callable[[], Any]] = {
    "ring": lambda: [ring(12)],
    "uneven": lambda: [ring(30, seed=3)],
    "bump": lambda: [bump()],
    "beds": lambda: [beds(0.9)],
    "stadium": lambda: [stadium(2.0)],
    "hopf": lambda: hopf(30, 41),
    "trefoil": lambda: list(starts.known("3_1") or ()),
    "9_1": lambda: list(starts.known("9_1") or ()),
}


def inscribed(vertices: Any, parts: int) -> tuple[Any, Any]:
    """Points on K_P, so many on each of its arcs, and the tangents there (m, 3), both exact to rounding."""
    edges = np.roll(vertices, -1, axis=0) - vertices
    lengths = np.linalg.norm(edges, axis=1)[:, None]
    onward = edges / lengths
    forward = np.roll(onward, 1, axis=0)
    tangent = np.minimum(lengths, np.roll(lengths, 1, axis=0)) / 2
    angle = np.arctan2(np.linalg.norm(np.cross(forward, onward), axis=1), (forward * onward).sum(axis=1))[
        :, None
    ]
    inward = onward - forward * np.cos(angle)
    inward /= np.maximum(np.linalg.norm(inward, axis=1), 1e-300)[:, None]
    radius = tangent / np.maximum(np.tan(angle / 2), 1e-12)
    points, tangents = [vertices + edges / 2], [onward]
    for share in np.linspace(0, 1, parts):
        turn = share * angle
        along, across = radius * np.sin(turn), 2 * radius * np.sin(turn / 2) ** 2
        points.append(vertices + (along - tangent) * forward + across * inward)
        tangents.append(np.cos(turn) * forward + np.sin(turn) * inward)
    return np.vstack(points), np.vstack(tangents)


def thickness(components: Any, parts: int = 5) -> float:
    """The least radius of a circle that touches K_P at one of these points and goes through another one."""
    pairs = [inscribed(np.asarray(part), parts) for part in components]
    points, tangents = (np.vstack(of) for of in zip(*pairs, strict=True))
    size = np.ptp(points, axis=0).max()
    least = np.inf
    for x, t in zip(points, tangents, strict=True):
        ways = points - x
        off = np.linalg.norm(np.cross(ways, t), axis=1)
        seen = off > 1e-7 * size  # nearer than that rounding decides
        least = min(least, ((ways[seen] ** 2).sum(axis=1) / (2 * off[seen])).min(initial=np.inf))
    return float(least)


@pytest.mark.parametrize("name", CURVES)
def test_the_rope_is_as_thick_as_said(name: str) -> None:
    curve = CURVES[name]()
    r_c = sono.measure(curve).r_c
    assert r_c
    found = thickness(curve)
    assert r_c * (1 - 1e-6) <= found
    assert found < 1.3 * r_c


@given(
    st.integers(0, 10**9),
    st.integers(8, 40),
    st.floats(0, 0.45),
    st.floats(0, 0.4),
    st.floats(0.3, 1),
)
@settings(max_examples=200, deadline=None)
def test_whatever_the_edges(seed: int, n: int, uneven: float, waves: float, narrow: float) -> None:
    """Rings with edges of all lengths, wavy and flattened, where the theorem has a bound."""
    draw = np.random.default_rng(seed)
    t = 2 * np.pi * (np.arange(n) + draw.uniform(-uneven, uneven, n)) / n
    wave = waves * np.sin(draw.integers(1, 4) * t + draw.uniform(0, 6))
    curve = np.column_stack([(1 + wave) * np.cos(t), narrow * (1 + wave) * np.sin(t), waves * np.sin(2 * t)])
    try:
        r_c = sono.measure(curve).r_c or 0.0
    except sono.CurveError:
        r_c = 0.0
    assume(r_c)
    assert r_c * (1 - 1e-6) <= thickness([curve], 3)


def test_lines_that_are_pointed_to_are_there() -> None:
    page = Path(__file__).parent.parent / "docs" / "explanation" / "theorem.md"
    if not page.is_file():
        pytest.skip("needs the source tree")
    lines = set(re.findall(r"^- \(([TDPC]\d+)\)", page.read_text(encoding="utf-8"), re.MULTILINE))
    paths = [Path(str(module.__file__)) for module in (check_certificate, check_thickness)]
    named = set(re.findall(r"\(([TDPC]\d+)\)", "".join(path.read_text(encoding="utf-8") for path in paths)))
    assert named <= lines
    assert {"T1", "T2", "T3", *(f"C{number}" for number in range(1, 10)), "T5", "T6", "T7", "C11"} <= named
