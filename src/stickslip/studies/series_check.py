"""Check a series of another program for usual mistakes before it is judged: units, counting from the start, and length."""

from __future__ import annotations

import math
from typing import NoReturn

import numpy as np

from stickslip.foundation.errors import InputError
from stickslip.problem.problem import Problem
from stickslip.schemes.series import Series
from stickslip.solution.solution import Solution

NEAR = 1.5
"""A number whose ratio to the expected one lies within this factor of a power of 1000 has a wrong unit."""
SMALLER = {1e-6: "M", 1e-3: "k", 1e3: "m", 1e6: "micro"}
"""The prefix of the unit in which a number must have been written, by the factor by which it is wrong."""


def check_length(series: Series, duration: float, whose: str = "the run") -> None:
    """Raise InputError if a series does not begin at t = 0 or ends before a duration (s), by more than two steps."""
    first, last = float(series.time[0]), float(series.time[-1])
    wrong = _prefix(last, duration)
    if wrong:
        _refuse(series, f"ends at {last:g} s, {whose} at {duration:g} s: is its time in {wrong}s? It must be in s")
    if first > 2.0 * series.step or first < -2.0 * series.step:
        _refuse(series, f"begins at {first:g} s: it must begin at t = 0")
    if last < duration - 2.0 * series.step:
        _refuse(series, f"ends at {last:g} s, {whose} at {duration:g} s: write more, or give a shorter duration")


def check_units(series: Series, exact: Solution, problem: Problem) -> None:
    """Raise InputError if slip, slip rate or traction of a series are wrong by a power of 1000, or slip has an offset."""
    peak = float(np.abs(series.slip - series.slip[0]).max())
    if abs(series.slip[0]) > max(0.1 * peak, 2.0 * series.step * float(np.abs(series.rate).max())):
        hint = " (it seems to be absolute)" if problem.initial_slip else ""
        _refuse(series, f"slip is {series.slip[0]:g} m at the start{hint}: slip must count from t = 0")
    time = series.time[series.time <= exact.history.span[1]]
    own = {"slip": peak, "slip rate": float(np.abs(series.rate).max()), "traction": float(np.abs(series.traction).max())}
    expected = {
        "slip": float(np.abs(exact.slip(time) - problem.initial_slip).max()),
        "slip rate": float(np.abs(exact.slip_rate(time)).max()),
        "traction": float(np.abs(exact.traction(time)).max()),
    }
    for name, unit in (("slip", "m"), ("slip rate", "m/s"), ("traction", "Pa")):
        wrong = _prefix(own[name], expected[name])
        if wrong:
            _refuse(series, f"largest {name} is {own[name]:g} {unit}, exact {expected[name]:g} {unit}: is it in {wrong}{unit}?")


def _prefix(value: float, expected: float) -> str:
    """Return the prefix of the unit that would explain a wrong value; "" if a wrong unit does not explain it."""
    if not (value > 0.0 and expected > 0.0):
        return ""
    return next((prefix for factor, prefix in SMALLER.items() if abs(math.log(value / expected / factor)) < math.log(NEAR)), "")


def _refuse(series: Series, what: str) -> NoReturn:
    raise InputError(f"{series.name}: {what}")
