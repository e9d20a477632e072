"""The command line: one module a command, imported when it is used.

May import `certificates`, `check_certificate`, `check_thickness`, `curve`, `figures`, `formats`,
`invariants`, `jobs`, `naming`, `patience`, `plot`, `printing`, `starts`, `strands`, `tables`, `thickness`
and `tightening`.
"""

import io
import os
import signal
import sys
import threading
from importlib import import_module
from typing import Any

import click

from sono.cli import streams, versions
from sono.printing import printable

COMMANDS = {
    "atlas": "Check or improve the table of the shortest known ropes.",
    "certify": "Prove bounds on ropelength, and check such proofs.",
    "compare": "Compare ropelengths with the published ones.",
    "completion": "Complete commands and knots in a shell.",
    "convert": "Write curves in another format.",
    "export": "Write ropes as solids to be printed.",
    "identify": "Name the knot or link of curves.",
    "measure": "Measure curves: dl, L_p, L_c, L_a.",
    "plot": "Draw pictures of ropes and of tables.",
    "report": "Write pages of many ropes, for a browser.",
    "search": "Find the shortest tight rope of a knot.",
    "start": "Write the starting conformation of a knot.",
    "tighten": "Tighten curves and write the paper's table.",
    "verify": "Tell whether two curves are the same knot.",
    "view": "Show ropes in the round, on a page for a browser.",
}


class _Commands(click.Group):
    """Finds a command `sono NAME` in the module `sono.cli.NAME`; the help needs none of them."""

    def list_commands(self, ctx: click.Context) -> list[str]:
        return list(COMMANDS)

    def get_command(self, ctx: click.Context, cmd_name: str) -> click.Command | None:
        if cmd_name not in COMMANDS:
            return None
        command: click.Command = import_module(f"sono.cli.{cmd_name}").command
        if ctx.resilient_parsing:  # as when a shell asks for completions
            import_module("sono.cli.completing").equip(command)
        return command

    def format_commands(self, ctx: click.Context, formatter: click.HelpFormatter) -> None:
        with formatter.section("Commands"):
            formatter.write_dl(list(COMMANDS.items()))

    def main(self, *args: Any, **more: Any) -> Any:
        """Run a command, and end well whatever stops it."""
        alone = more.get("standalone_mode", True)
        more["standalone_mode"] = False
        if not alone:
            return super().main(*args, **more)
        streams.secure()
        code: object = 1
        try:
            code = super().main(*args, **more)
        except click.ClickException as error:
            message = io.StringIO()
            error.show(message)
            streams.tell(printable(message.getvalue(), "\n").rstrip("\n"))
            code = error.exit_code
        except MemoryError:
            streams.complain("this needs more memory than there is")
        except OSError as error:  # those of files are met where files are read and written
            streams.unwritten(error)
        sys.exit(code if isinstance(code, int) else 0)

    def invoke(self, ctx: click.Context) -> Any:
        """Run a command; Ctrl-C ends it, and no second one hastens the end."""
        try:
            return super().invoke(ctx)
        except KeyboardInterrupt:
            signal.signal(signal.SIGINT, signal.SIG_IGN)
            ctx.exit(130)


@click.group(cls=_Commands, context_settings={"help_option_names": ["-h", "--help"]})
@click.option("--verbose", is_flag=True, is_eager=True, help="More of it, for reports of bugs.")
@click.option(
    "--version", is_flag=True, expose_value=False, callback=versions.show, help="Show the version and exit."
)
def main(verbose: bool) -> None:
    """Tighten knots: pull a closed curve tight as a rope of radius 1 and measure its ropelength.

    Ropelength is length over the rope's RADIUS: the trefoil has 32.743.

    \b
      sono start 3_1 > trefoil.txt
      sono tighten trefoil.txt -n 120,240,480
      sono measure trefoil.n480.txt
    """
    if verbose:
        raise click.UsageError("--verbose goes with --version")


def run() -> None:
    """Run `sono`, and leave without waiting for calls into the core that nobody waits for any more."""
    try:
        main(prog_name="sono")
    except SystemExit as end:
        if threading.active_count() == 1 or not isinstance(end.code, int):
            raise
        try:
            sys.stdout.flush()
        except OSError:
            os._exit(1)
        os._exit(end.code)
