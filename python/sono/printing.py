"""Text that is fit for a terminal, whatever it says."""

import re

_CONTROL = re.compile("[\x00-\x1f\x7f-\x9f\u2028-\u202e\u2066-\u2069]")


def printable(text: str, kept: str = "") -> str:
    """Escape what would move the cursor of a terminal, colour it or turn its text round, but for `kept`."""
    return _CONTROL.sub(lambda c: c[0] if c[0] in kept else c[0].encode("unicode_escape").decode(), text)
