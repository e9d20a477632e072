"""Pictures, pages and models of tight ropes.

May import `curve`.
"""
