"""Certificates: their decimals against exact arithmetic, the file they are of, and the command."""

import hashlib
import json
import re
from collections.abc import Sequence
from fractions import Fraction
from importlib import resources
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from conftest import Sono
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.typing import NDArray

import sono as package
from sono import _core, certificates, check_certificate, formats

Curve = Sequence[NDArray[np.float64]]

FIGURES = ("s", "min_rad", "r", "r_c", "length", "l_c")


def circle(n: int, radius: float = 1.0, height: float = 0.0) -> NDArray[np.float64]:
    angle = 2 * np.pi * np.arange(n) / n
    return np.column_stack([radius * np.cos(angle), radius * np.sin(angle), np.full(n, height)])


def squared_edges(curve: Curve) -> list[Fraction]:
    """Return the squares of all edges, exactly."""
    return [
        sum(((Fraction(p) - Fraction(q)) ** 2 for p, q in zip(*edge, strict=True)), Fraction())
        for component in curve
        for edge in zip(component.tolist(), np.roll(component, -1, axis=0).tolist(), strict=True)
    ]


def check_exactly(curve: Curve, certificate: package.Certificate) -> None:
    """Check what can be told without roots of sums."""
    s, min_rad, r, r_c, length, l_c = (Fraction(getattr(certificate, key)) for key in FIGURES)
    assert s**2 >= max(squared_edges(curve))
    assert r**2 > s**2 / 2
    assert r_c**2 <= r**2 - s**2 / 4
    assert l_c >= length / r_c
    assert min_rad > 0
    if certificate.decided_by.condition == "pair":
        one, other = (curve[c][i].tolist() for c, i in certificate.decided_by.vertices)
        apart = sum((Fraction(p) - Fraction(q)) ** 2 for p, q in zip(one, other, strict=True))
        assert 4 * r**2 <= apart < 4 * r**2 * (1 + Fraction(1, 10**12))


def check_each(curve: Curve, certificate: package.Certificate) -> None:
    """Check that no decimal is on the wrong side of its double, or far from it."""
    bound: Any = _core.certify(curve)
    up = [(certificate.s, "longest_edge"), (certificate.length, "inscribed_length"), (certificate.l_c, "l_c")]
    down = [(certificate.min_rad, "min_rad"), (certificate.r, "r"), (certificate.r_c, "r_c")]
    for decimal, double in ((Fraction(decimal), Fraction(bound[key])) for decimal, key in up):
        assert double <= decimal <= double * (1 + Fraction(1, 10**19))
    for decimal, double in ((Fraction(decimal), Fraction(bound[key])) for decimal, key in down):
        assert double * (1 - Fraction(1, 10**19)) <= decimal <= double


@settings(deadline=None, max_examples=40)
@given(
    n=st.integers(30, 90),
    scale=st.floats(1e-40, 1e40),
    shift=st.floats(0.5, 1.5),
    stretch=st.floats(0.5, 1.0),
)
def test_decimals_are_rounded_outward(n: int, scale: float, shift: float, stretch: float) -> None:
    rings = [circle(n), circle(n, height=shift) * [1, stretch, 1]]
    curve = [scale * ring for ring in rings]
    certificate = package.certify(curve)
    check_exactly(curve, certificate)
    check_each(curve, certificate)
    measures = package.measure(curve)
    assert float(certificate.l_c) == pytest.approx(measures.l_c, rel=1e-11)
    assert all(
        len(f"{getattr(certificate, key):f}".strip("0.").replace(".", "")) <= 20 for key in FIGURES[1:4]
    )


def test_what_is_shown_of_a_bound_is_rounded_up() -> None:
    certificate = package.certify("3_1")
    for digits in range(1, 25):
        shown = Fraction(certificate.rounded(digits))
        assert (
            Fraction(certificate.l_c)
            <= shown
            <= Fraction(certificate.l_c) + 10 * Fraction(1, 10) ** (digits - 1)
        )
    assert re.fullmatch(r"32\.849146707\d\d\d", certificate.rounded())


def test_what_is_not_proven_is_refused() -> None:
    with pytest.raises(package.CurveError, match="the bend at vertex 0 of component 0") as caught:
        package.certify([[0, 0, 0], [9, 0, 0], [9, 1, 0], [0, 1, 0]])
    assert caught.value.places == [(0, 0)]
    with pytest.raises(package.CurveError, match=r"R > S/sqrt 2 fails by 0\.0712") as caught:
        package.certify([circle(20), circle(20, height=0.3)])
    (one, i), (other, j) = caught.value.places
    assert (one, other, i) == (0, 1, j)
    with pytest.raises(ValueError, match="the atlas has no rope of 'P\\(-3,5,7\\)'"):
        package.certify("P(-3,5,7)")


def test_a_document_is_of_the_very_file(tmp_path: Path) -> None:
    curve = package.start("Hopf")
    certificate = package.certify(curve)
    path = tmp_path / "ring.txt"
    package.write(path, curve, "a Hopf link")
    document = certificate.document(path)
    assert document["file"] == "ring.txt"
    assert document["sha256"] == hashlib.sha256(path.read_bytes()).hexdigest()
    assert {key: document[key] for key in FIGURES} == {key: str(getattr(certificate, key)) for key in FIGURES}
    text = path.read_text()
    moved, joined = text.replace("0.", "1.", 1), text.replace("\n\n", "\n")
    for other in (moved, joined, text + "1 2 3\n", "x y z\n" + text, ""):
        path.write_text(other)
        with pytest.raises(ValueError, match=r"ring\.txt: does not hold these vertices"):
            certificate.document(path)


@pytest.mark.parametrize(
    "change",
    [
        lambda text: text.replace(" ", ", "),
        lambda text: "# a comment\n\n\n" + text.replace("\n", " # bead\n", 1) + "\n\n",
        lambda text: text.replace("\n", "\r\n"),
    ],
)
def test_plain_rows_may_look_otherwise(tmp_path: Path, change: Any) -> None:
    curve = package.start("Hopf")
    path = tmp_path / "ring.txt"
    package.write(path, curve)
    path.write_bytes(change(path.read_text()).encode())
    assert package.read(path) == curve
    assert package.certify(curve).document(path)["n"] == curve.n


def schema() -> Any:
    return json.loads(resources.files("sono").joinpath("data", "certificate.schema.json").read_text())


def follows(document: Any, schema: Any, root: Any) -> bool:
    """Tell whether a document follows a schema, of the kinds of rules that this one has."""
    schema = root["$defs"]["decimal"] if "$ref" in schema else schema
    kinds = {"object": dict, "array": list, "string": str, "integer": int, "null": type(None)}
    types = schema.get("type", [])
    ok = not types or any(
        isinstance(document, kinds[t]) for t in ([types] if isinstance(types, str) else types)
    )
    ok &= document in schema.get("enum", [document]) and document == schema.get("const", document)
    if isinstance(document, dict):
        properties = schema["properties"]
        ok &= set(schema["required"]) <= set(document) <= set(properties)
        ok = ok and all(follows(document[key], properties[key], root) for key in document)
    if isinstance(document, list):
        ok &= schema["minItems"] <= len(document) <= schema.get("maxItems", len(document))
        ok &= all(follows(item, schema["items"], root) for item in document)
    if isinstance(document, str) and "pattern" in schema:
        ok &= bool(re.search(schema["pattern"], document))
    return bool(ok)


def test_the_document_follows_the_schema(tmp_path: Path) -> None:
    for name, scale in (("3_1", 1.0), ("8_18", 1e-30), ("6_3", 1e30)):
        curve = [scale * component for component in package.start(name, known=True)]
        formats.write(tmp_path / "rope.txt", curve)
        document = package.certify(curve).document(tmp_path / "rope.txt")
        assert follows(json.loads(json.dumps(document)), schema(), schema())
        assert not follows({**document, "l_c": float(document["l_c"])}, schema(), schema())
    assert document["format"] == certificates.FORMAT
    assert document["version"] == certificates.VERSION


def test_rows_of_files_and_names(folder: Path, sono: Sono) -> None:
    result = sono("certify", "8_18", "3_1", "Hopf.txt", "--format", "jsonl")
    rows = [json.loads(line) for line in result.stdout.splitlines()]
    assert result.exit_code == 0
    coarse, _ = result.stderr.splitlines()  # of the names
    better = "sono tighten 8_18 --dl 0.02 -o fine/ && sono certify fine/8_18.dl0.02.txt"
    assert coarse == f"sono: 8_18: edges of 0.2, a coarse bound; `{better}` proves about 74.9"
    assert sono("certify", "8_18", "-q").stderr == ""
    assert [row["knot"] for row in rows] == ["8_18", "3_1", "Hopf"]  # 3_1.txt is not taken for the knot
    for row, curve in zip(
        rows, [package.start("8_18", known=True), package.start("3_1", known=True)], strict=False
    ):
        assert row["certified"] == package.certify(curve).rounded()
    assert re.fullmatch(r"pair 0:\d+ 1:\d+", rows[2]["decided_by"])
    assert sono("certify", "-", input=(folder / "Hopf.txt").read_text()).exit_code == 0


def test_certificates_in_a_folder(folder: Path, sono: Sono) -> None:
    result = sono("certify", "8_18", "Hopf.txt", "-o", "proofs", "--columns", "file")
    assert result.stdout.splitlines()[1:] == [str(Path("proofs", "8_18.txt")), "Hopf.txt"]
    assert sorted(path.name for path in Path("proofs").iterdir()) == [
        "8_18.certificate.json",
        "8_18.txt",
        "Hopf.certificate.json",
    ]
    document = json.loads(Path("proofs", "8_18.certificate.json").read_text())
    written = package.read("proofs/8_18.txt")
    assert written == package.start("8_18", known=True)
    assert document == package.certify(written).document("proofs/8_18.txt")
    again = sono("certify", "8_18", "-o", "proofs")
    assert again.exit_code == 1
    assert "exists; --force overwrites it" in again.stderr
    assert sono("certify", "8_18", "-o", "proofs", "--force").exit_code == 0


def test_files_of_other_formats_are_written_as_rows(folder: Path, sono: Sono) -> None:
    package.write("ring.json", "Hopf")
    result = sono("certify", "ring.json", "--json")
    assert (result.exit_code, result.stdout) == (1, "")
    assert "-o FOLDER writes one" in result.stderr
    assert sono("certify", "ring.json", "-o", "new").exit_code == 0
    document = json.loads(Path("new/ring.certificate.json").read_text())
    assert document["file"] == "ring.txt"
    assert hashlib.sha256(Path("new/ring.txt").read_bytes()).hexdigest() == document["sha256"]
    assert json.loads(sono("certify", "new/ring.txt", "--json").stdout) == document


def test_what_is_wrong_is_told_with_its_lines(folder: Path, sono: Sono) -> None:
    Path("long.txt").write_text("# long\n0 0 0\n9 0 0\n9 1 0\n0 1 0\n")
    Path("eight.txt").write_text("0 0 0\n2 2 0\n2 0 0\n0 2 0\n")
    result = sono("certify", "long.txt", "eight.txt", "P(-3,5,7)", "missing.txt", "Hopf.txt")
    assert result.exit_code == 1
    assert [row.split("\t")[0] for row in result.stdout.splitlines()[1:]] == ["Hopf"]
    messages = result.stderr.splitlines()
    assert messages[0].startswith("sono: long.txt:2: no bound is proven: R > S/sqrt 2 fails by ")
    assert messages[1].startswith("sono: eight.txt:1: the curve crosses itself")
    assert "`sono tighten 'P(-3,5,7)' -o rope.txt`" in messages[2]
    assert messages[3].startswith("sono: missing.txt: cannot be read")


@pytest.mark.parametrize(
    "arguments",
    [
        ["3_1", "--json", "-o", "proofs"],
        ["3_1", "8_18", "--check", "proof.json"],
        ["3_1", "--check", "proof.json", "--json"],
        [],
    ],
)
def test_wrong_options(sono: Sono, arguments: list[str]) -> None:
    result = sono("certify", *arguments)
    assert (result.exit_code, result.stdout) == (2, "")


def test_a_certificate_is_checked(folder: Path, sono: Sono) -> None:
    assert sono("certify", "8_18", "Hopf.txt", "-o", "proofs").exit_code == 0
    rope, proof = "proofs/8_18.txt", Path("proofs/8_18.certificate.json")
    result = sono("certify", "--check", str(proof), rope)
    bound = json.loads(proof.read_text())["l_c"]
    assert (result.exit_code, result.stderr) == (0, "")
    assert result.stdout == f"{rope}: proven: the ropelength of its type is at most {bound}\n"
    for certificate, file in ((str(proof), "Hopf.txt"), ("Hopf.txt", "Hopf.txt")):
        refused = sono("certify", "--check", certificate, file)
        assert (refused.exit_code, refused.stdout) == (1, "")
        assert refused.stderr.startswith(f"sono: {certificate}: proves nothing of {file}: ")
    missing = sono("certify", "--check", "missing.json", rope)
    assert missing.exit_code == 1
    assert missing.stderr.startswith("sono: missing.json: cannot be read: ")


@pytest.mark.slow
@settings(deadline=None, max_examples=60)
@given(
    shape=st.sampled_from([(2, 3), (2, 5), (1, 0), (3, 4)]),
    n=st.integers(70, 160),
    scale=st.sampled_from([1.0, 1e-20, 1e20, 3.7]),
    uneven=st.floats(0, 0.4),
    wobble=st.floats(0, 0.003),
    linked=st.booleans(),
    seed=st.integers(0, 2**32),
)
def test_what_is_certified_is_checked(
    tmp_path_factory: pytest.TempPathFactory,
    shape: tuple[int, int],
    n: int,
    scale: float,
    uneven: float,
    wobble: float,
    linked: bool,
    seed: int,
) -> None:
    t = 2 * np.pi * np.arange(n) / n
    t += uneven * np.sin(t)
    (p, q), random = shape, np.random.default_rng(seed)
    away = 2 + 0.8 * np.cos(q * t)
    knot = np.column_stack([away * np.cos(p * t), away * np.sin(p * t), 0.8 * np.sin(q * t)])
    rings = [knot, 3 * circle(n // 2)[:, [0, 2, 1]] + [2.5, 0, 0]] if linked else [knot]
    curve = [scale * (ring + wobble * random.normal(size=ring.shape)) for ring in rings]
    path = tmp_path_factory.mktemp("proofs") / "knot.txt"
    try:
        certificate = package.certify(curve)
    except package.CurveError:
        return
    package.write(path, curve)
    proof = path.with_suffix(".json")
    proof.write_text(json.dumps(certificate.document(path)))
    assert check_certificate.check(proof, path)["l_c"] == str(certificate.l_c)


def stadium(by: float) -> NDArray[np.float64]:
    """Two half circles of radius 1 and two straights, one half being moved away by so much."""
    angle = np.pi * (np.arange(50) + 0.5) / 50
    half = np.column_stack([np.sin(angle), np.cos(angle), 0 * angle])
    x = 2 - 0.1 * np.arange(1, 40)
    straight = np.column_stack([x, np.full(39, -1.0), 0 * x])
    right, left = np.array([2 + by, 0, 0]), np.array([-2, 0, 0])
    return np.concatenate([half + right, straight, left - half, -straight])


def nudged(kind: str, by: float) -> list[NDArray[np.float64]]:
    """A curve whose contact, bend or length has been nudged the wrong way."""
    if kind == "length":
        return [stadium(by)]
    if kind == "bend":
        ellipse = circle(200) * [2, 1, 1]
        ellipse[0] *= 1 + by
        return [ellipse]
    ring, other = circle(60), circle(60)[:, [0, 2, 1]] + [1, 0, 0]
    other[30] += [by, 0, 0]  # its vertex in the centre of the first ring, towards the vertex (1, 0, 0)
    return [ring, other]


@pytest.mark.parametrize("kind", ["contact", "bend", "length"])
def test_what_is_nudged_the_wrong_way_is_refused(tmp_path: Path, kind: str) -> None:
    path, proof = tmp_path / "curve.txt", tmp_path / "curve.json"
    package.write(path, nudged(kind, 0))
    document = package.certify(nudged(kind, 0)).document(path)
    proof.write_text(json.dumps(document))
    assert check_certificate.check(proof, path)["l_c"] == document["l_c"]
    wrong = nudged(kind, 1e-12)
    assert package.certify(wrong).l_c > Fraction(document["l_c"])
    package.write(path, wrong)
    proof.write_text(json.dumps({**document, "sha256": hashlib.sha256(path.read_bytes()).hexdigest()}))
    with pytest.raises(ValueError, match=r"^(?!sha256)\w+: "):
        check_certificate.check(proof, path)
