"""Prime links up to 9 crossings by their names.

Thistlethwaite's name, L5a1, may say the orientation of the components after the first, L5a1{1}; without it is
LinkInfo's first one. Rolfsen's name is typed 5^2_1 or 5.2.1. Braids and diagrams are LinkInfo's, as handed as
its braids are: a positive generator is a right-handed crossing.

>>> link_row("Whitehead")["link"], link_row("5.2.1")["link"], link_row("L6a4")["rolfsen"]
('L5a1{0}', 'L5a1{0}', '6^3_2')
"""

import re
from collections.abc import Iterator
from functools import cache
from itertools import permutations, product

from sono.curve import Components
from sono.invariants import fingerprint
from sono.naming import identify
from sono.starts.tables import table

COMMON = {"Whitehead": "L5a1", "Borromean": "L6a4", "Solomon": "L4a1"}

_ROLFSEN = re.compile(r"(\d)[\^.](\d)[_.](\d{1,2})")


@cache
def _links() -> list[dict[str, str]]:
    return table("links")


@cache
def _rows() -> dict[str, dict[str, str]]:
    """Return the rows of the table by all their names, in lower case."""
    found: dict[str, dict[str, str]] = {}
    for row in _links():
        link = row["link"].replace(" ", "")
        found[link.casefold()] = row
        for name in (link.split("{")[0], row["rolfsen"]):
            found.setdefault(name.casefold(), row)
    return found


@cache
def link_names() -> tuple[str, ...]:
    """Return the names without orientations: Thistlethwaite's, Rolfsen's, and common ones."""
    rows = _links()
    return (*dict.fromkeys(row["link"].split("{")[0] for row in rows), *_rolfsens(rows), *COMMON)


def link_row(name: str) -> dict[str, str] | None:
    """Return the row of the link of this name, if there is one."""
    plain = {common.casefold(): link for common, link in COMMON.items()}.get(name.casefold(), name)
    plain = _ROLFSEN.sub(r"\1^\2_\3", re.sub(r"\s", "", plain))
    return _rows().get(plain.casefold())


def oriented_like(curve: Components, model: Components) -> Components:
    """Return a link with its components in such an order, and so oriented, that its type is the model's.

    The type is compared by `fingerprint`, and by name: two orientations of L9n27 share all invariants. Raises
    `ValueError` if it is another link.
    """
    wanted, names = fingerprint(model), identify(model).names
    for candidate in _orientations(curve):
        if fingerprint(candidate) == wanted and identify(candidate).names == names:
            return candidate
    raise ValueError("this is another link than the model")


def _orientations(curve: Components) -> Iterator[Components]:
    """Give the orders and orientations of the components; to turn all of them round changes nothing."""
    for order in permutations(curve):
        for turns in product((1, -1), repeat=len(curve) - 1):
            yield [component[::turn] for component, turn in zip(order, (1, *turns), strict=True)]


def _rolfsens(rows: list[dict[str, str]]) -> list[str]:
    """Return Rolfsen's names, in his order."""
    names = dict.fromkeys(row["rolfsen"] for row in rows)
    return sorted(names, key=lambda name: [int(number) for number in re.findall(r"\d+", name)])
