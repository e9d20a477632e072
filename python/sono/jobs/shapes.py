"""The shapes that the package carries, made of the ropes of an atlas."""

import math

from sono import formats
from sono.curve import measure
from sono.jobs.atlas import SHORTER, Atlas
from sono.searching.trials import Watch, unwatched
from sono.starts import shapes
from sono.tightening import polished


def refresh(atlas: Atlas, watch: Watch = unwatched) -> list[str]:
    """Take the ropes of an atlas that are shorter than what the package has; return their knots.

    Raises `FormatError` where the package cannot be written, or a rope not be read.
    """
    known = shapes.lengths()
    shorter = {
        knot: float(row["l_a"] or math.inf)
        for knot, row in atlas.rows().items()
        if float(row["l_a"] or math.inf) < (1 - SHORTER) * known.get(knot, math.inf)
    }
    if shorter:
        found = {knot: shapes.Shape(shapes.shape(knot), l_a) for knot, l_a in known.items()}
        for knot, l_a in shorter.items():
            rope = formats.read(atlas.path(knot)).components
            coarse = polished(rope, round(measure(rope).l_p / shapes.EDGE), watch)
            found[knot] = shapes.Shape(list(coarse.curve), l_a)
        formats.save(str(shapes.FILE), shapes.packed(found))
        shapes.lengths.cache_clear()
    return list(shorter)
