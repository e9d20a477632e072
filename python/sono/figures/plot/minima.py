"""The minima that a search met: how long they are, and in how many trials."""

from collections.abc import Sequence
from typing import TYPE_CHECKING

from sono.figures.plot.sheet import library
from sono.tables import Row

if TYPE_CHECKING:
    from matplotlib.axes import Axes


def draw(rows: Sequence[Row], published: float | None, axes: "Axes") -> None:
    """Draw the minima of one knot: a stem at each L_a, or L_p where there is none, as high as its hits.

    The ropelength that is `published`, if any is, is a line.
    """
    lengths = [float(str(row.get("l_a") or row["l_p"])) for row in rows]
    hits = [int(str(row["hits"])) for row in rows]
    colour = library().rcParams["text.color"]
    if published is not None:
        axes.axvline(published, color=colour, linewidth=0.7, linestyle=(0, (4, 3)), label="published")
        axes.legend(loc="lower right", bbox_to_anchor=(1, 1))
    axes.vlines(lengths, 0, hits, color="C0")
    axes.plot(lengths, hits, "o", color="C0", clip_on=False)
    for length, count in zip(lengths, hits, strict=True):
        axes.annotate(str(count), (length, count), (0, 4), textcoords="offset points", ha="center")
    axes.set(xlabel="$L_a$ (length / radius)", ylabel="trials that met it")
    axes.set_ylim(0, 1.15 * max(hits))
    axes.margins(x=0.1)
    axes.ticklabel_format(axis="x", useOffset=False)
    axes.yaxis.get_major_locator().set_params(integer=True)
