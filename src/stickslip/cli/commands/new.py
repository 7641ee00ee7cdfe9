"""`stickslip new`: print a commented scenario to start from."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Annotated

import typer

from stickslip.cli.options import argument, complete_law, complete_pull, complete_template, option
from stickslip.cli.output.show import console, print_words
from stickslip.foundation.errors import InputError


def new(
    name: Annotated[
        str | None,
        argument("A starter, such as slab, block or string, or the name of a bundled scenario.", complete_template),
    ] = None,
    *,
    friction: Annotated[str | None, option("A friction law to put into a starter.", autocompletion=complete_law)] = None,
    pull: Annotated[str | None, option("A pull rate that varies in time, for a starter.", autocompletion=complete_pull)] = None,
    show_list: Annotated[bool, typer.Option("--list", "-l", help="List the names, with what each shows.")] = False,
) -> None:
    r"""Print a commented scenario to start from.

    Starters, such as "slab", "block", "string" and "layered-slab", explain every key, its unit and
    its range; the others are bundled runs. Redirect the text into a file, edit it, and hand it to
    `stickslip check` and `stickslip run`.

    \b
      stickslip new slab > mine.toml
      stickslip new block --friction exponential-stribeck
      stickslip new slab --pull hold-and-slide
      stickslip new fig6-slab
      stickslip new              (lists all names, as --list does)
      stickslip new --list drill (those with this word)
    """
    if show_list or (name is None and friction is None and pull is None):
        _print_list(name)
    elif name is None:
        raise InputError("new: which scenario? `stickslip new --list` lists them")
    else:
        from stickslip.problem.scenarios import template

        typer.echo(template(name, friction, pull), nl=False)


def _print_list(about: str | None) -> None:
    """Print what can be printed, or what has a word in its name, its trade or what it shows. Raises InputError if nothing has."""
    from stickslip.friction import LAWS
    from stickslip.problem import HISTORIES
    from stickslip.problem.scenarios import library

    screen, entries = console(), library.entries()
    groups = {"Starters, with every key explained": {name: one.meaning for name, one in library.STARTERS.items()}}
    for trade, names in library.by_trade().items():
        groups[trade] = {name: f"{entries[name].title}. {entries[name].description}" for name in names}
    word, rows = (about or "").casefold(), list[tuple[str, ...]]()
    for heading, texts in groups.items():
        found = [(name, text) for name, text in texts.items() if word in f"{heading} {name} {text}".casefold()]
        rows += [(heading,), *found] if found else []
    if not rows:
        raise InputError(f"new: nothing in the list has the word {ascii(about)[:60]}; `stickslip new --list` shows all of it")
    print_words(screen, ("name", "what it shows"), rows)
    if about:
        return
    registered: tuple[tuple[str, str, Mapping[str, type]], ...] = (("--friction", "law", LAWS), ("--pull", "pull rate", HISTORIES))
    for option_name, what, kinds in registered:
        screen.print()
        rows = [(kind, (one.__doc__ or "").strip().splitlines()[0]) for kind, one in kinds.items()]
        print_words(screen, (option_name, what), rows)
