"""Pictures, pages and models of tight ropes.

May import `certificates`, `curve`, `formats`, `invariants`, `model`, `naming`, `printing`, `starts` and
`tables`.
"""
