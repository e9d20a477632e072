"""The checker of certificates: it accepts what is proven, refuses all else, and needs nobody."""

import ast
import hashlib
import json
import math
import shutil
import subprocess
import sys
from collections.abc import Callable
from decimal import Context, Decimal, localcontext
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from certificates import PI, Fields, Loop, Parts, arctan, certificate, coded, concluded, content_of, nudged
from hypothesis import assume, given, settings
from hypothesis import strategies as st

from sono import check_certificate as checker
from sono import starts
from sono.check_certificate import RefusedError


def ring(n: int, radius: float = 1.0, seed: int | None = None) -> Any:
    """A regular polygon, or one that has unequal edges."""
    t = np.arange(n) / n
    if seed is not None:
        t += np.random.default_rng(seed).uniform(-0.3, 0.3, n) / n
    return radius * np.column_stack([np.cos(2 * np.pi * t), np.sin(2 * np.pi * t), np.zeros(n)])


def hopf(n: int, m: int) -> Parts:
    """Two linked rings of different size."""
    return [2 * ring(n, seed=1), 2.5 * ring(m)[:, [0, 2, 1]] + (2.2, 0, 0)]


def bump() -> Any:
    """A ring with one corner sharper than the others."""
    return ring(40) * np.where(np.arange(40) == 7, 1.003, 1)[:, None]


def beds(straight: float) -> Any:
    """Half a fine ring on either side of straight ways that are an edge each."""
    half = ring(24)[:13]
    down = np.array([0, straight, 0])
    return np.vstack([half, half[-1] - down, -half[1:-1] - down, half[0] - down])


def stadium(straight: float, n: int = 12) -> Any:
    """Half a polygon of 2 n corners on either side of straight ways, on which there are colinear vertices."""
    half = ring(2 * n)[: n + 1]
    way = np.column_stack([np.full(3, -1.0), -np.array([0.1, 0.25, 0.5]) * straight, np.zeros(3)])
    return np.vstack([half, way, -half - (0, straight, 0), -way[::-1] * (1, 0, 0) + way[::-1] * (0, 1, 0)])


CURVES: dict[str, Callable[[], Parts]] = {
    "hexagon": lambda: [ring(6)],
    "pentagon": lambda: [ring(5, 3.0)],
    "uneven": lambda: [ring(40, 0.7, seed=3)],
    "stadium": lambda: [stadium(2.0)],
    "bump": lambda: [bump()],
    "longer edges elsewhere": lambda: [bump(), ring(40, 5.0) + np.array([0, 0, 9])],
    "exactly 2 R": lambda: [ring(40, 5.0), ring(40, 5.0) + np.array([0, 0, 1.5])],
    "trefoil": lambda: list(starts.known("3_1") or ()),
    "8_18": lambda: list(starts.known("m8_18") or ()),
    "hopf": lambda: hopf(30, 41),
    "three": lambda: [*hopf(24, 24), ring(9) + np.array([0, 0, 9])],
    "tiny": lambda: [1e-300 * stadium(1.5)],
    "least": lambda: [np.round(ring(64, 300.0)) * 2.0**-1074],
    "huge": lambda: [1e300 * part for part in hopf(30, 40)],
    "far": lambda: [ring(20, seed=2) + np.array([1e6, -3e7, 1])],
    "loose": lambda: list(starts.start("4_1")),
}
TOO_MUCH = {"s": -1, "min_rad": 1, "r": 1, "r_c": 1, "length": -1, "l_c": -1}
"""In which direction a figure says too much."""


def verdict(fields: Fields, content: bytes) -> str:
    """Why a certificate is refused, or nothing."""
    try:
        checker.prove(checker.fields_of(coded(fields)), content)
    except RefusedError as error:
        return str(error)
    return ""


def renewed(fields: Fields, components: Parts) -> str:
    """The verdict on a certificate that has been given the hash of other vertices."""
    content = content_of(components)
    return verdict({**fields, "sha256": hashlib.sha256(content).hexdigest()}, content)


@pytest.mark.parametrize("name", CURVES)
@pytest.mark.parametrize("digits", [20, 15])
def test_what_is_true_is_accepted(name: str, digits: int) -> None:
    curve = CURVES[name]()
    assert verdict(certificate(curve, digits), content_of(curve)) == ""


@pytest.mark.parametrize("name", CURVES)
def test_a_last_digit_too_much_is_refused(name: str) -> None:
    curve = CURVES[name]()
    fields, content = certificate(curve), content_of(curve)
    for key, step in TOO_MUCH.items():
        assert verdict({**fields, key: nudged(fields[key], step)}, content).startswith(f"{key}: "), key


def test_a_radius_that_is_just_too_small() -> None:
    """R = S/sqrt 2 = 1 meets all conditions but the third."""
    square = [[(1, 0, 0), (0, 1, 0), (-1, 0, 0), (0, -1, 0)]]
    fields = concluded({**certificate(square), "r": "1"})
    assert "R > S/sqrt 2 fails (T3)" in verdict(fields, content_of(square))


def test_the_least_pi() -> None:
    with localcontext(Context(prec=60)):
        assert 0 < PI - Decimal(checker.PI.numerator) / checker.PI.denominator < Decimal("1e-49")


@pytest.mark.parametrize("name", CURVES)
def test_a_last_digit_less_is_accepted(name: str) -> None:
    curve = CURVES[name]()
    fields, content = certificate(curve), content_of(curve)
    for key, step in TOO_MUCH.items():
        less = {**fields, key: nudged(fields[key], -step)}
        if key in ("s", "r", "length"):
            less = concluded(less)
        elif key == "r_c":
            less["l_c"] = nudged(less["l_c"], 100)
        assert verdict(less, content) == "", key


def test_what_is_not_concluded_is_refused() -> None:
    """A larger s needs a smaller r_c, a smaller r_c a larger l_c, and so does a larger length."""
    curve = CURVES["trefoil"]()
    fields, content = certificate(curve), content_of(curve)
    for key, factor, refused in (("s", "1.1", "r_c"), ("r_c", "0.9", "l_c"), ("length", "1.1", "l_c")):
        other = {**fields, key: str(round(Decimal(fields[key]) * Decimal(factor), 12))}
        assert verdict(other, content).startswith(f"{refused}: ")


@pytest.mark.parametrize("condition", ["bend", "pair"])
def test_nudged_vertices_are_refused(condition: str) -> None:
    """Where 1e-12 of the size brings a contact nearer, sharpens a bend or lengthens the curve."""
    curve = CURVES["bump" if condition == "bend" else "trefoil"]()
    fields = certificate(curve)
    assert fields["decided_by"]["condition"] == condition
    (c, i), (d, j) = (fields["decided_by"]["vertices"] * 2)[:2]
    towards = curve[d][j] - curve[c][i]
    if condition == "bend":
        towards = 2 * curve[c][i] - curve[c][i - 1] - curve[c][(i + 1) % len(curve[c])]
    moved = [part.copy() for part in curve]
    moved[c][i] += 1e-12 * towards / np.linalg.norm(towards)
    assert renewed(fields, moved).startswith("r: ")
    larger = [part * (1 + 1e-12) for part in curve]
    assert renewed(fields, larger).startswith(("s: ", "length: "))
    assert renewed(fields, [part * (1 - 1e-12) for part in curve]).startswith("r: ")
    assert verdict(fields, content_of(moved)).startswith("sha256: ")


def test_the_message_names_inequality_and_vertices() -> None:
    curve = CURVES["trefoil"]()
    fields, content = certificate(curve), content_of(curve)
    i, j = fields["decided_by"]["vertices"]
    more = str(round(Decimal(fields["r"]) * Decimal("1.0000001"), 15))
    message = verdict({**fields, "r": more}, content)
    assert message.startswith("r: 2 R <= |v_i - v_j| fails for [0, ")
    said, bound = (Decimal(message.split()[place]) for place in (-3, -1))
    assert Decimal(fields["r"]) - Decimal("1e-12") < bound < said == Decimal(more)
    one = verdict({**fields, "r": nudged(fields["r"], 1)}, content)
    assert f"fails for {i} and {j} (T2)" in one
    flat = CURVES["bump"]()
    most = certificate(flat)
    (place,) = most["decided_by"]["vertices"]
    assert f"R^2 <= M_c^2 + S_c^2/4 fails at {place} (T1)" in verdict(
        {**most, "r": nudged(most["r"], 1)}, content_of(flat)
    )


def boundary(steps: int) -> Parts:
    """Two vertices at a turn that are pi M - S apart along the curve, but for so many roundings.

    S is the longest edge, which lies on a straight way.
    """
    longest = math.pi * math.cos(math.pi / 24) - 10 * 2 * math.sin(math.pi / 24)
    return [beds(longest * (1 + steps * 2**-53))]


def test_pairs_at_the_boundary_of_counting() -> None:
    """On one side of it they count, and decide R, and on the other side not."""
    found = {steps: certificate(boundary(steps)) for steps in (-2000, *range(-300, 300, 20), 2000)}
    for steps, fields in found.items():
        assert verdict(fields, content_of(boundary(steps))) == "", steps
    larger, smaller = found[-2000], found[2000]
    assert Decimal(larger["r"]) > Decimal(smaller["r"]) * Decimal("1.001")
    borrowed = concluded({**smaller, "r": larger["r"], "decided_by": larger["decided_by"]})
    assert "(T2)" in verdict(borrowed, content_of(boundary(2000)))


def hairpin(angle: float) -> Any:
    """A ring with a corner that turns by all but this angle."""
    back = ring(20)[0] + 0.5 * np.array([math.cos(angle / 2), math.sin(angle / 2), 0])
    return np.vstack([ring(20)[0], back, ring(20)[0] + (1e-9, 2 * (back[1] or 1e-12), 0), ring(20)[1:]])


@pytest.mark.parametrize(
    ("curve", "why"),
    [
        ([ring(3)], "(T3)"),
        ([ring(4)], "(T3)"),
        ([beds(1.3)], "(T3)"),  # R is between S/2 and S/sqrt 2
        ([hairpin(1e-3)], "(T3)"),
        ([hairpin(0.0)], "(T3)"),
        ([[(0, 0, 0), (1, 0, 0), (2, 0, 0), (3, 0, 0)]], "(T3)"),
        ([np.vstack([ring(30), ring(30)])], "(T3)"),  # twice round
        ([ring(30), ring(30) + np.array([1e-3, 0, 0])], "(T3)"),
        ([ring(30), 5 * ring(30)[:, [0, 2, 1]] + (5, 0, 0)], "(T3)"),  # the second passes the first's centre
    ],
)
def test_what_is_too_coarse_has_no_certificate(curve: Parts, why: str) -> None:
    fields = certificate(curve)
    assert why in verdict(fields, content_of(curve))
    # Nor with an R that meets this condition.
    for factor in ("1.01", "2", "10"):
        s = Decimal(fields["s"])
        fields = concluded({**fields, "r": str(round(s * Decimal(factor), 15))})
        assert verdict(fields, content_of(curve)).startswith("r: ")


FILES = {
    "nan": "nan 0 0\n1 0 0\n0 1 0\n",
    "infinite": "1e999 0 0\n1 0 0\n0 1 0\n",
    "words": "x y z\n1 0 0\n0 1 0\n1 1 1\n",
    "two numbers": "1 0\n0 1\n1 1\n",
    "four numbers": "1 0 0 0\n0 1 0 0\n1 1 0 0\n",
    "an index": "1 0 0 1\n2 0 1 1\n3 1 1 1\n",
    "underscores": "1_0 0 0\n0 1 0\n0 0 1\n",
    "hexadecimal": "0x10 0 0\n0 1 0\n0 0 1\n",
    "commas at the end": "1,0,0,\n0,1,0,\n1,1,0,\n",
    "nothing": "",
    "comments": "# a\n#b\n",
    "two vertices": "0 0 0\n1 0 0\n",
    "one of two": "0 0 0\n1 0 0\n0 1 0\n\n5 5 5\n",
    "one vertex": "1 2 3\n",
    "a square, and back": "0 0 0\n1 0 0\n0 0 0\n",
}


@pytest.mark.parametrize("name", FILES)
def test_wrong_files(name: str) -> None:
    content = FILES[name].encode()
    fields = certificate([ring(6)])
    message = verdict({**fields, "sha256": hashlib.sha256(content).hexdigest()}, content)
    assert "the file" in message


def test_a_vertex_that_comes_twice() -> None:
    doubled = ring(12)[[0, 1, 1, *range(2, 12)]]
    content = content_of([doubled])
    fields = {**certificate([ring(12)]), "n": 13, "components": [13]}
    assert "[0, 1] (T1)" in verdict({**fields, "sha256": hashlib.sha256(content).hexdigest()}, content)
    same = content_of([[(1, 2, 3)] * 4])
    fields = {**fields, "n": 3, "components": [3], "sha256": hashlib.sha256(same).hexdigest()}
    assert "[0, 0] (T1)" in verdict(fields, same)


@pytest.mark.parametrize(
    ("before", "after"),
    [
        ("\n", "\r\n"),
        ("\n", "\r"),
        (" ", ", "),
        (" ", "\t"),
        ("# a", "\n\n\n# a é"),
        ("\n\n", "\n \n\n# c\n"),
        ("\n", "\n# c\n"),
    ],
)
def test_the_same_rows_written_otherwise(before: str, after: str) -> None:
    curve = hopf(24, 25)
    head, rows = content_of(curve).decode().split("\n", 1)
    text = (
        (head + "\n" + rows).replace(before, after)
        if before != " "
        else head + "\n" + rows.replace(before, after)
    )
    content = text.encode()
    assert content != content_of(curve)
    fields = {**certificate(curve), "sha256": hashlib.sha256(content).hexdigest()}
    assert verdict(fields, content) == ""


def test_the_last_vertex_may_repeat_the_first() -> None:
    curve = hopf(24, 25)
    content = content_of([np.vstack([part, part[:1]]) for part in curve])
    fields = {**certificate(curve), "sha256": hashlib.sha256(content).hexdigest()}
    assert verdict(fields, content) == ""
    assert verdict({**fields, "n": 51, "components": [25, 26]}, content).startswith("n: ")


WRONG: list[tuple[str, object]] = [
    ("format", "sono"),
    ("version", 2),
    ("version", True),
    ("version", "1"),
    ("program", None),
    ("file", 3),
    ("sha256", "0" * 64),
    ("sha256", None),
    ("curve", "2"),
    ("n", 48),
    ("n", None),
    ("n", "49"),
    ("components", [49]),
    ("components", [25, 24]),
    ("components", 49),
    *((key, value) for key in TOO_MUCH for value in ("nan", "inf", "-1", "0", "0.000", "", "1e9999")),
    *((key, value) for key in TOO_MUCH for value in (None, 1.5, 1, True, "1_0", "٣", " 1", "1/2")),
    *((key, "1.000000000000000000001") for key in TOO_MUCH),
    ("decided_by", None),
    ("decided_by", []),
    ("decided_by", {}),
    ("decided_by", {"condition": "bend"}),
    ("decided_by", {"condition": "bend", "vertices": [[0, 0], [0, 1]]}),
    ("decided_by", {"condition": "pair", "vertices": [[0, 0]]}),
    ("decided_by", {"condition": "pair", "vertices": [[0, 0], [0, 1]]}),
    ("decided_by", {"condition": "pair", "vertices": [[0, 0], [0, 0]]}),
    ("decided_by", {"condition": "pair", "vertices": [[0, 0], [2, 0]]}),
    ("decided_by", {"condition": "pair", "vertices": [[0, 0], [1, -1]]}),
    ("decided_by", {"condition": "pair", "vertices": [[0, 0.0], [1, True]]}),
    ("decided_by", {"condition": "pair", "vertices": ["[0, 0]", "[1, 0]"]}),
    ("decided_by", {"condition": "pair", "vertices": "[0, 0]"}),
    ("decided_by", {"condition": ["pair"], "vertices": [[0, 0], [1, 1]]}),
    ("decided_by", {"condition": "bend", "vertices": [[1, 2]]}),
    ("decided_by", {"condition": "bend", "vertices": [[0]], "by": 3}),
]


@pytest.mark.parametrize(("key", "value"), WRONG, ids=repr)
def test_wrong_fields(key: str, value: object) -> None:
    curve = hopf(24, 25)
    fields = certificate(curve)
    assert verdict(fields, content_of(curve)) == ""
    assert verdict({**fields, key: value}, content_of(curve)).startswith(
        f"{key}: ".replace("version", "format")
    )


@pytest.mark.parametrize("key", sorted(checker.FIELDS))
def test_fields_that_are_missing(key: str) -> None:
    fields = certificate([ring(6)])
    del fields[key]
    assert verdict(fields, content_of([ring(6)])) == f"{key}: the certificate lacks it"
    assert verdict({**fields, key: "1", "type": "3_1"}, b"").startswith("type: the certificate may not")


@pytest.mark.parametrize(
    "content",
    [b"", b"{", b"[]", b"null", b"\xff\xfe", b"[" * 100_000, b'{"n": 1, "n": 2}', b"9" * 9999, b'{"n": NaN}'],
    ids=lambda content: repr(content[:20]),
)
def test_certificates_that_are_none(content: bytes) -> None:
    with pytest.raises(RefusedError):
        checker.fields_of(content)


@given(st.data())
@settings(max_examples=100, deadline=None)
def test_damaged_certificates_are_refused(data: st.DataObject) -> None:
    """Whatever one byte is changed to, it is refused, or the same figures or weaker ones are left."""
    curve = hopf(24, 25)
    fields = certificate(curve)
    text = bytearray(coded(fields))
    text[data.draw(st.integers(0, len(text) - 1))] = data.draw(st.integers(0, 255))
    try:
        found = checker.fields_of(bytes(text))
        checker.prove(found, content_of(curve))
    except RefusedError:
        return
    for key, step in TOO_MUCH.items():
        assert (Decimal(found[key]) - Decimal(fields[key])) * step <= 0


def shorter(loop: checker.Loop, i: int, j: int) -> int:
    return min(loop.along[j] - loop.along[i], loop.along[-1] - loop.along[j] + loop.along[i])


@given(st.integers(0, 10**9), st.booleans())
@settings(max_examples=400, deadline=None)
def test_pairs_by_arcs_are_all_pairs(seed: int, same: bool) -> None:
    """The nearest pair that counts is found, and none where it is far enough, on edges of all lengths."""
    draw = np.random.default_rng(seed)
    if same:  # a smooth one, where few pairs count
        t = 2 * np.pi * np.arange(n := draw.integers(40, 90)) / n
        waves = [np.cos(k * t[:, None] + draw.uniform(0, 6, 3)) / k**2 for k in (1, 2, 3)]
        walks = [10**6 * np.sum(waves, axis=0)]
    else:
        walks = [np.cumsum(1000 * draw.standard_t(1, (draw.integers(3, 30), 3)), axis=0) for _ in range(2)]
    loops = [checker.loop_of([(int(x), int(y), int(z)) for x, y, z in walk]) for walk in walks]
    one, other = loops[0], loops[-1]
    squares = {
        (i, j): checker.square(v, w)
        for i, v in enumerate(one.vertices)
        for j, w in enumerate(other.vertices)
        if not same or (i <= j and shorter(one, i, j) >= one.counts)
    }
    assume(squares)
    least = min(squares.values())
    assert not list(checker.nearer(one, other, least))
    i, j, apart = next(checker.nearer(one, other, least + 1), (0, 0, -1))
    assert apart == least == squares[i, j]


@given(st.integers(8, 14), st.integers(5, 30), st.integers(0, 2), st.integers(0, 10**6), st.integers(0, 9))
@settings(max_examples=300, deadline=None)
def test_coarse_units_are_on_the_safe_side(n: int, size: int, noise: int, seed: int, bits: int) -> None:
    """A rounding the other way would be seen, where the longest edge has so few units."""
    rows = np.round(ring(n, size) + np.random.default_rng(seed).uniform(-noise, noise, (n, 3)))
    assume((rows != np.roll(rows, 1, axis=0)).any(axis=1).all())
    with pytest.MonkeyPatch.context() as patch, localcontext(Context(prec=60)):
        patch.setattr(checker, "BITS", bits)
        exact = Loop(rows)
        (vertices,), units = checker.in_units([list(map(tuple, rows.tolist()))])
        loop = checker.loop_of(vertices)
        tiny = Decimal("1e-40")
        assert loop.longest == round(units**2 * exact.s**2)
        assert all(loop.bends[i] <= 4 * units**2 * square + tiny for i, square in exact.rad2.items())
        assert all(loop.along[i] >= units * sum(exact.s_i[:i]) - tiny for i in range(n + 1))
        assert loop.counts <= units * (PI * exact.m - exact.s)
        if max(exact.turns) < 90:
            assert loop.length >= units * exact.length - tiny


@given(st.integers(1, 10**9), st.integers(1, 10**9))
@settings(deadline=None)
def test_roots_and_arcs(over: int, tilt: int) -> None:
    root = checker.root_above(over)
    assert (root - 1) ** 2 < over <= root**2
    # The bend between (1, 0) and (over, tilt), whose tangent of half the angle is u.
    tilt = min(tilt, over - 1) or 1
    with localcontext(Context(prec=80)):
        cosine = 1 / (1 + (Decimal(tilt) / over) ** 2).sqrt()
        u = ((1 - cosine) / (1 + cosine)).sqrt()
        square = (over**2 + tilt**2) << 256
        saved = checker.saving(math.isqrt(square), over << 128)
        exact = 1 - arctan(u) / u
        assert 0 <= exact - Decimal(saved) / 2**checker.BITS < Decimal("1e-34")


def test_it_stands_alone(tmp_path: Path) -> None:
    """It runs where there is no sono, imports the standard library only, and has nothing that -O skips."""
    source = Path(checker.__file__)
    tree = ast.parse(source.read_text())
    names = {alias.name for node in ast.walk(tree) if isinstance(node, ast.Import) for alias in node.names}
    names |= {str(node.module) for node in ast.walk(tree) if isinstance(node, ast.ImportFrom)}
    assert {name.partition(".")[0] for name in names} <= sys.stdlib_module_names
    assert not any(isinstance(node, ast.Assert) for node in ast.walk(tree))
    assert not any(
        isinstance(node, ast.Constant) and isinstance(node.value, float) for node in ast.walk(tree)
    )
    shutil.copy(source, tmp_path / "check.py")
    curve = CURVES["trefoil"]()
    (tmp_path / "rope.txt").write_bytes(content_of(curve))
    fields = certificate(curve)
    (tmp_path / "rope.json").write_bytes(coded(fields))
    (tmp_path / "false.json").write_bytes(coded({**fields, "l_c": nudged(fields["l_c"], -1)}))

    def run(*arguments: str) -> "subprocess.CompletedProcess[str]":
        command = [sys.executable, "-I", "-S", "-O", "check.py", *arguments]
        return subprocess.run(command, cwd=tmp_path, capture_output=True, text=True, check=False)

    done = run("rope.json", "rope.txt")
    assert (done.returncode, done.stderr) == (0, "")
    assert f"ropelength {fields['l_c']} at most" in done.stdout
    done = run("false.json", "rope.txt")
    assert (done.returncode, done.stdout) == (1, "")
    assert done.stderr.startswith("false.json: refused: l_c: ")
    assert run("rope.json", "false.json").stderr.startswith("rope.json: refused: sha256: ")
    assert "No such file" in run("missing.json", "rope.txt").stderr
    assert run("rope.json").returncode == 2


def test_by_paths(tmp_path: Path) -> None:
    (tmp_path / "ring.txt").write_bytes(content_of([ring(20)]))
    (tmp_path / "ring.json").write_bytes(coded(certificate([ring(20)])))
    fields = checker.check(tmp_path / "ring.json", str(tmp_path / "ring.txt"))
    assert fields == json.loads(coded(certificate([ring(20)])))
    with pytest.raises(OSError, match="No such file"):
        checker.check(tmp_path / "ring.json", tmp_path / "none.txt")
