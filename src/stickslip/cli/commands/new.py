"""`stickslip new`: print a commented scenario to start from."""

from __future__ import annotations

from typing import Annotated

import typer

from stickslip.cli.names import complete_law, complete_pull, complete_template
from stickslip.foundation.errors import InputError


def new(
    name: Annotated[
        str | None,
        typer.Argument(
            help="slab, block, or the name of a bundled scenario.", autocompletion=complete_template, show_default=False
        ),
    ] = None,
    friction: Annotated[
        str | None,
        typer.Option(help="A friction law to put into a starter.", autocompletion=complete_law, show_default=False),
    ] = None,
    pull: Annotated[
        str | None,
        typer.Option(help="A pull rate that varies in time, for a starter.", autocompletion=complete_pull, show_default=False),
    ] = None,
    show_list: Annotated[bool, typer.Option("--list", "-l", help="List the names, with what each shows.")] = False,
) -> None:
    """Print a commented scenario to start from.

    "slab" and "block" are starters that explain every key, its unit and its
    range; the others are bundled runs. Redirect the text into a file,
    edit it, and hand it to `stickslip check` and `stickslip run`.

    \b
      stickslip new slab > mine.toml
      stickslip new block --friction exponential-stribeck
      stickslip new slab --pull hold-and-slide
      stickslip new fig6-slab
      stickslip new --list
    """
    if show_list:
        _print_list()
    elif name is None:
        raise InputError("new: which scenario? `stickslip new --list` lists them")
    else:
        from stickslip.scenarios.templates import template

        typer.echo(template(name, friction, pull), nl=False)


def _print_list() -> None:
    import tomllib

    from stickslip.cli.output.show import console, table
    from stickslip.friction import LAWS
    from stickslip.loading import HISTORIES
    from stickslip.scenarios import library

    listing = table("name", "what it shows")
    listing.add_row("slab", "starter: an elastic slab, every key explained")
    listing.add_row("block", "starter: a block on a spring, every key explained")
    for name in library.names():
        content = tomllib.loads(library.text(name))
        listing.add_row(name, f"{content['title']}. {content['description']}")
    console().print(listing)
    laws = table("--friction", "law")
    for kind, law in LAWS.items():
        laws.add_row(kind, (law.__doc__ or "").strip().splitlines()[0])
    console().print(laws)
    pulls = table("--pull", "pull rate")
    for kind, history in HISTORIES.items():
        pulls.add_row(kind, (history.__doc__ or "").strip().splitlines()[0])
    console().print(pulls)
