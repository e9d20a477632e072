"""What knot is it: invariants of polygons, through a projection that exact isotopies have simplified.

May import `curve`.
"""
