"""Pictures, pages and models of tight ropes.

May import `curve`, `invariants`, `model`, `naming`, `printing`, `starts` and `tables`.
"""
