"""What a series at the contact is worth: its errors against an exact solution, its pulses, arrest, shocks, ringing and energy."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

from stickslip.extensions.schemes.contract import Energies, Series
from stickslip.extensions.schemes.shocks import CELLS_NEAR_SHOCK, Shock, shadow, shocks_of
from stickslip.extensions.schemes.verdict import mean_magnitude
from stickslip.foundation.arrays import Floats
from stickslip.foundation.names import KINDS_OF_BODY
from stickslip.friction import FrictionLaw
from stickslip.problem import default_event_rate
from stickslip.solution import Solution

COMPARED = 0.5
"""At least this share of a series must lie away from shocks, so that its slip rate and traction are compared at all."""
JUMP_OF_TRACTION = 0.01
"""Traction jumps where it changes at once by more than this share of its range."""
COLUMNS_OF_SCHEMES = {
    "scheme": ("", "name of the scheme, or of the program"),
    "cells": ("", "cells in the thickness; 0 if unknown"),
    "step": ("s", "step of time"),
    "slip_error": ("m", "mean magnitude of the slip difference from the exact solution under the problem's own rule"),
    "largest_error": ("m", "largest magnitude of this difference"),
    "rate_error": ("m/s", "mean magnitude of the difference in slip rate, away from shocks"),
    "traction_error": ("Pa", "mean magnitude of the difference in traction, away from shocks"),
    "rest_error": ("Pa", "mean magnitude of the difference in traction while the exact contact rests; NaN if it never does"),
    "slip_order": ("", "order of convergence of slip_error, from the mesh before"),
    "rate_order": ("", "order of convergence of rate_error, from the mesh before"),
    "slip_change": ("m", "mean magnitude of the slip difference from the mesh before"),
    "rate_change": ("m/s", "mean magnitude of the difference in slip rate from the mesh before"),
    "final_slip": ("m", "slip at the end, since t = 0"),
    "peak_rate": ("m/s", "largest slip rate"),
    "pulses": ("", "maxima of |v| separated by minima below half the lower one; ringing of the scheme makes some, too"),
    "periods": ("", "largest slip since t = 0, in periods of friction along slip; NaN if friction has none"),
    "arrest": ("s", "time from which on the contact stays at rest; NaN if it slips at the end"),
    "shocks": ("", "how many of the exact shocks the series makes"),
    "own_shocks": ("", "shocks that the series makes and the exact solution does not"),
    "shock_delay": ("s", "delay of the largest shock; NaN if it is not made"),
    "shock_size": ("", "size of the largest shock, as a share of the exact size"),
    "stored": ("J/m^2", "change of kinetic and strain energy since t = 0, as the scheme counts it; NaN if it counts none"),
    "driver_work": ("J/m^2", "work of the driver, likewise"),
    "heat": ("J/m^2", "work against friction; of a series without energies, by the trapezoidal rule"),
    "damped": ("J/m^2", "energy that the scheme itself dissipates; negative if it makes energy"),
    "energy_drift": ("", "stored + heat + damped - driver_work, as a share of heat: what the balance of the scheme leaves open"),
    "heat_error": ("", "heat minus the exact heat, as a share of that"),
    "oscillation": ("", "total variation of the slip rate beyond the exact one's, as a share of that"),
    "rule": ("", "selection rule whose exact path the series follows; none; or cannot tell, if it could be any rule's"),
}
"""Columns of the table, each with its unit and meaning."""


def units_for(load_unit: str) -> Mapping[str, str]:
    """Return the units that take the place of those of a slab for a body whose loads have this unit."""
    kind = KINDS_OF_BODY[load_unit]
    return {"m": kind.slip, "m/s": f"{kind.slip}/s", "Pa": load_unit, "J/m^2": kind.energy}


def in_units(columns: Mapping[str, tuple[str, str]], load_unit: str) -> dict[str, tuple[str, str]]:
    """Return columns with the units that they have for such a body."""
    units = units_for(load_unit)
    return {name: (units.get(unit, unit), meaning) for name, (unit, meaning) in columns.items()}


def said_of(columns: Mapping[str, tuple[str, str]]) -> list[str]:
    """Return a line for each column of a table, with its unit and meaning."""
    return [f"{name}{f' ({unit})' if unit else ''}: {meaning}" for name, (unit, meaning) in columns.items()]


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


def period_of(law: FrictionLaw) -> float:
    """Return the slip (m) after which friction, or its part that depends on slip, repeats itself; NaN if it does not."""
    wavenumber = getattr(getattr(law, "slip", law), "wavenumber", None)
    return 2.0 * math.pi / abs(wavenumber) if wavenumber else math.nan


def arrest_in(time: Floats, rate: Floats, threshold: float) -> float:
    """Return the time (s) after which |v| stays at or below a threshold (m/s); NaN if it never slips or slips at the end."""
    slips = np.flatnonzero(np.abs(rate) > threshold)
    return float(time[slips[-1] + 1]) if slips.size and slips[-1] + 1 < len(time) else math.nan


@dataclass(frozen=True, eq=False)
class MeasuredSeries:
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
    def traction(self) -> Floats:
        """Traction of the series, Pa."""
        tractions: Floats = self.series.traction[self._kept]
        return tractions

    @cached_property
    def exact_traction(self) -> Floats:
        """Exact traction at these times, Pa."""
        return self.exact.traction(self.time)

    @cached_property
    def away(self) -> NDArray[np.bool_]:
        """True at times away from the exact shocks, when slip rate and traction are compared."""
        shocks = self.exact.shocks.time.to_numpy(float)
        return np.asarray((np.abs(self.time[:, None] - shocks) > self.shadows(shocks)).all(axis=1))

    @cached_property
    def away_from_jumps(self) -> NDArray[np.bool_]:
        """True at times away from shocks, and more than a step away from jumps of traction at rest, when traction is compared.

        Where echoes come so often that this leaves less than half of the time, these jumps do not count.
        """
        breaks = self.exact.breaks[self.exact.breaks <= self.until]
        jump = np.abs(self.exact.traction(breaks) - self.exact.traction(breaks, side="left"))
        jumps = breaks[jump > JUMP_OF_TRACTION * float(np.ptp(self.exact_traction))]
        beside = self.shadows(jumps) / CELLS_NEAR_SHOCK
        edges = np.zeros(self.time.size + 1, int)  # there may be as many jumps as echoes: count those that each sample lies beside
        np.add.at(edges, np.searchsorted(self.time, jumps - beside), 1)
        np.add.at(edges, np.searchsorted(self.time, jumps + beside, "right"), -1)
        away = self.away & (np.cumsum(edges[:-1]) == 0)
        return away if self.weights[away].sum() >= COMPARED else self.away

    @cached_property
    def weights(self) -> Floats:
        """The share of time that each sample stands for: where steps are longer, a sample counts for more."""
        steps = np.diff(self.time)
        halves = 0.5 * (np.append(steps, 0.0) + np.append(0.0, steps))
        shares: Floats = halves / halves.sum()
        return shares

    @property
    def compared(self) -> float:
        """The share of time that lies away from shocks: slip rate and traction are compared there."""
        return float(self.weights[self.away].sum())

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
        return mean_magnitude(self.gap, self.time)

    def shadows(self, shocks: Floats) -> Floats:
        """Return the times (s) on either side of shocks, at times (s), within which the slip rate is not compared."""
        return shadow(self.series, self.exact, shocks)

    @property
    def rate_error(self) -> float:
        """The mean magnitude of the difference in slip rate away from shocks, m/s."""
        return _mean(np.abs(self.rate - self.exact_rate)[self.away])

    @property
    def traction_errors(self) -> tuple[float, float]:
        """The mean magnitude of the difference in traction away from shocks, in all and while the exact contact rests, Pa."""
        gap = np.abs(self.traction - self.exact_traction)
        return _mean(gap[self.away]), _mean(gap[self.away & (self.exact_rate == 0.0)])

    @property
    def oscillation(self) -> float:
        """The total variation of the slip rate beyond the exact one's, as a share of that."""
        own, exact = (float(np.abs(np.diff(rate)).sum()) for rate in (self.rate, self.exact_rate))
        return (own - exact) / exact if exact else math.nan

    def energies(self) -> dict[str, float]:
        """Return the columns of the balance of energy.

        A series without energies has its heat only. It is compared with the exact one by the same sum over the same samples.
        """
        own = self.series.energies
        if own is None:
            heat = float(np.trapezoid(self.traction * self.rate, self.time))
            exact = float(np.trapezoid(self.exact_traction * self.exact_rate, self.time))
            unknown = dict.fromkeys(("stored", "driver_work", "damped", "energy_drift"), math.nan)
            return unknown | {"heat": heat, "heat_error": (heat - exact) / exact if exact else math.nan}
        first, last = Energies(*own[0]), Energies(*own[self._kept][-1].tolist())
        exact = float(self.exact.energy(self.time[-1:]).heat[0])
        left = last.stored - float(first.stored) + last.friction + last.damped - last.driver
        return {
            "stored": last.stored - float(first.stored),
            "driver_work": last.driver,
            "heat": last.friction,
            "damped": last.damped,
            "energy_drift": left / last.friction if last.friction else math.nan,
            "heat_error": (last.friction - exact) / exact if exact else math.nan,
        }

    @cached_property
    def shocks(self) -> list[Shock]:
        """The exact shocks beside those of the series, and then shocks of its own."""
        return shocks_of(self.series, self.exact, self.until)

    def row(self) -> dict[str, Any]:
        """Return the columns of the table that a series has by itself and against this solution."""
        exact = [shock for shock in self.shocks if not math.isnan(shock.exact_time)]
        largest = max(exact, key=lambda shock: shock.jump, default=None)
        return {
            "slip_error": self.slip_error,
            "largest_error": float(np.abs(self.gap).max()),
            "rate_error": self.rate_error,
            **dict(zip(("traction_error", "rest_error"), self.traction_errors, strict=True)),
            "final_slip": float(self.series.slip[self._kept][-1]),
            "peak_rate": float(np.abs(self.rate).max()),
            "pulses": pulses_in(self.rate, self.threshold),
            "periods": float(self.series.slip[self._kept].max()) / period_of(self.exact.problem.friction),
            "arrest": arrest_in(self.time, self.rate, self.threshold),
            "shocks": sum(not math.isnan(shock.time) for shock in exact),
            "own_shocks": len(self.shocks) - len(exact),
            "shock_delay": largest.delay if largest else math.nan,
            "shock_size": largest.size if largest else math.nan,
            **self.energies(),
            "oscillation": self.oscillation,
        }


def _mean(gap: Floats) -> float:
    return float(gap.mean()) if gap.size else math.nan
