"""Every conformation that has a name: knots of the tables, torus types, chains, braids, and their variants.

May import `curve`, `invariants` and `naming`.
"""

from sono.starts.canonical import canonical
from sono.starts.names import doubt, has_variants, knows, names, start
from sono.starts.shapes import drawn, known
from sono.starts.tables import table

__all__ = ["canonical", "doubt", "drawn", "has_variants", "known", "knows", "names", "start", "table"]
