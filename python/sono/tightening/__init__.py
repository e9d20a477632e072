"""From any closed curve to a tight one: the plan of a run, and the loop that runs it.

May import `curve`, `figures`, `invariants`, `patience` and `records`.
"""

from sono.tightening.once import polished
from sono.tightening.results import KnotTypeError, Progress, Stopped, Tight
from sono.tightening.run import Run
from sono.tightening.settings import Method, Settings

__all__ = ["KnotTypeError", "Method", "Progress", "Run", "Settings", "Stopped", "Tight", "polished"]
