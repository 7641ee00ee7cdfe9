"""Intervals with first derivatives, on arrays: where a formula and its slopes lie over whole stretches of slip and slip rate.

Shares no code with the package, whose answers are compared with what is found by it (`benchmarks.composed_truth`).
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]
ROUNDING = 1e-15
"""Each result is widened by this share of its ends."""


@dataclass(frozen=True)
class Interval:
    """The numbers from `low` to `high`; anything may be in it if an end is not a number."""

    low: Floats
    high: Floats

    @classmethod
    def hull(cls, *ends: Floats) -> Interval:
        """The smallest interval with all of these ends, widened by their rounding."""
        low, high = np.minimum.reduce(ends), np.maximum.reduce(ends)
        known = ~(np.isnan(low) | np.isnan(high))
        low = np.where(known, low - ROUNDING * np.abs(low), -np.inf)
        return cls(low, np.where(known, high + ROUNDING * np.abs(high), np.inf))

    def __add__(self, other: Interval) -> Interval:
        return Interval.hull(self.low + other.low, self.high + other.high)

    def __sub__(self, other: Interval) -> Interval:
        return Interval.hull(self.low - other.high, self.high - other.low)

    def __mul__(self, other: Interval) -> Interval:
        ends = [_product(a, b) for a in (self.low, self.high) for b in (other.low, other.high)]
        return Interval.hull(*ends)

    def inverse(self) -> Interval:
        """1 over the interval: everything where it contains zero."""
        clear = (self.low > 0.0) | (self.high < 0.0)
        return Interval.hull(np.where(clear, 1.0 / self.low, np.nan), np.where(clear, 1.0 / self.high, np.nan))

    def __pow__(self, power: float) -> Interval:
        a, b = self.low**power, self.high**power
        if float(power).is_integer() and power > 0:
            zero = np.where((self.low < 0.0) & (self.high > 0.0), 0.0, a)
            return Interval.hull(a, b, zero) if power % 2 == 0 else Interval.hull(a, b)
        clear = self.low > 0.0
        return Interval.hull(np.where(clear, a, np.nan), np.where(clear, b, np.nan))

    def rising(self, function: Callable[[Floats], Floats]) -> Interval:
        """A function that rises everywhere."""
        return Interval.hull(function(self.low), function(self.high))

    def cos(self) -> Interval:
        """The cosine: its extremes are at whole multiples of pi."""
        first = np.ceil(self.low / np.pi)
        many, one = first + 1.0 <= self.high / np.pi, first <= self.high / np.pi
        ends = Interval.hull(np.cos(self.low), np.cos(self.high))
        top = np.where(first % 2 == 0, 1.0, -1.0)
        low = np.where(many, -1.0, np.where(one, np.minimum(ends.low, top), ends.low))
        high = np.where(many, 1.0, np.where(one, np.maximum(ends.high, top), ends.high))
        return Interval.hull(np.where(np.isfinite(self.low - self.high), low, -1.0), np.where(np.isfinite(self.high), high, 1.0))

    def meet(self, other: Interval) -> Interval:
        """What is in both."""
        return Interval(np.maximum(self.low, other.low), np.minimum(self.high, other.high))


def _product(a: Floats, b: Floats) -> Floats:
    """A product in which zero times infinity is zero."""
    return np.where((a == 0.0) | (b == 0.0), 0.0, a * b)


def number(value: float) -> Interval:
    """One number."""
    return Interval(np.asarray(float(value)), np.asarray(float(value)))


ZERO, ONE = number(0.0), number(1.0)


@dataclass(frozen=True)
class Slopes:
    """A value and its derivatives by slip and slip rate, each as an interval."""

    value: Interval
    by: tuple[Interval, Interval] = (ZERO, ZERO)

    @staticmethod
    def of(other: Any) -> Slopes:
        """A number as a constant."""
        return other if isinstance(other, Slopes) else Slopes(number(other))

    def chain(self, value: Interval, slope: Interval) -> Slopes:
        """A function of this one, with its slope here."""
        return Slopes(value, (self.by[0] * slope, self.by[1] * slope))

    def __add__(self, other: Any) -> Slopes:
        o = Slopes.of(other)
        return Slopes(self.value + o.value, (self.by[0] + o.by[0], self.by[1] + o.by[1]))

    def __sub__(self, other: Any) -> Slopes:
        o = Slopes.of(other)
        return Slopes(self.value - o.value, (self.by[0] - o.by[0], self.by[1] - o.by[1]))

    def __mul__(self, other: Any) -> Slopes:
        o = Slopes.of(other)
        by = tuple(a * o.value + self.value * b for a, b in zip(self.by, o.by, strict=True))
        return Slopes(self.value * o.value, (by[0], by[1]))

    def __truediv__(self, other: Any) -> Slopes:
        o = Slopes.of(other)
        inverse = o.value.inverse()
        return self * o.chain(inverse, ZERO - inverse * inverse)

    def __pow__(self, power: float) -> Slopes:
        if power == 0:
            return Slopes(ONE)
        return self.chain(self.value**power, number(power) * (ONE if power == 1 else self.value ** (power - 1)))

    def __neg__(self) -> Slopes:
        return Slopes.of(0.0) - self

    def __radd__(self, other: float) -> Slopes:
        return self + other

    def __rsub__(self, other: float) -> Slopes:
        return Slopes.of(other) - self

    def __rmul__(self, other: float) -> Slopes:
        return self * other

    def __rtruediv__(self, other: float) -> Slopes:
        return Slopes.of(other) / self


HALF_TURN = number(0.5 * np.pi)


def _sin(x: Slopes) -> Slopes:
    return x.chain((x.value - HALF_TURN).cos(), x.value.cos())


def _cos(x: Slopes) -> Slopes:
    return x.chain(x.value.cos(), ZERO - (x.value - HALF_TURN).cos())


def _exp(x: Slopes) -> Slopes:
    value = x.value.rising(np.exp)
    return x.chain(value, value)


def _log(x: Slopes) -> Slopes:
    return x.chain(x.value.rising(np.log), x.value.inverse())


def _sqrt(x: Slopes) -> Slopes:
    value = x.value.rising(np.sqrt)
    return x.chain(value, number(0.5) * value.inverse())


def _tanh(x: Slopes) -> Slopes:
    most = np.where((x.value.low < 0.0) & (x.value.high > 0.0), 0.0, np.minimum(np.abs(x.value.low), np.abs(x.value.high)))
    least = np.maximum(np.abs(x.value.low), np.abs(x.value.high))
    steepness = Interval.hull(1.0 / np.cosh(np.minimum(most, 700.0)) ** 2, 1.0 / np.cosh(np.minimum(least, 700.0)) ** 2)
    return x.chain(x.value.rising(np.tanh), steepness)


def _arcsinh(x: Slopes) -> Slopes:
    return x.chain(x.value.rising(np.arcsinh), ((ONE + x.value**2) ** 0.5).inverse())


FUNCTIONS: dict[str, Callable[[Slopes], Slopes]] = {
    "sin": _sin,
    "cos": _cos,
    "exp": _exp,
    "log": _log,
    "sqrt": _sqrt,
    "tanh": _tanh,
    "arcsinh": _arcsinh,
}


def _of_anything(rule: Callable[[Slopes], Slopes]) -> Callable[[Any], Slopes]:
    """The function of a number, too."""
    return lambda x: rule(Slopes.of(x))


class Law:
    """A formula of u and v as text of Python, for numbers, arrays and boxes."""

    def __init__(self, text: str) -> None:
        self._code = compile(text, "law", "eval")
        self._numbers = {name: getattr(np, name) for name in FUNCTIONS} | {"pi": np.pi}
        self._plain = {name: getattr(math, "asinh" if name == "arcsinh" else name) for name in FUNCTIONS} | {"pi": np.pi}
        self._boxes: dict[str, Any] = {name: _of_anything(rule) for name, rule in FUNCTIONS.items()} | {"pi": np.pi}

    def __call__(self, u: Any, v: Any) -> Any:
        """The coefficient of friction at slips (m) and slip rates (m/s)."""
        return eval(self._code, self._numbers, {"u": u, "v": v})

    def at(self, u: float, v: float) -> float:
        """The coefficient of friction at one slip (m) and slip rate (m/s), several times faster."""
        try:
            return float(eval(self._code, self._plain, {"u": u, "v": v}))
        except (ArithmeticError, ValueError):  # where numpy has an infinity or no number
            return float(self(np.float64(u), np.float64(v)))

    def over(self, u: Interval, v: Interval) -> Interval:
        """An enclosure of the coefficient over boxes: the plain one, or that of the mean value theorem where it is tighter."""
        found = Slopes.of(eval(self._code, self._boxes, {"u": Slopes(u, (ONE, ZERO)), "v": Slopes(v, (ZERO, ONE))}))
        middle = 0.5 * (u.low + u.high), 0.5 * (v.low + v.high)
        here = np.asarray(self(*middle), float)
        centred = Interval.hull(here) + found.by[0] * Interval(u.low - middle[0], u.high - middle[0])
        centred = centred + found.by[1] * Interval(v.low - middle[1], v.high - middle[1])
        return found.value.meet(centred)
