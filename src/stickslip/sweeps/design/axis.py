"""The values of one parameter of a sweep: "body.thickness=1km..50km:300:log", "friction.alpha=0.1,0.5,2", or a list of values."""

from __future__ import annotations

import re
from collections.abc import Iterable
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from stickslip.foundation.errors import InputError
from stickslip.foundation.quantities import Choice
from stickslip.scenarios.scenario import Scenario
from stickslip.scenarios.values import show
from stickslip.sweeps.design.parameter_paths import Key, key_named

Values = NDArray[Any]
"""Numbers in SI (float64), or words (strings)."""
LARGEST_AXIS = 10_000_000
"""Largest number of values of an axis, and of members of a random design: 80 MB for each key."""
FORM = '"KEY=LOW..HIGH:POINTS", followed by ":log" for equal ratios, or "KEY=VALUE,VALUE,..."'

_RANGE = re.compile(r"(?P<low>.+?)\.\.(?P<high>[^:]+)(?::(?P<points>\d{1,9}))?(?P<log>:log)?")


@dataclass(frozen=True, eq=False)
class Axis:
    """A parameter (`key`) with its `values`, or with the `ends` (SI) between which samples are drawn.

    Samples are distributed evenly between the ends, or evenly in the logarithm if `log` is True.
    """

    key: Key
    values: Values
    ends: tuple[float, float] | None = None
    log: bool = False

    def at(self, shares: NDArray[np.float64]) -> Values:
        """Return the values at the given fractions (0 to 1) of the way from one end to the other, or through the list of values."""
        if self.ends is None:
            return self.values[np.minimum((shares * len(self.values)).astype(np.intp), len(self.values) - 1)]
        low, high = self.ends
        if self.log:
            return np.asarray(low * np.exp(shares * np.log(high / low)))
        return np.asarray(low + shares * (high - low))


def read_axis(scenario: Scenario, text: str, where: str) -> Axis:
    """Read an axis that was typed as "KEY=...". Raises InputError, whose message begins with `where`."""
    name, equals, content = text.partition("=")
    if not equals or not name.strip() or not content.strip():
        raise InputError(f"{where} must be {FORM}, got {show(text)}")
    return axis_of(scenario, name.strip(), content.strip(), where)


def axis_of(scenario: Scenario, name: str, content: Any, where: str) -> Axis:
    """Return the axis of a key from the text after the "=" of FORM, or from values (numbers in SI or texts with a unit).

    Raises InputError.
    """
    key = key_named(scenario, name, where)
    if isinstance(content, str):
        found = _RANGE.fullmatch(content)
        return _range(key, found, where) if found else _listed(key, content.split(","), where)
    if not isinstance(content, Iterable):
        raise InputError(f"{where}: {key.name} must be a text or a list of values, got {show(content)}")
    return _listed(key, content, where)


def read_values(key: Key, values: Iterable[Any], where: str) -> Values:
    """Return the values of a key in SI. Raises InputError for the first value that cannot be read."""
    read = [key.read(value, where) for value in values]
    return np.array(read, dtype=float if key.unit else np.dtypes.StringDType())


def _listed(key: Key, values: Iterable[Any], where: str) -> Axis:
    found = read_values(key, values, where)
    if found.size == 0:
        raise InputError(f"{where}: {key.name} needs at least one value")
    _check_size(key, found.size, where)
    return Axis(key, found)


def _range(key: Key, found: re.Match[str], where: str) -> Axis:
    if isinstance(key.declared, Choice):
        raise InputError(f"{where}: {key.name} takes words, not a range: list some of {', '.join(key.declared.allowed)}")
    low, high = (float(key.read(found[end], where)) for end in ("low", "high"))
    log = bool(found["log"])
    if not np.isfinite([low, high]).all() or not low < high:
        raise InputError(f"{where}: {key.name} must go from a smaller to a larger number, got {low:g} to {high:g} {key.unit}")
    if log and low <= 0.0:
        raise InputError(f"{where}: {key.name} must be above 0 for :log, got {low:g} {key.unit}")
    if found["points"] is None:
        return Axis(key, np.empty(0), (low, high), log)
    points = int(found["points"])
    _check_size(key, points, where)
    if points < 2:
        raise InputError(f"{where}: {key.name} needs at least 2 points, got {points}")
    spaced = np.geomspace if log else np.linspace
    return Axis(key, np.asarray(spaced(low, high, points)), (low, high), log)


def _check_size(key: Key, size: int, where: str) -> None:
    if size > LARGEST_AXIS:
        raise InputError(f"{where}: {key.name} has {size} values, at most {LARGEST_AXIS} are allowed")
