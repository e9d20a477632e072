"""Diagrams of up to 13 crossings in a letter a crossing, as the table of types keeps them.

Along the components, one after the other, every other passage has a letter for where its crossing is passed
again, whether it is passed above, and whether it is right-handed; a slash ends a component.

>>> trefoil = ([[-1, 2, -3, 1, -2, 3]], [True, True, True])
>>> packed(trefoil), packed(unpacked("fjb"))
('fjb', 'fjb')
"""

from itertools import product
from string import ascii_letters

from sono.invariants.diagrams import Gauss

MOST_CROSSINGS = len(ascii_letters) // 4


def packed(gauss: Gauss) -> str:
    """Return the letters of a diagram. Raises `ValueError` for too many crossings."""
    passages, right = gauss
    if len(right) > MOST_CROSSINGS:
        raise ValueError(f"{len(right)} crossings are too many; {MOST_CROSSINGS} are the most")
    # Each component can begin such that crossings join even and odd places: a plane has two colours.
    for turns in product((0, 1), repeat=len(passages)):
        turned = [along[turn:] + along[:turn] for along, turn in zip(passages, turns, strict=True)]
        flat = [passage for along in turned for passage in along]
        odd = {abs(passage): place // 2 for place, passage in enumerate(flat) if place % 2}
        if len(odd) == len(right):
            break
    letters = iter(
        ascii_letters[4 * odd[abs(passage)] + 2 * (passage > 0) + right[abs(passage) - 1]]
        for passage in flat[::2]
    )
    return "/".join("".join(next(letters) for _ in along[::2]) for along in turned)


def unpacked(text: str) -> Gauss:
    """Return the diagram of such letters; crossings are numbered in the order of the letters."""
    letters = text.replace("/", "")
    flat, right = [0] * (2 * len(letters)), []
    for number, letter in enumerate(letters, 1):
        odd, kind = divmod(ascii_letters.index(letter), 4)
        over = 1 if kind >= 2 else -1
        flat[2 * number - 2], flat[2 * odd + 1] = over * number, -over * number
        right.append(kind % 2 == 1)
    places = iter(flat)
    return [[next(places) for _ in range(2 * len(component))] for component in text.split("/")], right
