"""What a series at the contact is worth: its errors against an exact solution, its pulses, arrest, shocks, ringing and energy."""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np

from stickslip.bodies import as_slab
from stickslip.schemes.series import Series
from stickslip.solution.solution import Solution
from stickslip.trajectory.history import Floats
from stickslip.trajectory.slip_events import default_event_rate

CELLS_NEAR_SHOCK = 4.0
"""Travel time, in cells, on either side of a shock in which the slip rate of a grid is not compared."""

COLUMNS = {
    "scheme": ("", "name of the scheme, or of the program"),
    "cells": ("", "cells in the thickness; 0 if unknown"),
    "step": ("s", "step of time"),
    "slip_error": ("m", "mean magnitude of the slip difference from the exact solution under the problem's own rule"),
    "largest_error": ("m", "largest magnitude of this difference"),
    "rate_error": ("m/s", "mean magnitude of the difference in slip rate, away from shocks"),
    "slip_order": ("", "order of convergence of slip_error, from the mesh before"),
    "rate_order": ("", "order of convergence of rate_error, from the mesh before"),
    "final_slip": ("m", "slip at the end, since t = 0"),
    "peak_rate": ("m/s", "largest slip rate"),
    "pulses": ("", "maxima of |v| separated by minima below half the lower one"),
    "arrest": ("s", "time from which on the contact stays at rest; NaN if it slips at the end"),
    "shocks": ("", "how many of the exact shocks the series makes"),
    "shock_delay": ("s", "delay of the largest shock; NaN if it is not made"),
    "shock_size": ("", "size of the largest shock, as a share of the exact size"),
    "energy_drift": ("", "energy that has appeared (negative: that has been damped away), as a share of the friction heat"),
    "oscillation": ("", "total variation of the slip rate beyond the exact one's, as a share of that"),
    "rule": ("", "selection rules whose exact solution the series follows; none; or unique if all rules have the same"),
}
"""Columns of the table, each with its unit and meaning."""


def pulses_in(rate: Floats, threshold: float) -> int:
    """Count the maxima of |v| above a threshold (m/s) that are separated by minima below half the lower one.

    It is the definition of `Solution.events`, for the samples of a series.
    """
    speed = np.where(np.abs(rate) > threshold, np.abs(rate), 0.0)
    count, peak, low = 0, 0.0, 0.0
    for value in speed.tolist():
        if low < 0.5 * min(peak, value) or (count == 0 and value > 0.0):
            count, peak, low = count + 1, value, value
        elif value > peak:
            peak = low = value
        else:
            low = min(low, value)
    return count


def arrest_in(time: Floats, rate: Floats, threshold: float) -> float:
    """Return the time (s) from which on |v| stays at or below a threshold (m/s); NaN if it never slips or slips at the end."""
    slips = np.flatnonzero(np.abs(rate) > threshold)
    return float(time[slips[-1] + 1]) if slips.size and slips[-1] + 1 < len(time) else math.nan


@dataclass(frozen=True, eq=False)
class Measured:
    """A series beside an exact solution, up to a time (s) that both cover."""

    series: Series
    exact: Solution
    until: float

    @cached_property
    def _kept(self) -> Any:
        return self.series.time <= self.until

    @cached_property
    def time(self) -> Floats:
        """Times of the series, s."""
        times: Floats = self.series.time[self._kept]
        return times

    @cached_property
    def rate(self) -> Floats:
        """Slip rate of the series, m/s."""
        rates: Floats = self.series.rate[self._kept]
        return rates

    @cached_property
    def exact_rate(self) -> Floats:
        """Exact slip rate at these times, m/s."""
        return self.exact.slip_rate(self.time)

    @cached_property
    def gap(self) -> Floats:
        """Slip of the series minus the exact slip, m."""
        gap: Floats = self.series.slip[self._kept] - (self.exact.slip(self.time) - self.exact.problem.initial_slip)
        return gap

    @cached_property
    def threshold(self) -> float:
        """Slip rate (m/s) above which the contact counts as slipping."""
        return default_event_rate(self.exact.problem)

    @property
    def slip_error(self) -> float:
        """The mean magnitude of the slip difference, m."""
        return self._mean(np.abs(self.gap))

    def _mean(self, values: Floats) -> float:
        return float(np.trapezoid(values, self.time) / (self.time[-1] - self.time[0]))

    @property
    def shadow(self) -> float:
        """Time on either side of a shock in which the slip rate is not compared, s."""
        slab = as_slab(self.exact.problem.body, "schemes: a block has no grid")
        cell = slab.thickness / slab.wave_speed / self.series.cells if self.series.cells else self.series.step
        return CELLS_NEAR_SHOCK * max(cell, self.series.step)

    @property
    def rate_error(self) -> float:
        """The mean magnitude of the difference in slip rate away from shocks, m/s."""
        shocks = self.exact.shocks.time.to_numpy(float)
        away = (np.abs(self.time[:, None] - shocks) > self.shadow).all(axis=1)
        gap = np.abs(self.rate - self.exact_rate)[away]
        return float(gap.mean()) if gap.size else math.nan

    @property
    def oscillation(self) -> float:
        """The total variation of the slip rate beyond the exact one's, as a share of that."""
        own, exact = (float(np.abs(np.diff(rate)).sum()) for rate in (self.rate, self.exact_rate))
        return (own - exact) / exact if exact else math.nan

    @property
    def energy_drift(self) -> float:
        """Energy that has appeared, by the balance of the scheme's own motion, as a share of the friction heat.

        A negative share has been damped away. Where the series has no energies it is the work of friction minus the exact one, as a
        share of the latter; both are sums over the samples.
        """
        series, stress = self.series, self.exact.problem.load
        heat = float(np.trapezoid(series.traction * series.rate, series.time))
        if series.energy is None or series.driver_work is None:
            done = float(np.trapezoid(self.exact.traction(self.time) * self.exact_rate, self.time))
            own = float(np.trapezoid((series.traction * series.rate)[self._kept], self.time))
            return (own - done) / done if done else math.nan
        spent = float(np.trapezoid((series.traction - stress) * series.rate, series.time))
        gained = float(series.energy[-1] - series.energy[0] - series.driver_work[-1]) + spent
        return gained / heat if heat else math.nan

    def shocks(self) -> tuple[int, float, float]:
        """Return how many exact shocks the series makes, and of the largest one the delay (s) and the size as a share of the exact.

        A series makes a shock if it passes the middle of the two slip rates, in the right direction, no further away than twice the
        `shadow`. The size is taken between the edges of the shadow.
        """
        made, delay, size, largest = 0, math.nan, math.nan, 0.0
        for time, before, after in self.exact.shocks[["time", "rate_before", "rate_after"]].to_numpy(float):
            near = np.abs(self.time - time) <= 2.0 * self.shadow
            beyond = (self.rate > 0.5 * (before + after)) == (after > before)
            turned = np.flatnonzero(beyond & np.append(time <= self.time[0], ~beyond[:-1]) & near)
            made += bool(turned.size)
            if abs(after - before) > largest:
                largest = abs(after - before)
                first = turned[np.argmin(np.abs(self.time[turned] - time))] if turned.size else -1
                delay = float(self.time[first] - time) if turned.size else math.nan
                sides = (time - self.shadow, time + self.shadow)
                own = np.interp(sides, self.time, self.rate, left=0.0)
                size = float((own[1] - own[0]) / (after - before))
        return made, delay, size

    def row(self) -> dict[str, Any]:
        """Return the columns of the table that a series has by itself and against this solution."""
        made, delay, size = self.shocks()
        return {
            "slip_error": self.slip_error,
            "largest_error": float(np.abs(self.gap).max()),
            "rate_error": self.rate_error,
            "final_slip": float(self.series.slip[self._kept][-1]),
            "peak_rate": float(np.abs(self.rate).max()),
            "pulses": pulses_in(self.rate, self.threshold),
            "arrest": arrest_in(self.time, self.rate, self.threshold),
            "shocks": made,
            "shock_delay": delay,
            "shock_size": size,
            "energy_drift": self.energy_drift,
            "oscillation": self.oscillation,
        }
