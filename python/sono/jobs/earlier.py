"""The rope that is in the output of a search already, and whether it stays there."""

import math
import os
from collections.abc import Callable
from dataclasses import dataclass
from functools import partial

from sono.curve import Curve, forces, measure
from sono.formats import FormatError
from sono.formats.ropefile import STOPPED, TIGHT
from sono.invariants import fingerprint
from sono.jobs.curvefiles import KEPT_RESIDUAL, rope_in
from sono.jobs.quest import Quest
from sono.jobs.result import as_row
from sono.patience import patiently
from sono.searching.minima import SAME_LENGTH, Minimum, has_edges, same_edges
from sono.searching.trials import Source, Watch
from sono.tables import Row

SAME_ROPE = 1e-8
"""Relative difference in L_a up to which ropes of the same edges are one, found again."""


@dataclass(frozen=True)
class Earlier:
    """A rope that is in the output already, its row, and what it says of the search that found it.

    `limit` are the seconds after which that search was over, if that is why it ended, and `finished` tells
    that the header calls the rope tight.
    """

    row: Row
    rope: Minimum
    finished: bool
    seed: int | None = None
    trials: int = 0
    limit: float = 0

    def does(self, job: Quest, trials: int) -> bool:
        """Tell whether the earlier search was finished and did what this one, of so many trials, is to do."""
        done = self.trials >= trials or self.limit >= (job.time_limit or math.inf)
        edges = has_edges(sum(map(len, self.rope.curve)), self.rope.length, job.dl)
        return done and self.seed == job.seed and edges and self.rope.converged and self.finished

    def stays(self, new: Minimum, finer: Callable[[Minimum, int], Minimum | None]) -> bool:
        """Tell whether the rope is to stay there: both are compared on the finer edges.

        The finer rope stays unless the other one is another, shorter minimum. `finer` polishes one on more
        vertices, if it can.
        """
        old, dl = self.rope, measure(new.curve).dl
        if old.converged and not new.converged:
            return True
        old_dl = float(self.row["dl"] or 0) / float(self.row["r_s"] or 1)
        if same_edges(old_dl, dl):
            return new.length > old.length * (1 + SAME_ROPE)
        coarse, fine = (old, dl) if dl < old_dl else (new, old_dl)
        polished = finer(coarse, round(coarse.length / fine))
        if not polished:
            return True
        if coarse is old:
            return new.length > polished.length * (1 + SAME_LENGTH)
        return polished.length > old.length * (1 - SAME_LENGTH)


def left_in(job: Quest, origin: str, source: Source, look: Watch) -> Earlier | None:
    """Return what is in the output, if there is any. Raises `FormatError` for another knot."""
    output = job.output
    if not os.path.isfile(output):
        return None
    file, measures, header = rope_in(output)
    # Invariants do not tell all knots apart; where the file says what it was made from, that has to fit.
    made_from = None if header.made else header.origin
    why = "was found from another curve" if made_from and made_from != origin else None
    if patiently(partial(fingerprint, file.components), look) != source.type:
        why = "is another knot"
    if why:
        raise FormatError(f"{output}: {why} than {job.name}; move it away or name another -o")
    residual = patiently(partial(forces, file.components), look).residual
    tight = residual <= KEPT_RESIDUAL
    row = as_row(job.name, output, measures, status=TIGHT if tight else STOPPED, residual=residual)
    length, curve = measures.l_a or math.inf, Curve(file.components)
    rope = Minimum(0, length, tight, residual=residual, curve=curve, met=[])
    finished, work = header.status == TIGHT, header.searched
    if not work or not work.trials:
        return Earlier(row, rope, finished)
    row = {**row, "variant": work.variant, "hits": work.hits, "trials": work.trials}
    limit = work.limit or work.seconds
    return Earlier(row, rope, finished, seed=work.seed, trials=work.trials, limit=limit)
