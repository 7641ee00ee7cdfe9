"""The normal load along finished steps, at points and on discs around them, from the problem alone.

A law under a normal load that varies takes p = S(t) / S(0) - 1 and its rate of change as states (`friction.pressed`). The engine
keeps their series with each step. A proof that read S(t) from there would agree with whatever stands there, so it puts in the
history of the normal load that the user gave, at the times of the step.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from stickslip.engine import History
from stickslip.foundation.arrays import Floats
from stickslip.friction.formula import Disc
from stickslip.problem import LoadingHistory

OF_TIME = 4e-16
"""Rounding of a time (1), a product and a sum of numbers that are rounded themselves, relative to it."""
OF_GROWTH = 1e-15
"""Rounding of the growth of the normal load (1), relative to the sum of the sizes of its terms."""
AT_A_BREAK = 1e-12
"""A time is at a break of the loading if it is no further from it than this share (1) of the round trip, or of itself."""


class NormalLoads(NamedTuple):
    """The growth of the normal load in some steps, in the segment of its history that holds in each: columns, a row for each step.

    Within a step the time is that of its start plus speed xi + bend xi^2.
    """

    begins: Floats  # s since the start of the run
    speed: Floats  # s
    bend: Floats  # s
    since: Floats  # s: where the segment begins
    value: Floats  # 1: growth there, but for the tone
    slope: Floats  # 1/s
    apart: Floats  # 1: how far from these the lines of other segments are at most that hold in a part of the step, too
    slopes_apart: Floats  # 1/s: and how far their slopes
    tone: tuple[float, float, float]  # amplitude (1), frequency (rad/s), phase (rad)

    @classmethod
    def of(cls, history: History, n: NDArray[np.intp]) -> NormalLoads:
        """Return the normal load in pieces n of a history whose problem has one that varies."""
        load, store, normal = history.problem.normal_load, history.store, history.problem.normal
        assert load is not None
        begins = store.trip[n] * history.round_trip_time + store.phase_from[n]
        start, value, slope = load.parts
        of = segment_of(load, history, n)
        amplitude, frequency, phase = load.tone
        apart, slopes = _others(load, history, n, of)
        columns = (begins, store.speed[n], store.bend[n], start[of], (value[of] - normal) / normal, slope[of] / normal)
        own = (np.asarray(one, float)[:, None] for one in (*columns, apart / normal, slopes / normal))
        return cls(*own, (amplitude / normal, frequency, phase))  # type: ignore[arg-type, call-arg] # eight columns and a tone

    def at(self, xi: Floats) -> list[Disc]:
        """Return p and its rate of change (1/s) at places xi in each step, with a radius for rounding."""
        local = xi * (self.speed + xi * self.bend)
        return self._discs(local, OF_TIME * (np.abs(self.begins) + np.abs(local)))

    def around_middle(self, radii: Floats) -> list[Disc]:
        """Return p and its rate of change (1/s) on discs of these radii around the middle of each step, in its lengths."""
        local = 0.5 * self.speed + 0.25 * self.bend
        reach = np.abs(self.speed + self.bend) * radii + np.abs(self.bend) * radii**2
        return self._discs(local, reach + OF_TIME * (np.abs(self.begins) + np.abs(local) + reach))

    def _discs(self, local: Floats, reach: Floats) -> list[Disc]:
        """Return p and its rate of change while the time is within `reach` (s) of `local` (s) after the start of the step.

        For the sine of a complex angle, |sin(a + b) - sin a| <= |sin a| (cosh |b| - 1) + |cos a| sinh |b|.
        """
        amplitude, frequency, phase = self.tone
        passed = (self.begins - self.since) + local
        straight = self.value + self.slope * passed
        angle = frequency * (self.begins + local) + phase
        sine, cosine, turned = np.sin(angle), np.cos(angle), frequency * reach
        with np.errstate(over="ignore", invalid="ignore"):  # a disc over which the tone turns often says nothing
            wide, high = (abs(amplitude) * one for one in (np.sinh(turned), 2.0 * np.sinh(0.5 * turned) ** 2))
            moved = np.abs(self.slope) * reach + np.abs(sine) * high + np.abs(cosine) * wide
            bent = frequency * (np.abs(cosine) * high + np.abs(sine) * wide)
        size = np.abs(self.value) + np.abs(self.slope * passed) + abs(amplitude) * (1.0 + np.abs(angle) * OF_TIME)
        growth, rate = straight + amplitude * sine, self.slope + amplitude * frequency * cosine
        rounding = OF_GROWTH * (np.abs(self.slope) + abs(amplitude) * frequency)
        reached = moved + OF_GROWTH * (1.0 + size) + self.apart
        return [Disc.of(growth, reached), Disc.of(rate, bent + rounding + self.slopes_apart)]


PLACES_IN_STEP = np.linspace(0.0, 1.0, 9)
"""Places (1) in a step where what the engine wrote of the normal load is compared with what was given."""


def missed_growth(history: History, n: NDArray[np.intp]) -> Floats:
    """Return how far (1) the normal load that a history has in its pieces n is at most from the one that was given, relatively.

    It is looked at in PLACES_IN_STEP only, and is 0 if it lies within the rounding of the given one.
    """
    assert history.problem.normal_load is not None
    lowest = history.problem.normal_load.lowest / history.problem.normal
    first = len(history.problem.friction.states)
    known = history.store.state[n, first] @ PLACES_IN_STEP ** np.arange(history.store.state.shape[2])[:, None]
    given, _ = NormalLoads.of(history, n).at(PLACES_IN_STEP)
    return np.asarray(np.maximum(np.abs(known - given.centre) - given.radius, 0.0).max(axis=1, initial=0.0) / lowest)


def near_break(history: History, time: Floats) -> Floats:
    """Return how near (s) to a break of the loading times may be to be at it."""
    return np.asarray(AT_A_BREAK * np.maximum(history.round_trip_time, np.abs(time)))


def _others(load: LoadingHistory, history: History, n: NDArray[np.intp], of: NDArray[np.intp]) -> tuple[Floats, Floats]:
    """Return how far the lines, and the slopes, of further segments are from those of segments `of` in pieces n of a history.

    The engine cuts pieces where segments begin. A piece that nevertheless holds the start of a segment is in the wrong place.
    """
    store, (start, value, slope) = history.store, load.parts
    begins = store.trip[n] * history.round_trip_time + store.phase_from[n]
    ends = begins + store.speed[n] + store.bend[n]
    near = near_break(history, ends)
    first, last = (np.maximum(np.searchsorted(start, time, side="right") - 1, 0) for time in (begins + near, ends - near))
    apart, slopes = np.zeros(len(n)), np.zeros(len(n))
    for k in np.flatnonzero(last > first).tolist():
        times, others = np.array([begins[k], ends[k]]), np.arange(first[k], last[k] + 1)[:, None]
        lines = value[others] + slope[others] * (times - start[others])
        own = value[of[k]] + slope[of[k]] * (times - start[of[k]])
        apart[k], slopes[k] = np.abs(lines - own).max(), np.abs(slope[others] - slope[of[k]]).max()
    return apart, slopes


def segment_of(load: LoadingHistory, history: History, n: NDArray[np.intp]) -> NDArray[np.intp]:
    """Return the segment of a loading that holds in each of some pieces of a history.

    The engine cuts pieces where segments begin. Where rounding hides on which side of a break a very short piece lies, it is in the
    segment whose growth of the normal load it has.
    """
    store = history.store
    start, value, slope = load.parts
    middle = store.trip[n] * history.round_trip_time + store.phase_from[n] + 0.5 * store.speed[n] + 0.25 * store.bend[n]
    near = near_break(history, middle)
    early, late = (np.maximum(np.searchsorted(start, middle + by, side="right") - 1, 0) for by in (-near, near))
    found = np.maximum(np.searchsorted(start, middle, side="right") - 1, 0)
    for k in np.flatnonzero(early != late).tolist():
        either = np.arange(early[k], late[k] + 1)
        swing = load.tone.amplitude * np.sin(load.tone.frequency * middle[k] + load.tone.phase)
        grown = (value[either] + slope[either] * (middle[k] - start[either]) + swing) / history.problem.normal - 1.0
        kept = store.state[n[k], len(history.problem.friction.states), 0]
        found[k] = either[np.argmin(np.abs(grown - kept))]
    return np.asarray(found)
