"""One line on what was mistyped on the command line: the fault, what may have been meant, and where it is explained."""

from __future__ import annotations

import re
from collections.abc import Collection, Iterator
from pathlib import Path
from typing import Any

from stickslip.cli.extra_words import about_extra
from stickslip.cli.options import is_data
from stickslip.extension import command_left_out
from stickslip.foundation.errors import did_you_mean, meant, nearest
from stickslip.foundation.synonyms import same

_KINDS = {"int": "a whole number", "float": "a number"}
"""What a value must be, by the type of its parameter."""
MOST_OWNERS = 5
"""Largest number of commands that are named as having an option."""
OF_ALL = ("help", "version")
"""Options of `stickslip` itself that are typed like commands."""
READERS = {
    ".toml": ("a scenario", "`stickslip run {0}` or `stickslip check {0}`"),
    ".nc": ("a file of results", "`stickslip show {0}`"),
    ".zarr": ("a folder of results", "`stickslip show {0}`"),
}
"""What a file is that stands in place of a command, by the end of its name, and what may be meant."""
OF_DATA = ("a table", "`stickslip fit {0}` or `stickslip infer SCENARIO {0} --free NAMES`")
"""The same for measured data."""


def unknown_command(name: str, commands: Collection[str]) -> str:
    """Return the message for a command that there is not."""
    from stickslip.problem.scenarios import library

    shown = name if name.isprintable() else ascii(name)
    if name.casefold() in OF_ALL:
        return f"there is no command '{shown}'; did you mean `stickslip --{name.casefold()}`?"
    kind = READERS.get(".toml" if name in library.names() else Path(name).suffix.lower(), OF_DATA if is_data(name) else None)
    if kind is not None:
        return f"'{shown}' is {kind[0]}, not a command: did you mean {kind[1].format(shown)}?"
    if left_out := command_left_out(name):
        return left_out
    return f"there is no command '{shown}'; {nearest(name, commands, listed='`stickslip --help` shows all')}"


def explain(error: Any) -> str:
    """Return the message for an error of the parser of the command line."""
    context = getattr(error, "ctx", None)
    if context is None:  # of an option without its value, or with one that it does not take
        return str(error.format_message()).replace("requires an argument", "needs a value").rstrip(".")
    command = f"{context.info_name}: " if context.parent else ""
    teach = f"`{context.command_path} --help` {'explains it, with examples' if context.parent else 'shows all'}"
    said = {
        "MissingParameter": lambda: f"{_missing(error.param, context)}; {teach}",
        "NoSuchOption": lambda: f"there is no option {error.option_name}; {_hint(error.option_name, context)}{teach}",
        "BadParameter": lambda: _bad_value(error),
        "UsageError": lambda: _too_many(error.format_message(), context, teach),
    }.get(type(error).__name__)
    return f"{command}{said()}" if said else str(error.format_message())


def _missing(parameter: Any, context: Any) -> str:
    """Return what is missing, and which order is right if data stand where the scenario belongs."""
    given = context.params.get("scenario")
    if parameter.name == "data" and isinstance(given, str):
        if is_data(given):
            return f"the scenario comes first, and then the data: `{context.command_path} SCENARIO {given} ...`"
        return f"{_name(parameter)} is missing, after the scenario: `{context.command_path} {given} DATA ...`"
    return f"{_name(parameter)} is missing"


def _name(parameter: Any) -> str:
    longest = max(parameter.opts, key=len)
    return str(longest if longest.startswith("-") else longest.upper())


def _options(command: Any, context: Any) -> list[str]:
    return [name for one in command.get_params(context) for name in one.opts if name.startswith("-")]


def _hint(name: str, context: Any) -> str:
    """Return which option may be meant: of this command one of that meaning, the same of others, or one that is spelled alike."""
    options = [one for one in _options(context.command, context) if one.startswith("--")]
    is_word = name.startswith("--")
    close = same(name, options) if is_word else []
    owners = list(_owners(name, context))
    some = owners if len(owners) <= MOST_OWNERS else [*owners[:MOST_OWNERS], "others"]
    elsewhere = f"it is an option of {' and '.join(filter(None, (', '.join(some[:-1]), some[-1])))}; " if some else ""
    if close or not (some or not is_word):
        close = close or meant(name, options)
    if close:
        return f"{elsewhere}{did_you_mean(close)} "
    if same(name, ["--out"]):
        return f"{elsewhere}`> FILE` behind the command keeps what it prints; "
    if is_word and not some and "--set" in options:
        return f"if it is a number of the scenario, write --set {name[2:].replace('-', '_')}=VALUE; "
    return elsewhere


def _owners(name: str, context: Any) -> Iterator[str]:
    """Yield the names of other commands that have an option of this name."""
    root = context.find_root()
    for command in root.command.list_commands(root):
        if command != context.info_name and name in _options(root.command.get_command(root, command), context):
            yield command


def _bad_value(error: Any) -> str:
    """Return what a value must be and what was given, if both are known."""
    from stickslip.foundation.meant import decimal_point

    described = getattr(error.param, "type_descriptor", None)  # private to typer
    kind = _KINDS.get(getattr(getattr(described, "annotation", None), "__name__", ""))
    faults = error.__cause__.errors() if hasattr(error.__cause__, "errors") else []
    if kind is None or not faults:
        return " ".join(str(error.format_message()).split())
    least = getattr(error.param, "min", None)
    bound = "" if least is None else f", at least {least}"
    given = str(faults[0]["input"])
    point = decimal_point(given)
    return f"{_name(error.param)} must be {kind}{bound}, got {given[:60]!a}" + (f": write {point}" if point else "")


def _too_many(message: str, context: Any, teach: str) -> str:
    found = re.search(r"unexpected extra arguments?(?:\(s\))? \((.*)\)", message)
    return about_extra(found[1], context, teach) if found else message
