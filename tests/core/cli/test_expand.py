"""Options that a dataclass declares: each is taken by its name and reaches the field that declares it."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Annotated

import typer
from typer.testing import CliRunner

from stickslip.cli.expand import expanded
from stickslip.cli.options import option


@dataclass(frozen=True)
class Inner:
    """Options within options."""

    colour: Annotated[str | None, option("Colour.", "--colour", "-c")] = None


@dataclass(frozen=True)
class Outer:
    """Options, and a group of them."""

    inner: Inner
    width: Annotated[float, typer.Option(help="Width.")] = 2.0


def test_each_field_is_an_option_and_receives_what_is_typed() -> None:
    found = []

    def draw(name: Annotated[str, typer.Argument()], *, outer: Outer, often: Annotated[int, typer.Option()] = 1) -> None:
        found.append((name, outer, often))

    app = typer.Typer()
    app.command()(expanded(draw))
    for typed in (["a"], ["a", "-c", "red", "--often", "3", "--width", "5"]):
        assert CliRunner().invoke(app, typed).exit_code == 0
    assert found == [("a", Outer(Inner(), 2.0), 1), ("a", Outer(Inner("red"), 5.0), 3)]
