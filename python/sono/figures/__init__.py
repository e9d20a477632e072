"""Pictures, pages and models of tight ropes.

May import `calls`, `curve`, `formats` and `records`.
"""
