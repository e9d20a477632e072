"""The header of a rope's file: what is written is what is read, and nothing that is damaged raises."""

import random

import pytest

import sono
from sono.formats import ropefile
from sono.formats.ropefile import STUCK, TIGHT, Header, Made, Searched

MEASURES = sono.measure("3_1")
PHYSICS = (("residual", 1.9e-12), ("mu", 1e-11))

HEADERS = [
    Header.of("3_1", TIGHT, MEASURES),
    Header.of(
        "a: tight, b", STUCK, MEASURES, made=Made("both", 4, {"seed": 3}), physics=PHYSICS, origin="8f"
    ),
    Header.of("x", TIGHT, MEASURES, made=Made("sono", 1, {"c_1": 0.5, "seed": 0}), origin="8f"),
    Header.of("T(2,5)", TIGHT, MEASURES, searched=Searched(-3, 7, 5, 64, 32, 60.0), origin="T(2,5)"),
    Header.of("8_18", TIGHT, MEASURES, searched=Searched(3, 0, 5, 64, 32), physics=PHYSICS[:1], origin="x"),
    Header.of("8_18", TIGHT, MEASURES, searched=Searched(-12, 1)),
]


@pytest.mark.parametrize("header", HEADERS)
def test_what_is_written_is_read(header: Header) -> None:
    lines = header.lines()
    again = ropefile.parse("".join(f"# {line}\n" for line in lines) + "1 2 3\n")
    assert (again.name, again.status, again.figures) == (header.name, header.status, header.figures)
    assert (again.made, again.searched, again.origin) == (header.made, header.searched, header.origin)


def test_a_name_may_hold_anything() -> None:
    header = Header.of("a\nb\x1b[31m\udcff", TIGHT, MEASURES)
    assert all(line.isprintable() for line in header.lines())
    assert ropefile.parse(f"# {header.lines()[0]}\n").status == TIGHT


def test_nothing_that_is_damaged_raises() -> None:
    draw = random.Random(0)
    pieces = [
        "9" * 5000,
        "-",
        "e999",
        "{",
        "}",
        '"',
        "nan",
        "\x00",
        " ",
        "[" * 2000,
        "of 1e99 s",
        ".",
        "1.2.3",
        "",
    ]
    for _ in range(3000):
        header = draw.choice(HEADERS)
        text = "".join(f"# {line}\n" for line in header.lines())
        for _ in range(draw.randint(1, 4)):
            place = draw.randrange(len(text))
            text = text[:place] + draw.choice(pieces) + text[place + draw.randint(0, 9) :]
        ropefile.parse(text)


def test_another_file_says_nothing() -> None:
    assert ropefile.parse("# nothing\n1 2 3\n") == Header("", "", "")
