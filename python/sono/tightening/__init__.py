"""From any closed curve to a tight one: the plan of a run, its trials, and the loop that runs it.

May import `curve`, `invariants` and `patience`.
"""
