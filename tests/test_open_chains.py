"""Open chains: refused as they are, and closed as the user asks, with the type that this gives."""

import numpy as np
import pytest
from conftest import Sono
from hypothesis import given
from hypothesis import strategies as st
from numpy.typing import NDArray

import sono as package
from sono import formats, starts
from sono.formats import FormatError, vect
from sono.formats.closing import closing
from sono.formats.vertices import Chain, Raw, VertexFile
from sono.invariants import fingerprint

Floats = NDArray[np.float64]

KNOT = starts.start("3_1")[0]
"""A closed trefoil, from which a piece can be cut."""

TAIL = np.linspace(1, 4, 40)[:, None]


def cut(knot: Floats = KNOT) -> Floats:
    """A knot cut open where it is outermost, with its ends drawn far apart, outwards."""
    first = int(np.linalg.norm(knot - knot.mean(axis=0), axis=1).argmax())
    chain = np.roll(knot, -first, axis=0)
    out = chain[0] - knot.mean(axis=0)
    side = 0.5 * np.cross(out, [0, 0, 1])
    return np.vstack([chain[1] + (out - side) * TAIL[::-1], chain[1:-1], chain[-2] + (out + side) * TAIL])


def checked(rows: Floats, closed: bool | None, close: formats.Close | None = None) -> VertexFile:
    return VertexFile.checked("k", Raw([Chain(rows, range(1, len(rows) + 1), closed)]), close)


def test_an_open_chain_is_refused_with_the_cure() -> None:
    for closed in (False, None):
        with pytest.raises(
            FormatError, match=r"^k:\d+: the chain is open: it .* line 1; --close direct joins"
        ):
            checked(cut(), closed)


def test_ends_decide_where_the_format_does_not() -> None:
    assert len(checked(KNOT, None).components[0]) == len(KNOT)
    with pytest.raises(FormatError, match="the chain is open"):
        checked(KNOT, False)
    repeated = np.vstack([KNOT, KNOT[:1]])
    for close in (None, "direct", "sphere"):
        file = checked(repeated, False, close)
        assert (len(file.components[0]), file.doubts()) == (len(KNOT), [])


@pytest.mark.parametrize("close", ["direct", "sphere"])
@pytest.mark.parametrize("closed", [True, False, None])
def test_a_closed_chain_has_no_giant_edge_and_the_right_type(close: formats.Close, closed: bool) -> None:
    file = checked(cut(), closed, close)
    (vertices,) = file.components
    edges = np.linalg.norm(np.roll(vertices, -1, axis=0) - vertices, axis=1)
    assert edges[len(cut()) - 1 :].max() < 2 * edges.mean()
    assert (vertices[: len(cut())] == cut()).all()
    assert len(file.lines[0]) == len(vertices)
    (note,) = file.doubts()
    assert note.startswith(f"k:{len(cut())}: the open chain that ends here was closed to line 1 by ")
    assert fingerprint([vertices]) == fingerprint([KNOT])


@pytest.mark.parametrize("name", ["4_1", "5_1", "m5_2", "6_3", "8_19"])
def test_ends_that_reach_out_keep_the_knot(name: str) -> None:
    (knot,) = starts.start(name)
    file = checked(cut(knot), False, "sphere")
    assert fingerprint(file.components) == fingerprint([knot])


def test_the_two_ways_may_give_two_knots() -> None:
    chain = KNOT[:-12]
    types = [fingerprint(checked(chain, False, close).components) for close in ("direct", "sphere")]
    assert types == [fingerprint([KNOT]), fingerprint(starts.start("unknot"))]


def test_closed_chains_are_left_alone() -> None:
    for close in ("direct", "sphere"):
        file = checked(KNOT, True, close)
        assert (bool((file.components[0] == KNOT).all()), file.doubts()) == (True, [])


@given(
    st.integers(3, 40).flatmap(
        lambda n: st.lists(st.tuples(*[st.integers(-5, 5)] * 3), min_size=n, max_size=n, unique=True)
    ),
    st.sampled_from(["direct", "sphere"]),
    st.sampled_from([1e-100, 1.0, 1e100]),
)
def test_any_chain_is_closed_by_finite_steps(
    points: list[tuple[int, int, int]], close: formats.Close, scale: float
) -> None:
    chain = scale * np.array(points, float)
    added = closing(chain, close)
    assert np.isfinite(added).all()
    assert len(added) < 100 * len(chain)
    whole = np.vstack([chain, added])
    edges = np.linalg.norm(np.roll(whole, -1, axis=0) / scale - whole / scale, axis=1)
    mean = edges[: len(chain) - 1].mean()
    assert (edges[len(chain) - 1 :] < 1.6 * mean).all()
    assert (edges > 0).all()
    assert (added == closing(chain, close)).all()


@pytest.mark.parametrize(
    "ends",
    [
        [[-5, 0, 0], [5, 0, 0]],  # on opposite sides
        [[5, 0, 0], [6, 0, 0]],  # on the same side, behind each other
        [[0, 0, 0], [5, 0, 0]],  # one in the centre
    ],
)
def test_ends_in_special_places(ends: list[list[float]]) -> None:
    around = np.array([[0, 3, 0.1], [0, 0, 3], [0, -3, 0], [0, 0, -3]]) - [1, 0, 0] * np.ones((4, 1))
    chain = np.vstack([ends[0], around, ends[1]])
    chain[1:-1] -= chain.mean(axis=0) * len(chain) / 4  # so that the centre of mass is where it should be
    assert abs(chain.mean(axis=0)).max() < 1e-12
    file = checked(chain, False, "sphere")
    assert np.isfinite(package.measure(file.components).l_p)


def test_the_command_and_the_call(sono: Sono) -> None:
    with open("k.vect", "w") as file:
        file.write(vect.write([cut()], []).replace(f"\n-{len(cut())}\n", f"\n{len(cut())}\n"))
    refused = sono("measure", "k.vect")
    assert (refused.exit_code, refused.stdout.count("\n")) == (1, 1)
    assert "the chain is open" in refused.stderr
    for close in ("direct", "sphere"):
        done = sono("measure", "k.vect", "--close", close, "--columns", "n,l_p")
        assert done.exit_code == 0
        assert "was closed to line" in done.stderr
        curve = package.read("k.vect", close=close)
        assert done.stdout.splitlines()[1].startswith(f"{curve.n}\t")
    assert sono("measure", "k.vect", "--close", "wrong").exit_code == 2
    with pytest.raises(ValueError, match="close = 'wrong': give 'direct' or 'sphere'"):
        package.read("k.vect", close="wrong")  # type: ignore[arg-type]


def test_rows_are_closed_as_asked_where_they_look_open(sono: Sono) -> None:
    formats.write("k.txt", [cut()])
    as_it_is = sono("measure", "k.txt")
    assert "if this chain is open" in as_it_is.stderr
    assert "--close sphere" in as_it_is.stderr
    closed = sono("measure", "k.txt", "--close", "sphere")
    assert "if this chain is open" not in closed.stderr
    assert closed.stdout != as_it_is.stdout
