"""Declare fields of laws other than single quantities: series of numbers, other laws, text, choices and named numbers.

As in `stickslip.foundation.quantities`, each field is declared once. Laws check their values against the declaration; scenarios,
`stickslip new` and the documentation read it.
"""

from __future__ import annotations

import dataclasses
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from itertools import pairwise
from typing import Any, NamedTuple

import numpy as np

from stickslip.foundation.errors import InputError, nearest
from stickslip.foundation.quantities import Quantity

LARGEST_SERIES = 10_000
"""Largest number of points in a series: a limit for scenario files, which are untrusted."""


class Named(NamedTuple):
    """A number with a name and, if one was given, its unit in powers of m, kg and s, such as "m s^-1"."""

    name: str
    value: float
    unit: str = ""


@dataclass(frozen=True)
class Series:
    """Declare a list of numbers of one kind, optionally in ascending order."""

    item: Quantity
    ascending: bool = False
    least: int = 2
    """Smallest number of entries: two points by default, which a line needs."""

    @property
    def meaning(self) -> str:
        """Return the meaning of the numbers."""
        return self.item.meaning

    def check(self, owner: str, name: str, value: Any) -> tuple[float, ...]:
        """Return the numbers as a tuple of floats. Raise InputError that names owner, field and index."""
        if isinstance(value, str | Mapping) or not isinstance(value, Iterable) or np.ndim(np.asarray(value, object)) != 1:
            raise InputError(f"{owner}: {name} must be a list of numbers in {self.item.label}, got {type(value).__name__}")
        numbers = tuple(self.item.check(owner, f"{name}[{i}]", one) for i, one in enumerate(value))
        if not self.least <= len(numbers) <= LARGEST_SERIES:
            raise InputError(f"{owner}: {name} must have {self.least} to {LARGEST_SERIES} numbers, got {len(numbers)}")
        if self.ascending:
            for i, (one, following) in enumerate(pairwise(numbers)):
                if not one < following:
                    raise InputError(f"{owner}: {name} must ascend, but [{i + 1}] = {following:g} follows {one:g}")
        return numbers


@dataclass(frozen=True)
class Part:
    """Declare a field that holds another friction law."""

    meaning: str

    def check(self, owner: str, name: str, value: Any) -> Any:
        """Return the law unchanged: the law that contains it checks it."""
        return value


@dataclass(frozen=True)
class Text:
    """Declare a line of text with at most `longest` characters."""

    meaning: str
    longest: int

    def check(self, owner: str, name: str, value: Any) -> str:
        """Return the text without leading and trailing spaces. Raise InputError if it is not text or is too long."""
        if not isinstance(value, str):
            raise InputError(f"{owner}: {name} must be text, got {type(value).__name__}")
        if len(value) > self.longest:
            raise InputError(f"{owner}: {name} must have at most {self.longest} characters, got {len(value)}")
        return value.strip()


@dataclass(frozen=True)
class Choice:
    """Declare a choice between several words."""

    meaning: str
    allowed: tuple[str, ...]

    def check(self, owner: str, name: str, value: Any) -> str:
        """Return the word if it is allowed, else raise InputError."""
        if not isinstance(value, str) or value not in self.allowed:
            raise InputError(f"{owner}: {name} {ascii(value)[:60]} is unknown; {nearest(str(value), self.allowed)}")
        return value


@dataclass(frozen=True)
class NamedNumbers:
    """Declare numbers whose names users choose; `key` is the name of their table in scenario files."""

    meaning: str
    key: str

    def check(self, owner: str, name: str, value: Any) -> tuple[Named, ...]:
        """Return the numbers from a mapping of names to values, or from tuples of name, value and optional unit."""
        triples = value.items() if isinstance(value, Mapping) else value
        named = [Named(*one) for one in triples]
        return tuple(Named(n, Quantity("1", "").check(owner, f"{self.key} {ascii(n)[:60]}", x), unit) for n, x, unit in named)


Field = Series | Part | Text | Choice | NamedNumbers


def declare(field: Field, default: Any = dataclasses.MISSING) -> Any:
    """Return a dataclass field with the given declaration and default."""
    return dataclasses.field(default=default, metadata={"field": field})


def fields_of(kind: type) -> dict[str, tuple[Quantity | Field, Any]]:
    """Return the declaration and the default of each field of a law, quantities included, by name.

    Fields without a default (MISSING) come first and choices come last.
    """
    found = [(f.name, f.metadata.get("quantity") or f.metadata.get("field"), f.default) for f in dataclasses.fields(kind)]
    found.sort(key=lambda one: (one[2] is not dataclasses.MISSING, isinstance(one[1], Choice)))
    return {name: (declared, default) for name, declared, default in found if declared is not None}


def check_fields(owner: Any) -> None:
    """Check all declared fields of a frozen dataclass and store the converted values.

    A field that is None is left as it is if None is its default.
    """
    for name, (declared, default) in fields_of(type(owner)).items():
        value = getattr(owner, name)
        if value is not None or default is not None:
            object.__setattr__(owner, name, declared.check(type(owner).__name__, name, value))
