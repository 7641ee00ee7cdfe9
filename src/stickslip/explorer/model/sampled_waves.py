"""The two waves in a slab, sampled finely in time: from them the pictures of slab and energy are read off by interpolation.

The exact field and energies of `stickslip.observables` take a millisecond for each time. A picture needs hundreds of times within
some milliseconds, and no more digits than a screen shows.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import NamedTuple

import numpy as np

from stickslip.foundation.arrays import Floats
from stickslip.observables.field import WaveInterval, slab_of
from stickslip.observables.waves import Radiation, Waves
from stickslip.solution.evaluation import Readings
from stickslip.solution.interval import choose_interval
from stickslip.solution.solution import Solution
from stickslip.solution.window import Window


class ShownInterval(NamedTuple):
    """An interval of a run from `start` to `end` (s), in the time of `readings`, which counts from `begin` (s after the start)."""

    readings: Readings
    start: float
    end: float
    begin: float

    @classmethod
    def of(cls, solution: Solution) -> ShownInterval:
        """Return the interval to show of a run."""
        readings, start, end = choose_interval(solution, None, None)
        epoch = readings.history.epoch
        begin = epoch.trip * readings.history.round_trip_time + epoch.offset if isinstance(readings, Window) else 0.0
        return cls(readings, start, end, begin)


EVEN = 3000
"""Number of evenly spaced samples."""
INSIDE = 6
"""Number of samples within each piece of the history, if there are not more than `ENDS_ONLY` pieces."""
ENDS_ONLY = 600
"""With more pieces than this, only their ends are sampled besides."""
OF_START = 500
"""Number of samples of the load that the initial state brings."""
NEARBY = 1e-9
"""Distance of the sample before a front from the one after it, as a share of the two-way travel time."""


@dataclass(frozen=True)
class Wave:
    """A wave (Pa, plus or minus the reference strength) at the contact against time (s)."""

    time: Floats
    value: Floats

    def at(self, time: Floats) -> Floats:
        """Return the wave at times."""
        return np.interp(time, self.time, self.value)

    @cached_property
    def _sums(self) -> Floats:
        return summed(self.time, self.value)

    def total(self, time: Floats) -> Floats:
        """Return the integral of the wave up to times, Pa s."""
        return np.interp(time, self.time, self._sums)

    def mean(self, begin: Floats, end: Floats) -> Floats:
        """Return the mean of the wave between times."""
        return (self.total(end) - self.total(begin)) / (end - begin)

    @cached_property
    def _squares(self) -> Floats:
        return summed(self.time, self.value**2)

    def squared(self, time: Floats) -> Floats:
        """Return the integral of the square of the wave up to times, Pa^2 s."""
        return np.interp(time, self.time, self._squares)


def summed(time: Floats, value: Floats) -> Floats:
    """Return the integral of values from the first time to each time, by the trapezoidal rule."""
    return np.append(0.0, np.cumsum(0.5 * np.diff(time) * (value[1:] + value[:-1])))


class SampledWaves:
    """The waves of a slab in an interval of its run; times are those of `shown.readings`.

    `leaving` is w = 2 Z v - beta plus the reference strength where it leaves the contact, `coming` is beta minus the reference
    where it arrives there. Raises InputError if the waves are not known because the run leaped over creep.
    """

    def __init__(self, shown: ShownInterval) -> None:
        self.shown = shown
        self.history, self.body = shown.readings.history, slab_of(shown.readings.problem)
        self.waves, self.radiation = Waves(self.history, self.body), Radiation(self.history, self.body)
        self.first, half = self.history.span[0], self.waves.half
        self.leaving = self._leaving(max(shown.start - self.waves.round, self.first - half))
        sent = self.leaving.time - self.first
        back = self.waves.arriving(self.leaving.value, sent)
        begin = np.linspace(0.0, half * (1.0 - NEARBY), OF_START)
        known = self.leaving.time >= self.first - half
        self.coming = Wave(
            np.concatenate([self.first + begin, self.leaving.time[known] + self.waves.round]),
            np.concatenate([self.waves.first_load(begin), back[known]]),
        )
        if shown.start - self.waves.round > self.first - half:
            self.coming = Wave(self.leaving.time + self.waves.round, back)

    def _leaving(self, begin: float) -> Wave:
        interval, end = WaveInterval(self.waves, begin, self.shown.end), self.shown.end
        slack = NEARBY * self.waves.round
        edges = self.waves.inflow.edges(begin - self.first + self.waves.round, end - self.first + self.waves.round)
        edges = edges + self.first - self.waves.round
        breaks = np.unique(np.append(interval.start, self.first))
        breaks = breaks[(breaks >= begin) & (breaks <= end)]
        inside = np.diff(breaks) * np.linspace(0.0, 1.0, INSIDE + 2)[1:-1, None] + breaks[:-1]
        within = np.ravel(inside) if len(breaks) <= ENDS_ONLY else breaks[:0]
        right = np.concatenate([np.linspace(begin, end, EVEN), breaks, within, edges - slack, edges + slack])
        time = np.concatenate([right, breaks - slack])
        value = np.concatenate([interval.leaving(right, "right"), interval.leaving(breaks, "left")])
        order = np.argsort(time, kind="stable")
        return Wave(time[order], value[order])

    def velocity_and_stress(self, begin: Floats, end: Floats, place: Floats) -> tuple[Floats, Floats]:
        """Return the means of velocity (m/s) and shear stress (Pa) between times, at places (m from the contact) that broadcast."""
        away = place / self.body.wave_speed
        coming, leaving = self.coming.mean(begin + away, end + away), self.leaving.mean(begin - away, end - away)
        return (coming + leaving) / (2.0 * self.body.impedance), self.waves.reference + 0.5 * (coming - leaving)

    def displacement(self, time: Floats, place: Floats, at_contact: Floats) -> Floats:
        """Return the displacement (m) at times and places that broadcast, from the slip of the contact at these times."""
        away = place / self.body.wave_speed
        come = self.coming.total(time + away) - self.coming.total(time)
        left = self.leaving.total(time) - self.leaving.total(time - away)
        ground = self.history.problem.ground
        if ground is not None:
            at_contact = at_contact + ground.displacement_at(time - self.first)
        return at_contact + (2.0 * self.waves.reference * away + come - left) / (2.0 * self.body.impedance)

    def kinetic(self, time: Floats, places: int) -> Floats:
        """Return the kinetic energy in the slab (J/m^2) at times: the mean over `places` is only taken where both waves overlap."""
        half = self.waves.half
        away = half * (np.arange(places) + 0.5) / places
        both = np.mean(self.coming.at(time[:, None] + away) * self.leaving.at(time[:, None] - away), axis=1)
        return np.asarray((self._squares(time) + 2.0 * half * both) / (8.0 * self.body.impedance))

    def stored(self, time: Floats) -> Floats:
        """Return the elastic and kinetic energy in the slab (J/m^2, up to a constant) at times, from both waves."""
        half = self.waves.half
        come = self.coming.total(time + half) - self.coming.total(time)
        left = self.leaving.total(time) - self.leaving.total(time - half)
        return (self._squares(time) + 2.0 * self.waves.reference * (come - left)) / (4.0 * self.body.impedance)

    def _squares(self, time: Floats) -> Floats:
        """Return the integral of the squares of both waves over the slab at times, Pa^2 s."""
        half = self.waves.half
        come = self.coming.squared(time + half) - self.coming.squared(time)
        return come + self.leaving.squared(time) - self.leaving.squared(time - half)

    def work(self, time: Floats) -> Floats:
        """Return the work of the driver up to times (J/m^2, up to a constant), net of what is radiated."""
        return self._of_driver(self.waves, time)

    def radiated(self, time: Floats) -> Floats:
        """Return the energy radiated through the driver up to times (J/m^2, up to a constant)."""
        return self._of_driver(self.radiation, time)

    def _of_driver(self, waves: Waves, time: Floats) -> Floats:
        power = waves.power(self.leaving.value, self.leaving.time - self.first)
        return np.interp(time - waves.half, self.leaving.time, summed(self.leaving.time, power))
