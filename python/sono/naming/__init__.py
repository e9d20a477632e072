"""What knot or link a curve is, by name.

May import `curve` and `invariants`.
"""

from sono.naming.identity import Identity, identify

__all__ = ["Identity", "identify"]
