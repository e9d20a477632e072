"""Pictures, pages and models of tight ropes.

May import `calls`, `curve`, `formats`, `invariants`, `model`, `naming`, `printing`, `records`,
`starts` and `tables`.
"""
