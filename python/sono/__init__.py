"""sono tightens knots: it pulls a closed curve tight as a rope of radius 1 and measures its ropelength.

Ropelength is length over the rope's RADIUS (the trefoil has 32.743); half of the literature divides by the
diameter. A curve is an (n, 3) array of vertices, or a sequence of such arrays, one for each component of a
link; it is closed, and its last vertex does not repeat the first.

>>> import sono
>>> trefoil = sono.start("3_1")
>>> tight = sono.tighten(trefoil, n=60)
>>> 32.5 < tight.measures.l_p < 32.6
True
"""

from importlib import import_module
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from sono import model as model
    from sono import plot as plot
    from sono._core import CurveError as CurveError
    from sono.calls import descriptors as descriptors
    from sono.calls import forces as forces
    from sono.calls import identify as identify
    from sono.calls import measure as measure
    from sono.calls import names as names
    from sono.calls import read as read
    from sono.calls import read_all as read_all
    from sono.calls import refine as refine
    from sono.calls import search as search
    from sono.calls import start as start
    from sono.calls import tighten as tighten
    from sono.calls import verify as verify
    from sono.calls import write as write
    from sono.certificates import Certificate as Certificate
    from sono.certificates import certify as certify
    from sono.comparison import Comparison as Comparison
    from sono.comparison import compare as compare
    from sono.curve import Curve as Curve
    from sono.curve import Forces as Forces
    from sono.curve import Measures as Measures
    from sono.figures.solids import Solid as Solid
    from sono.formats import FormatError as FormatError
    from sono.invariants import TooEntangledError as TooEntangledError
    from sono.naming import Identity as Identity
    from sono.naming import Verdict as Verdict
    from sono.searching import Minimum as Minimum
    from sono.shape import Descriptors as Descriptors
    from sono.showing import export as export
    from sono.showing import view as view
    from sono.thickness import Thickness as Thickness
    from sono.thickness import sharpen as sharpen
    from sono.tightening import KnotTypeError as KnotTypeError
    from sono.tightening import Progress as Progress
    from sono.tightening import Settings as Settings
    from sono.tightening import Stopped as Stopped
    from sono.tightening import Tight as Tight

_HOMES = {
    "CurveError": "sono._core",
    "Curve": "sono.curve",
    "Forces": "sono.curve",
    "Measures": "sono.curve",
    "FormatError": "sono.formats",
    "Identity": "sono.naming",
    "Verdict": "sono.naming",
    "TooEntangledError": "sono.invariants",
    "KnotTypeError": "sono.tightening",
    "Settings": "sono.tightening",
    "Progress": "sono.tightening",
    "Stopped": "sono.tightening",
    "Tight": "sono.tightening",
    "Minimum": "sono.searching",
    "Certificate": "sono.certificates",
    "certify": "sono.certificates",
    "Thickness": "sono.thickness",
    "sharpen": "sono.thickness",
    "Comparison": "sono.comparison",
    "compare": "sono.comparison",
    "Solid": "sono.figures.solids",
    "export": "sono.showing",
    "Descriptors": "sono.shape",
    "descriptors": "sono.calls",
    "forces": "sono.calls",
    "identify": "sono.calls",
    "measure": "sono.calls",
    "names": "sono.calls",
    "read": "sono.calls",
    "read_all": "sono.calls",
    "refine": "sono.calls",
    "search": "sono.calls",
    "start": "sono.calls",
    "tighten": "sono.calls",
    "verify": "sono.calls",
    "view": "sono.showing",
    "write": "sono.calls",
}

_MODULES = ("model", "plot")

__all__ = ["__version__", *_MODULES, *sorted(_HOMES)]


def __getattr__(name: str) -> Any:
    """Import a public name when it is first used, so that `sono --help` need not wait for numpy."""
    if name == "__version__":
        from importlib.metadata import version

        return version("sono")
    if name in _MODULES:
        return import_module(f"sono.{name}")
    if name not in _HOMES:
        raise AttributeError(f"module 'sono' has no attribute {name!r}")
    return getattr(import_module(_HOMES[name]), name)


def __dir__() -> list[str]:
    """List the public names, whether they have been imported or not."""
    return __all__
