"""Files of programs for knots: PKF of libbiarc, and KnotPlot's, binary and printed."""

import re
import struct
from collections.abc import Iterator, Sequence
from contextlib import suppress

import numpy as np
import pytest
from knots import Floats, damaged, hopf, trefoil

from sono import CurveError, formats, measure
from sono.formats import FormatError, VertexFile
from sono.formats.vertices import Raw
from sono.invariants import fingerprint


def with_tangents(curve: Floats) -> Floats:
    """Nodes (n, 6) of a smooth curve that is given by many points, their tangents of any length."""
    n = len(curve)
    waves = np.fft.rfft(curve, axis=0) * 1j * np.arange(n // 2 + 1)[:, None]
    return np.column_stack([curve, np.fft.irfft(waves, n, axis=0)])


def pkf(parts: Sequence[Floats], name: str = "a knot") -> str:
    text = f"PKF 0.2\nBIARC_KNOT {name}\nETICL 11\nETIC please cite\nEND\n"
    text += f"CITEL 0\nEND\nHISTL 5\nHIST drawn\nEND\nNCMP {len(parts)}\n"
    for part in parts:
        rows = "".join("NODE " + " ".join(f"{x:.9g}" for x in row) + "\n" for row in part.tolist())
        text += f"COMP {len(part)}\n{rows}END\n"
    return text


def read(content: str) -> VertexFile:
    (curve,) = formats.parse("k.pkf", content.encode())
    return curve


def test_arcs_of_a_circle_are_on_it() -> None:
    curve = read(pkf([with_tangents(hopf(7)[0])]))
    assert len(curve.components[0]) % 14 == 0
    assert np.allclose(np.linalg.norm(curve.components[0], axis=1), 3)
    assert measure(curve.components).l_p == pytest.approx(2 * np.pi, rel=0.02)
    assert curve.where(0, -1) == "k.pkf:19"
    assert curve.comments == ["a knot"]


def test_biarcs_of_a_trefoil() -> None:
    nodes = with_tangents(trefoil(40))
    curve = read(pkf([nodes]))
    far = np.linalg.norm(curve.components[0][:, None] - trefoil(4000), axis=2).min(axis=1)
    assert far.max() < 0.03
    assert [np.abs(curve.components[0] - node[:3]).sum(axis=1).min() for node in nodes] == pytest.approx(
        [0] * 40, abs=1e-7
    )
    assert fingerprint(curve.components) == fingerprint([trefoil()])
    assert curve.doubts() == [f"k.pkf: the biarcs were sampled at {len(curve.components[0])} points"]


def test_few_nodes_are_enough_where_edges_are_not() -> None:
    """Six nodes of a trefoil: the polygon through them meets itself."""
    nodes = with_tangents(trefoil(600))[::100]
    with pytest.raises(CurveError, match="the curve crosses itself"):
        measure([nodes[:, :3]])
    assert fingerprint(read(pkf([nodes])).components) == fingerprint([trefoil()])


def test_links_and_open_curves() -> None:
    curve = read(pkf([with_tangents(ring) for ring in hopf()]))
    assert fingerprint(curve.components) == fingerprint(hopf())
    (raw,) = formats.READERS["pkf"].read(pkf([with_tangents(trefoil(200))[:100]]), "k.pkf")
    assert raw.chains[0].closed is False
    assert np.allclose(raw.chains[0].rows[[0, -1]], trefoil(200)[[0, 99]])
    assert len(raw.chains[0].lines) == len(raw.chains[0].rows)


@pytest.mark.parametrize(
    "nodes",
    [
        trefoil(),
        np.column_stack([trefoil(), np.tile([1.0, 0, 0], (60, 1))]),
        np.column_stack([trefoil(), 0 * trefoil()]),
    ],
    ids=["none", "dummies", "zeros"],
)
def test_without_fitting_tangents_nodes_are_joined_by_edges(nodes: Floats) -> None:
    curve = read(pkf([nodes]))
    assert np.allclose(curve.components[0], trefoil(), atol=1e-6)
    assert curve.doubts() == ["k.pkf: the nodes are joined by edges, as they have no tangents of their own"]


PKF = pkf([with_tangents(trefoil(20))])


def malformed() -> Iterator[tuple[str, str, str]]:
    yield "empty", "", ":1: the file ends where PKF 0.2 should follow"
    yield "plain rows", "0 0 0\n1 0 0\n", ":1: only version 0.2 of PKF is read"
    yield "another version", PKF.replace("0.2", "0.3"), ":1: only version 0.2 of PKF is read"
    yield "no name", "PKF 0.2\n", ":2: the file ends where BIARC_KNOT and a name should follow"
    yield "no ETICL", PKF.replace("ETICL", "ETIC"), ":3: ETICL and a whole number, 0 or more, should stand"
    yield "no end of ETIC", PKF.replace("END\n", ""), r":\d+: the file ends where END should follow"
    yield "no CITEL", PKF.replace("CITEL 0\nEND\n", ""), ":6: CITEL and a whole number, 0 or more"
    yield "no NCMP", PKF.replace("NCMP 1\n", ""), ":11: NCMP and a whole number, 1 or more"
    yield "no components", PKF.replace("NCMP 1", "NCMP 0"), ":11: NCMP and a whole number, 1 or more"
    yield "words of components", PKF.replace("NCMP 1", "NCMP one"), ":11: NCMP and a whole number"
    yield "too many components", PKF.replace("NCMP 1", "NCMP 2"), ":34: the file ends where COMP and a number"
    yield "no nodes", PKF.replace("COMP 20", "COMP 0"), ":12: COMP and a whole number, 3 or more"
    yield "half a count", PKF.replace("COMP 20", "COMP 2.5"), ":12: COMP and a whole number, 3 or more"
    yield (
        "too few nodes",
        PKF.replace("COMP 20", "COMP 21"),
        ":33: NODE and x y z, and mostly a tangent, should",
    )
    yield (
        "too many nodes",
        PKF.replace("COMP 20", "COMP 19"),
        ":32: END should stand here, after as many NODEs",
    )
    yield (
        "cut off",
        PKF[: len(PKF) // 2].rpartition("\n")[0] + "\n",
        r":\d+: the file ends where NODE and its numbers",
    )
    yield "cut in a row", PKF[: len(PKF) // 2], r":\d+: .*"
    yield "four numbers", PKF.replace("NODE 6 0 0", "NODE 6 0 0 0 0 0 0"), ":13: NODE and x y z, and mostly"
    yield "no tag", PKF.replace("NODE 6", "6"), ":13: NODE and x y z, and mostly a tangent"
    yield "a word", PKF.replace("NODE 6", "NODE six"), ":13: 'six' is not a number"
    yield (
        "mixed",
        PKF.replace("END\nNCMP", "END\nNCMP").replace("NODE 6 0 0 ", "NODE 6 0 0\nNODE ", 1),
        r":\d+: .*",
    )
    yield "not finite", PKF.replace("NODE 6", "NODE nan"), ":13: 6 finite numbers should stand here"
    yield (
        "twice",
        PKF.replace("COMP 20", "COMP 40").replace("END\n", "").replace("NCMP", "END\nNCMP"),
        r":\d+: .*",
    )
    yield (
        "a tangent back",
        pkf([with_tangents(trefoil(20)) * [1, 1, 1, -1, -1, -1]]),
        ":13: no biarc goes from",
    )
    yield (
        "a tangent of zero",
        re.sub(r"(NODE 6 0 0) .*", r"\1 0 0 0", PKF),
        ":13: no biarc goes from this node",
    )
    yield "crossed", pkf([with_tangents(trefoil(20) * [1, 1, 0])]), ":13: the curve meets itself, or nearly"


@pytest.mark.parametrize(("content", "message"), [pytest.param(b, c, id=a) for a, b, c in malformed()])
def test_what_is_wrong_with_pkf_is_said_in_one_line(content: str, message: str) -> None:
    with pytest.raises(FormatError, match=rf"^k\.pkf{message}") as caught:
        read(content)
    assert "\n" not in str(caught.value)


@pytest.mark.filterwarnings("error")
def test_damaged_pkf_raises_nothing_else() -> None:
    for text in damaged(PKF, 150):
        with suppress(FormatError):
            read(text)


def field(name: bytes, content: bytes = b"") -> bytes:
    return name + (struct.pack(">I", len(content)) if name.isupper() else b"") + content


def knotplot(parts: Sequence[Floats], name: bytes = b"LOCD", kind: str = ">f8", closed: int = 1) -> bytes:
    head = b"KnotPlot 1.0\n# a link\n\f\n" + field(b"NAME", b"a link")
    attributes = field(b"Attr", struct.pack(">I", 0x100 | closed))
    components = [field(b"comp") + attributes + field(name, part.astype(kind).tobytes()) for part in parts]
    return head + b"".join(components) + field(b"endf")


def raw(data: bytes) -> Raw:
    (only,) = formats.BINARY["knotplot"].read(data, "k.k")
    return only


@pytest.mark.parametrize(("name", "kind"), [(b"LOCD", ">f8"), (b"LOCF", ">f4")])
def test_knotplot(name: bytes, kind: str) -> None:
    (curve,) = formats.parse("9.2.57", knotplot(hopf(), name, kind))
    assert [np.allclose(a, b, atol=1e-5) for a, b in zip(curve.components, hopf(), strict=True)] == [
        True,
        True,
    ]
    assert curve.comments == ["a link"]
    assert raw(knotplot(hopf(), closed=0)).chains[0].closed is False
    # One component in two fields, and without the field that begins it.
    halves = field(b"LOCD", trefoil()[:20].astype(">f8").tobytes()) + field(
        b"LOCD", trefoil()[20:].astype(">f8").tobytes()
    )
    (chain,) = raw(b"KnotPlot 1.0\n\f\n" + halves + b"endf").chains
    assert np.array_equal(chain.rows, trefoil())


def test_scaled_coordinates_of_knotplot() -> None:
    low, scale = trefoil().min(axis=0), 12 / 65535
    counts = np.rint((trefoil() - low) / scale).astype(">u2").tobytes()
    data = field(b"LOCS", np.array([scale, *low], ">f4").tobytes() + counts)
    (chain,) = raw(b"KnotPlot 1.0\n\f\ncomp" + data + b"endf").chains
    assert np.allclose(chain.rows, trefoil(), atol=2e-4)


FILE = knotplot([trefoil()])


@pytest.mark.parametrize(
    ("data", "message"),
    [
        (b"KnotPlot 1.0", "the file ends within a field"),
        (FILE[:40], "the file ends within a field"),
        (FILE[:-4], "the file ends within a field"),
        (b"KnotPlot 1.0\ncompendf", "the file ends within a field"),
        (FILE.replace(b"LOCD", b"L\0CD"), r"'L\\x00CD' is no field of KnotPlot"),
        (FILE.replace(b"LOCD", b"LOCC"), "coordinates as LOCC are not read"),
        (FILE.replace(b"LOCD", b"COLR"), "the file holds no coordinates"),
        (knotplot([trefoil()]).replace(b"comp", b"endf"), "the file holds no coordinates"),
        (b"KnotPlot 1.0\n\f\ncomp" + field(b"LOCD", b"\0" * 25) + b"endf", "a field LOCD is 25 bytes long"),
        (b"KnotPlot 1.0\n\f\ncomp" + field(b"LOCS", b"\0" * 15) + b"endf", "a field LOCS is 15 bytes long"),
        (knotplot([np.full((4, 3), np.nan)]), "a coordinate is not finite"),
        (knotplot([trefoil()[:2]]), "too few vertices: 2"),
    ],
)
def test_what_is_wrong_with_knotplot_is_said_in_one_line(data: bytes, message: str) -> None:
    with pytest.raises(FormatError, match=rf"^k:1: .*{message}"):
        formats.parse("k", data)


def test_damaged_knotplot_raises_nothing_else() -> None:
    draw = np.random.default_rng(0)
    data = knotplot(hopf(), b"LOCF", ">f4")
    for _ in range(300):
        damaged_data = bytearray(data)
        for place in draw.integers(12, len(data), 3):
            damaged_data[place] = draw.integers(256)
        for content in (bytes(damaged_data), data[: draw.integers(12, len(data))]):
            with suppress(FormatError):
                formats.parse("k", content)


def test_what_knotplot_prints() -> None:
    text = "".join(
        f"Component {i} of 2:\n" + "".join(f"{x} {y} {z}\n" for x, y, z in part.tolist())
        for i, part in enumerate(hopf(), 1)
    )
    (curve,) = formats.parse("k.txt", text.encode())
    assert [np.array_equal(a, b) for a, b in zip(curve.components, hopf(), strict=True)] == [True, True]
    assert [curve.where(0, 0), curve.where(1, 0)] == ["k.txt:2", "k.txt:27"]
    with pytest.raises(FormatError, match=r"^k\.txt:2: "):
        formats.parse("k.txt", text.replace("3.0", "three", 1).encode())
