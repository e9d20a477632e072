"""Writes the gallery of the documentation from the atlas: `python -m tests.make_gallery`.

The page is made each time, a picture only where there is none; `--pictures` draws all of them anew, which
takes a few minutes, and needs matplotlib.
"""

import csv
import io
import re
import shlex
import sys
from collections.abc import Iterator
from decimal import ROUND_CEILING, Decimal
from pathlib import Path

import sono

DOCS = Path(__file__).parent.parent / "docs"

PAGE = DOCS / "gallery.md"

PICTURES = DOCS / "pictures" / "gallery"

ATLAS = Path(sono.__file__).parent / "data" / "atlas"

SIZE = 288
"""Width and height of a picture in pixels, at most; it is shown half as large or a little more."""

COLOURS = 48

SHOWN = {
    "Knots": {
        "3_1": "The trefoil.",
        "4_1": "The figure eight, the braid (1 -2)² closed.",
        "5_1": "T(2,5). Five-fold symmetric it would be 48.2 long.",
        "5_2": "The three-twist knot.",
        "8_18": "The braid (1 -2)⁴ closed.",
        "8_19": "T(3,4), the first knot without an alternating diagram.",
        "10_123": "The braid (1 -2)⁵ closed.",
        "10_124": "T(3,5), and the pretzel P(-2,3,5).",
        "10_161": "The Perko pair: Rolfsen's 10_161 and 10_162.",
        "11n_34": "Conway's knot; its Alexander polynomial is 1.",
        "12n_242": "The pretzel P(-2,3,7), with twelve crossings.",
    },
    "Sums": {
        "3_1#m3_1": "The square knot: a trefoil and its mirror image.",
        "3_1#3_1": "The granny knot: twice the same trefoil.",
    },
    "Links": {
        "Hopf": "Two circles. Its ropelength is known: 8π = 25.1327.",
        "L5a1": "The Whitehead link.",
        "L6a4": "The Borromean rings, the braid (1 -2)³ closed.",
        "L6n1": "T(3,3), or 6^3_3: three rings, each linked with each.",
    },
    "Torus types": {
        "T(2,11)": "Two strands wind round each other.",
        "T(2,31)": "The same, for longer.",
        "T(7,7)": "Seven rings in a bundle.",
        "T(15,15)": "Fifteen rings, each linked with each.",
        "T(19,24)": "One strand, 432 crossings.",
    },
}
"""The ropes that are shown, by their names, and what is said of each."""

HEAD = """# Gallery

Ropes of the atlas: the shortest that were found. It has all {knots:,} prime knots to 12 crossings, all
{links} prime links to 9, {composites} sums, and {torus} torus knots and links. For {la:,} of the knots L_a is
at most the shortest ropelength that is published, and for {lc:,} the certified L_c is; of the {few} to ten
crossings, for {few_la} and {few_lc}. Other pages say [what these letters mean](explanation/rope.md),
[what is proven](explanation/bounds.md), and [what "tight" does not say](explanation/tight.md). L_a is
rounded; L_c is the certified one, rounded up, on the finest edges that the atlas has it on.

Each of these ropes, and any other of the atlas, is had by its name:

```sh
sono start 8_18 --known -o 8_18.txt     # its vertices
sono tighten 8_18 -n 480                # the same rope on 480 of them, polished
sono view 8_18                          # 8_18.html: the rope in the round
```
"""

CARD = """<figure style="display: inline-block; width: {width}px; margin: 8px; vertical-align: top">
<img src="{picture}" alt="{name}" width="{width}" loading="lazy">
<figcaption style="font-style: normal; font-size: 85%">
<b>{name}</b><br>L_a {l_a}<br>L_c {l_c}<br>{what}<br><code>{command}</code>
</figcaption>
</figure>
"""

Row = dict[str, str]


def page() -> str:
    """Write the page."""
    tables = {name: table(name) for name in ("knots", "links", "composites", "torus")}
    rows = {row["knot"]: row for rows in tables.values() for row in rows.values()} | {
        "Hopf": tables["links"]["L2a1"]
    }
    knots = list(tables["knots"].values())
    few = [row for row in knots if re.match(r"(\d|10)_", row["knot"])]
    head = HEAD.format(
        **{name: len(table) for name, table in tables.items()},
        **{"la": shorter(knots, "l_a"), "lc": shorter(knots, "l_c")},
        **{"few": len(few), "few_la": shorter(few, "l_a"), "few_lc": shorter(few, "l_c")},
    )
    return "\n".join([head, *sections(rows)])


def shorter(rows: list[Row], key: str) -> int:
    """Count the rows whose length is at most what is published."""
    return sum(row["published"] != "-" and float(row[f"{key}_difference"]) <= 0 for row in rows)


def sections(rows: dict[str, Row]) -> Iterator[str]:
    """Write the ropes, family by family."""
    for family, ropes in SHOWN.items():
        yield f"## {family}\n"
        for name, what in ropes.items():
            yield card(name, what, rows[name])


def card(name: str, what: str, row: Row) -> str:
    """Write what is shown of one rope."""
    file = picture_of(name)
    bounds = [Decimal(row[key]) for key in ("l_c", "l_c_fine") if row[key] != "-"]
    return CARD.format(
        name=name,
        picture=file.relative_to(DOCS).as_posix(),
        width=SIZE // 2,
        l_a=f"{float(row['l_a']):.4f}",
        l_c=min(bounds).quantize(Decimal("0.0001"), ROUND_CEILING),
        what=what,
        command=f"sono view {shlex.quote(name)}",
    )


def table(name: str) -> dict[str, Row]:
    """Read a table of the atlas."""
    with (ATLAS / f"{name}.tsv").open(encoding="utf-8") as file:
        return {row["knot"]: row for row in csv.DictReader(file, delimiter="\t")}


def picture_of(name: str) -> Path:
    """Return the file of a rope's picture."""
    return PICTURES / f"{re.sub(r'[^a-z0-9]+', '_', name.lower()).strip('_')}.png"


def picture(name: str) -> bytes:
    """Draw a rope of the atlas on a clear ground, in few colours."""
    from matplotlib.figure import Figure
    from PIL import Image

    data, small = io.BytesIO(), io.BytesIO()
    with sono.plot.style("light"):
        figure = Figure(figsize=(3, 3))
        sono.plot.knot(name, axes=figure.add_axes((0, 0, 1, 1)))
        figure.savefig(data, format="png", dpi=SIZE / 3, transparent=True)
    drawn = Image.open(data).quantize(COLOURS, Image.Quantize.FASTOCTREE, dither=Image.Dither.NONE)
    drawn.save(small, "png", optimize=True)
    return small.getvalue()


def main() -> None:
    """Write the page and the pictures."""
    PICTURES.mkdir(parents=True, exist_ok=True)
    for name in [name for ropes in SHOWN.values() for name in ropes]:
        file = picture_of(name)
        if "--pictures" in sys.argv or not file.exists():
            file.write_bytes(picture(name))
    PAGE.write_text(page(), encoding="utf-8")


if __name__ == "__main__":
    main()
