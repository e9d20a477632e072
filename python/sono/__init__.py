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
    from sono._core import CurveError as CurveError
    from sono.curve import Forces as Forces
    from sono.curve import Measures as Measures
    from sono.curve import forces as forces
    from sono.curve import measure as measure
    from sono.starts import start as start
    from sono.tightening import Progress as Progress
    from sono.tightening import Tight as Tight
    from sono.tightening import tighten as tighten

__version__ = "0.1.0"

_HOMES = {
    "CurveError": "sono._core",
    "Forces": "sono.curve",
    "Measures": "sono.curve",
    "Progress": "sono.tightening",
    "Tight": "sono.tightening",
    "forces": "sono.curve",
    "measure": "sono.curve",
    "start": "sono.starts",
    "tighten": "sono.tightening",
}

__all__ = ["CurveError", "Forces", "Measures", "Progress", "Tight", "forces", "measure", "start", "tighten"]


def __getattr__(name: str) -> Any:
    """Import a public name when it is first used, so that `sono --help` need not wait for numpy."""
    if name not in _HOMES:
        raise AttributeError(f"module 'sono' has no attribute {name!r}")
    return getattr(import_module(_HOMES[name]), name)


def __dir__() -> list[str]:
    """List the public names, whether they have been imported or not."""
    return __all__
