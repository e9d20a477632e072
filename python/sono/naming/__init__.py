"""What knot or link a curve is, by name, and whether two are the same.

May import `curve`, `invariants` and `records`.
"""

from sono.naming.identity import Identity, identify
from sono.naming.sameness import Verdict, verify

__all__ = ["Identity", "Verdict", "identify", "verify"]
