"""What knot is it: invariants of polygons, through a projection that exact isotopies have simplified.

May import `curve`.
"""

from sono.invariants.crossings import TooEntangledError
from sono.invariants.identify import Fingerprint, fingerprint, homfly

__all__ = ["Fingerprint", "TooEntangledError", "fingerprint", "homfly"]
