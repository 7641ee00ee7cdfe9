"""Check a series of another program for usual mistakes, and pair its shocks with those of the exact solution."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import NamedTuple, NoReturn

import numpy as np

from stickslip.extensions.schemes.contract import Series
from stickslip.extensions.schemes.verdict import travel_time
from stickslip.foundation.arrays import Floats
from stickslip.foundation.errors import InputError
from stickslip.problem import Problem
from stickslip.solution import Solution

NEAR_POWER = 1.5
"""A number whose ratio to the expected one lies within this factor of a power of 1000 has a wrong unit."""
SMALLER = {1e-6: "M", 1e-3: "k", 1e3: "m", 1e6: "micro"}
"""The prefix of the unit that a number must have been written in, by the factor that it is wrong by."""


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
        _refuse(series, f"slip is {series.slip[0]:g} {problem.unit_of('slip')} at the start{hint}: slip must count from t = 0")
    time = series.time[series.time <= exact.history.span[1]]
    expected = {
        "slip": float(np.abs(exact.slip(time) - problem.initial_slip).max()),
        "slip rate": float(np.abs(exact.slip_rate(time)).max()),
        "traction": float(np.abs(exact.traction(time)).max()),
    }
    check_sizes(series, expected, {name: problem.unit_of(name.replace(" ", "_")) for name in expected})


def check_sizes(series: Series, expected: Mapping[str, float], units: Mapping[str, str], right: str = "exact") -> None:
    """Raise InputError if the largest slip, slip rate or traction of a series are wrong by a power of 1000."""
    peak = float(np.abs(series.slip - series.slip[0]).max())
    own = {"slip": peak, "slip rate": float(np.abs(series.rate).max()), "traction": float(np.abs(series.traction).max())}
    for name, unit in units.items():
        wrong = _prefix(own[name], expected[name])
        if wrong:
            _refuse(series, f"largest {name} is {own[name]:g} {unit}, {right} {expected[name]:g} {unit}: is it in {wrong}{unit}?")


def _prefix(value: float, expected: float) -> str:
    """Return the prefix of the unit that would explain a wrong value; "" if a wrong unit does not explain it."""
    if not (value > 0.0 and expected > 0.0):
        return ""
    return next(
        (prefix for factor, prefix in SMALLER.items() if abs(math.log(value / expected / factor)) < math.log(NEAR_POWER)), ""
    )


def _refuse(series: Series, what: str) -> NoReturn:
    raise InputError(f"{series.name}: {what}")


CELLS_NEAR_SHOCK = 4.0
"""Travel time, in cells, on either side of a shock over which a grid spreads it."""
MADE = 0.5
"""A shock counts as made if the slip rate changes by at least this share of the exact change."""

SHOCK_COLUMNS = {
    "scheme": ("", "name of the scheme, or of the program"),
    "cells": ("", "cells in the thickness; 0 if unknown"),
    "exact_time": ("s", "time of the exact shock; NaN for a shock that the exact solution does not have"),
    "exact_before": ("m/s", "exact slip rate before it"),
    "exact_after": ("m/s", "exact slip rate after it"),
    "time": ("s", "time at which the slip rate of the series passes the middle of both; NaN if it makes no such shock"),
    "before": ("m/s", "slip rate of the series before it, by the time over which a grid spreads a shock"),
    "after": ("m/s", "slip rate of the series after it, by the same time"),
    "delay": ("s", "time minus exact_time"),
    "size": ("", "change of the slip rate as a share of the exact change between times as far from the exact shock"),
}
"""Columns of the table of shocks, each with its unit and meaning."""


class Shock(NamedTuple):
    """A shock of the exact solution beside the one that a series makes; the fields are in SHOCK_COLUMNS."""

    exact_time: float
    exact_before: float
    exact_after: float
    time: float = math.nan
    before: float = math.nan
    after: float = math.nan
    delay: float = math.nan
    size: float = math.nan

    @property
    def jump(self) -> float:
        """Magnitude of the exact jump, m/s."""
        return abs(self.exact_after - self.exact_before)


def shadow(series: Series, exact: Solution, at: Floats) -> Floats:
    """Return the time (s) on either side of shocks at times over which a series spreads them, by its cells or its steps there."""
    steps, count = np.diff(series.time), int(CELLS_NEAR_SHOCK)
    beyond = np.arange(1, count + 1)
    time = np.concatenate([series.time[0] - steps[0] * beyond[::-1], series.time, series.time[-1] + steps[-1] * beyond])
    rows = np.arange(time.size, dtype=float)
    row = np.interp(np.clip(at, series.time[0], series.time[-1]), time, rows)
    by_steps = np.maximum(at - np.interp(row - count, rows, time), np.interp(row + count, rows, time) - at)
    widths: Floats = np.maximum(CELLS_NEAR_SHOCK * travel_time(series, exact), by_steps)
    return widths


def shocks_of(series: Series, exact: Solution, until: float) -> list[Shock]:
    """Return the shocks of the exact solution up to a time (s), each beside that of a series, and then shocks of its own.

    A series makes a shock where its slip rate passes the middle of the two exact ones in the same direction, and changes by at
    least half as much. The nearest such passage in time counts, how far away it may be, and each counts once. A change of half the
    largest exact jump elsewhere is a shock of the series' own. It is not looked for where the exact slip rate, too, changes as fast
    without a shock.
    """
    kept = series.time <= until
    time, rate = series.time[kept], series.rate[kept]
    found: list[Shock] = []
    used: list[float] = []
    for at, before, after in exact.shocks[["time", "rate_before", "rate_after"]].to_numpy(float):
        if at <= until:
            found.append(_beside(Shock(at, before, after), (time, rate), (exact, series), used))
    return found + _own(found, (time, rate), (exact, series), used)


def _change(time: Floats, rate: Floats, at: Floats, width: Floats) -> tuple[Floats, Floats]:
    """Return the slip rates before and after times, by widths (s); before t = 0 the contact is at rest."""
    return np.interp(at - width, time, rate, left=0.0), np.interp(at + width, time, rate, left=0.0)


def _beside(shock: Shock, series: tuple[Floats, Floats], how: tuple[Solution, Series], used: list[float]) -> Shock:
    """Return a shock with what the series makes of it, and note the time of the series' own in `used`."""
    (time, rate), (exact, whole_series) = series, how
    width = float(shadow(whole_series, exact, np.array(shock.exact_time)))
    beyond = (rate > 0.5 * (shock.exact_before + shock.exact_after)) == (shock.exact_after > shock.exact_before)
    at_start = shock.exact_time <= float(time[0])
    turned = np.flatnonzero(beyond & np.append(at_start, ~beyond[:-1]))
    last = float(time[-1])
    sides = np.clip([shock.exact_time - width, shock.exact_time + width], 0.0, last)
    exact_rates = [0.0 if at_start else float(exact.slip_rate(sides[0])), float(exact.slip_rate(sides[1]))]
    whole = exact_rates[1] - exact_rates[0] or shock.exact_after - shock.exact_before
    passages = np.where(turned > 0, _middle(time, rate, turned, 0.5 * (shock.exact_before + shock.exact_after)), time[turned])
    nearest = passages[np.argsort(np.abs(passages - shock.exact_time))]
    sides_of = np.transpose(_change(time, rate, nearest, shadow(whole_series, exact, nearest)))
    for at, (before, after) in zip(nearest.tolist(), sides_of.tolist(), strict=True):
        if at not in used and (after - before) / whole >= MADE:
            used.append(at)
            return shock._replace(time=at, before=before, after=after, delay=at - shock.exact_time, size=(after - before) / whole)
    return shock


def _middle(time: Floats, rate: Floats, turned: np.ndarray[tuple[int], np.dtype[np.intp]], level: float) -> Floats:
    """Return when (s) the slip rate passes a level before each of some samples."""
    before = np.maximum(turned - 1, 0)
    rise = rate[turned] - rate[before]
    share = np.divide(level - rate[before], rise, out=np.zeros_like(rise), where=rise != 0.0)
    return time[before] + np.clip(share, 0.0, 1.0) * (time[turned] - time[before])


def _own(found: list[Shock], series: tuple[Floats, Floats], how: tuple[Solution, Series], used: list[float]) -> list[Shock]:
    """Return the shocks of a series that the exact solution does not have."""
    (time, rate), (exact, whole_series) = series, how
    width = shadow(whole_series, exact, time)
    least = MADE * max((shock.jump for shock in found), default=math.inf)
    places = np.array([shock.exact_time for shock in found])
    reach = np.maximum(width[:, None], shadow(whole_series, exact, places))
    far = (np.abs(time[:, None] - places) > 2.0 * reach).all(axis=1)
    before, after = _change(time, exact.slip_rate(time), time, width)
    if (np.abs(after - before)[far] >= least).any():
        return []
    before, after = _change(time, rate, time, width)
    large = np.where(np.abs(after - before) >= least, np.sign(after - before), 0.0)
    starts = np.flatnonzero((large != 0.0) & (large != np.append(0.0, large[:-1])))
    ends = np.flatnonzero((large != 0.0) & (large != np.append(large[1:], 0.0)))
    shocks = []
    for start, end in zip(starts.tolist(), ends.tolist(), strict=True):
        if not any(time[start] - width[start] <= at <= time[end] + width[end] for at in used):
            k = start + int(np.argmax(np.abs(after - before)[start : end + 1]))
            middle = 0.5 * (time[start] + time[end])
            shocks.append(Shock(math.nan, math.nan, math.nan, float(middle), float(before[k]), float(after[k])))
    return shocks
