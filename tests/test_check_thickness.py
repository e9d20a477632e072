"""The sharper bound: K_P is as thick as is said, what is proven is refused when anything is changed."""

import json
import shutil
import subprocess
import sys
from decimal import Decimal
from fractions import Fraction
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from conftest import Sono
from hypothesis import given, settings
from hypothesis import strategies as st
from test_theorem import thickness

import sono as package
from sono import check_certificate, check_thickness, formats
from sono.check_thickness import RefusedError, arc_at, check


@pytest.fixture(scope="module")
def trefoil() -> Any:
    return package.tighten("3_1", 60, trials=1)


def test_it_is_sharper_and_no_more_than_true(trefoil: Any) -> None:
    sharp, bound = package.sharpen(trefoil), package.certify(trefoil).l_c
    excess, sharper = float(bound) - 32.7429, float(sharp.l_k) - 32.7429
    assert 0 < sharper < excess / 3
    assert float(sharp.tau) <= thickness(trefoil.curve) * (1 + 1e-6)
    assert sharp.l_k >= sharp.length / sharp.tau
    assert Decimal(sharp.rounded(6)) >= sharp.l_k


def test_links_and_names() -> None:
    hopf = package.sharpen("Hopf")
    assert 8 * np.pi < hopf.l_k < package.certify("Hopf").l_c


@settings(deadline=None, max_examples=30)
@given(st.integers(0, 10**6), st.floats(-30, 30))
def test_arcs_lie_in_their_capsules(seed: int, exponent: float) -> None:
    """Random corners: points of the arc, and of its halves, are as near to the pieces as is said."""
    draw = np.random.default_rng(seed)
    v = draw.normal(size=(3, 3)) * [[0, 0, 0], [1, 1, 1], [0.3, 0.3, 0.3]] + [[0, 0, 0], [3, 0, 0], [6, 1, 0]]
    rows = [tuple(row) for row in (v * 10**exponent).tolist()]
    (vertices,), _ = check_certificate.in_units([rows])
    arc = arc_at(vertices, 1, 1 << 20)
    for part in (arc, *arc.halves(), *arc.halves()[0].halves()):
        scale = float(part.cosine) / check_thickness.ONE
        p, c, q = (np.array(point, float) for point in (part.start, part.corner, part.end))
        x = np.linspace(0, 1, 33)[:, None]
        points = ((1 - x) ** 2 * p + 2 * scale * x * (1 - x) * c + x**2 * q) / (
            (1 - x) ** 2 + 2 * scale * x * (1 - x) + x**2
        )
        centre, axis, radius = part.capsule()
        y, g = np.array(centre, float) / 8, np.array(axis, float) / 8
        along = np.clip((points - y) @ g / (g @ g), -1, 1)[:, None]
        off = np.linalg.norm(points - y - along * g, axis=1).max()
        assert off <= radius / 8 * (1 + 1e-9)
        assert off >= 0.2 * np.linalg.norm(c - (p + q) / 2), "and not much nearer"


@pytest.mark.parametrize(
    ("key", "factor", "why"),
    [
        ("tau", "1.004", "tau: K_P is not proven 2 tau apart"),
        ("tau", "2", "above the least M_c"),
        ("length", "0.9999999", "length: below"),
        ("l_k", "0.9999999", "l_k: below"),
        ("r", "1.001", "T2"),
        ("r", "0.1", "T3"),
    ],
)
def test_what_is_not_so_is_refused(trefoil: Any, key: str, factor: str, why: str) -> None:
    rows = [list(map(tuple, component.tolist())) for component in trefoil.curve]
    sharp = package.sharpen(trefoil)
    claimed = {name: Fraction(getattr(sharp, name)) for name in check_thickness.DECIMALS}
    check_thickness.prove(claimed, rows)
    claimed[key] *= Fraction(factor)
    with pytest.raises(RefusedError, match=why):
        check_thickness.prove(claimed, rows)


def test_the_command_and_the_script(folder: Path, sono: Sono, trefoil: Any) -> None:
    formats.write("rope.xyz", list(trefoil.curve))
    result = sono("certify", "--sharp", "rope.xyz", "-o", "proofs/", "--columns", "certified,sharp")
    assert result.exit_code == 0
    bound, sharp = map(float, result.stdout.split()[-2:])
    assert sharp < bound
    proof = "proofs/rope.thickness.json"
    assert str(sharp)[:8] in sono("certify", "--check", proof, "proofs/rope.txt").stdout
    for name in ("check_certificate", "check_thickness"):
        shutil.copy(Path(check_thickness.__file__).with_name(f"{name}.py"), folder)
    command = [
        sys.executable,
        "-I",
        "-S",
        "-c",
        "import sys; sys.path.insert(0, '.'); import check_thickness as c; ",
    ]
    command[-1] += f"sys.argv = ['', '{proof}', 'proofs/rope.txt']; sys.exit(c.main())"
    assert "holds" in subprocess.run(command, capture_output=True, text=True, check=True).stdout
    document = json.loads(Path(proof).read_text())
    changes: list[dict[str, Any]] = [
        {"sha256": "0" * 64},
        {"tau": 1},
        {"tau": "nan"},
        {"tau": "0"},
        {"version": 2},
        {"more": "x"},
        {"file": None},
    ]
    for change in changes:
        Path("changed.thickness.json").write_text(json.dumps({**document, **change}))
        with pytest.raises(RefusedError):
            check("changed.thickness.json", "proofs/rope.txt")
        assert sono("certify", "--check", "changed.thickness.json", "proofs/rope.txt").exit_code == 1


def test_where_nothing_is_sharper(folder: Path, sono: Sono) -> None:
    square = [[0, 0, 0], [9, 0, 0], [9, 1, 0], [0, 1, 0]]
    with pytest.raises(package.CurveError):
        package.sharpen(square)
    t = 2 * np.pi * np.arange(40) / 40
    circle = np.column_stack([np.cos(t), np.sin(t), 0 * t])  # as sharp a bend as there may be, all round
    with pytest.raises(ValueError, match="no sharper bound is proven"):
        package.sharpen(circle)
    formats.write("circle.txt", [circle])
    result = sono("certify", "--sharp", "circle.txt")
    assert (result.exit_code, result.stderr.count("\n")) == (1, 1)
    assert "circle.txt: no sharper bound" in result.stderr


def test_alone_it_says_what_it_needs(tmp_path: Path) -> None:
    alone = shutil.copy(check_thickness.__file__, tmp_path)
    found = subprocess.run([sys.executable, alone, "a", "b"], capture_output=True, text=True, cwd=tmp_path)
    assert found.returncode == 1
    assert (
        found.stderr
        == "check_thickness.py: needs check_certificate.py beside it; copy both into one folder\n"
    )
