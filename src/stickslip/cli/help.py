"""The help of the commands: options by groups, and the names that an option accepts, looked up when help is shown."""

from __future__ import annotations

from collections.abc import Callable
from inspect import cleandoc
from textwrap import wrap
from typing import Any

from typer.core import TyperArgument, TyperCommand

from stickslip.cli.names import CHOICES

WIDEST_TERM = 28
"""Largest width (columns) of the terms of a list; the explanation of a longer one begins below it."""
LEAST_WIDTH = 20
"""Smallest width (columns) of explanations."""


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
