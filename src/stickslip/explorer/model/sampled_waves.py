"""The two waves in a slab, sampled finely in time: from them the pictures of slab and energy are read off by interpolation.

The exact field and energies of `stickslip.observables` take a millisecond for each time. A picture needs hundreds of times within
some milliseconds, and no more digits than a screen shows.

Work and memory are bounded by what a screen shows, and not by the number of round trips. Over a time of so many that they cannot
be told apart, a sample is a mean over a round trip. The means of waves and of their squares give those of velocity, stress and
energies, also of the product of both waves: over a round trip and over the places of the slab each meets every part of the other.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property
from typing import NamedTuple

import numpy as np

from stickslip.foundation.arrays import Floats
from stickslip.observables.field import WaveInterval, check_known, many_places, slab_of
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
MANY = 300_000
"""Places between which another piece may hold; if there may be more of them in an interval, means are sampled."""
PHASES = 8
"""Number of times in a round trip, or in a shorter time between two samples, whose mean is a sample."""
NEARBY = 1e-9
"""Distance of the sample before a front from the one after it, as a share of the two-way travel time."""


@dataclass(frozen=True)
class Wave:
    """A wave (Pa, plus or minus the reference strength) at the contact against time (s)."""

    time: Floats
    value: Floats
    square: Floats
    """The square of the wave (Pa^2), or the mean of the squares where `value` is a mean."""

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
        return summed(self.time, self.square)

    def squared(self, time: Floats) -> Floats:
        """Return the integral of the square of the wave up to times, Pa^2 s."""
        return np.interp(time, self.time, self._squares)


def summed(time: Floats, value: Floats) -> Floats:
    """Return the integral of values from the first time to each time, by the trapezoidal rule."""
    return np.append(0.0, np.cumsum(0.5 * np.diff(time) * (value[1:] + value[:-1])))


class Samples(NamedTuple):
    """Samples of a wave at times (s): each is the mean over some moments of its own, or the wave at one moment."""

    time: Floats
    moment: Floats
    """s, shape (samples, moments)."""
    wave: Floats
    """The wave at these moments, Pa, plus or minus the reference strength."""

    def mean(self, of_wave: Callable[[Floats, Floats], Floats]) -> Floats:
        """Return the mean, for each sample, of a function of the wave and the moment."""
        found = of_wave(self.wave.ravel(), self.moment.ravel()).reshape(self.wave.shape)
        return found[:, 0] if found.shape[1] == 1 else np.asarray(found.mean(axis=1))

    @property
    def as_wave(self) -> Wave:
        """The samples as a wave that is interpolated between them."""
        return Wave(self.time, self.mean(lambda wave, _: wave), self.mean(lambda wave, _: wave**2))


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
        self._moving: Floats | None = None  # the kinetic energy of each sample (J/m^2), where samples are means
        self.samples = self._sampled(max(shown.start - self.waves.round, self.first - half))
        self.leaving = self.samples.as_wave
        moment = self.samples.moment
        came = self.waves.arriving(self.samples.wave.ravel(), moment.ravel() - self.first).reshape(moment.shape)
        back = Samples(self.leaving.time + self.waves.round, moment, came).as_wave
        self.coming = back
        if not shown.start - self.waves.round > self.first - half:
            begin = np.linspace(0.0, half * (1.0 - NEARBY), OF_START)
            known, load = self.leaving.time >= self.first - half, self.waves.first_load(begin)
            self.coming = Wave(
                np.concatenate([self.first + begin, back.time[known]]),
                np.concatenate([load, back.value[known]]),
                np.concatenate([load**2, back.square[known]]),
            )

    def _sampled(self, begin: float) -> Samples:
        """Return samples of the wave that leaves the contact, from a time on to the end of what is shown."""
        end, round_trip = self.shown.end, self.waves.round
        within = begin - self.first + round_trip, end - self.first + round_trip
        check_known(self.history, begin, end)
        if many_places(self.history, begin, end) > MANY or self.waves.inflow.many_edges(*within) > MANY:
            return self._means(begin)
        interval, slack = WaveInterval(self.waves, begin, end), NEARBY * round_trip
        edges = self.waves.inflow.edges(*within)
        edges = edges + self.first - round_trip
        breaks = np.unique(np.append(interval.start, self.first))
        breaks = breaks[(breaks >= begin) & (breaks <= end)]
        inside = np.diff(breaks) * np.linspace(0.0, 1.0, INSIDE + 2)[1:-1, None] + breaks[:-1]
        inner = np.ravel(inside) if len(breaks) <= ENDS_ONLY else breaks[:0]
        right = np.concatenate([np.linspace(begin, end, EVEN), breaks, inner, edges - slack, edges + slack])
        time = np.concatenate([right, breaks - slack])
        value = np.concatenate([interval.leaving(right, "right"), interval.leaving(breaks, "left")])
        order = np.argsort(time, kind="stable")
        return Samples(time[order], time[order, None], value[order, None])

    def _means(self, begin: float) -> Samples:
        """Return means of the wave around evenly spaced times: over a round trip, or the time between two of them if it is less."""
        end = self.shown.end
        time = np.linspace(begin, end, EVEN)
        width = min(self.waves.round, (end - begin) / EVEN)
        start = np.minimum(np.maximum(time - 0.5 * width, begin), end - width)
        moment = start[:, None] + width * (np.arange(PHASES) + 0.5) / PHASES
        wave = self._left(moment)
        self._moving = self._of_means(moment, wave)
        return Samples(time, moment, wave)

    def _left(self, moment: Floats) -> Floats:
        """Return the wave that leaves the contact at times (s), Pa, each of which is looked up."""
        wave = self.waves.left_before(moment - self.first)
        inside = moment >= self.first
        wave[inside] = self.waves.leaving(self.history.find(np.minimum(moment[inside], self.history.span[1]), "right"))
        return wave

    def _of_means(self, moment: Floats, wave: Floats) -> Floats:
        """Return the mean kinetic energy (J/m^2) of each sample, whose moments (s) are spread over a round trip: see above."""
        since, left = np.maximum(moment - self.first, 0.0), moment - self.waves.round
        back = self.waves.arriving(self._left(left).ravel(), left.ravel() - self.first).reshape(moment.shape)
        load = np.where(since < self.waves.half, self.waves.first_load(since), back)
        both = load.var(axis=1) + wave.var(axis=1) + (load.mean(axis=1) + wave.mean(axis=1)) ** 2
        return np.asarray(self.waves.half * both / (8.0 * self.body.impedance))

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
        if self._moving is not None:
            return np.interp(time, self.samples.time, self._moving)
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
        power = self.samples.mean(lambda leaving, moment: waves.power(leaving, moment - self.first))
        return np.interp(time - waves.half, self.leaving.time, summed(self.leaving.time, power))
