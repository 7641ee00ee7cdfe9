"""The command `stickslip`, with one file for each subcommand; errors become one line and an exit code."""

from __future__ import annotations

import sys
import warnings
from collections.abc import Callable, Sequence
from inspect import cleandoc
from typing import Annotated, Any

import typer
from typer.core import TyperGroup
from typer.exceptions import TyperException

from stickslip.cli.commands.analogy import analogy
from stickslip.cli.commands.check import check
from stickslip.cli.commands.compare import compare
from stickslip.cli.commands.ensemble import ensemble
from stickslip.cli.commands.export import export
from stickslip.cli.commands.fit import fit
from stickslip.cli.commands.new import new
from stickslip.cli.commands.paper import paper
from stickslip.cli.commands.regularise import regularise
from stickslip.cli.commands.run import run
from stickslip.cli.commands.sweep import sweep
from stickslip.foundation.errors import InputError, InputWarning

_HELP = """Dynamic frictional sliding of a rigid block and of an elastic slab.

What happens at a frictional contact once inertia and waves matter: how it
slips, how it stops, and whether the answer is even unique.

\b
  stickslip new --list             scenarios that come with the package
  stickslip new slab > mine.toml   a commented scenario to start from
  stickslip check mine.toml        what it means, what to know before a run
  stickslip run mine.toml          run it; --figure mine.png draws it
  stickslip fit points.csv         make a law from measured friction
  stickslip compare A B            runs side by side: a table, a figure
  stickslip sweep mine.toml        many runs: maps over its numbers
  stickslip analogy                where a block can replace a slab
  stickslip export mine.toml F     time series for other tools
  stickslip regularise mine.toml   find the selection rule that physics chooses
  stickslip ensemble mine.toml     find how far events and statistics can be trusted
  stickslip paper --out paper      the source paper, claim by claim
"""

COMMANDS: dict[str, Callable[..., None]] = {
    command.__name__: command for command in (run, check, new, fit, compare, sweep, analogy, export, regularise, ensemble, paper)
}
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
        self.commands: Any = dict.fromkeys(COMMANDS)  # the names, from which the nearest one to a wrong name is found

    def get_command(self, ctx: Any, cmd_name: str) -> Any:
        """Return the command of this name, or None if there is none."""
        return _built(cmd_name) if cmd_name in COMMANDS else None

    def format_commands(self, ctx: Any, formatter: Any) -> None:
        """Write the names of all commands, each with the first sentence of its help."""
        with formatter.section("Commands"):
            formatter.write_dl([(name, " ".join(_help_of(name).partition("\n\n")[0].split())) for name in COMMANDS])


def _built(name: str) -> Any:
    """Return a command as typer reads it from its function."""
    alone = typer.Typer(add_completion=False, **STYLE)
    alone.command(name, help=_help_of(name))(COMMANDS[name])
    return typer.main.get_command(alone)


def _help_of(name: str) -> str:
    return cleandoc(COMMANDS[name].__doc__ or "").replace(r"\b", "\b")  # \b keeps the line breaks of a paragraph


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


def main(arguments: Sequence[str] | None = None) -> None:
    """Run the command line and exit with 0 (done), 1 (the run failed), 2 (the input cannot be used) or 130 (interrupted)."""
    sys.exit(_code(arguments))


def _code(arguments: Sequence[str] | None) -> int:
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("default", InputWarning)
            warnings.showwarning = _show_warning
            code = app(arguments, prog_name="stickslip", standalone_mode=False)
    except InputError as error:
        return _fail(str(error))
    except TyperException as error:
        return _fail(error.format_message())
    except OSError as error:
        return _fail(f"{error.filename}: {error.strerror}" if error.filename and error.strerror else str(error))
    except (KeyboardInterrupt, typer.Abort):
        code = 130
    if code == 130:
        return _fail("interrupted", code=130)
    return code if isinstance(code, int) else 0


def _show_warning(message: Warning | str, category: type[Warning], filename: str, lineno: int, *_: Any, **__: Any) -> None:
    """Show what to know about the input as one line on standard error, and other warnings as Python does."""
    if issubclass(category, InputWarning):
        typer.echo(f"stickslip: note: {message}", err=True)
    else:
        sys.stderr.write(warnings.formatwarning(message, category, filename, lineno))


def _fail(message: str, code: int = 2) -> int:
    typer.echo(f"stickslip: {' '.join(message.split())}", err=True)
    return code
