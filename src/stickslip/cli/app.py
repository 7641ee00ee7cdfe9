"""The subcommands of `stickslip`, one file each, in the groups in which the help shows them."""

from __future__ import annotations

from collections.abc import Callable
from typing import Annotated, Any

import typer
from typer.core import TyperGroup

from stickslip.cli.commands.analogy import analogy
from stickslip.cli.commands.check import check
from stickslip.cli.commands.compare import compare
from stickslip.cli.commands.doctor import doctor
from stickslip.cli.commands.ensemble import ensemble
from stickslip.cli.commands.explore import explore
from stickslip.cli.commands.export import export
from stickslip.cli.commands.fit import fit
from stickslip.cli.commands.new import new
from stickslip.cli.commands.paper import paper
from stickslip.cli.commands.regularise import regularise
from stickslip.cli.commands.run import run
from stickslip.cli.commands.show import show
from stickslip.cli.commands.sweep import sweep
from stickslip.cli.help import Command, prose_of, sections_of, write_list
from stickslip.foundation.errors import InputError, nearest

_HELP = """Dynamic frictional sliding of a rigid block and of an elastic slab.

What happens at a frictional contact once inertia and waves matter: how it slips, how it stops, and whether the answer is unique.

\b
  stickslip new slab > mine.toml   write a commented scenario
  stickslip check mine.toml        what it means, before a run
  stickslip run mine.toml          run it
  stickslip run mine.toml --out mine.nc --figure mine.png
  stickslip show mine.nc           the same summary, later
  stickslip new --list             scenarios to learn from
  stickslip COMMAND --help         options, with examples
"""
GROUPS: dict[str, tuple[Callable[..., None], ...]] = {
    "A scenario and its run": (new, check, run, show, export, explore),
    "Measured friction": (fit,),
    "Questions that need many runs": (compare, sweep, analogy, ensemble, regularise),
    "The source paper": (paper,),
    "This installation": (doctor,),
}
"""The functions of all commands, by the heading under which the help shows them."""
COMMANDS = {command.__name__: command for commands in GROUPS.values() for command in commands}
"""The functions of all commands, by name."""
STYLE: dict[str, Any] = {
    "rich_markup_mode": None,
    "pretty_exceptions_enable": False,
    "context_settings": {"help_option_names": ["-h", "--help"], "max_content_width": 100},
}
"""Plain help, because boxes and colours take as long to load as all else that `stickslip --help` does."""


class Commands(TyperGroup):
    """The commands of `stickslip`. Only the one that is asked for is built, because each takes some milliseconds."""

    def __init__(self, **given: Any) -> None:
        super().__init__(**given)
        self.commands: Any = dict.fromkeys(COMMANDS)

    def get_command(self, ctx: Any, cmd_name: str) -> Any:
        """Return the command of this name, or None if there is none."""
        return _built(cmd_name) if cmd_name in COMMANDS else None

    def resolve_command(self, ctx: Any, args: list[str]) -> Any:
        """Return the command that is meant. Raises InputError for an unknown one, but not while the shell completes words."""
        if args[0] not in COMMANDS and not args[0].startswith("-") and not ctx.resilient_parsing:
            raise InputError(_unknown(args[0]))
        return super().resolve_command(ctx, args)

    def format_options(self, ctx: Any, formatter: Any) -> None:
        """Write the names of all commands, each with the first sentence of its help, and the options."""
        for heading, commands in GROUPS.items():
            with formatter.section(heading):
                write_list(formatter, [(one.__name__, prose_of(one).partition("\n\n")[0]) for one in commands])
        sections_of(self, ctx, formatter)


def _built(name: str) -> Any:
    """Return a command as typer reads it from its function."""
    alone = typer.Typer(add_completion=False, **STYLE)
    alone.command(name, cls=Command, help=prose_of(COMMANDS[name]))(COMMANDS[name])
    return typer.main.get_command(alone)


def _unknown(name: str) -> str:
    from stickslip.scenarios import library

    shown = name if name.isprintable() else ascii(name)
    if name in library.names() or name.endswith(".toml"):
        return f"'{shown}' is a scenario, not a command: did you mean `stickslip run {shown}` or `stickslip check {shown}`?"
    return f"there is no command '{shown}'; {nearest(name, COMMANDS)}"


app = typer.Typer(name="stickslip", cls=Commands, help=_HELP, invoke_without_command=True, **STYLE)


def _print_version(wanted: bool) -> None:
    if wanted:
        from stickslip import __version__

        typer.echo(f"stickslip {__version__}")
        raise typer.Exit


@app.callback()
def start(
    context: typer.Context,
    version: Annotated[
        bool, typer.Option("--version", help="Show the version and stop.", callback=_print_version, is_eager=True)
    ] = False,
) -> None:
    """Show the help if no command is given."""
    if context.invoked_subcommand is None:
        typer.echo(context.get_help())
