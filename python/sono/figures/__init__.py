"""Pictures, pages and models of tight ropes.

May import `certificates`, `curve`, `formats`, `invariants`, `model`, `naming`, `printing`,
`records`, `shape`, `starts` and `tables`.
"""
