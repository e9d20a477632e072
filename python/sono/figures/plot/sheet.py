"""What all plots share: matplotlib, which is an extra, its styles, new axes, and files of pictures."""

import io
import warnings
from contextlib import AbstractContextManager
from importlib import import_module
from pathlib import PurePath
from typing import TYPE_CHECKING, Any, Literal, TypeAlias, get_args

from sono.printing import printable

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

Style: TypeAlias = Literal["light", "dark"]

STYLES = get_args(Style)

SUFFIXES = (".png", ".svg", ".pdf")
"""What pictures are called."""

DPI = 300
"""Dots per inch of what is made of dots."""

LONGEST = 24
"""Letters of a label."""

COLOURS = {
    "light": ("#0072B2", "#D55E00", "#009E73", "#E69F00", "#CC79A7", "#56B4E9", "#7F7F7F"),
    "dark": ("#56B4E9", "#E69F00", "#00B88A", "#F07F2F", "#E09CC4", "#3E8FD0", "#B0B0B0"),
}
"""Colours that the colour-blind tell apart, those of M. Okabe and K. Ito; some are lighter on black."""

PAPER = {"light": ("white", "#222222", "#D8D8D8"), "dark": ("#16181D", "#E6E6E6", "#3A3F4A")}
"""Paper, ink and lines of a grid."""

SCALES = {"light": "viridis_r", "dark": "viridis"}
"""Scales of colour on which what stands out most is most."""

_SAME = {
    "figure.figsize": (3.4, 2.7),
    "savefig.dpi": DPI,
    "savefig.bbox": "tight",
    "savefig.pad_inches": 0.03,
    "font.size": 8,
    "axes.titlesize": 8,
    "legend.fontsize": 7,
    "axes.linewidth": 0.6,
    "lines.linewidth": 1,
    "lines.markersize": 3.5,
    "axes.spines.top": False,
    "axes.spines.right": False,
    "axes.axisbelow": True,
    "legend.frameon": False,
    "mathtext.fontset": "dejavusans",
    "svg.hashsalt": "sono",  # so that the same figures give the same bytes
    "pdf.fonttype": 42,
}


def colour(component: int) -> str:
    """Return the colour of a component on white paper, #RRGGBB.

    >>> colour(0), colour(7) == colour(0)
    ('#0072B2', True)
    """
    return COLOURS["light"][component % len(COLOURS["light"])]


def library(module: str = "matplotlib") -> Any:
    """Import a module of matplotlib. Raises `ImportError` that names the extra."""
    try:
        return import_module(module)
    except ImportError:
        raise ImportError("pictures are drawn by matplotlib; pip install 'sono[plot]'") from None


def style(name: Style = "light") -> AbstractContextManager[Any]:
    """Return a context in which plots are for a paper's column: "light", or "dark" for a black page.

    Raises `ValueError` for another name.
    """
    if name not in STYLES:
        raise ValueError(f"style = {name!r}: give {' or '.join(map(repr, STYLES))}")
    paper, ink, grid = PAPER[name]
    inked = ("text.color", "axes.labelcolor", "axes.edgecolor", "xtick.color", "ytick.color")
    cycle = library("cycler").cycler(color=COLOURS[name])
    grounds: dict[str, Any] = dict.fromkeys(
        ("figure.facecolor", "axes.facecolor", "savefig.facecolor"), paper
    )
    colours = {**grounds, **dict.fromkeys(inked, ink), "grid.color": grid, "axes.prop_cycle": cycle}
    colours["image.cmap"] = SCALES[name]
    context: AbstractContextManager[Any] = library().rc_context(_SAME | colours)
    return context


def given(axes: Any, panels: int = 1) -> Any:
    """Return axes, or a pair of them; new ones of pyplot if there are none."""
    if axes is not None:
        return axes
    width, height = library().rcParams["figure.figsize"]
    size = (width, panels * height)
    return library("matplotlib.pyplot").subplots(panels, 1, figsize=size, layout="constrained")[1]


def sheet(rows: int, columns: int, size: tuple[float, float]) -> "tuple[Figure, list[Axes]]":
    """Return a figure that no window shows, panels of such a size in inches, and their axes, row by row."""
    whole = (columns * size[0], rows * size[1])
    figure = library("matplotlib.figure").Figure(figsize=whole, layout="constrained")
    return figure, list(figure.subplots(rows, columns, squeeze=False).flat)


def saved(figure: "Figure", suffix: str) -> bytes:
    """Return the bytes of a picture, the same each time; the style must still be on."""
    data = io.BytesIO()
    undated = {".svg": {"Date": None}, ".pdf": {"CreationDate": None}}.get(suffix, {})
    with warnings.catch_warnings(action="ignore"):  # a letter that the font lacks is drawn as a box
        figure.savefig(data, format=suffix[1:], metadata=undated)
    return data.getvalue()


def suffix_of(path: str) -> str:
    """Return the suffix of a picture's file; standard output is a PNG. Raises `ValueError` for another."""
    suffix = ".png" if path == "-" else PurePath(path).suffix.lower()
    if suffix not in SUFFIXES:
        raise ValueError(f"{path}: is no name for a picture; the suffixes are: {', '.join(SUFFIXES)}")
    return suffix


def label(name: str) -> str:
    """Return a name as a label: not too long, and nothing in it begins a formula."""
    shown = printable(name if len(name) <= LONGEST else f"{name[:LONGEST]}…")
    return shown.replace("$", r"\$")
