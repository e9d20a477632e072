"""Torus knots and links proven by their closed braids, and what is none."""

import re
from fractions import Fraction
from itertools import product
from pathlib import Path

import numpy as np
import pytest
from conftest import Sono

import sono
from sono import formats
from sono.curve import Components
from sono.invariants.braids import _moved, braid_of, torus_type
from sono.invariants.crossings import diagram
from sono.invariants.diagrams import Gauss, as_crossings, gauss_code, homfly_polynomial, shortened
from sono.invariants.polynomials import alexander
from sono.invariants.signatures import signature
from sono.naming import identify, tori, verify
from sono.naming.known import mirrored
from sono.starts import start
from sono.starts.braids import braid
from sono.starts.drawing import mirror
from sono.starts.scramble import scramble

SMALL = [(p, q) for p in range(2, 7) for q in range(p, 9)]
LARGE = [
    "T(24,48)",
    "T(12,20)",
    *(pytest.param(name, marks=pytest.mark.slow) for name in ("T(25,26)", "T(30,40)")),
]


def closure(p: int, word: list[int]) -> Gauss:
    """Return the diagram of a closed braid."""
    after: dict[int, int] = {}
    ends: list[int] = list(range(p))
    met: list[list[int]] = [[] for _ in range(p)]  # what the strand that begins at each place meets
    for number, letter in enumerate(word, 1):
        at = abs(letter) - 1
        # The strand that leads outward is above in a right-handed crossing.
        above = number if letter > 0 else -number
        met[ends[at]].append(above)
        met[ends[at + 1]].append(-above)
        ends[at], ends[at + 1] = ends[at + 1], ends[at]
    after = {strand: place for place, strand in enumerate(ends)}
    components, left = [], set(range(p))
    while left:
        strand, along = min(left), list[int]()
        while strand in left:
            left.remove(strand)
            along += met[strand]
            strand = after[strand]
        components.append(along)
    return components, [letter > 0 for letter in word]


def delta(p: int, q: int) -> list[int]:
    return list(range(1, p)) * q if q > 0 else list(range(1 - p, 0)) * -q


def inverse(word: list[int]) -> list[int]:
    return [-letter for letter in reversed(word)]


def random_word(random: np.random.Generator, p: int, length: int) -> list[int]:
    letters = random.integers(1, p, length) * random.choice([-1, 1], length)
    return [int(letter) for letter in letters]


def parallel(curve: Components, random: np.random.Generator) -> Components:
    """Return a link turned round, with its components in another order and all reversed."""
    turn, _ = np.linalg.qr(random.normal(size=(3, 3)))
    turn *= np.sign(np.linalg.det(turn))
    return [3 * curve[k][::-1] @ turn + 7 for k in random.permutation(len(curve))]


@pytest.mark.parametrize(("p", "q"), SMALL)
def test_all_that_are_drawn(p: int, q: int) -> None:
    for number, name in enumerate((f"T({p},{q})", f"T({q},{-p})", f"mT({p},{q})")):
        found = torus_type(shortened(gauss_code(diagram(start(name, number)))))
        assert found
        assert tuple(sorted(map(abs, found))) == (p, q)
        assert (found[1] > 0) == (number == 0)
    assert torus_type(closure(p, delta(p, q))) == (p, q)
    assert torus_type(mirrored(closure(q, delta(q, p)))) == (q, -p)


@pytest.mark.parametrize(("p", "q"), [(2, 5), (3, 3), (3, 4), (4, 6), (4, -5), (5, 7), (6, -6), (6, 9)])
def test_conjugates_are_proven(p: int, q: int) -> None:
    random = np.random.default_rng(p)
    for length in (1, 3, 8, 30):
        more = random_word(random, p, length)
        gauss = closure(p, [*more, *delta(p, q), *inverse(more)])
        assert torus_type(gauss) == (p, q)
        assert torus_type(mirrored(gauss)) == (p, -q)


@pytest.mark.parametrize(("p", "q"), [(3, 4), (3, -5), (4, 5), (4, -8), (5, 6)])
def test_near_misses(p: int, q: int) -> None:
    """A crossing is changed, a strand led elsewhere, a crossing is more or less, or on another side."""
    word, proven, others = delta(p, q), 0, 0
    hand = 1 if q > 0 else -1
    more = [[1, 1, 1 - p, 1 - p], [1, p - 1, -1, 1 - p], [1, 1 - p]]
    for at in range(0, len(word), 1 + len(word) // 12):
        letter, before, after = word[at], word[:at], word[at + 1 :]
        other = hand * (abs(letter) % (p - 1) + 1)
        nears = [
            [*before, -letter, *after],
            [*before, other, *after],
            [*before, *after],
            [*before, other, *word[at:]],
        ]
        for near in (*nears, [*before, *after, other], *([*before, *extra, *word[at:]] for extra in more)):
            found = torus_type(closure(p, near))
            assert found is None or is_torus(closure(p, near), *found)
            proven, others = proven + (found is not None), others + (found is None)
    assert others > 12
    assert torus_type(closure(p, [*word, hand])) is None


def is_torus(gauss: Gauss, p: int, q: int) -> bool:
    """Tell whether a diagram has the polynomials of a torus link, those that can be had."""
    wanted, image = homfly_polynomial(closure(p, delta(p, q))), homfly_polynomial(gauss)
    one, other = (alexander(as_crossings(link), 1j) for link in (gauss, closure(p, delta(p, q))))
    return (None in (wanted, image) or wanted == image) and one == pytest.approx(other, abs=1e-6)


def test_powers_of_the_other_root_of_the_full_twist() -> None:
    """Those of epsilon are torus links of p strands only where they are full twists."""
    for p, k in product(range(3, 7), range(1, 11)):
        epsilon = [*delta(p, 1), 1]
        full = k % (p - 1) == 0
        assert torus_type(closure(p, epsilon * k)) == ((p, p * k // (p - 1)) if full else None)


@pytest.mark.parametrize(("p", "length", "q"), [(3, 6, 3), (3, 8, 4)])
def test_of_all_positive_words_only_those_with_the_polynomial_are_proven(p: int, length: int, q: int) -> None:
    wanted = homfly_polynomial(closure(p, delta(p, q)))
    proven = 0
    for word in product(range(1, p), repeat=length):
        gauss = closure(p, list(word))
        found = torus_type(gauss)
        assert (found == (p, q)) == (homfly_polynomial(gauss) == wanted)
        proven += found is not None
    assert proven


def burau(word: list[int]) -> list[list[Fraction]]:
    """Return the reduced Burau matrix of a braid on three strands, by which it is known (W. Magnus, 1969)."""
    t, one, nil = Fraction(3), Fraction(1), Fraction(0)
    right = {1: [[-t, one], [nil, one]], 2: [[one, nil], [t, -t]]}
    left = {1: [[-1 / t, 1 / t], [nil, one]], 2: [[one, nil], [one, -1 / t]]}
    made = [[one, nil], [nil, one]]
    for letter in word:
        by = (right if letter > 0 else left)[abs(letter)]
        made = [[sum((row[k] * by[k][j] for k in (0, 1)), Fraction()) for j in (0, 1)] for row in made]
    return made


def test_laminations_tell_what_braids_are_trivial() -> None:
    random = np.random.default_rng(5)
    trivial = 0
    for length, _ in product((2, 4, 6, 8), range(200)):
        word = random_word(random, 3, length)
        moves = _moved([0, 1] * 3, word) != [0, 1] * 3
        assert moves == (burau(word) != burau([]))
        trivial += not moves
    assert trivial > 20


@pytest.mark.parametrize("p", [4, 6])
def test_braids_act_on_laminations(p: int) -> None:
    random = np.random.default_rng(p)
    same = [([k, k + 1, k], [k + 1, k, k + 1]) for k in range(1, p - 1)]
    same += [([1, 3], [3, 1]), ([2, -2], []), ([-1, 1], [])]
    same += [([*delta(p, p), k], [k, *delta(p, p)]) for k in range(1, p)]
    for _ in range(50):
        some = [int(number) for number in random.integers(-99, 99, 2 * p)]
        for one, other in same:
            assert _moved(some, one) == _moved(some, other)
            assert _moved(some, inverse(one)) == _moved(some, inverse(other))
    assert _moved([0, 1] * p, delta(p, p)) != [0, 1] * p


def test_braids_of_diagrams() -> None:
    assert braid_of(gauss_code(diagram(start("0_1")))) == (1, [])
    assert braid_of(closure(3, [])) is None  # three circles apart
    found = braid_of(shortened(gauss_code(diagram(start("4_1")))))
    assert found
    assert found[0] == 3
    assert sorted(found[1]) in ([-2, -2, 1, 1], [-1, -1, 2, 2])
    random = np.random.default_rng(3)
    for p in (2, 3, 5, 8):
        word = [*delta(p, 1), *random_word(random, p, 20)]
        again = braid_of(closure(p, word))
        assert again
        assert again[0] == p
        assert homfly_polynomial(closure(*again)) == homfly_polynomial(closure(p, word))


@pytest.mark.slow
@pytest.mark.parametrize("name", ["T(2,15)", "mT(2,10)", "T(3,7)", "T(4,5)", "T(4,6)", "mT(5,6)"])
def test_scrambled_ones_are_named(name: str) -> None:
    found = identify(scramble(start(name), 0, swirls=8))
    assert (found.name, found.proven) == (name, True)
    assert verify(scramble(start(name), 3), mirror(start(name))).verdict == "mirror images"


@pytest.mark.parametrize("name", ["P(3,5,7)", "3_1#T(2,15)", "C(5,4,5)"])
def test_other_closed_braids_have_no_torus_name(name: str) -> None:
    assert not re.fullmatch(r"m?T\(\d+,\d+\)", identify(start(name)).name or "")


def test_components_must_run_in_parallel() -> None:
    link = start("T(4,8)")
    assert identify([*link[1:], link[0][::-1]]).name is None
    assert identify([component[::-1] for component in link]).name == "T(4,8)"


@pytest.mark.parametrize("name", LARGE)
def test_of_any_size_from_anywhere(name: str) -> None:
    random = np.random.default_rng(1)
    for variant in (0, 1):
        curve = parallel(start(name, variant), random)
        found = identify(curve)
        assert (found.names, found.known) == ((name,), "proven")
        assert identify(mirror(curve)).name == f"m{name}"
    assert verify(start(name), curve).verdict == "same"
    assert (verify(start(name), mirror(curve)).verdict, found.components) == ("mirror images", len(curve))


@pytest.mark.slow
def test_large_ones_are_told_apart() -> None:
    found = verify(start("T(30,40)"), start("T(30,42)"))
    assert (found.verdict, found.known) == ("different", "proven")
    # One crossing is changed among 1209.
    word = delta(31, 40)
    near = braid([*word[:500], -word[500], *word[501:]])
    with pytest.raises(sono.TooEntangledError):
        identify(near)
    assert identify(braid(word)).name == "T(31,40)"


@pytest.mark.parametrize(("p", "q"), SMALL)
def test_determinants_and_signatures(p: int, q: int) -> None:
    found = diagram(start(f"T({p},{q})"))
    assert tori.determinant(p, q) == tori.determinant(-q, p) == round(alexander(found, -1))
    assert tori.signature(p, q) == -tori.signature(-q, p) == signature(found, -1)
    assert tori.name(p, -q) == f"mT({p},{q})"


def test_commands(folder: Path, sono: Sono) -> None:
    formats.write(folder / "large.txt", start("T(25,26)", 2))
    formats.write(folder / "sum.txt", start("mT(2,15)#3_1"))
    result = sono("identify", "large.txt", "sum.txt", "--columns", "knot,known,crossings,determinant")
    assert [line.split("\t") for line in result.stdout.splitlines()[1:]] == [
        ["T(25,26)", "proven", "624", "25"],
        ["mT(2,15)#3_1", "proven", "18", "45"],
    ]
    result = sono("verify", "large.txt", "T(25,26)")
    assert (result.exit_code, result.stdout.splitlines()[1].split("\t")[2:4]) == (0, ["same", "proven"])
