"""Options that are declared once, as the fields of a dataclass, and that several commands take."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import fields, is_dataclass
from inspect import Parameter, Signature, signature
from typing import Any, get_type_hints


def expanded(command: Callable[..., None]) -> Callable[..., None]:
    """Return a command that takes an option for each field of those of its parameters that are dataclasses."""
    known, taken = get_type_hints(command, include_extras=True), signature(command).parameters
    hints = {name: known.get(name, str if p.default in (Parameter.empty, None) else type(p.default)) for name, p in taken.items()}

    def called(**typed: Any) -> None:
        from stickslip.foundation.given import shown_in  # here, with the table of units, which help does without

        with shown_in({}):  # each command shows results in the units of its own problem
            command(**{name: _made(hint, typed) if is_dataclass(hint) else typed[name] for name, hint in hints.items()})

    parameters = [one for name, hint in hints.items() for one in _options(hint, taken[name])]
    called.__signature__ = Signature(parameters)  # type: ignore[attr-defined] # typer reads it
    called.__annotations__ = {one.name: one.annotation for one in parameters}
    return called


def _options(hint: Any, parameter: Parameter) -> Iterator[Parameter]:
    """Yield a parameter with its hint, or if that is a dataclass, a parameter for each field."""
    if not is_dataclass(hint):
        yield parameter.replace(annotation=hint)
        return
    hints = get_type_hints(hint, include_extras=True)
    for field in fields(hint):
        default = Parameter.empty if is_dataclass(hints[field.name]) else field.default
        yield from _options(hints[field.name], Parameter(field.name, Parameter.KEYWORD_ONLY, default=default))


def _made(kind: Any, typed: dict[str, Any]) -> Any:
    """Return the dataclass with the values that were typed."""
    hints = get_type_hints(kind)
    return kind(**{name: _made(hint, typed) if is_dataclass(hint) else typed[name] for name, hint in hints.items()})
