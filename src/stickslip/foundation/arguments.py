"""Check the arguments of public functions, and describe in a message what was given instead."""

from __future__ import annotations

import inspect
import math
import os
from datetime import date, time
from functools import cache
from numbers import Integral, Real
from pathlib import Path
from typing import Any, Self

import numpy as np

from stickslip.foundation.errors import InputError, nearest

LONGEST = 60
"""Largest number of characters of a value that a message repeats."""
EXACT = 10**15
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
    if isinstance(value, Integral) and abs(int(value)) < EXACT:
        return str(int(value))
    if isinstance(value, Real):
        return repr(as_float(value))
    if isinstance(value, date | time):  # from a TOML file
        return str(value)
    if isinstance(value, str | bytes | os.PathLike | list | tuple | dict):
        text = ascii(value)
        return text if len(text) <= LONGEST else f"{text[: LONGEST - 3]}..."
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
