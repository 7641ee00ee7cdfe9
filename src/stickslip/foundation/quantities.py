"""Declare the fields of bodies, laws and loading histories: unit, meaning and allowed values of each, once, with the field.

The owners check their values against these declarations (`check_fields`); scenario files, `stickslip new`, the Parameters section
of a docstring (`foundation.show`) and the documentation are made from them.
"""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Collection, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import cache, cached_property, lru_cache
from types import MappingProxyType
from typing import Any, NamedTuple, TypeVar

import numpy as np
from numpy.typing import NDArray

from stickslip.foundation.arguments import check_whole, shown
from stickslip.foundation.conversion import as_text, has_unit, remembered, to_number, unit_among
from stickslip.foundation.errors import InputError, nearest
from stickslip.foundation.given import Given
from stickslip.foundation.names import TURNS, own_units
from stickslip.foundation.units import si_base

LARGEST_WHOLE = 16
"""Largest magnitude of a whole-numbered quantity; such quantities are exponents."""
LARGEST, SMALLEST = 1e50, 1e-50
"""Largest magnitude of a quantity, and its smallest distance from an exclusive lower bound (both in SI units).

Within these limits products of several quantities neither overflow nor underflow.
"""
LARGEST_SERIES = 10_000
"""A series has at most this many points, unless it says otherwise; a scenario writes so many as a list, and more of them packed."""
MOST_SAMPLES = 1_000_000
"""A loading history has at most this many points: each takes 32 bytes as a number, and 24 as a part of the history."""


@dataclass(frozen=True)
class Quantity:
    """Unit (SI; "1" for a pure number), meaning and allowed range of a number.

    `above` and `at_least` are exclusive and inclusive lower bounds, `at_most` is an upper bound, in `unit`. If `infinite`, infinite
    values and magnitudes above `LARGEST` are allowed, and `word` may be given for infinity besides "inf". If `whole`, only whole
    numbers up to `LARGEST_WHOLE` in magnitude are allowed, such as an exponent. In a friction law such a number is written into the
    formula and is not a parameter of it.
    """

    unit: str
    meaning: str
    above: float | None = None
    at_least: float | None = None
    infinite: bool = False
    word: str = "inf"
    whole: bool = False
    at_most: float | None = None

    def check(self, owner: str, name: str, value: Any) -> float:
        """Return the value in SI as a float. Raise InputError, which names owner and field, if it is not allowed.

        A value is a number in SI, a text with a unit, or a quantity of pint; of the last two the first unit of "Pa or N" to which
        it converts counts. Whole numbers, fractions, decimals, and numbers and arrays without dimensions of numpy are numbers.
        """
        where = f"{owner}: {name}"
        try:
            known = type(value) is float or type(value) is Given
            number = value if known else to_number(value, self.unit, ("inf", self.word) if self.infinite else ())
        except InputError as error:
            raise InputError(f"{where} must be {self.allowed}, got {error}{_without_percent(value)}") from None
        low, high = self._plain
        if low <= number <= high:
            return number if known else remembered(value, number, self.unit)
        for broken, rule in self._rules(number):
            if broken:
                origin = f" (from {shown(value)})" if isinstance(value, str) else ""
                raise InputError(f"{where} must {rule}, got {number:g}{origin}")
        return number

    def allows(self, values: NDArray[np.float64]) -> NDArray[np.bool_]:
        """Return True for each of the numbers (SI) that `check` accepts, with the shape of `values`."""
        fine = np.ones(np.shape(values), bool)
        for broken, _ in self._rules(values):
            fine &= ~broken
        return fine

    @cached_property
    def _plain(self) -> tuple[float, float]:
        """An interval of numbers that break no rule, for a quick answer; it is empty for whole numbers."""
        if self.whole:
            return 1.0, 0.0
        beyond = -math.inf if self.above is None else max(self.above + SMALLEST, math.nextafter(self.above, math.inf))
        most = self.at_most if self.at_most is not None else math.inf if self.infinite else LARGEST
        return max(beyond, -most if self.at_least is None else self.at_least, -most), most

    def _rules(self, number: Any) -> Iterator[tuple[Any, str]]:
        """Yield for each rule where a number, or each number of an array, breaks it, and what the rule demands."""
        yield (number != number) | ((abs(number) == math.inf) & (not self.infinite)), "be finite"
        if self.whole:
            yield (number != np.rint(number)) | (abs(number) > LARGEST_WHOLE), f"be a whole number up to {LARGEST_WHOLE}"
        if self.above is not None:
            yield number <= self.above, f"be greater than {self.above:g} {self.label}"
        if self.at_least is not None:
            yield number < self.at_least, f"be at least {self.at_least:g} {self.label}"
        if self.at_most is not None:
            yield number > self.at_most, f"be at most {self.at_most:g} {self.label}"
        if not self.infinite:
            yield abs(number) > LARGEST, f"lie within {LARGEST:g} {self.label}"
        if self.above is not None:
            yield number < self.above + SMALLEST, f"be at least {self.above + SMALLEST:g} {self.label}"

    @property
    def label(self) -> str:
        """The unit as it is shown to people: "(a pure number)" in place of "1"."""
        return "(a pure number)" if self.unit == "1" else self.unit

    @property
    def allowed(self) -> str:
        """The values that may be given, in words."""
        first, several, _ = self.unit.partition(" or ")
        example = f'a number in {self.unit}{"," * bool(several)} or a text with a unit such as "10 {first.removeprefix("1")}"'
        return ("a number" if self.unit == "1" else example) + (f' (or "{self.word}")' if self.infinite else "")

    @property
    def described(self) -> str:
        """Meaning, unit and bounds, in words."""
        parts = [self.meaning, "no unit" if self.unit == "1" else f"in {self.unit}"]
        parts += [] if self.above is None else [f"above {self.above:g}"]
        parts += [] if self.at_least is None else [f"at least {self.at_least:g}"]
        parts += [] if self.at_most is None else [f"at most {self.at_most:g}"]
        return ", ".join(parts)


@dataclass(frozen=True)
class NumberSeries:
    """Declare a list of numbers of one kind, optionally in ascending order.

    `least` is the smallest number of entries (two points by default, which a line needs), and `most` the largest. `sampled` numbers
    are those of a recorder: none of them has a name of its own, and a scenario keeps them packed.
    """

    item: Quantity
    ascending: bool = False
    least: int = 2
    most: int = LARGEST_SERIES
    sampled: bool = False

    @property
    def meaning(self) -> str:
        """The meaning of the numbers."""
        return self.item.meaning

    def lists(self, values: Sequence[float]) -> bool:
        """Return True for numbers that people write, name and change one by one."""
        return not self.sampled and len(values) <= LARGEST_SERIES

    def check(self, owner: str, name: str, value: Any) -> tuple[float, ...]:
        """Return the numbers in SI as a tuple of floats. Raise InputError that names owner, field and index.

        The value is a list, or an array, of what `Quantity.check` takes, or an array of numpy with a unit of pint.
        """
        if has_unit(value) and np.ndim(value.magnitude) == 1:
            value = list(value)
        found = self.at_once(value)
        if found is None:
            if isinstance(value, str | Mapping) or has_unit(value) or not isinstance(value, Iterable) or any(map(_is_list, value)):
                raise InputError(f"{owner}: {name} must be a list of numbers in {self.item.label}, got {type(value).__name__}")
            found = tuple(self.item.check(owner, f"{name}[{i}]", one) for i, one in enumerate(value))
        if not self.least <= len(found) <= self.most:
            raise InputError(f"{owner}: {name} must have {self.least} to {self.most} numbers, got {len(found)}")
        numbers = value if _is_plain(value) else found
        falls = np.flatnonzero(np.diff(np.asarray(numbers, float)) <= 0.0) if self.ascending else ()
        for i in falls[:1]:
            one, following = found[i], found[i + 1]
            cure = "sort the points" if following < one else "keep one point of each, or their mean"
            raise InputError(f"{owner}: {name} must ascend, but [{i + 1}] = {following:g} follows {one:g}; {cure}")
        return found

    def at_once(self, value: Any) -> tuple[float, ...] | None:
        """Return floats, or an array of plain numbers, if all of them are allowed; else None: look at them one by one."""
        if _is_plain(value):
            array = value.astype(float)
            found = tuple(array.tolist()) if self.item.allows(array).all() else None
        elif type(value) in (list, tuple) and set(map(type, value)) <= {float, Given}:
            found = tuple(value) if self.item.allows(np.array(value, float)).all() else None
        else:
            found = None
        return found


def _without_percent(value: Any) -> str:
    """Return what to write in place of a text such as "80%", or nothing."""
    try:
        return f"; write {float(value[:-1]) / 100.0:g}" if isinstance(value, str) and value.endswith("%") else ""
    except ValueError:
        return ""


def _is_plain(value: Any) -> bool:
    """Return True for a row of numbers of numpy, without units."""
    return type(value) is np.ndarray and value.ndim == 1 and value.dtype.kind in "fiu"


def _is_list(value: Any) -> bool:
    return isinstance(value, list | tuple) or (isinstance(value, np.ndarray) and value.ndim > 0)


@dataclass(frozen=True)
class LawField:
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
class Count:
    """Declare a whole number from 1 to below a bound; `key` is its name in scenario files, if that differs from the field's."""

    meaning: str
    below: int
    key: str = ""

    def check(self, owner: str, name: str, value: Any) -> int:
        """Return the number as an int. Raise InputError, which names owner and field, if it is not allowed."""
        found = check_whole(f"{owner}: {name}", value)
        if found >= self.below:
            raise InputError(f"{owner}: {name} must be below {self.below:g}, got {shown(value)}")
        return found


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
        """Make one from a number, a text with a unit or a quantity of pint. Raise InputError that begins with `where`."""
        if not isinstance(value, str) and not has_unit(value):
            return cls(name, value)
        try:
            return cls(name, *si_base(value if isinstance(value, str) else as_text(value)))
        except InputError as error:
            cure = ": write a number without quotes" if _is_number_text(value) else ""
            raise InputError(
                f"{where} parameters {ascii(name)[:60]} must be a number or a text with a unit: {error}{cure}"
            ) from None


def _is_number_text(value: Any) -> bool:
    """Return True for a text that is a number without a unit, such as "0.7"."""
    try:
        return isinstance(value, str) and math.isfinite(float(value))
    except ValueError:
        return False


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


Field = Quantity | NumberSeries | LawField | Text | Count | Choice | NamedNumbers
"""Every kind of declaration."""
_Declared = TypeVar("_Declared", bound=Field)


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
    word: str = "inf",
    whole: bool = False,
    default: Any = dataclasses.MISSING,
) -> Any:
    """Return a dataclass field that holds a physical quantity in SI units; the arguments but `default` are those of `Quantity`.

    With None as `default` the field is optional.
    """
    return declare(Quantity(unit, meaning, above=above, at_least=at_least, infinite=infinite, word=word, whole=whole), default)


def fields_of(kind: type) -> Mapping[str, tuple[Field, Any]]:
    """Return the declaration and the default of each declared field of a class, by name.

    Fields without a default (MISSING) come first and choices come last.
    """
    return _fields_of(kind)


@cache
def _fields_of(kind: type) -> dict[str, tuple[Field, Any]]:
    found = [(f.name, f.metadata["declared"], f.default) for f in dataclasses.fields(kind) if "declared" in f.metadata]
    found.sort(key=lambda one: (one[2] is not dataclasses.MISSING, isinstance(one[1], Choice)))
    return {name: (declared, default) for name, declared, default in found}


def quantities_of(kind: type) -> Mapping[str, Quantity]:
    """Return the declared quantities of a class by field name, in the order of its fields."""
    return _quantities_of(kind)


@cache
def _quantities_of(kind: type) -> dict[str, Quantity]:
    found = {f.name: f.metadata.get("declared") for f in dataclasses.fields(kind)}
    return {name: declared for name, declared in found.items() if isinstance(declared, Quantity)}


def check_fields(owner: Any, but: Collection[str] = (), units: Mapping[str, str] = MappingProxyType({})) -> None:
    """Check the declared fields of a frozen dataclass, except those in `but`, and store the converted values.

    `units` replaces declared units such as "Pa or N" by the one that applies here. A field that is None is left as it is if None
    is its default. Raise InputError for a value that is not allowed.
    """
    for name, (declared, default) in fields_of(type(owner)).items():
        value = getattr(owner, name)
        if name not in but and (value is not None or default is not None):
            object.__setattr__(owner, name, in_units(declared, units).check(type(owner).__name__, name, value))


def given_in(owner: Any) -> str:
    """Return "rad" if a field that is declared in m, m/s, s/m or 1/m was given with an angle in its unit, "m" if as declared.

    Returns "" if no such field was given with a unit.
    """
    found = ""
    for name, (declared, _) in fields_of(type(owner)).items():
        item, value = declared.item if isinstance(declared, NumberSeries) else declared, getattr(owner, name)
        if not (isinstance(item, Quantity) and "rad" in (turned := own_units(TURNS).get(item.unit, ""))):
            continue
        for one in value if isinstance(value, list | tuple) else (value,):
            if isinstance(one, str) or has_unit(one):
                unit = unit_among(one, f"{item.unit} or {turned}")
                found = "rad" if unit == turned else found or ("m" if unit else "")
    return found


def in_units(declared: _Declared, units: Mapping[str, str]) -> _Declared:
    """Return a declaration with its unit, or that of its items, replaced as `units` says."""
    if isinstance(declared, NumberSeries) and declared.item.unit in units:
        return dataclasses.replace(declared, item=_in_unit(declared.item, units[declared.item.unit]))
    if isinstance(declared, Quantity) and declared.unit in units:
        return _in_unit(declared, units[declared.unit])  # type: ignore[return-value] # of the same class
    return declared


@lru_cache(maxsize=1024)
def _in_unit(declared: Quantity, unit: str) -> Quantity:
    return dataclasses.replace(declared, unit=unit)
