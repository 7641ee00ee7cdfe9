"""Declare the fields of bodies, laws and loading histories: unit, meaning and allowed values of each, once, with the field.

The owners check their values against these declarations (`check_fields`); scenario files, `stickslip new`, the Parameters section
of a docstring (`document_fields`) and the documentation are made from them.
"""

from __future__ import annotations

import dataclasses
import math
import numbers
from collections.abc import Collection, Iterable, Iterator, Mapping
from dataclasses import dataclass
from itertools import pairwise
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from stickslip.foundation.errors import InputError, nearest
from stickslip.foundation.units import si_base

LARGEST_WHOLE = 16
"""Largest magnitude of a whole-numbered quantity; such quantities are exponents."""
LARGEST, SMALLEST = 1e50, 1e-50
"""Largest magnitude of a quantity, and its smallest distance from an exclusive lower bound (both in SI units).

Within these limits products of several quantities neither overflow nor underflow.
"""
LARGEST_SERIES = 10_000
"""Largest number of points in a series: a limit for scenario files, which are untrusted."""


@dataclass(frozen=True)
class Quantity:
    """Unit (SI), meaning and allowed range of a number.

    Parameters
    ----------
    unit : str
        SI unit, "1" for a pure number.
    meaning : str
        Description for people.
    above, at_least : float, optional
        Exclusive and inclusive lower bound, in `unit`.
    infinite : bool
        If True, infinite values and magnitudes above `LARGEST` are allowed.
    whole : bool
        If True, only whole numbers up to `LARGEST_WHOLE` in magnitude are allowed, such as an exponent. In a friction law such a
        number is written into the formula and is not a parameter of it.
    """

    unit: str
    meaning: str
    above: float | None = None
    at_least: float | None = None
    infinite: bool = False
    whole: bool = False

    def check(self, owner: str, name: str, value: Any) -> float:
        """Return the value as a float. Raise InputError, which names owner and field, if it is not allowed."""
        where = f"{owner}: {name}"
        if isinstance(value, bool) or not isinstance(value, numbers.Real):
            raise InputError(f"{where} must be a number in {self.label}, got {value!r}")
        number = as_float(value)
        for broken, rule in self._rules(number):
            if broken:
                raise InputError(f"{where} must {rule}, got {number:g}")
        return number

    def allows(self, values: NDArray[np.float64]) -> NDArray[np.bool_]:
        """Return True for each of the numbers (SI) that `check` accepts, with the shape of `values`."""
        fine = np.ones(np.shape(values), bool)
        for broken, _ in self._rules(values):
            fine &= ~broken
        return fine

    def _rules(self, number: Any) -> Iterator[tuple[Any, str]]:
        """Yield for each rule where a number, or each number of an array, breaks it, and what the rule demands."""
        yield (number != number) | ((abs(number) == math.inf) & (not self.infinite)), "be finite"
        if self.whole:
            yield (number != np.rint(number)) | (abs(number) > LARGEST_WHOLE), f"be a whole number up to {LARGEST_WHOLE}"
        if self.above is not None:
            yield number <= self.above, f"be greater than {self.above:g} {self.label}"
        if self.at_least is not None:
            yield number < self.at_least, f"be at least {self.at_least:g} {self.label}"
        if not self.infinite:
            yield abs(number) > LARGEST, f"lie within {LARGEST:g} {self.label}"
        if self.above is not None:
            yield number < self.above + SMALLEST, f"be at least {self.above + SMALLEST:g} {self.label}"

    @property
    def label(self) -> str:
        """The unit as it is shown to people: "(a pure number)" in place of "1"."""
        return "(a pure number)" if self.unit == "1" else self.unit


def as_float(value: Any) -> float:
    """Return a number as a float; an integer that is too large for a float becomes infinite, with its sign."""
    try:
        return float(value)
    except OverflowError:
        return math.inf if value > 0 else -math.inf


@dataclass(frozen=True)
class Series:
    """Declare a list of numbers of one kind, optionally in ascending order."""

    item: Quantity
    ascending: bool = False
    least: int = 2
    """Smallest number of entries: two points by default, which a line needs."""

    @property
    def meaning(self) -> str:
        """The meaning of the numbers."""
        return self.item.meaning

    def check(self, owner: str, name: str, value: Any) -> tuple[float, ...]:
        """Return the numbers as a tuple of floats. Raise InputError that names owner, field and index."""
        if isinstance(value, str | Mapping) or not isinstance(value, Iterable) or np.ndim(np.asarray(value, object)) != 1:
            raise InputError(f"{owner}: {name} must be a list of numbers in {self.item.label}, got {type(value).__name__}")
        found = tuple(self.item.check(owner, f"{name}[{i}]", one) for i, one in enumerate(value))
        if not self.least <= len(found) <= LARGEST_SERIES:
            raise InputError(f"{owner}: {name} must have {self.least} to {LARGEST_SERIES} numbers, got {len(found)}")
        if self.ascending:
            for i, (one, following) in enumerate(pairwise(found)):
                if not one < following:
                    raise InputError(f"{owner}: {name} must ascend, but [{i + 1}] = {following:g} follows {one:g}")
        return found


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


class Named(NamedTuple):
    """A number with a name and, if one was given, its unit in powers of m, kg and s, such as "m s^-1"."""

    name: str
    value: float
    unit: str = ""

    @classmethod
    def read(cls, name: str, value: Any, where: str) -> Named:
        """Make one from a number or a text with a unit. Raise InputError, with a message that begins with `where`."""
        if not isinstance(value, str):
            return cls(name, value)
        try:
            return cls(name, *si_base(value))
        except InputError as error:
            raise InputError(f"{where} parameters {ascii(name)[:60]} must be a number or a text with a unit: {error}") from None


@dataclass(frozen=True)
class NamedNumbers:
    """Declare numbers whose names users choose; `key` is the name of their table in scenario files."""

    meaning: str
    key: str

    def check(self, owner: str, name: str, value: Any) -> tuple[Named, ...]:
        """Return the numbers from a mapping of names to values or texts with units, or from tuples of name, value and unit."""
        if not isinstance(value, Mapping | tuple | list | None):
            raise InputError(f"{owner}: {self.key} must be a mapping of names to values, got {type(value).__name__}")
        if isinstance(value, Mapping):
            named = [Named.read(key, one, f"{owner}:") for key, one in value.items()]
        else:
            named = [Named(*one) for one in value or ()]
        return tuple(Named(n, Quantity("1", "").check(owner, f"{self.key} {ascii(n)[:60]}", x), unit) for n, x, unit in named)


Field = Quantity | Series | Part | Text | Choice | NamedNumbers
"""Every kind of declaration."""


def declare(declared: Field, default: Any = dataclasses.MISSING) -> Any:
    """Return a dataclass field with the given declaration and default."""
    return dataclasses.field(default=default, metadata={"declared": declared})


def quantity(
    unit: str,
    meaning: str,
    *,
    above: float | None = None,
    at_least: float | None = None,
    infinite: bool = False,
    whole: bool = False,
    default: Any = dataclasses.MISSING,
) -> Any:
    """Return a dataclass field that holds a physical quantity in SI units; the arguments but `default` are those of `Quantity`.

    With None as `default` the field is optional.
    """
    return declare(Quantity(unit, meaning, above=above, at_least=at_least, infinite=infinite, whole=whole), default)


def fields_of(kind: type) -> dict[str, tuple[Field, Any]]:
    """Return the declaration and the default of each declared field of a class, by name.

    Fields without a default (MISSING) come first and choices come last.
    """
    found = [(f.name, f.metadata["declared"], f.default) for f in dataclasses.fields(kind) if "declared" in f.metadata]
    found.sort(key=lambda one: (one[2] is not dataclasses.MISSING, isinstance(one[1], Choice)))
    return {name: (declared, default) for name, declared, default in found}


def quantities_of(kind: type) -> dict[str, Quantity]:
    """Return the declared quantities of a class by field name, in the order of its fields."""
    found = {f.name: f.metadata.get("declared") for f in dataclasses.fields(kind)}
    return {name: declared for name, declared in found.items() if isinstance(declared, Quantity)}


def check_fields(owner: Any, but: Collection[str] = ()) -> None:
    """Check the declared fields of a frozen dataclass, except those in `but`, and store the converted values.

    A field that is None is left as it is if None is its default. Raise InputError for a value that is not allowed.
    """
    for name, (declared, default) in fields_of(type(owner)).items():
        value = getattr(owner, name)
        if name not in but and (value is not None or default is not None):
            object.__setattr__(owner, name, declared.check(type(owner).__name__, name, value))


def document_fields(kind: type, source: str = "") -> None:
    """Append the declared fields, as the section Parameters, and the source to the docstring of a class that is being defined.

    Call it in `__init_subclass__`, where the fields of the class itself are still plain attributes. A class without a docstring, or
    with a section Parameters of its own, is left as it is.
    """
    text = kind.__doc__
    if not text or "Parameters\n" in text:
        return
    declared: dict[str, dataclasses.Field[Any]] = {}
    for base in reversed(kind.__mro__[1:]):
        declared |= {name: field for name, field in getattr(base, "__dataclass_fields__", {}).items() if field.metadata}
    declared |= {name: value for name, value in vars(kind).items() if isinstance(value, dataclasses.Field)}
    sections = [text.rstrip()]
    lines = [f"    {name}\n        {_described(one.metadata['declared'])}" for name, one in declared.items() if one.metadata]
    if lines:
        sections.append("    Parameters\n    ----------\n" + "\n".join(lines))
    if source:
        sections.append(f"    Notes\n    -----\n    Source: {source}.")
    kind.__doc__ = "\n\n".join(sections) + "\n    "


def _described(declared: Field) -> str:
    """Return meaning, unit and bounds of a field as a sentence."""
    item = declared.item if isinstance(declared, Series) else declared
    parts = [declared.meaning]
    if isinstance(item, Quantity):
        parts.append("no unit" if item.unit == "1" else f"in {item.unit}")
        parts += [f"greater than {item.above:g}"] if item.above is not None else []
        parts += [f"at least {item.at_least:g}"] if item.at_least is not None else []
    if isinstance(declared, Series):
        parts += [f"{declared.least} or more numbers"] + ["ascending"] * declared.ascending
    if isinstance(declared, Choice):
        parts.append(" or ".join(f'"{word}"' for word in declared.allowed))
    text = ", ".join(parts)
    return f"{text[:1].upper()}{text[1:]}."
