"""The search for the shortest tight rope of a knot: many trials, and the minima that they end in.

May import `curve`, `invariants`, `records`, `starts` and `tightening`.
"""

from sono.searching.minima import Minimum

__all__ = ["Minimum"]
