"""Tubes: closed, outward, as near to the smooth tube as was asked for, and never through themselves."""

import itertools
import math

import numpy as np
import pytest
from numpy.typing import NDArray

import sono
from sono import _core
from sono.curve import Components, CurveLike, Floats
from sono.figures import tube as tubes


def circle(radius: float, n: int) -> Floats:
    angles = np.linspace(0, math.tau, n, endpoint=False)
    return radius * np.stack([np.cos(angles), np.sin(angles), 0 * angles], axis=1)


def wavy(n: int) -> Floats:
    """A curve that bends and twists everywhere, of holonomy far from 0."""
    t = np.linspace(0, math.tau, n, endpoint=False)
    return np.stack(
        [(5 + np.cos(3 * t)) * np.cos(2 * t), (5 + np.cos(3 * t)) * np.sin(2 * t), np.sin(3 * t)], axis=1
    )


def volume(mesh: tubes.Mesh) -> float:
    a, b, c = np.moveaxis(mesh.vertices[mesh.faces], 1, 0)
    return float(np.sum(a * np.cross(b, c)) / 6)


def is_closed(faces: NDArray[np.int64]) -> bool:
    """Whether each edge is passed once in each direction."""
    edges = np.concatenate([faces[:, [0, 1]], faces[:, [1, 2]], faces[:, [2, 0]]])
    forward, times = np.unique(edges, axis=0, return_counts=True)
    return bool((times == 1).all() and (forward == np.unique(edges[:, ::-1], axis=0)).all())


def off(mesh: tubes.Mesh, line: Components, radius: float) -> float:
    """Return how far points of facets are from the tube round lines that are dense."""
    rng = np.random.default_rng(1)
    weights = rng.dirichlet([0.5, 0.5, 0.5], 1500)
    points = np.einsum("pk,pkd->pd", weights, mesh.vertices[rng.choice(mesh.faces, 1500)])
    dense = np.concatenate(line)
    nearest = [np.linalg.norm(dense - point, axis=1).min() for point in points]
    return float(np.abs(np.array(nearest) - radius).max())


def test_a_torus_has_the_volume_and_the_area_of_one() -> None:
    mesh = tubes.tube(circle(3, 400), 1, 200)
    a, b, c = np.moveaxis(mesh.vertices[mesh.faces], 1, 0)
    area = np.linalg.norm(np.cross(b - a, c - a), axis=1).sum() / 2
    assert volume(mesh) == pytest.approx(math.tau * 3 * math.pi, rel=1e-3)
    assert area == pytest.approx(math.tau * 3 * math.tau, rel=1e-3)


@pytest.mark.parametrize(
    "line", [circle(3, 5), wavy(200), wavy(200)[::-1]], ids=["coarse", "wavy", "reversed"]
)
def test_a_tube_is_closed_and_outward(line: Floats) -> None:
    mesh = tubes.tube(line, 0.3, 9)
    assert is_closed(mesh.faces)
    assert volume(mesh) > 0
    assert len(np.unique(mesh.faces)) == len(mesh.vertices) == 9 * len(line)
    assert len(mesh.vertices) - 3 * len(mesh.faces) // 2 + len(mesh.faces) == 0  # Euler: a torus


def test_frames_are_right_handed_and_do_not_turn_about_the_line() -> None:
    line = wavy(600)
    tangents, normals, binormals = tubes.frames(line)
    assert np.allclose(np.cross(tangents, normals), binormals)
    for one, other in itertools.combinations([tangents, normals, binormals], 2):
        assert np.abs(np.sum(one * other, axis=1)).max() < 1e-12
    change = np.roll(normals, -1, axis=0) - normals
    spin = np.sum(change * binormals, axis=1)
    assert spin.std() < 1e-4  # even, also where the last ring meets the first
    assert abs(spin.sum()) < math.pi + 0.01


def test_a_planar_curve_needs_no_turning() -> None:
    _, normals, _ = tubes.frames(circle(2, 30) * [3, 1, 1])
    up = normals[:, 2]
    assert np.ptp(up) < 1e-12


@pytest.mark.parametrize("name", ["3_1", "4_1", "Hopf", "T(2,7)"])
@pytest.mark.parametrize("tolerance", [0.05, 0.01])
def test_the_tolerance_is_kept(name: str, tolerance: float) -> None:
    curve = sono.start(name, known=True)
    meshes = tubes.tubes(curve, 0.9, tolerance)
    dense = _core.refine(list(curve), 3000 * len(curve))
    assert len(meshes) == len(curve)
    for mesh in meshes:
        assert is_closed(mesh.faces)
        assert off(mesh, dense, 0.9) < tolerance
        assert volume(mesh) == pytest.approx(
            math.pi * 0.81 * sono.measure(curve).inscribed_length / len(curve), rel=3 * tolerance
        )


def test_fewer_triangles_for_a_wider_tolerance() -> None:
    counts = [len(tubes.tubes(sono.start("3_1", known=True), 0.9, t)[0].faces) for t in (0.003, 0.03)]
    assert 5 < counts[0] / counts[1] < 20  # both ways go with the square root


@pytest.mark.parametrize(("radius", "tolerance"), [(0, 1), (-1, 1), (1, 0), (math.nan, 1), (1, math.inf)])
def test_what_is_no_radius_and_no_tolerance(radius: float, tolerance: float) -> None:
    curve: CurveLike = circle(3, 20)
    with pytest.raises(ValueError, match="must be positive"):
        tubes.tubes(curve, radius, tolerance)
