"""Check the arguments of public functions, and describe in a message what was given instead."""

from __future__ import annotations

import inspect
import math
import os
from collections.abc import Callable, Mapping, Sequence
from datetime import date, time
from functools import cache, lru_cache, wraps
from numbers import Integral, Real
from pathlib import Path
from typing import TYPE_CHECKING, Any, Self, TypeVar, cast

import numpy as np

from stickslip.foundation.errors import ArgumentError, InputError, UnknownAttributeError, nearest

LONGEST_VALUE = 60
"""Largest number of characters of a value that a message repeats."""
EXACT_WHOLE_NUMBERS = 10**15
"""Whole numbers below this are shown with all digits."""


def as_float(value: Any) -> float:
    """Return a number as a float; an integer that is too large for a float becomes infinite, with its sign."""
    try:
        return float(value)
    except OverflowError:
        return math.inf if value > 0 else -math.inf


def is_number(value: Any) -> bool:
    """Return True for a real number; True and False are none."""
    return isinstance(value, Real) and not isinstance(value, bool | np.timedelta64)


def check_ordinary(path: Path) -> None:
    """Raise InputError for a pipe, a device or a socket, which may never end. What is not there is left to the reader."""
    if path.exists() and not path.is_file() and not path.is_dir():
        raise InputError(f"{path}: not an ordinary file")


def shown(value: Any) -> str:
    """Return what was given, for a message: a number or a text itself, of anything else the name of its type."""
    if isinstance(value, type):
        return f"the class {value.__name__}, not an instance of it: call it"
    if value is None or isinstance(value, bool):
        return str(value)
    if isinstance(value, np.timedelta64):  # numpy's intervals of time count as whole numbers, but convert to none
        return type(value).__name__
    if isinstance(value, Integral) and abs(int(value)) < EXACT_WHOLE_NUMBERS:
        return str(int(value))
    if isinstance(value, Real):
        return repr(as_float(value))
    if isinstance(value, date | time):  # from a TOML file
        return str(value)
    if isinstance(value, str | bytes | os.PathLike | list | tuple | dict):
        text = ascii(value)
        return text if len(text) <= LONGEST_VALUE else f"{text[: LONGEST_VALUE - 3]}..."
    return type(value).__name__


def check_type(where: str, value: Any, kind: Any, wanted: str) -> None:
    """Raise InputError, beginning with `where`, unless a value is an instance of `kind`; `wanted` describes that."""
    if not isinstance(value, kind):
        raise InputError(f"{where} must be {wanted}, got {shown(value)}")


def check_whole(where: str, value: Any, least: int = 1, most: int | None = None) -> int:
    """Return a whole number from `least` to `most` as an int. Raises InputError, beginning with `where`, for anything else."""
    found = int(value) if isinstance(value, Integral) and is_number(value) else None
    if found is not None and least <= found and (most is None or found <= most):
        return found
    bounds = f" from {least} to {most}" if most is not None else f" above {least - 1}" if least > 0 else ", 0 or more"
    raise InputError(f"{where} must be a whole number{bounds}, got {shown(value)}")


def as_path(where: str, value: Any, wanted: str = "the name of a file") -> Path:
    """Return the path of a file. Raises InputError, beginning with `where`, if the value is neither a text nor a path."""
    check_type(where, value, str | os.PathLike, wanted)
    return Path(value)


class NamesAttributes:
    """Base of the classes that people use: an attribute that an object does not have is answered with those that it has."""

    if not TYPE_CHECKING:  # with it, type checkers would accept any attribute

        def __getattr__(self, name: str) -> Any:
            if name.startswith("_") or hasattr(type(self), name):  # the second is a property that raised an error of this kind
                return object.__getattribute__(self, name)
            raise UnknownAttributeError(self, name)


class CheckedArguments(NamesAttributes):
    """Base of the classes that people make by hand."""

    def __new__(cls, *given: Any, **named: Any) -> Self:
        """Check the names of the arguments; their values are checked once they are in their fields."""
        if not _fits(cls, len(given), frozenset(named)):  # type: ignore[arg-type] # classes are hashable
            check_names(cls.__name__, _taken(cls), given, named)  # type: ignore[arg-type] # classes are hashable
        return super().__new__(cls)

    def __reduce__(self) -> tuple[Any, ...]:
        """Copy and pickle an object without its arguments: it is made empty and filled."""
        return _empty, (type(self),), vars(self)


def _empty(cls: type) -> Any:
    return object.__new__(cls)


@cache
def _taken(cls: type) -> tuple[inspect.Parameter, ...]:
    """Return the arguments that a class takes."""
    return tuple(inspect.signature(cls.__init__).parameters.values())[1:]  # type: ignore[misc] # of the class itself


@lru_cache(maxsize=1024)
def _fits(cls: type, places: int, names: frozenset[str]) -> bool:
    """Return True if a class can be called with so many arguments by position, and with these names."""
    try:
        check_names("", _taken(cls), (None,) * places, dict.fromkeys(names))
    except ArgumentError:
        return False
    return True


def check_names(who: str, taken: Sequence[inspect.Parameter], given: Sequence[Any], named: Mapping[str, Any]) -> None:
    """Raise ArgumentError, which begins with `who`, for arguments that are unknown, too many, given twice or missing."""
    kinds = {one.kind for one in taken}
    any_number, any_name = inspect.Parameter.VAR_POSITIONAL in kinds, inspect.Parameter.VAR_KEYWORD in kinds
    taken = [one for one in taken if one.kind not in (one.VAR_POSITIONAL, one.VAR_KEYWORD)]
    names = [one.name for one in taken]
    by_place = [one.name for one in taken if one.kind is not one.KEYWORD_ONLY]
    wrong = None if any_name else next((name for name in named if name not in names), None)
    if wrong is not None:
        hint = nearest(wrong, names, listed=f"help({who}) lists all")
        raise ArgumentError(f"{who}: unknown argument '{wrong}'; {hint}")
    if len(given) > len(by_place) and not any_number:
        named_only = f" and by name {', '.join(names[len(by_place) :])}" if len(by_place) < len(names) else ""
        most = f"takes at most {len(by_place)} arguments, {', '.join(by_place)}{named_only}" if names else "takes no arguments"
        raise ArgumentError(f"{who}: {most}; got {len(given)}")
    twice = next((name for name in by_place[: len(given)] if name in named), None)
    if twice is not None:
        raise ArgumentError(f"{who}: {twice} is given twice")
    missing = [one.name for one in taken if one.default is one.empty and one.name not in {*named, *by_place[: len(given)]}]
    if missing:
        raise ArgumentError(f"{who}: {', '.join(missing)} must be given")


_Function = TypeVar("_Function", bound=Callable[..., Any])


def for_users(function: _Function) -> _Function:
    """Decorate a function that people call: arguments that it does not have, or lacks, are refused in one line with the nearest."""

    @wraps(function)
    def call(*given: Any, **named: Any) -> Any:
        try:
            return function(*given, **named)
        except TypeError:
            check_names(function.__name__, tuple(inspect.signature(function).parameters.values()), given, named)
            raise

    return cast(_Function, call)
