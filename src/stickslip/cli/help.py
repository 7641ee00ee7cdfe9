"""The help of the commands: options by groups, and the names that an option accepts, looked up when help is shown."""

from __future__ import annotations

from collections.abc import Callable
from inspect import cleandoc
from typing import Any

from typer.core import TyperArgument, TyperCommand

from stickslip.cli.names import CHOICES


def prose_of(command: Callable[..., Any]) -> str:
    """Return the docstring of a command with each paragraph on one line, but for those that begin with a backslash and b."""
    paragraphs = cleandoc(command.__doc__ or "").split("\n\n")
    return "\n\n".join(text.replace(r"\b", "\b") if text.startswith(r"\b") else " ".join(text.split("\n")) for text in paragraphs)


class Command(TyperCommand):
    """A command whose help shows its options by groups, with the names that they accept."""

    def format_options(self, ctx: Any, formatter: Any) -> None:
        """Write the arguments and the options."""
        for one in self.params:
            names = CHOICES.get(str(one.name))
            if names is not None:
                one.help = f"{one.help} One of: {', '.join(names())}."  # type: ignore[attr-defined] # typer's options have one
        sections_of(self, ctx, formatter)


def sections_of(command: Any, ctx: Any, formatter: Any) -> None:
    """Write the arguments and options of a command, each under the heading of its group."""
    sections: dict[str, list[tuple[str, str]]] = {"Arguments": [], "Options": []}
    for one in command.get_params(ctx):
        heading = "Arguments" if isinstance(one, TyperArgument) else getattr(one, "rich_help_panel", None) or "Options"
        record = one.get_help_record(ctx)
        if record is not None:
            sections.setdefault(heading, []).append(record)
    for heading, records in sections.items():
        if records:
            with formatter.section(heading):
                formatter.write_dl(records)
