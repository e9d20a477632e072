"""`sono completion SHELL`: what makes a shell complete commands, options, files and names of knots."""

import click
from click.shell_completion import get_completion_class

SHELLS = [shell for shell in ("bash", "zsh", "fish", "powershell") if get_completion_class(shell)]
"""Those that Click knows; PowerShell since 8.5."""


@click.command("completion")
@click.argument("shell", type=click.Choice(SHELLS))
@click.pass_context
def command(ctx: click.Context, shell: str) -> None:
    """Print the script that completes commands, options, files and names of knots in a shell.

    The shell reads it when it begins, by a line in ~/.bashrc or ~/.zshrc, or from a folder:

    \b
      source <(sono completion bash)
      source <(sono completion zsh)                     # after compinit
      sono completion fish > ~/.config/fish/completions/sono.fish
    """
    completes = get_completion_class(shell)
    assert completes
    click.echo(completes(ctx.find_root().command, {}, "sono", "_SONO_COMPLETE").source(), nl=False)
