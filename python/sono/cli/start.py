"""`sono start NAME`: starting conformations."""

import os
import sys
from typing import TYPE_CHECKING

import click

from sono.cli import options, places

if TYPE_CHECKING:
    from sono.curve import Components


@click.command("start")
@click.argument("name", required=False)
@options.codes
@click.option("--braid", "word", metavar="WORD", help='Closure of a braid word such as "1 -2 1 -2".')
@click.option(
    "--variant",
    type=int,
    default=0,
    show_default=True,
    help="Another conformation of the same type for each K; negative ones are drawn from a planar diagram.",
    metavar="K",
)
@click.option(
    "--scramble",
    "scramble_seed",
    type=click.IntRange(0),
    metavar="SEED",
    help="Entangle the curve, isotopically.",
)
@click.option("--known", is_flag=True, help="The tight rope that the atlas has of it.")
@click.option("--list", "list_names", is_flag=True, help="List the names that are built in.")
@click.option("-o", "--output", default="-", show_default=True, metavar="FILE", help="Where to write it.")
@click.option("--force", is_flag=True, help="Overwrite FILE.")
def command(
    name: str | None,
    codes: list[str],
    word: str | None,
    variant: int,
    scramble_seed: int | None,
    known: bool,
    list_names: bool,
    output: str,
    force: bool,
) -> None:
    """Write the starting conformation of a knot or link.

    NAME is a knot of KnotInfo's table (8_20, or m8_20 for its mirror image; 11a_1 needs the extra
    sono[knotinfo]), a link (L5a1, 5^2_1, Hopf), a torus knot or link ("T(2,5)", negative for the mirror
    image), a pretzel ("P(-2,3,7)"), a two-bridge link (5/2, "C(3,2)"), chain3, or a sum (3_1#m3_1); --list
    has those that are built in.

    \b
      sono start 3_1 > trefoil.txt
      sono start --braid "1 -2 1 -2" -o figure8.txt
      sono start 8_18 --known | sono measure -
    """
    # Imported here, since numpy would make --help wait.
    from sono import formats, starts
    from sono.cli import options
    from sono.starts.scramble import scramble

    if list_names:
        if name or codes or word or output != "-":
            raise click.UsageError("--list stands alone")
        click.echo("\n".join(starts.names()))
        return
    given = [text for text in (name, *codes, word) if text is not None]
    if len(given) != 1:
        raise click.UsageError("give one NAME, a --pd, --dt or --gauss code, or a --braid word")
    name = given[0] if word is None else None
    if word is not None and variant < 0:
        raise click.UsageError(f"--variant {variant}: a braid word has no planar diagram; give 0 or more")
    if known and (variant or word is not None):
        raise click.UsageError("--known is the one rope of a NAME in the atlas, without a --variant")
    places.check_suffix(output)
    if output != "-" and os.path.exists(output) and not force:
        raise click.UsageError(f"{output} exists; --force overwrites it")
    try:
        title, curve = _drawn(name, word, variant, known)
        if scramble_seed is not None:
            title += f", scrambled with seed {scramble_seed}"
            curve = scramble(curve, scramble_seed)
    except ValueError as error:
        raise click.UsageError(f"{error}{_or_known(name, error)}") from error
    if doubt := starts.doubt(name or ""):
        options.complain(doubt)
    try:
        formats.write(output, curve, [title])
    except formats.FormatError as error:
        options.complain(str(error))
        sys.exit(1)


def _drawn(name: str | None, word: str | None, variant: int, known: bool) -> "tuple[str, Components]":
    """Draw what was asked for, and say what it is. Raises `ValueError`."""
    import sono
    from sono import starts
    from sono.starts.braids import braid
    from sono.starts.scramble import scramble

    if word is not None:
        title = f"closed braid {word}"
        curve = braid(_generators(word))
        curve = scramble(curve, variant) if variant else curve
    else:
        title = name or ""
        curve = sono.start(title, known=True) if known else starts.start(title, variant)
    title += ", the rope of the atlas" if known else ""
    title += f", variant {variant}" if variant else ""
    return title, curve


def _or_known(name: str | None, error: ValueError) -> str:
    """Offer the atlas's rope where the table is not installed that has the drawing."""
    from sono import starts
    from sono.starts.tabled import NoTableError

    has = name is not None and isinstance(error, NoTableError) and starts.known(name)
    return "; or --known, for the rope of the atlas" if has else ""


def _generators(word: str) -> list[int]:
    try:
        if generators := [int(generator) for generator in word.replace(",", " ").split()]:
            return generators
    except ValueError:
        pass
    raise click.UsageError(f'--braid {word!r}: give whole numbers such as "1 -2 1 -2"')
