"""The samples of simulations, molecules and ideal knots: what each holds, and of which type it is."""

from pathlib import Path

import pytest
from knots import hopf, trefoil

from sono import formats
from sono.invariants import fingerprint

SAMPLES = Path(__file__).parent / "samples"
TREFOIL, HOPF = [trefoil()], hopf()
MIRRORED = trefoil() * [1, 1, -1]

HOLD = {
    "rings.lammpstrj": {"0": HOPF, "10000": HOPF},
    "trefoil.data": {"": TREFOIL},
    "protein.pdb": {"A": TREFOIL, "B": [MIRRORED]},
    "hopf.ent": {"1": HOPF, "2": HOPF},
    "ideal.txt": {"3:1:1": TREFOIL, "L2a1": HOPF},
    "knot.3_1.fseries": {"": TREFOIL},
    "trefoil.pkf": {"": TREFOIL},
    "hopf.knotplot": {"": HOPF},
    "hopf.coords.txt": {"": HOPF},
    "knot.cif": {"A": TREFOIL, "B": [MIRRORED]},
}
"""What is in each sample: curves of the same type, by key."""


@pytest.mark.parametrize("name", HOLD)
def test_samples_are_read(name: str) -> None:
    if name.endswith(".cif"):
        pytest.importorskip("gemmi")
    curves = formats.read_all(SAMPLES / name, close="direct")
    assert {curve.key: fingerprint(curve.components) for curve in curves} == {
        key: fingerprint(components) for key, components in HOLD[name].items()
    }


@pytest.mark.parametrize("name", HOLD)
def test_samples_are_recognised_by_their_content(name: str, tmp_path: Path) -> None:
    if name.endswith(".cif"):
        pytest.importorskip("gemmi")
    (tmp_path / "k.txt").write_bytes((SAMPLES / name).read_bytes())
    assert [curve.key for curve in formats.read_all(tmp_path / "k.txt", close="direct")] == list(HOLD[name])
