"""What knot or link a curve is, by name.

May import `curve`, `invariants` and `records`.
"""

from sono.naming.identity import Identity, identify

__all__ = ["Identity", "identify"]
