"""The two waves in a slab, sampled finely in time: from them the pictures of slab and energy are read off by interpolation.

The exact field and energies of `stickslip.solution.observables` take a millisecond for each time. A picture needs hundreds of times
within some milliseconds, and no more digits than a screen shows.

Work and memory are bounded by what a screen shows, and not by the number of round trips. Over a time of so many that they cannot
be told apart, a sample is a mean over a round trip. The means of waves and of their squares give those of velocity, stress and
energies, also of the product of both waves: over a round trip and over the places of the slab each meets every part of the other.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from stickslip.engine import History
from stickslip.foundation.arrays import Floats
from stickslip.solution import Readings, Solution, Window, choose_interval
from stickslip.solution.observables import OfWave, Radiation, Sampled, WaveInterval, Waves, check_known, slab_of


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
SAMPLES_INSIDE = 6
"""Number of samples within each piece of the history, if there are not more than `ENDS_ONLY` pieces."""
ENDS_ONLY = 600
"""With more pieces than this, only their ends are sampled besides."""
OF_START = 500
"""Number of samples of the load that the initial state brings."""
MANY_PLACES = 300_000
"""Places between which another piece may hold; if there may be more of them in an interval, means are sampled."""
PHASES = 8
"""Number of times between two samples whose mean is a sample."""
TRIPS = 240
"""Number of round trips, among more than `EVEN`, whose means are sampled."""
NEARBY = 1e-9
"""Distance of the sample before a front from the one after it, as a share of the two-way travel time."""


@dataclass(frozen=True)
class Wave:
    """A wave (Pa, plus or minus the reference strength) at the contact against time (s)."""

    time: Floats
    value: Floats
    square: Floats
    """The square of the wave (Pa^2), or the mean of the squares where `value` is a mean."""
    of_trips: bool = False
    """True where `value` is the mean over a round trip, and samples are many round trips apart."""

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

    def over(self, begin: Floats, end: Floats, lasting: Floats | float) -> Floats:
        """Return the integral of the wave between times, Pa s; they are `lasting` apart (s), at most a round trip.

        That is given because the difference of two times is rounded, late in a long run to few digits.
        """
        return self.at(0.5 * (begin + end)) * lasting if self.of_trips else self.total(end) - self.total(begin)

    @cached_property
    def _squares(self) -> Floats:
        return summed(self.time, self.square)

    def squared(self, begin: Floats, end: Floats, lasting: float) -> Floats:
        """Return the integral of the square of the wave between such times, Pa^2 s."""
        if self.of_trips:
            return np.interp(0.5 * (begin + end), self.time, self.square) * lasting
        first, last = (np.interp(time, self.time, self._squares) for time in (begin, end))
        return np.asarray(last - first)


def summed(time: Floats, value: Floats) -> Floats:
    """Return the integral of values from the first time to each time, by the trapezoidal rule."""
    return np.append(0.0, np.cumsum(0.5 * np.diff(time) * (value[1:] + value[:-1])))


class WaveSamples(NamedTuple):
    """WaveSamples of a wave at times (s): the wave at one moment each, or the mean over several moments."""

    time: Floats
    moment: Floats
    """s, those of all samples one after the other."""
    wave: Floats
    """The wave at these moments, Pa, plus or minus the reference strength."""
    weight: Floats | None = None
    """The share of each moment in the mean; None for one moment each."""
    first: NDArray[np.intp] | None = None
    """Where the moments of each sample begin."""
    of_trips: bool = False
    """True if each sample is the mean over a round trip."""

    @classmethod
    def of_means(cls, time: Floats, means: Sequence[Sampled]) -> WaveSamples:
        """Return samples, each the mean over a round trip."""
        whole = Sampled.joined(means)
        first = np.cumsum([0, *(len(one.time) for one in means[:-1])])
        return cls(time, whole.time, whole.wave, whole.weight, first, of_trips=True)

    def mean(self, of_wave: OfWave) -> Floats:
        """Return, for each sample, a function of the wave and the moment, or the mean of that function."""
        found = of_wave(self.wave, self.moment)
        if self.weight is None or self.first is None:
            return found
        return np.asarray(np.add.reduceat(self.weight * found, self.first) / np.add.reduceat(self.weight, self.first))

    @property
    def as_wave(self) -> Wave:
        """The samples as a wave that is interpolated between them."""
        return Wave(self.time, self.mean(lambda wave, _: wave), self.mean(lambda wave, _: wave**2), self.of_trips)


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
        back = self._back(self.samples).as_wave
        self.coming = back
        if not shown.start - self.waves.round > self.first - half:
            begin = np.linspace(0.0, half * (1.0 - NEARBY), OF_START)
            known, load = self.leaving.time >= self.first - half, self.waves.first_load(begin)
            self.coming = Wave(
                np.concatenate([self.first + begin, back.time[known]]),
                np.concatenate([load, back.value[known]]),
                np.concatenate([load**2, back.square[known]]),
                back.of_trips,
            )

    def _sampled(self, begin: float) -> WaveSamples:
        """Return samples of the wave that leaves the contact, from a time on to the end of the view."""
        end, round_trip = self.shown.end, self.waves.round
        within = begin - self.first + round_trip, end - self.first + round_trip
        check_known(self.history, begin, end)
        if _many_places(self.history, begin, end) > MANY_PLACES or self.waves.inflow.many_edges(*within) > MANY_PLACES:
            return self._means(begin)
        interval, slack = WaveInterval(self.waves, begin, end), NEARBY * round_trip
        edges = self.waves.inflow.edges(*within)
        edges = edges + self.first - round_trip
        breaks = np.unique(np.append(interval.start, self.first))
        breaks = breaks[(breaks >= begin) & (breaks <= end)]
        inside = np.diff(breaks) * np.linspace(0.0, 1.0, SAMPLES_INSIDE + 2)[1:-1, None] + breaks[:-1]
        inner = np.ravel(inside) if len(breaks) <= ENDS_ONLY else breaks[:0]
        right = np.concatenate([np.linspace(begin, end, EVEN), breaks, inner, edges - slack, edges + slack])
        time = np.concatenate([right, breaks - slack])
        value = np.concatenate([interval.leaving(right, "right"), interval.leaving(breaks, "left")])
        order = np.argsort(time, kind="stable")
        return WaveSamples(time[order], time[order], value[order])

    def _means(self, begin: float) -> WaveSamples:
        """Return means of the wave from a time on: over round trips here and there, or where there are few, over short times."""
        lasting = self.shown.end - begin
        if lasting > EVEN * self.waves.round:
            return self._means_of_trips(begin)
        time, width = np.linspace(begin, self.shown.end, EVEN), lasting / EVEN
        start = np.clip(time - 0.5 * width, begin, self.shown.end - width)
        moment = np.ravel(start[:, None] + width * (np.arange(PHASES) + 0.5) / PHASES)
        wave, inside = self.waves.left_before(moment - self.first), moment >= self.first
        wave[inside] = self.waves.leaving(self.history.find(np.minimum(moment[inside], self.history.span[1]), "right"))
        return WaveSamples(time, moment, wave, np.ones(len(moment)), np.arange(0, len(moment), PHASES))

    def _means_of_trips(self, begin: float) -> WaveSamples:
        """Return the means of the wave over round trips, and note their mean kinetic energies."""
        epoch, round_trip = self.history.epoch, self.waves.round
        past = [epoch.trip + int((time + epoch.offset) // round_trip) for time in (max(begin, self.first), self.shown.end)]
        trips = np.unique(np.linspace(past[0] + 1, past[1] - 1, TRIPS).astype(np.int64)).tolist()
        before, own = ([self.waves.in_trip(trip - back, 0.0, round_trip, epoch) for trip in trips] for back in (1, 0))
        time = self.history.seconds(np.array(trips), np.full(len(trips), 0.5 * round_trip))
        time[0], time[-1] = begin, self.shown.end  # what is shown begins and ends there
        found, load = WaveSamples.of_means(time, own), self._back(WaveSamples.of_means(time - round_trip, before)).as_wave
        leaving = found.as_wave
        varying = load.square - load.value**2 + leaving.square - leaving.value**2
        both = np.maximum(varying, 0.0) + (load.value + leaving.value) ** 2
        self._moving = self.waves.half * both / (8.0 * self.body.impedance)
        return found

    def _back(self, left: WaveSamples) -> WaveSamples:
        """Return the loads, minus the reference, that waves which left the contact bring back."""
        came = self.waves.arriving(left.wave, left.moment - self.first)
        return left._replace(time=left.time + self.waves.round, wave=came)

    def velocity_and_stress(self, begin: Floats, end: Floats, place: Floats) -> tuple[Floats, Floats]:
        """Return the means of velocity (m/s) and shear stress (Pa) between times, at places (m from the contact) that broadcast."""
        away = place / self.body.wave_speed
        coming, leaving = self.coming.mean(begin + away, end + away), self.leaving.mean(begin - away, end - away)
        return (coming + leaving) / (2.0 * self.body.impedance), self.waves.reference + 0.5 * (coming - leaving)

    def displacement(self, time: Floats, place: Floats, at_contact: Floats) -> Floats:
        """Return the displacement (m) at times and places that broadcast, from the slip of the contact at these times."""
        away = place / self.body.wave_speed
        come, left = self.coming.over(time, time + away, away), self.leaving.over(time - away, time, away)
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
        come, left = self.coming.over(time, time + half, half), self.leaving.over(time - half, time, half)
        return (self._squares(time) + 2.0 * self.waves.reference * (come - left)) / (4.0 * self.body.impedance)

    def _squares(self, time: Floats) -> Floats:
        """Return the integral of the squares of both waves over the slab at times, Pa^2 s."""
        half = self.waves.half
        return self.coming.squared(time, time + half, half) + self.leaving.squared(time - half, time, half)

    def work(self, time: Floats) -> Floats:
        """Return the work of the driver up to times (J/m^2, up to a constant), net of radiation."""
        return self._of_driver(self.waves, time)

    def radiated(self, time: Floats) -> Floats:
        """Return the energy radiated through the driver up to times (J/m^2, up to a constant)."""
        return self._of_driver(self.radiation, time)

    def _of_driver(self, waves: Waves, time: Floats) -> Floats:
        power = self.samples.mean(lambda leaving, moment: waves.power(leaving, moment - self.first))
        return np.interp(time - waves.half, self.leaving.time, summed(self.leaving.time, power))


def _many_places(history: History, low: float, high: float) -> float:
    """Return how often, at most, another piece may begin to hold between two times (s): see `WaveInterval`."""
    pieces = int(np.searchsorted(history.start, high, side="right"))
    return (1.0 + 2.0 * pieces) * (2.0 + (high - low) / history.round_trip_time)
