"""Values as they are usually typed, without pydantic, which typer asks about each option and which takes long to load.

What is not plain goes to typer, which refuses it with its own messages.
"""

from __future__ import annotations

import os
import re
from pathlib import Path
from typing import Any, get_args
from weakref import WeakKeyDictionary

import typer
from typer.core import TyperArgument, TyperOption

TYPED_NUMBERS = {int: re.compile(r"[-+]?[0-9]{1,15}"), float: re.compile(r"[-+]?[0-9]+(\.[0-9]*)?([eE][-+]?[0-9]+)?")}
"""Numbers as they are usually typed."""
CHECKS = (
    *("callback", "parser", "min", "max", "clamp"),
    *("exists", "file_okay", "dir_okay", "readable", "writable", "resolve_path", "path_type"),
)
"""What may be asked of a value beyond its kind: then it is left to typer, unless all is as by default."""
USUAL = typer.Option()
"""An option of which nothing is asked."""


class Typed:
    """What options and arguments have in common."""

    def process_value(self: Any, ctx: Any, value: Any) -> Any:
        """Return the value of what was typed."""
        several = self.multiple or self.nargs == -1
        kind = get_args(self.type_descriptor.annotation)[0] if several else self.type_descriptor.annotation
        if value is None and not self.required:
            nothing = () if several else None
            return nothing if self.callback is None else self.callback(ctx, self, nothing)
        values = value if several else [value]
        if values and self._asks_nothing() and all(is_plain(kind, one) for one in values):
            made = [kind(one) for one in values]
            return made if several else made[0]
        return super().process_value(ctx, value)  # type: ignore[misc] # of typer's class

    def _asks_nothing(self: Any) -> bool:
        declared = self.type_descriptor.parameter_info
        return all(getattr(declared, name) == getattr(USUAL, name) for name in CHECKS)


class TypedOption(Typed, TyperOption):
    """An option."""


class TypedArgument(Typed, TyperArgument):
    """An argument."""


class OfTyped:
    """What commands and groups have in common whose options and arguments are of these kinds."""

    def get_params(self: Any, ctx: Any) -> list[Any]:
        """Return the options and arguments."""
        return [typed(one) for one in super().get_params(ctx)]  # type: ignore[misc] # of typer's class


TYPED_KINDS: dict[Any, Any] = {TyperOption: TypedOption, TyperArgument: TypedArgument}
"""What typer's options and arguments become."""
_MADE: WeakKeyDictionary[Any, Any] = WeakKeyDictionary()
"""What was made of each: typer asks several times, and expects the same objects."""


def typed(parameter: Any) -> Any:
    """Return an option or argument of typer as one of these kinds, with all that it has, and any other as it is."""
    kind = TYPED_KINDS.get(type(parameter))
    if kind is None:
        return parameter
    if parameter not in _MADE:
        _MADE[parameter] = kind.__new__(kind)
        vars(_MADE[parameter]).update(vars(parameter))
    return _MADE[parameter]


def is_plain(kind: Any, given: Any) -> bool:
    """Return True if a value of this kind is there already, or if a text is one as it is usually typed."""
    if not isinstance(given, str):
        return kind in (int, float, Path) and isinstance(given, kind)
    if kind is Path:  # typer refuses what cannot be read
        return os.access(given, os.R_OK) or not os.access(given, os.F_OK)
    return kind is str or (kind in TYPED_NUMBERS and TYPED_NUMBERS[kind].fullmatch(given) is not None)
