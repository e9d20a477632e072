"""Pictures, pages and models of tight ropes.

May import `curve`, `model`, `printing`, `starts` and `tables`.
"""
