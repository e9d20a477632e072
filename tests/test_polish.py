"""What SONO and the polish reach together: the paper's tables beaten, balanced forces, the best of trials."""

import csv
from pathlib import Path

import numpy as np
import pytest
from conftest import QUICK, Sono

import sono as library
from sono import formats, starts
from sono.curve import as_components
from sono.tightening import Run, Tight

PAPER = Path(__file__).parent / "paper" / "tables.csv"


def rows(knot: str) -> list[dict[str, str]]:
    with PAPER.open(encoding="utf-8") as stream:
        return [row for row in csv.DictReader(stream) if row["knot"] == knot]


def table(knot: str, targets: list[int]) -> list[Tight]:
    run = Run(as_components(starts.start(knot)), targets, {})
    tight = []
    while run.targets:
        tight.append(run.tighten())
        run.next_target()
    return tight


@pytest.mark.slow
@pytest.mark.parametrize("knot", ["3_1", "5_1", "7_1", "9_1"])
def test_every_row_of_the_papers_tables_is_beaten(knot: str) -> None:
    printed = rows(knot)
    for row, tight in zip(printed, table(knot, [int(row["n"]) for row in printed]), strict=True):
        assert tight.converged
        assert tight.measures.l_p <= float(row["L_p"])
        assert tight.measures.l_c is not None
        assert tight.measures.l_c <= float(row["L_c"])


def test_the_trefoil_to_seven_digits() -> None:
    # Przybyl and Pieranski (2014): 32.742934477.
    (tight,) = table("3_1", [1920])
    assert tight.measures.l_p <= 32.74276
    assert tight.measures.l_c is not None
    assert tight.measures.l_c <= 32.74372
    assert tight.measures.l_a == pytest.approx(32.742934, abs=3e-6)


def test_figure_eight_at_dl_0_1() -> None:
    (tight,) = table("4_1", [420])
    assert tight.measures.l_a is not None
    assert tight.measures.l_a <= 42.0843


def test_a_tight_rope_carries_its_physics() -> None:
    tight = library.tighten(starts.start("4_1"), 140, trials=2)
    assert tight.converged
    assert tight.residual is not None
    assert tight.residual <= 1e-8
    assert tight.mu == pytest.approx(1e-11)
    assert tight.excess is not None
    assert 0 < tight.excess < 1e-7
    forces = tight.forces
    assert forces is not None
    assert forces.tension.shape == forces.couple.shape == (140,)
    assert forces.contacts.shape == (len(forces.pressing), 2)
    # The net force on each bead, from the vertices and the forces alone, away from the bent parts.
    (v,) = tight.curve
    onward = np.roll(v, -1, axis=0) - v
    pull = forces.tension[:, None] * onward / np.linalg.norm(onward, axis=1)[:, None]
    net = pull - np.roll(pull, 1, axis=0)
    apart = v[forces.contacts[:, 0]] - v[forces.contacts[:, 1]]
    push = forces.pressing[:, None] * apart / np.linalg.norm(apart, axis=1)[:, None]
    np.add.at(net, forces.contacts[:, 0], push)
    np.add.at(net, forces.contacts[:, 1], -push)
    bent = forces.couple > 1e-6
    near_bent = bent | np.roll(bent, 1) | np.roll(bent, -1)
    assert (~near_bent).sum() > 20
    assert np.abs(net[~near_bent]).max() < 1e-4


def test_sono_alone_has_no_physics() -> None:
    tight = library.tighten(starts.start("3_1"), 60, method="sono", settings={"anneal_sweeps": 5000})
    assert (tight.residual, tight.mu, tight.excess, tight.forces) == (None, None, None, None)
    assert tight.sweeps > 0 == tight.factorisations


def test_several_trials_find_a_better_shape() -> None:
    # From this start nearly all gentle anneals end at L_a 61.508.
    tight = library.tighten(starts.start("7_1"), 154)
    assert len(tight.shapes) == 8
    assert tight.measures.l_a is not None
    assert tight.measures.l_a == pytest.approx(min(tight.shapes), rel=1e-6)
    assert tight.measures.l_a < 61.41 < max(tight.shapes)


def test_trials_that_agree_are_enough() -> None:
    assert len(library.tighten(starts.start("3_1"), 60).shapes) == 4
    assert len(library.tighten(starts.start("3_1"), 60, trials=3).shapes) == 3
    with pytest.raises(ValueError, match="trials = 0 is too small"):
        library.tighten(starts.start("3_1"), 60, trials=0)


def test_an_unknown_method() -> None:
    with pytest.raises(ValueError, match="unknown method 'newton'; the methods are: both, sono, polish"):
        library.tighten(starts.start("3_1"), 60, method="newton")  # type: ignore[arg-type]


def test_the_run_says_what_it_tried(sono: Sono) -> None:
    options = ("--trials", "2", "--set", "anneal_sweeps=5000")
    result = sono("tighten", "3_1.txt", "-n", "60", *options)
    assert result.exit_code == 0
    assert result.stderr.startswith("sono: 3_1: 2 trials at n = 60 ended at L_a 32.7192 (2 of them)")
    assert "residual" in Path("3_1.n60.txt").read_text().splitlines()[3]
    assert sono("tighten", "3_1.txt", "-n", "60", "-o", "q.txt", "--quiet", *options).stderr == ""


def test_contacts_file(sono: Sono) -> None:
    assert sono("tighten", "Hopf.txt", "-n", "80", *QUICK, "--contacts", "forces.tsv").exit_code == 0
    lines = [line for line in Path("forces.tsv").read_text().splitlines() if not line.startswith("#")]
    kinds = [row["kind"] for row in csv.DictReader(lines, delimiter="\t")]
    assert (kinds.count("tension"), kinds.count("couple")) == (80, 80)
    for row in csv.DictReader(lines, delimiter="\t"):
        assert float(row["force"]) >= 0
        if row["kind"] == "contact":
            assert int(row["i"]) < 40 <= int(row["j"]) < 80
    assert kinds.count("contact") > 80


def test_contacts_of_several(sono: Sono) -> None:
    line = ("tighten", "3_1.txt", "-n", "40,60", *QUICK, "--contacts")
    assert sono(*line, "one.tsv").exit_code == 2
    assert sono(*line, "folder/", "-o", "tight/").exit_code == 0
    assert sorted(path.name for path in Path("folder").iterdir()) == [
        "3_1.n40.contacts.tsv",
        "3_1.n60.contacts.tsv",
    ]
    assert sono(*line, "folder/", "-o", "again/").exit_code == 2  # they are there
    assert sono(*line, "x.tsv", "--method", "sono").exit_code == 2


def test_a_lost_contacts_file_is_made_again(sono: Sono) -> None:
    line = ("tighten", "3_1.txt", "-n", "60", *QUICK, "--contacts", "forces.tsv", "--resume")
    assert sono(*line).exit_code == 0
    vertices = Path("3_1.n60.txt").read_bytes()
    Path("forces.tsv").unlink()
    assert sono(*line).exit_code == 0
    assert Path("forces.tsv").exists()
    assert Path("3_1.n60.txt").read_bytes() == vertices


def test_residual_of_any_curve(sono: Sono) -> None:
    assert sono("tighten", "3_1.txt", "-n", "60", *QUICK).exit_code == 0
    result = sono("measure", "--residual", "3_1.n60.txt", "3_1.txt", "--format", "csv", "--quiet")
    assert result.exit_code == 0
    tight, loose = csv.DictReader(result.stdout.splitlines())
    assert float(tight["residual"]) < 1e-6
    assert float(loose["residual"]) > 0.1
    assert library.forces(formats.read("3_1.n60.txt").components).residual == float(tight["residual"])


def test_tight_files_are_kept_by_resume(sono: Sono) -> None:
    line = ("tighten", "3_1.txt", "-n", "60", *QUICK, "--resume", "--columns", "n,l_p,status")
    first, again = sono(*line), sono(*line)
    assert (first.exit_code, again.exit_code) == (0, 0)
    assert first.stdout == again.stdout
