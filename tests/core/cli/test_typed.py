"""What is typed becomes what typer makes of it, whether pydantic is asked or not."""

from __future__ import annotations

import re
from pathlib import Path
from typing import Annotated, Any

import pytest
import typer
from typer.main import get_command

from stickslip.cli.app import STYLE, CommandWithSections, app
from stickslip.cli.typed import Typed, is_plain

TEXTS = (
    *(
        "12",
        "-3",
        "+4",
        "007",
        "1.5",
        "7.",
        ".5",
        "1e3",
        "-2E-5",
        "0",
        "10000000000000000000000",
        "1e999",
        "1.7976931348623157e308",
    ),
    *("", " ", " 7", "7 ", "1_000", "1,5", "0x10", "nan", "inf", "-inf", "True", "١٢", "abc", "ä µ", "a b.nc", "-", ".", "/", "~"),
    *("two\nlines", "\x1b[31m", "\udcff", "no/such/folder/file.nc", "friction.alpha=2"),
)
"""Texts that are typed, or mistyped."""


def told(process: Any, ctx: Any, value: Any) -> tuple[str, str]:
    """Return what a function makes of a value, as it is written in Python, or why it refuses it."""
    try:
        made = process(ctx, value)
    except typer.BadParameter as error:
        return "refused", error.format_message()
    return "made", repr(made)


@pytest.mark.sampled(every=8)
@pytest.mark.parametrize("name", [*get_command(app).commands])
def test_every_option_takes_what_typer_takes(name: str) -> None:
    command = get_command(app).get_command(None, name)
    ctx = command.make_context(name, [], resilient_parsing=True)
    ctx.resilient_parsing = False
    asked = 0
    for one in command.get_params(ctx):
        assert isinstance(one, Typed)
        if one.callback is not None:  # --help ends the command
            continue
        several = one.multiple or one.nargs == -1
        values = [(text,) for text in TEXTS] + [TEXTS[:3], ()] if several else [*TEXTS, one.get_default(ctx)]
        for value in [*values, *([] if one.required else [None])]:
            assert told(one.process_value, ctx, value) == told(super(Typed, one).process_value, ctx, value), (one.name, value)
            asked += 1
    assert asked or name == "doctor"


def declared(kind: Any, **asked: Any) -> Any:
    """Return a parameter of a command of others, of whose value something is asked."""
    alone = typer.Typer(add_completion=False, **STYLE)

    def command(given: Any = None) -> None: ...

    command.__annotations__["given"] = Annotated[kind, typer.Option(**asked)]
    alone.command("alone", cls=CommandWithSections)(command)
    return typer.main.get_command(alone).get_params(typer.Context(typer.main.get_command(alone)))[0]


@pytest.mark.parametrize(
    ("kind", "asked", "text", "message"),
    [
        (Path, {"exists": True}, "not there", "does not exist"),
        (Path, {"dir_okay": False}, "folder", "is a directory"),
        (int, {"min": 3}, "2", "greater than or equal to 3"),
        (float, {"max": 3.0}, "4", "less than or equal to 3"),
        (str, {"parser": lambda text: {"one": 1}[text]}, "one", ""),
    ],
)
def test_what_a_command_of_others_asks_of_a_value_is_asked(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, kind: Any, asked: dict[str, Any], text: str, message: str
) -> None:
    monkeypatch.chdir(tmp_path)
    (tmp_path / "folder").mkdir()
    one = declared(kind, **asked)
    assert isinstance(one, Typed)
    found, said = told(one.process_value, None, text)
    assert (found == "refused" and re.search(message, said)) if message else said == "1"


def test_a_file_that_nobody_may_read_is_left_to_typer(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("stickslip.cli.typed.os.access", lambda _, mode: mode == 0)
    assert not is_plain(Path, str(tmp_path))
