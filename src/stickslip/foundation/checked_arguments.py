"""Refuse arguments that a class does not have, or that are missing, in one line that names the nearest right one."""

from __future__ import annotations

import inspect
from functools import cache
from typing import Any, Self

from stickslip.foundation.errors import InputError, nearest


class CheckedArguments:
    """Base of the classes that people make by hand."""

    def __new__(cls, *given: Any, **named: Any) -> Self:
        """Check the names of the arguments; their values are checked once they are in their fields."""
        names, needed = _fields(cls)  # type: ignore[arg-type] # classes are hashable
        wrong = next((name for name in named if name not in names), None)
        if wrong is not None:
            raise InputError(f"{cls.__name__}: unknown argument '{wrong}'; {nearest(wrong, names)}")
        if len(given) > len(names):
            raise InputError(f"{cls.__name__}: takes at most {len(names)} arguments, {', '.join(names)}; got {len(given)}")
        if given or named:  # a copy is made without arguments, and filled afterwards
            missing = [name for name in needed if name not in named and name not in names[: len(given)]]
            if missing:
                raise InputError(f"{cls.__name__}: {', '.join(missing)} must be given")
        return super().__new__(cls)


@cache
def _fields(cls: type) -> tuple[tuple[str, ...], tuple[str, ...]]:
    """Return the names of a class's arguments, and of those that must be given."""
    taken = list(inspect.signature(cls.__init__).parameters.values())[1:]  # type: ignore[misc] # of the class itself
    return tuple(one.name for one in taken), tuple(one.name for one in taken if one.default is one.empty)
