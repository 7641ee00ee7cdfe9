"""The values of one parameter of a sweep, from an array or a list, or the two ends between which samples are drawn.

On the command line an axis is a text such as "thickness=1km..50km:300:log" or "friction.alpha=0.1,0.5,2".
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from stickslip.foundation.arguments import shown
from stickslip.foundation.axis import TypedRange, check_ends, range_meant, spaced
from stickslip.foundation.conversion import has_unit, without_unit
from stickslip.foundation.errors import InputError
from stickslip.foundation.given import Given
from stickslip.foundation.quantities import Choice, Quantity
from stickslip.problem.scenarios import ParameterPath, Scenario, find_parameter

Values = NDArray[Any]
"""Numbers in SI (float64), or words (strings)."""
LARGEST_AXIS = 10_000_000
"""Largest number of values of an axis, and of members of a random design: 80 MB for each parameter."""
LONG_COUNT = 10**15
"""From this number of values on, it is shown with three digits."""
EQUAL = 1e-9
"""Ratios of successive values that differ by less than this (relative) count as equal."""
FORM = '"KEY=LOW..HIGH:POINTS", followed by ":log" for equal ratios, or "KEY=VALUE,VALUE,..."'


@dataclass(frozen=True, eq=False)
class DesignAxis:
    """A parameter with its `values`, or with the `ends` (SI) between which samples are drawn.

    If `log` is True, samples are distributed evenly in the logarithm, and figures have a logarithmic axis.
    """

    parameter: ParameterPath
    values: Values
    ends: tuple[float, float] | None = None
    log: bool = False

    @classmethod
    def of_values(cls, parameter: ParameterPath, values: Any, where: str) -> DesignAxis:
        """Return the axis of an array, a list or a pint quantity array; it is logarithmic if the values are in equal ratios.

        Raises InputError, whose message begins with `where`.
        """
        if isinstance(values, str | Mapping) or not isinstance(values, Iterable) or getattr(values, "ndim", 1) != 1:
            hint = ": use a list or numpy.linspace" if isinstance(values, str) else ""
            got = " ".join(shown(values.tolist() if isinstance(values, np.ndarray) else values).split())
            raise InputError(f"{where}: {parameter.name} must be a one-dimensional array or a list of values, got {got}{hint}")
        found = read_values(parameter, values, where)
        return cls(in_unit_of(parameter, values, where), found, log=_in_equal_ratios(found))

    @classmethod
    def of_range(cls, parameter: ParameterPath, ends: Sequence[Any], log: bool, where: str) -> DesignAxis:
        """Return the axis of samples between two ends. Raises InputError unless they are numbers in ascending order."""
        if isinstance(parameter.declared, Choice):
            words = ", ".join(parameter.declared.allowed)
            raise InputError(f"{where}: {parameter.name} takes words, not a range: list some of {words}")
        parameter = in_unit_of(parameter, ends, where)
        low, high = (float(parameter.read(_without_unit(parameter, end, where), where)) for end in ends)
        check_ends(f"{where}: {parameter.name}", low, high, log=log, unit=parameter.unit)
        return cls(parameter, np.empty(0), (low, high), log)

    def at(self, shares: NDArray[np.float64]) -> Values:
        """Return the values at the given fractions (0 to 1) of the way from one end to the other, or through the list of values."""
        if self.ends is None:
            return self.values[np.minimum((shares * len(self.values)).astype(np.intp), len(self.values) - 1)]
        low, high = self.ends
        if self.log:
            return np.asarray(low * np.exp(shares * np.log(high / low)))
        return np.asarray(low + shares * (high - low))


def in_unit_of(parameter: ParameterPath, values: Any, where: str) -> ParameterPath:
    """Return a parameter that is shown in the unit of the first of its values, if results are shown in it."""
    listed = values if isinstance(values, list | tuple) else ()
    first = next((one for one in listed if isinstance(one, str) or has_unit(one)), None)
    given = None if first is None or not parameter.unit else parameter.read(first, where)
    return replace(parameter, shown_in=given.unit) if isinstance(given, Given) else parameter


def read_values(parameter: ParameterPath, values: Iterable[Any], where: str, most: float = LARGEST_AXIS) -> Values:
    """Return values in SI. Raises InputError for the first that the parameter cannot have, for none, and for more than `most`."""
    values = _without_unit(parameter, values, where)
    # no subclass of the array: those of other libraries may carry a unit
    if type(values) is np.ndarray and values.dtype.kind in "iuf" and values.size and _takes_an_interval(parameter):
        for extreme in (values.min(), values.max()):  # both are NaN if any of the values is
            parameter.read(extreme, where)
        read = values.astype(float)
    else:
        plain = [parameter.read(_without_unit(parameter, value, where), where) for value in values]
        read = np.array(plain, dtype=float if parameter.unit else np.dtypes.StringDType())
    if not len(read):
        raise InputError(f"{where}: {parameter.name} needs at least one value")
    check_size(parameter, len(read), where, most)
    return read


def _takes_an_interval(parameter: ParameterPath) -> bool:
    """Return True if a parameter can have all numbers between any two that it can have."""
    return isinstance(parameter.declared, Quantity) and not parameter.declared.whole


def check_size(parameter: ParameterPath, size: int, where: str, most: float = LARGEST_AXIS) -> None:
    """Raise InputError for more values than `most`."""
    if size > most:
        count = size if size < LONG_COUNT else f"{size:.3g}"
        raise InputError(f"{where}: {parameter.name} has {count} values, at most {most} are allowed")


def _without_unit(parameter: ParameterPath, value: Any, where: str) -> Any:
    """Return the magnitude in SI of a number or an array with a unit of pint; anything else as it is. Raises InputError."""
    if not has_unit(value):
        return value
    if not parameter.unit:
        raise InputError(f"{where}: {parameter.name} takes words, got a quantity in {value.units:D}")
    try:
        return without_unit(value, parameter.unit)
    except InputError as error:
        raise InputError(f"{where}: {parameter.name}: {error}") from None


def _in_equal_ratios(values: Values) -> bool:
    """Return True for three or more positive numbers in equal ratios, as from numpy.geomspace."""
    if values.dtype.kind != "f" or len(values) < 3 or values.min() <= 0.0 or np.isinf(values).any():
        return False
    ratios = values[1:] / values[:-1]
    return bool((np.abs(ratios - ratios[0]) <= EQUAL * ratios[0]).all() and abs(ratios[0] - 1.0) > EQUAL)


# ---- axes that are typed ----------------------------------------------------------------------------------------------------


def typed_axes(scenario: Scenario, texts: Iterable[str], where: str) -> list[DesignAxis]:
    """Return the axes that were typed, each in the FORM. Raises InputError, whose message begins with `where`."""
    return [_typed_axis(scenario, text, where) for text in texts]


def typed_value(parameter: ParameterPath, text: Any) -> Any:
    """Return a number that was typed as text as a number, and words, texts with a unit and anything else as they are."""
    try:
        return float(text) if isinstance(text, str) and parameter.unit else text
    except ValueError:
        return text


def _typed_axis(scenario: Scenario, text: str, where: str) -> DesignAxis:
    name, equals, content = (part.strip() for part in text.partition("="))
    if not equals or not name or not content:
        raise InputError(f"{where} must be {FORM}, got {shown(text)}")
    parameter = find_parameter(scenario, name, where)
    found = TypedRange.of(content, f"{where}: {parameter.name}")
    values = [typed_value(parameter, one) for one in (found[:2] if found else content.split(","))]
    if found is None:
        try:
            return DesignAxis(in_unit_of(parameter, values, where), read_values(parameter, values, where))
        except InputError as error:
            meant = range_meant(content)
            raise InputError(f"{where}: {parameter.name}: {meant}, got {shown(content)}" if meant else str(error)) from None
    axis = DesignAxis.of_range(parameter, values, found.log, where)
    return axis if found.points is None else _with_points(axis, found.points, where)


def _with_points(axis: DesignAxis, points: int, where: str) -> DesignAxis:
    """Return an axis with evenly spaced values, both ends included. Raises InputError for fewer than two, or too many."""
    check_size(axis.parameter, points, where)
    if points < 2:
        raise InputError(f"{where}: {axis.parameter.name} needs at least 2 points, got {points}")
    assert axis.ends
    return replace(axis, values=spaced(*axis.ends, points, log=axis.log))
