"""One trial: a curve is collapsed, annealed with SONO on few beads, and polished there.

Runs and searches share it; a `Recipe` says in what their trials differ.
"""

import json
from dataclasses import dataclass
from typing import Any, Literal

from sono._core import Collapse, CurveError, Polish, Tightener
from sono.curve import Components
from sono.tightening.engines import Engine, status_of
from sono.tightening.targets import Target, aimed, coarsest

TRIAL_EDGE = 0.45
"""Edge length of shapes that are found for no n, in radii."""

HOT = 0.5
"""Violation tolerated at the start of a hot anneal; it crosses higher barriers."""


@dataclass(frozen=True)
class Recipe:
    """How a trial is made.

    `collapse` and `anneal` are the settings of these stages, `polish` those of the last one as JSON; beads of
    the anneal lie `edge` radii apart, as far as the shape has so many. That has the vertices of the `target`,
    halved as long as its edges stay below `COARSE`; it has edges of `TRIAL_EDGE` where there is no target,
    and is polished only as far as is worth refining.
    """

    collapse: dict[str, Any]
    anneal: dict[str, Any]
    seed: int
    edge: float
    target: Target | None = None
    polish: str = "{}"


@dataclass
class Trial:
    """A trial under way: the stage that comes next, on `n` vertices, and the curve that it begins with.

    `loosened` tells that the curve was loosened before. `few` is the n of the shape, once it is known.
    """

    recipe: Recipe
    curve: Components
    loosened: bool = False
    stage: Literal["collapse", "anneal", "trial"] = "collapse"
    n: int = 0
    few: int = 0

    def begin(self) -> Engine:
        """Begin the stage. Raises `CurveError`."""
        recipe = self.recipe
        if self.stage == "collapse":
            return Collapse(self.curve, self.loosened, json.dumps(recipe.collapse))
        if self.stage == "trial":
            return Polish(self.curve, self.n, recipe.target is None, recipe.seed, recipe.polish)
        try:
            return Tightener(self.curve, "anneal", self.n, json.dumps(recipe.anneal))
        except CurveError:
            if self.few in (0, self.n):
                raise
            # So few beads are too coarse for some component; those of the shape may do.
            return Tightener(self.curve, "anneal", self.few, json.dumps(recipe.anneal))

    def take(self, engine: Engine) -> bool:
        """Go on from what the stage has ended in; tell whether there is another one."""
        recipe, length = self.recipe, status_of(engine).best.l_p
        self.curve = engine.best()
        if self.stage == "collapse":
            self.n = max(int(length / recipe.edge), 3 * len(self.curve))
            if recipe.target is not None:
                self.few = max(coarsest(aimed(recipe.target, length), length), 3 * len(self.curve))
                self.n = min(self.n, self.few)
            self.stage = "anneal"
        elif self.stage == "anneal":
            self.stage, self.n = "trial", self.few or round(length / TRIAL_EDGE)
        else:
            return False
        return True
