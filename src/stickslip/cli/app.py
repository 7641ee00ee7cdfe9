"""The subcommands of `stickslip` in groups, and their help."""

from __future__ import annotations

import re
from collections.abc import Callable
from inspect import cleandoc
from textwrap import wrap
from typing import Annotated, Any

import typer

from stickslip.cli.commands.check import check
from stickslip.cli.commands.doctor import doctor
from stickslip.cli.commands.export import export
from stickslip.cli.commands.find import find
from stickslip.cli.commands.new import new
from stickslip.cli.commands.run import run
from stickslip.cli.commands.show import show
from stickslip.cli.expand import expanded
from stickslip.cli.mistyped import unknown_command
from stickslip.cli.options import CHOICES
from stickslip.extension import Command
from stickslip.extension import commands as commands_of_extensions
from stickslip.foundation.errors import InputError

try:  # all names of typer that it does not document
    from typer.core import TyperArgument, TyperCommand, TyperGroup
    from typer.exceptions import TyperException as TyperException

    from stickslip.cli.typed import OfTyped
except ImportError as error:
    raise InputError(f"typer {typer.__version__} does not suit ({error}); 0.29 does: pip install 'typer>=0.29,<0.30'") from None

WIDEST_TERM = 28
"""Largest width (columns) of the terms of a list; the explanation of a longer one begins below it."""
_OF_SEVERAL = re.compile(r"<list\[(\w+)\]>")
"""What typer shows for a value that may be given several times."""
LEAST_WIDTH = 20
"""Smallest width (columns) of explanations."""


def prose_of(command: Callable[..., Any]) -> str:
    """Return the docstring of a command with each paragraph on one line, but for those that begin with a backslash and b."""
    paragraphs = cleandoc(command.__doc__ or "").split("\n\n")
    return "\n\n".join(text.replace(r"\b", "\b") if text.startswith(r"\b") else " ".join(text.split("\n")) for text in paragraphs)


class CommandWithSections(OfTyped, TyperCommand):
    """A command whose help shows its options by groups, with the names that they accept."""

    def format_options(self, ctx: Any, formatter: Any) -> None:
        """Write the arguments and the options."""
        for one in self.get_params(ctx):
            names = CHOICES.get(str(one.name))
            if names is not None:
                one.help = f"{one.help} One of: {', '.join(names())}."
        sections_of(self, ctx, formatter)


def sections_of(command: Any, ctx: Any, formatter: Any) -> None:
    """Write the arguments and options of a command, each under the heading of its group."""
    sections: dict[str, list[tuple[str, str]]] = {"Arguments": [], "Options": []}
    for one in command.get_params(ctx):
        heading = "Arguments" if isinstance(one, TyperArgument) else getattr(one, "rich_help_panel", None) or "Options"
        record = one.get_help_record(ctx)
        if record is not None:
            record = _OF_SEVERAL.sub(r"<\1>", record[0]), record[1]  # one is typed at a time
            sections.setdefault(heading, []).append(record)
    for heading, records in sections.items():
        if records:
            with formatter.section(heading):
                write_list(formatter, records)


def write_list(formatter: Any, records: list[tuple[str, str]]) -> None:
    """Write terms, each with its explanation beside it or, after a long term, below it; words with hyphens stay whole."""
    start = min(max(len(term) for term, _ in records), WIDEST_TERM) + 2
    width = max(formatter.width - formatter.current_indent - start, LEAST_WIDTH)
    for term, text in records:
        lines = wrap(text, width, break_on_hyphens=False, break_long_words=False) or [""]
        first = f"{term:{start}}{lines.pop(0)}" if len(term) <= start - 2 else term
        for line in (first, *(f"{'':{start}}{one}" for one in lines)):
            formatter.write(f"{'':{formatter.current_indent}}{line}".rstrip() + "\n")


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
OF_CORE: dict[str, tuple[Command, ...]] = {
    "A scenario and its run": (new, check, run, show, export),
    "Measured friction": (),
    "Questions that need many runs": (find,),
    "For other programs": (),
}
"""The functions of the core's commands, by their heading in the help; extensions add theirs to these headings, or to others."""
LAST: dict[str, tuple[Command, ...]] = {"This installation": (doctor,)}
"""What comes last in the help."""


def _all_groups() -> dict[str, tuple[Command, ...]]:
    """Return the functions of all commands, by their heading in the help. Raises InputError if two have one name."""
    added = commands_of_extensions()
    headings, of_core = [*OF_CORE, *(heading for heading in added if heading not in LAST), *LAST], OF_CORE | LAST
    groups = {heading: (*of_core.get(heading, ()), *added.get(heading, ())) for heading in headings}
    names = [command.__name__ for group in groups.values() for command in group]
    if twice := sorted({name for name in names if names.count(name) > 1}):
        raise InputError(f"two extensions, or one and the core, have a command '{twice[0]}': uninstall one")
    return {heading: group for heading, group in groups.items() if group}


GROUPS = _all_groups()
"""The functions of all commands, by their heading in the help."""
COMMANDS = {command.__name__: command for commands in GROUPS.values() for command in commands}
"""The functions of all commands, by name."""
STYLE: dict[str, Any] = {
    "rich_markup_mode": None,
    "pretty_exceptions_enable": False,
    "context_settings": {"help_option_names": ["-h", "--help"], "max_content_width": 100},
}
"""Plain help, because boxes and colours take as long to load as all else that `stickslip --help` does."""


class Commands(OfTyped, TyperGroup):
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
            raise InputError(unknown_command(args[0], COMMANDS))
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
    alone.command(name, cls=CommandWithSections, help=prose_of(COMMANDS[name]))(expanded(COMMANDS[name]))
    return typer.main.get_command(alone)


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
