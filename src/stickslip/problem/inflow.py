"""Inflow: what a driver adds to the load at the contact. For tables and observables; the engine has its own `varying_forcing`.

The load of a slab is beta(t) = r w(t - R) + F(t). The inflow is F(t) = 2 Z [Zd V + s] / (Z + Zd) at t - h/c, or 2 Z V(t - h/c)
for a rigid driver, less (1 + r) times the reference strength, because all loads are differences from it. In terms of r it is
Z (1 - r) V + (1 + r) (s - reference), with the r of the driver that the wave has met. The load of a block grows by K V(t) per
second, less the mass times the jerk of the ground. What moving ground adds to the load of a slab is in `shaking`.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from stickslip.foundation.arrays import Floats
from stickslip.foundation.constants import RIGID
from stickslip.problem.loading_history import SILENT, Tone


@dataclass(frozen=True, eq=False)
class Inflow:
    """Straight segments, each with the time (s) of its arrival, plus a tone. Slab: Pa; block: N/s.

    A segment has a reflection coefficient of the driver, too, and a factor of the tone.
    """

    start: Floats
    value: Floats
    slope: Floats
    tone: Tone
    round_trip_time: float
    reflection: Floats  # 1; 0 of a block
    gain: Floats  # 1, but for a tone that passes through a driver that changes

    def at(self, time: Floats, seen: Floats | None = None) -> Floats:
        """Return F at times (s since the start of the run), in the segments that hold at the times `seen`, by default the same.

        At a jump it is the right limit.
        """
        n = self.segment(time if seen is None else seen)
        straight = self.value[n] + self.slope[n] * (time - self.start[n])
        return straight if self.tone is SILENT else np.asarray(straight + self.gain[n] * self._swing(time))

    def reflection_at(self, time: Floats) -> Floats:
        """Return the factor (1) of the echo that arrives at times (s since the start of the run); at a jump, the right limit."""
        return self.reflection[self.segment(time)]

    def total(self, low: Floats, high: Floats) -> Floats:
        """Return the integral of F between times (s)."""
        first, last, middle = self.segment(low), self.segment(high), 0.5 * (low + high)
        inside = (high - low) * (self.value[first] + self.slope[first] * (middle - self.start[first]))
        straight = np.where(first == last, inside, self._up_to(last, high) - self._up_to(first, low))
        if self.tone is SILENT:
            return straight
        swings = self._swung(low, high)
        if np.ptp(self.gain) == 0.0:
            return np.asarray(straight + self.gain[0] * swings)
        starts = self.start[1:]
        whole = np.append(0.0, np.cumsum(self.gain[:-1] * self._swung(self.start[:-1], starts)))
        begun, ended = (whole[n] + self.gain[n] * self._swung(self.start[n], t) for n, t in ((first, low), (last, high)))
        return np.asarray(straight + np.where(first == last, self.gain[first] * swings, ended - begun))

    def gathered(self, trip: Floats, offset: Floats, trips: Floats) -> Floats:
        """Return the growth of a load at rest over the given number of whole round trips, while only the tone changes.

        It is the sum of F over these round trips: their number times the mean of F, with Dirichlet's kernel for the tone.
        """
        time = trip * self.round_trip_time + offset
        n = self.segment((trip + 1.0) * self.round_trip_time)
        rigid = self.reflection[n] == RIGID
        if not rigid.any():
            return np.zeros(len(trips))
        middle = time + 0.5 * (trips + 1.0) * self.round_trip_time
        straight = trips * (self.value[n] + self.slope[n] * (middle - self.start[n]))
        if self.tone is not SILENT:
            straight = straight + self.gain[n] * self._summed(trips) * self._swing(middle)
        return np.where(rigid, straight, 0.0)

    def breaks(self) -> list[tuple[int, float]]:
        """Return the round trips and offsets (s) where segments begin; an edge between two round trips is offset 0 of the later."""
        return breaks_of(self.start, self.round_trip_time)

    def edges(self, low: float, high: float) -> Floats:
        """Return the times (s) between two others when segments arrive or a tone has turned by about 1 rad."""
        turns = math.floor(self._turns(high - low))
        inside = self.start[(self.start > low) & (self.start < high)]
        return np.unique(np.concatenate([inside, np.linspace(low, high, turns + 2)[1:-1]])) if turns else inside

    def many_edges(self, low: float, high: float) -> float:
        """Return the number of times that `edges` returns, at most."""
        return len(self.start) + 1.0 + self._turns(high - low)

    def _turns(self, lasting: float) -> float:
        """Return the number of times that the tone turns by 1 rad in a time (s)."""
        return lasting * self.tone.frequency if self.tone.amplitude != 0.0 else 0.0

    def segment(self, time: Floats) -> NDArray[np.intp]:
        """Return the segment that has arrived at each time (s)."""
        return np.maximum(np.searchsorted(self.start, time, side="right") - 1, 0)

    def _up_to(self, n: NDArray[np.intp], time: Floats) -> Floats:
        lasting = np.diff(self.start)
        whole = np.append(0.0, np.cumsum(lasting * (self.value[:-1] + 0.5 * self.slope[:-1] * lasting)))
        since = time - self.start[n]
        return np.asarray(whole[n] + since * (self.value[n] + 0.5 * self.slope[n] * since))

    def _summed(self, trips: Floats) -> Floats:
        """Return the sum of the tone over the given number of round trips, divided by the tone at their mean time."""
        from stickslip.foundation.phasors import dirichlet  # compiled, which `stickslip check` does without

        return np.array([dirichlet(count, self.tone.frequency * self.round_trip_time) for count in trips.tolist()])

    def _swung(self, low: Floats, high: Floats) -> Floats:
        """Return the integral of the tone between times (s)."""
        frequency = self.tone.frequency
        return np.asarray(2.0 / frequency * np.sin(0.5 * frequency * (high - low)) * self._swing(0.5 * (low + high)))

    def _swing(self, time: Floats) -> Floats:
        return np.asarray(self.tone.amplitude * np.sin(self.tone.frequency * time + self.tone.phase))


EDGE = 1e-13
"""Distance from the edge of a round trip, as a share of it, within which a break lies on the edge."""


def breaks_of(start: Floats, round_trip_time: float, joined: bool = False) -> list[tuple[int, float]]:
    """Return the round trips and offsets (s) of times (s); an edge between two round trips is offset 0 of the later.

    If `joined`, offsets that differ by rounding become one, so that breaks that come in every round trip cut it at one place.
    """
    trips = np.floor(start / round_trip_time)
    offsets = start - trips * round_trip_time
    rounding = max(EDGE * round_trip_time, 8.0 * float(np.spacing(start[-1]))) if joined else EDGE * round_trip_time
    late, early = offsets > round_trip_time - rounding, offsets < rounding
    offsets[late | early] = 0.0
    if joined:
        order = np.argsort(offsets, kind="stable")
        ranked = offsets[order]
        first = np.append(True, np.diff(ranked) > rounding)
        offsets[order] = ranked[first][np.cumsum(first) - 1]
    return list(zip((trips + late).astype(int).tolist(), offsets.tolist(), strict=True))
