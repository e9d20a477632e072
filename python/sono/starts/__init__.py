"""Every conformation that has a name: knots of the tables, torus types, chains, braids, and their variants.

May import `curve` and `invariants`.
"""
