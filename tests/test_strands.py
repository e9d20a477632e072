"""Chains that are not closed: described as they are, by brute force and by curves that are known."""

import csv
import math
from pathlib import Path

import numpy as np
import pytest
from conftest import Sono
from knots import Floats, hopf, trefoil
from numpy.typing import NDArray

import sono as package
from sono import _core, formats, strands
from sono.formats import FormatError
from sono.formats.boxes import Box
from sono.formats.doubts import ends_apart
from sono.formats.images import MOVED, UNCLEAR, gathered

RNG = np.random.default_rng(5)


def walk(n: int, seed: int = 1) -> Floats:
    steps = np.random.default_rng(seed).normal(size=(n, 3))
    return np.cumsum(steps / np.linalg.norm(steps, axis=1)[:, None], axis=0)


def dump(frames: list[list[Floats]], side: float) -> str:
    """Write wrapped molecules, without image flags."""
    blocks = []
    for step, chains in enumerate(frames):
        rows = [(mol, *(row % side)) for mol, chain in enumerate(chains, 1) for row in chain]
        atoms = [f"{k} {mol} {x} {y} {z}" for k, (mol, x, y, z) in enumerate(rows, 1)]
        head = ["ITEM: TIMESTEP", f"{step * 10}", "ITEM: NUMBER OF ATOMS", f"{len(atoms)}"]
        box = ["ITEM: BOX BOUNDS pp pp pp", *[f"0 {side}"] * 3, "ITEM: ATOMS id mol x y z"]
        blocks += [*head, *box, *atoms]
    return "\n".join(blocks) + "\n"


def test_closed_chains_writhe_as_the_core_says() -> None:
    for curve in ([trefoil()], hopf(), [walk(30, 3)]):
        assert np.allclose(strands.writhe(curve, [True] * len(curve)), _core.writhe(curve), atol=1e-6)


def test_the_writhe_of_an_open_chain_is_what_is_seen_of_it() -> None:
    chain = walk(25)
    found = package.descriptors(chain, closed=False)
    signs = [_signs(chain, view) for view in RNG.normal(size=(3000, 3))]
    assert abs(np.mean([sum(seen) for seen in signs]) - found.writhe) < 0.15
    assert abs(np.mean([len(seen) for seen in signs]) - found.acn) < 0.3
    mirrored = package.descriptors(chain * [1, 1, -1], closed=False)
    assert (mirrored.writhe, mirrored.acn) == pytest.approx((-found.writhe, found.acn))


def _signs(chain: Floats, view: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return the signs of the crossings that are seen from one side."""
    turned, _ = np.linalg.qr(np.column_stack([view, np.eye(3)[:, :2]]))
    corners = np.roll(chain @ (turned * np.sign(np.linalg.det(turned))), -1, axis=1)
    edges = np.diff(corners, axis=0)
    i, j = np.triu_indices(len(edges), 2)
    u, v, w = edges[i], edges[j], corners[j] - corners[i]
    turn = _turn(u, v)
    s, t = _turn(w, v) / turn, _turn(w, u) / turn
    above = corners[i, 2] + s * u[:, 2] > corners[j, 2] + t * v[:, 2]
    return (np.sign(turn) * np.where(above, 1, -1))[(s > 0) & (s < 1) & (t > 0) & (t < 1)]


def _turn(u: NDArray[np.float64], v: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return how far two vectors turn in the plane of x and y."""
    return u[:, 0] * v[:, 1] - u[:, 1] * v[:, 0]


def test_a_straight_chain_and_a_half_circle() -> None:
    rod = package.descriptors(np.arange(11)[:, None] * [[1.0, 0, 0]], closed=False)
    assert (rod.writhe, rod.acn, rod.total_curvature, rod.max_curvature, rod.contacts) == (0, 0, 0, 0, None)
    assert (rod.diameter, rod.radius_of_gyration) == pytest.approx((10, math.sqrt(100 / 12)))
    angles = np.linspace(0, math.pi, 101)
    half = package.descriptors(np.stack([np.cos(angles), np.sin(angles), 0 * angles], 1), closed=False)
    assert half.total_curvature == pytest.approx(math.pi * 99 / 100)
    assert (half.max_curvature, half.diameter) == pytest.approx((1, 2), rel=1e-3)


@pytest.mark.parametrize(
    "rows", [[[0, 0, 0]], [[0, 0, 0], [0, 0, 0], [1, 0, 0]], [[0, 0, 0], [1, 0, math.nan]]]
)
def test_what_is_no_chain_is_refused(rows: list[list[float]]) -> None:
    with pytest.raises(ValueError, match="chain 0 needs"):
        package.descriptors(rows, closed=False)


def test_measure_describes_the_files_own_vertices(sono: Sono) -> None:
    chain = walk(40) + np.arange(40)[:, None] * [0.5, 0, 0] + 30  # ends far apart
    Path("open.lammpstrj").write_text(dump([[chain], [chain * 1.01]], 100))
    columns = "file,n,length,writhe,acn,radius_of_gyration,gyration_1,diameter"
    true = package.descriptors(chain, closed=False)
    for more, n in ((), 40), (("--close", "sphere"), None):
        done = sono("measure", "open.lammpstrj", "--columns", columns, "--format", "csv", *more)
        row = next(csv.DictReader(done.stdout.splitlines()))
        assert done.exit_code == 0
        assert (int(row["n"]) == 40) == (n == 40)
        for key in ("writhe", "acn", "radius_of_gyration", "diameter"):
            assert float(row[key]) == pytest.approx(getattr(true, key), rel=1e-6)
    assert done.stderr.count("was closed to line") == 1
    assert "in all 2 curves of the file" in done.stderr
    refused = sono("measure", "open.lammpstrj", "--columns", "file,n,l_p")
    assert (refused.exit_code, "the chain is open" in refused.stderr) == (1, True)


@pytest.mark.parametrize(
    ("gap", "ring"), [(1.0, True), (1.4, True), (1.9, False), (3.0, False), (9.0, False)]
)
@pytest.mark.parametrize("name", ["k.lammpstrj", "k.xyz", "k.txt", "k.gro", "k.npy"])
def test_an_explicit_closure_counts_unless_the_ends_are_a_bond_apart(
    gap: float, ring: bool, name: str, folder: Path
) -> None:
    n = 60
    # A circle with edges of 1, but for the one that closes it.
    radius = (n + gap - 1) / math.tau
    angles = np.arange(n) / radius
    chain = np.stack([radius * np.cos(angles), radius * np.sin(angles), 0 * angles], 1) + 50
    if name.endswith("lammpstrj"):
        Path(name).write_text(dump([[chain]], 200))
    elif name.endswith("gro"):
        rows = [
            f"{k:>5}{'PE':<5}{'C':>5}{k:>5}{x:8.3f}{y:8.3f}{z:8.3f}" for k, (x, y, z) in enumerate(chain, 1)
        ]
        Path(name).write_text("\n".join(["t", f"{n}", *rows, "200.0 200.0 200.0", ""]))
    elif name.endswith("xyz"):
        Path(name).write_text("\n".join([f"{n}", "", *(f"C {x} {y} {z}" for x, y, z in chain)]))
    else:
        formats.write(name, [chain])
    file = formats.read(name, "sphere")
    assert file.rings == [ring]
    assert (len(file.components[0]) == n) == ring
    assert any("--close leaves it alone" in note for note in file.notes) == ring
    assert ends_apart(chain) != ring


def rings(apart: Floats) -> list[Floats]:
    """Two linked circles, the second one moved."""
    one, other = hopf(30, 3.0)
    return [one + 50, other + 50 + apart]


@pytest.mark.parametrize("shift", [[0, 0, 0], [46.0, 0, 0], [47, 48, 0], [44, 49, 51], [50, 50, 50]])
def test_links_across_the_boundary_are_found(shift: list[float], folder: Path) -> None:
    chains = [ring + shift for ring in rings(np.zeros(3))]
    Path("k.lammpstrj").write_text(dump([chains], 100))
    assert "L2a1" in str(package.identify(package.read("k.lammpstrj")).name)


@pytest.mark.parametrize("flags", [[1, 0, 0], [-3, 2, 0], [0, 0, 7]])
def test_any_image_of_a_linked_ring_is_the_same(flags: list[int]) -> None:
    box = Box(np.zeros(3), np.array([[20.0, 0, 0], [5, 20, 0], [3, -4, 20]]), np.full(3, True))
    one, other = rings(np.zeros(3))
    (here, there), notes = gathered(box, [one, other + np.array(flags) @ box.edges])
    assert notes == [MOVED]
    assert np.allclose(here, one)
    assert np.allclose(there, other)


def test_chains_that_no_image_links_stay_and_large_ones_are_told() -> None:
    one, other = rings(np.array([40.0, 0, 0]))
    wide = Box(np.zeros(3), np.eye(3) * 100, np.full(3, True))
    assert gathered(wide, [one, other])[1] == []
    for axes, told in ((True, True, True), True), ((False, False, False), False):
        small = Box(np.zeros(3), np.eye(3) * 8, np.array(axes))
        assert (UNCLEAR in gathered(small, rings(np.zeros(3)))[1]) == told


def test_a_chain_joins_others_by_way_of_a_third() -> None:
    ring = trefoil()
    box = Box(np.zeros(3), np.eye(3) * 30, np.full(3, True))
    row = [ring + np.array([4.0 * k, 0, 0]) for k in range(4)]
    scattered = [part + 30 * RNG.integers(-2, 3, 3) for part in row]
    found, _ = gathered(box, scattered)
    for k, part in enumerate(found):
        assert np.allclose(part - found[0], row[k] - row[0])


def gro(residues: list[tuple[int, str]], rows: Floats) -> str:
    lines = [
        f"{number:>5}{'PE':<5}{called:>5}{k % 100000:>5}{x:8.3f}{y:8.3f}{z:8.3f}"
        for k, ((number, called), (x, y, z)) in enumerate(zip(residues, rows, strict=True), 1)
    ]
    return "\n".join(["t", f"{len(lines)}", *lines, "90.0 90.0 90.0", ""])


@pytest.mark.parametrize("kind", ["a residue a molecule", "numbers go back"])
def test_molecules_of_gro(kind: str, folder: Path) -> None:
    chains = hopf(30, 3.0)
    numbers = [1] * 30 + [2] * 30 if kind.startswith("a") else [*range(1, 31)] * 2
    Path("k.gro").write_text(gro([(number, "C") for number in numbers], np.vstack(chains) + 40))
    assert [len(part) for part in formats.read("k.gro").components] == [30, 30]


def test_numbers_after_99999_go_on(folder: Path) -> None:
    ring = trefoil(60) + 40
    Path("k.gro").write_text(gro([((99970 + k) % 100000, "C") for k in range(60)], ring))
    assert len(formats.read("k.gro").components) == 1
    Path("bad.gro").write_text(gro([(1, "C")] * 60, ring).replace("    1PE", "   xxPE"))
    assert len(formats.read("bad.gro").components) == 1


@pytest.mark.parametrize(
    ("name", "keys"),
    [("k.lammpstrj", ["0"]), ("k.xyz", ["1"]), ("k.gro", ["1", "1:1"]), ("k.pd", ["a"])],
)
def test_the_only_curve_of_a_file_has_its_key(name: str, keys: list[str], folder: Path) -> None:
    ring = trefoil(60) + 40
    content = {
        "k.lammpstrj": dump([[ring]], 100),
        "k.xyz": "\n".join(["60", "", *(f"C {x} {y} {z}" for x, y, z in ring)]),
        "k.gro": gro([(k, "C") for k in range(1, 61)], ring),
        "k.pd": "a: X[1,5,2,4] X[3,1,4,6] X[5,3,6,2]\n",
    }[name]
    Path(name).write_text(content)
    (alone,) = formats.read_all(name)
    assert alone.key == ""
    for key in keys:
        (found,) = formats.read_all(f"{name}:{key}")
        assert np.array_equal(found.components[0], alone.components[0])
    with pytest.raises(FormatError, match=f"holds no curve 'no'; there are: {keys[0]}"):
        formats.read(f"{name}:no")


def test_a_key_of_a_file_that_has_none(folder: Path) -> None:
    formats.write("k.npy", [trefoil()])
    with pytest.raises(FormatError, match="give the file without a key"):
        formats.read("k.npy:1")


@pytest.mark.parametrize(
    ("name", "data"),
    [
        ("a.xtc", b""),
        ("a.TRR", b"any"),
        ("a.dcd", b"any"),
        ("a", b"\0\0\7\xcb\0\0"),
        ("a.dat", b"\0\0\7\xc9\0"),
        ("b", b"T\0\0\0CORD"),
    ],
)
def test_trajectories_are_refused_with_what_writes_others(name: str, data: bytes, sono: Sono) -> None:
    Path(name).write_bytes(data)
    done = sono("identify", name)
    assert done.exit_code == 1
    assert f"trjconv -f {name}" in done.stderr


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        (["identify", "--columns", "writhe"], "`sono measure` has it"),
        (["measure", "--columns", "n,determinant"], "`sono identify` has it"),
        (["measure", "--columns", "published"], "there are: knot, file, n"),
        (["measure", "--columns", "rg"], "did you mean radius_of_gyration?"),
        (["measure", "--columns", "writh"], "did you mean writhe"),
    ],
)
def test_columns_that_a_command_has_not(arguments: list[str], said: str, sono: Sono) -> None:
    done = sono(*arguments, "3_1.txt")
    assert (done.exit_code, said in " ".join(done.stderr.split())) == (2, True)


def test_csv_has_empty_cells_and_tsv_dashes(sono: Sono) -> None:
    Path("coarse.txt").write_text("0 0 0\n2 0 0\n2 2 1\n0 2 0\n")
    cells = {
        format: sono("measure", "coarse.txt", "--columns", "n,l_c", "--format", format).stdout.splitlines()[1]
        for format in ("csv", "tsv")
    }
    assert cells == {"csv": "4,", "tsv": "4\t-"}
    assert "no L_c" not in sono("measure", "coarse.txt", "--columns", "n").stderr


def test_an_l_for_a_1_has_the_nearest_name() -> None:
    with pytest.raises(ValueError, match="did you mean '3_1'"):
        package.start("3_l")


@pytest.mark.parametrize("seed", range(20))
def test_a_ring_of_uneven_bonds_is_left_alone(seed: int) -> None:
    ring = trefoil(60) + 0.1 * np.random.default_rng(seed).normal(size=(60, 3))
    for first in range(0, 60, 7):
        assert not ends_apart(np.roll(ring, first, axis=0))
