"""What a law may be made of besides single quantities: series of numbers, other laws, text, a choice, named numbers.

Like `stickslip.foundation.quantities`, a field says once what it is: laws check themselves from it, and scenarios, `stickslip new`
and the documentation read it.
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
"""Points of the longest series."""


class Named(NamedTuple):
    """A number with a name, and its unit in powers of m, kg and s ("m s^-1") where one was given."""

    name: str
    value: float
    unit: str = ""


@dataclass(frozen=True)
class Series:
    """Numbers of one kind, ascending where they are places."""

    item: Quantity
    ascending: bool = False
    least: int = 2
    """Numbers in the shortest series."""

    @property
    def meaning(self) -> str:
        """What the numbers are."""
        return self.item.meaning

    def check(self, owner: str, name: str, value: Any) -> tuple[float, ...]:
        """The numbers as a tuple of floats; InputError names owner, field and the place in the series."""
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
    """Another friction law."""

    meaning: str

    def check(self, owner: str, name: str, value: Any) -> Any:
        """The law as it is; what it must be is for the law that holds it to say."""
        return value


@dataclass(frozen=True)
class Text:
    """A line of text."""

    meaning: str
    longest: int

    def check(self, owner: str, name: str, value: Any) -> str:
        """The text without spaces around it."""
        if not isinstance(value, str):
            raise InputError(f"{owner}: {name} must be text, got {type(value).__name__}")
        if len(value) > self.longest:
            raise InputError(f"{owner}: {name} must have at most {self.longest} characters, got {len(value)}")
        return value.strip()


@dataclass(frozen=True)
class Choice:
    """One of several words."""

    meaning: str
    allowed: tuple[str, ...]

    def check(self, owner: str, name: str, value: Any) -> str:
        """The word, if it is allowed."""
        if not isinstance(value, str) or value not in self.allowed:
            raise InputError(f"{owner}: {name} {ascii(value)[:60]} is unknown; {nearest(str(value), self.allowed)}")
        return value


@dataclass(frozen=True)
class NamedNumbers:
    """Numbers with names of the user's choice; `key` is what scenario files call the table of them."""

    meaning: str
    key: str

    def check(self, owner: str, name: str, value: Any) -> tuple[Named, ...]:
        """The numbers, from a mapping or from triples of name, value and unit."""
        triples = value.items() if isinstance(value, Mapping) else value
        named = [Named(*one) for one in triples]
        return tuple(Named(n, Quantity("1", "").check(owner, f"{self.key} {ascii(n)[:60]}", x), unit) for n, x, unit in named)


Field = Series | Part | Text | Choice | NamedNumbers


def declare(field: Field, default: Any = dataclasses.MISSING) -> Any:
    """A dataclass field that holds what `field` says."""
    return dataclasses.field(default=default, metadata={"field": field})


def fields_of(kind: type) -> dict[str, tuple[Quantity | Field, Any]]:
    """Everything that a law declares, quantities too: by name, with its default.

    First what has no default (MISSING), last the choices.
    """
    found = [(f.name, f.metadata.get("quantity") or f.metadata.get("field"), f.default) for f in dataclasses.fields(kind)]
    found.sort(key=lambda one: (one[2] is not dataclasses.MISSING, isinstance(one[1], Choice)))
    return {name: (declared, default) for name, declared, default in found if declared is not None}


def check_fields(owner: Any) -> None:
    """Check everything that a frozen dataclass declares and store what came out; None stays where it is the default."""
    for name, (declared, default) in fields_of(type(owner)).items():
        value = getattr(owner, name)
        if value is not None or default is not None:
            object.__setattr__(owner, name, declared.check(type(owner).__name__, name, value))
