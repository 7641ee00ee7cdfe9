"""Explain in one line what was mistyped on the command line, beginning with the command, as the package's own messages do."""

from __future__ import annotations

import re
from typing import Any

from stickslip.foundation.conversion import decimal_point
from stickslip.foundation.errors import nearest

_KINDS = {"int": "a whole number", "float": "a number"}
"""What a value must be, by the type of its parameter."""


def explain(error: Any) -> str:
    """Return the message for an error of the parser of the command line."""
    context = getattr(error, "ctx", None)
    if context is None:  # of an option without its value, or with one that it does not take
        return str(error.format_message()).replace("requires an argument", "needs a value").rstrip(".")
    command = f"{context.info_name}: " if context.parent else ""
    options = [name for one in context.command.get_params(context) for name in one.opts if name.startswith("--")]
    teach = f"`{context.command_path} --help` {'explains it, with examples' if context.parent else 'shows all'}"
    said = {
        "MissingParameter": lambda: f"{_name(error.param)} is missing; {teach}",
        "NoSuchOption": lambda: f"there is no option {error.option_name}; {_hint(error.option_name, options)}{teach}",
        "BadParameter": lambda: _bad_value(error),
        "UsageError": lambda: _too_many(error.format_message(), teach),
    }.get(type(error).__name__)
    return f"{command}{said()}" if said else str(error.format_message())


def _name(parameter: Any) -> str:
    longest = max(parameter.opts, key=len)
    return str(longest if longest.startswith("-") else longest.upper())


def _hint(name: str, options: list[str]) -> str:
    hint = nearest(name, options)
    return f"{hint} " if hint.startswith("did") else ""


def _bad_value(error: Any) -> str:
    """Return what a value must be and what was given, if both are known."""
    kind = _KINDS.get(error.param.type_descriptor.annotation.__name__) if error.param else None
    faults = error.__cause__.errors() if hasattr(error.__cause__, "errors") else []
    if kind is None or not faults:
        return " ".join(str(error.format_message()).split())
    least = getattr(error.param, "min", None)
    bound = "" if least is None else f", at least {least}"
    given = str(faults[0]["input"])
    point = decimal_point(given)
    return f"{_name(error.param)} must be {kind}{bound}, got {given[:60]!a}" + (f": write {point}" if point else "")


def _too_many(message: str, teach: str) -> str:
    found = re.search(r"unexpected extra arguments?(?:\(s\))? \((.*)\)", message)
    if found is None:
        return message
    if "=" in found[1]:
        return f"{ascii(found[1])[:60]} is too much; a value of the scenario is replaced by --set NAME=VALUE; {teach}"
    return f'{ascii(found[1])[:60]} is too much; a text with spaces stands in quotes, as "480 years"; {teach}'
