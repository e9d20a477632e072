"""One trial: a curve is collapsed, annealed with SONO on few beads, and polished there.

Runs and searches share it; a `Recipe` says in what their trials differ.
"""

import json
import math
from dataclasses import dataclass
from typing import Any, Literal, Self

from sono._core import Collapse, CurveError, Polish, Tightener
from sono.curve import Components
from sono.tightening.engines import Engine, status_of
from sono.tightening.settings import default_settings, of_polish, of_sono
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

    @classmethod
    def numbered(cls, number: int, settings: dict[str, Any], target: Target, short: bool) -> Self:
        """Return the recipe of a run's trial, from 0. A `short` anneal has to find a shape only."""
        hot = number % 2 == 1
        # Edges of other lengths find other shapes; multiples of the golden ratio spread them evenly.
        least, most = (0.92, 1.1) if hot else (0.6, 0.9)
        edge = least + (most - least) * ((0.5 + number // 2 * (math.sqrt(5) - 1) / 2) % 1)
        seed = (settings.get("seed", 0) + number) % 2**64
        all_settings = default_settings() | settings
        changes = of_sono(settings) | {"seed": seed}
        if short:
            changes["anneal_sweeps"] = max(all_settings["anneal_sweeps"] // 10, 1)
            changes["anneal_tolerance"] = HOT if hot else all_settings["anneal_tolerance"]
        return cls(changes, changes, seed, edge, target, polish=of_polish(settings))


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
