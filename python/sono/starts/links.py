"""Prime links up to 9 crossings by their names.

Thistlethwaite's name, L5a1, may say the orientation of the components after the first, L5a1{1}; else it is
LinkInfo's first one, but the Hopf link has linking number +1. Rolfsen's name is 5^2_1. Braids and diagrams
are LinkInfo's, as handed as its braids are: a positive generator is a right-handed crossing.

>>> link_row("Whitehead")["link"], link_row("5^2_1")["link"], link_row("L6a4")["rolfsen"]
('L5a1{0}', 'L5a1{0}', '6^3_2')
"""

import re
from functools import cache
from itertools import permutations, product

import numpy as np

from sono.curve import Components
from sono.invariants import fingerprint
from sono.invariants.crossings import diagram, linking_matrix
from sono.naming import identify
from sono.starts.tables import table

HOPF = "L2a1{1}"

COMMON = {"Hopf": HOPF, "Whitehead": "L5a1", "Borromean": "L6a4", "Solomon": "L4a1"}


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
    found |= {common.casefold(): found[link.casefold()] for common, link in COMMON.items()}
    return found | {name: found[HOPF.casefold()] for name in ("l2a1", "2^2_1")}


@cache
def link_names() -> tuple[str, ...]:
    """Return the names without orientations: Thistlethwaite's, Rolfsen's, and common ones."""
    rows = _links()
    return (*dict.fromkeys(row["link"].split("{")[0] for row in rows), *_rolfsens(rows), *COMMON)


def link_row(name: str) -> dict[str, str] | None:
    """Return the row of the link of this name, if there is one."""
    return _rows().get(name.casefold())


def oriented_like(curve: Components, model: Components) -> Components:
    """Return a link with its components in such an order, and so oriented, that its type is the model's.

    The type is compared by `fingerprint`, and by name. Raises `ValueError` if it is another link.
    """
    # To turn all components round changes nothing.
    return _like(curve, model, [(1, *turns) for turns in product((1, -1), repeat=len(curve) - 1)])


def ordered_like(curve: Components, model: Components) -> Components:
    """Return a link with its components in the order that makes its type the model's; see `oriented_like`."""
    return _like(curve, model, [(1,) * len(curve)])


def _like(curve: Components, model: Components, orientations: list[tuple[int, ...]]) -> Components:
    """Return the components in an order, and one of these orientations, of the type of the model."""
    wanted, names = fingerprint(model), identify(model).names
    linking, pairs = linking_matrix(diagram(curve)), np.triu_indices(len(curve), 1)
    for order, turns in product(permutations(range(len(curve))), orientations):
        if tuple((linking[np.ix_(order, order)] * np.outer(turns, turns))[pairs].tolist()) == wanted[0]:
            candidate = [curve[number][::turn] for number, turn in zip(order, turns, strict=True)]
            # Invariants are not enough: two orientations of L9n27 share them all.
            if fingerprint(candidate) == wanted and identify(candidate).names == names:
                return candidate
    raise ValueError("this is another link than the model")


def _rolfsens(rows: list[dict[str, str]]) -> list[str]:
    """Return Rolfsen's names, in his order."""
    names = dict.fromkeys(row["rolfsen"] for row in rows)
    return sorted(names, key=lambda name: [int(number) for number in re.findall(r"\d+", name)])
