"""The load of one round trip as a function of the offset in it, and how much of it lies above a level."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from stickslip.engine.history.series import horner
from stickslip.engine.series.polynomial import MOST_CROSSINGS, crossings, restrict, total
from stickslip.engine.state.layout import TERMS, Floats
from stickslip.foundation.arrays import Floats1, Floats2
from stickslip.foundation.kernels.kernels import entry, kernel
from stickslip.foundation.kernels.memory.addresses import room_for

SMALLEST_DIVISOR = 1e-300
"""Smallest divisor: it keeps a division by zero from occurring."""


SLIVER, MOST_SLIVERS = 1e-9, 100
"""Widest sliver, as a share of the round trip, and how many of them may lie side by side."""


@dataclass(frozen=True)
class Parts:
    """Monotone parts of a load: polynomials in xi on [0, 1]; the phase is phase_from + speed xi + bend xi^2."""

    load: Floats  # (n, TERMS), Pa
    phase_from: Floats  # s
    speed: Floats
    bend: Floats

    def phase(self, part: NDArray[np.intp], xi: Floats) -> Floats:
        """Return the offset of places in parts, s."""
        return np.asarray(self.phase_from[part] + xi * (self.speed[part] + xi * self.bend[part]))

    def pace(self, part: NDArray[np.intp], xi: Floats) -> Floats:
        """Return d phase / d xi, s."""
        return np.asarray(self.speed[part] + 2.0 * xi * self.bend[part])

    def integral(self, part: NDArray[np.intp], xi: Floats) -> Floats:
        """Return the integral of the load over the phase from the start of each part up to xi, Pa s."""
        powers = np.arange(1, TERMS + 1)
        straight, bent = (
            self.speed[part, None] * self.load[part] / powers,
            2.0 * self.bend[part, None] * self.load[part] / (powers + 1),
        )
        return np.asarray(xi * (horner(straight, xi) + xi * horner(bent, xi)))

    def slope(self, part: NDArray[np.intp], xi: Floats) -> Floats:
        """Return d load / d phase, Pa/s."""
        return np.asarray(horner(self.load[part, 1:] * np.arange(1, TERMS), xi) / self.pace(part, xi))

    def crossing(self, part: int, level: float) -> float:
        """Return the place in [0, 1] at which a part that straddles a level (Pa) crosses it."""
        shifted, places = self.load[part].copy(), np.empty(MOST_CROSSINGS)
        shifted[0] -= level
        if crossings(shifted, places, np.empty(TERMS)):
            return float(places[0])
        return float(abs(shifted.sum()) < abs(shifted[0]))  # at an end, within rounding


def monotone_parts(load: Floats, phase_from: Floats, speed: Floats, bend: Floats) -> Parts:
    """Cut the pieces of a load at their extrema."""
    room, count = 2 * len(load) + 64, NO_ROOM
    given, loads = np.array([phase_from, speed, bend], float), np.ascontiguousarray(load)
    while count == NO_ROOM:
        cut, shape = np.zeros((room, TERMS)), np.zeros((room, 3))
        count = cut_at_extrema(loads, given, cut, shape)
        room *= 2
    return Parts(cut[:count], *np.ascontiguousarray(shape[:count].T))


NO_ROOM = -1
"""Says that a pattern has more monotone parts than there is room for."""


@entry
def cut_at_extrema(load: Floats2, given: Floats2, cut: Floats2, shape: Floats2) -> int:
    """Write the monotone parts of the pieces of a load into `cut`, and their phase, speed and bend into rows of `shape`.

    Those of the pieces are the rows of `given`. Returns the number of parts.
    """
    slope, places, spare, count = room_for(TERMS), room_for(MOST_CROSSINGS), room_for(TERMS), 0
    slope[TERMS - 1] = 0.0
    for n in range(len(load)):
        for k in range(1, TERMS):
            slope[k - 1] = k * load[n, k]
        found = crossings(slope, places, spare)
        if count + found + 1 > len(cut):
            return NO_ROOM
        left, a, b = 0.0, given[1, n], given[2, n]
        for m in range(found + 1):
            right = places[m] if m < found else 1.0
            width = right - left
            restrict(load[n], left, width, cut[count])
            shape[count, 0] = given[0, n] + left * (a + left * b)
            shape[count, 1], shape[count, 2] = (a + 2.0 * b * left) * width, b * width * width
            left, count = right, count + 1
    return count


@kernel
def area_up_to(load: Floats, speed: float, bend: float, xi: float) -> float:
    """Return the integral of a part of a load over the phase from its start up to the place xi (Pa s)."""
    straight = bent = 0.0
    for k in range(TERMS - 1, -1, -1):
        straight = straight * xi + speed * load[k] / (k + 1)
        bent = bent * xi + 2.0 * bend * load[k] / (k + 2)
    return xi * (straight + xi * bent)


@entry
def part_above(load: Floats2, shape: Floats2, ends: Floats2, lift: float, out: Floats1) -> None:
    """Write into the first four entries of `out` the numbers of `Above`, for a load that is lifted by `lift` (Pa).

    `shape` has phase, speed and bend of each part in its rows, `ends` its lowest and highest load, its integral and its length.
    The rest of `out` is room for two numbers of each part that crosses the level.
    """
    shifted, places, spare = room_for(TERMS), room_for(MOST_CROSSINGS), room_for(TERMS)
    area, length, crossed = 0.0, 0.0, 0
    for n in range(len(load)):
        low, high, speed, bend = ends[0, n], ends[1, n], shape[1, n], shape[2, n]
        if low >= -lift:
            area, length = area + ends[2, n], length + ends[3, n]
        elif high > -lift:
            for k in range(TERMS):
                shifted[k] = load[n, k]
            shifted[0] += lift
            rises = total(shifted) > shifted[0]
            xi = 1.0 if abs(total(shifted)) < abs(shifted[0]) else 0.0  # at an end, within rounding
            if crossings(shifted, places, spare) > 0:
                xi = places[0]
            covered, time = area_up_to(load[n], speed, bend, xi), xi * (speed + xi * bend)
            own = ends[3, n] - time if rises else time
            area += ends[2, n] - covered if rises else covered
            length += own
            steep = 0.0
            for k in range(TERMS - 1, 0, -1):
                steep = steep * xi + k * load[n, k]
            out[4 + 2 * crossed] = 1.0 / max(abs(steep / (speed + 2.0 * xi * bend)), SMALLEST_DIVISOR)
            out[5 + 2 * crossed] = length - own if rises else length  # what slips before this border
            crossed += 1
    out[0], out[1], out[2], out[3] = area + lift * length, length, 0.0, 0.0
    for n in range(crossed):
        place = min(max(out[5 + 2 * n] / max(length, SMALLEST_DIVISOR), 0.0), 1.0)
        out[2] += out[4 + 2 * n]
        out[3] += out[4 + 2 * n] * (place - 0.5) ** 2


@dataclass(frozen=True)
class Above:
    """The part of a load, lifted by a given amount, that lies above zero."""

    area: float  # integral over the phase of the part above zero, Pa s
    length: float  # measure of the offsets above zero, s: d area / d lift
    border: float  # sum over the borders of that part of 1 / |d load / d phase|, s/Pa: d length / d lift
    spread: float  # the same sum, weighted with the squared distance from the middle of the part above zero (1/4 at its ends)


@dataclass(frozen=True)
class Pattern:
    """The load of one round trip (Pa) in monotone parts."""

    parts: Parts

    @cached_property
    def ends(self) -> Floats:
        """The lowest and the highest load of each part, shape (2, parts)."""
        ends = np.stack([self.parts.load[:, 0], self.parts.load.sum(axis=1)])
        return np.stack([ends.min(axis=0), ends.max(axis=0)])

    @cached_property
    def whole(self) -> Floats:
        """The integral over the phase of each part, Pa s."""
        return self.parts.integral(np.arange(len(self.parts.speed)), np.ones(len(self.parts.speed)))

    @cached_property
    def width(self) -> Floats:
        """The length of each part, s."""
        return np.asarray(self.parts.speed + self.parts.bend)

    def _row(self, ends: Floats) -> NDArray[np.intp]:
        """Return the number of the stretch, of those that end at `ends` (s), in which each part lies."""
        return np.searchsorted(ends, self.parts.phase_from + 0.5 * self.width)

    def rows_above(self, level: float, ends: Floats) -> NDArray[np.bool_]:
        """Return True for stretches of the round trip, which end at `ends` (s), that reach above a level (Pa) somewhere.

        Slivers beside them are taken, too.
        """
        found = np.zeros(len(ends), bool)
        found[self._row(ends)[self.ends[1] > level]] = True
        narrow = np.diff(ends, prepend=0.0) < SLIVER * ends[-1]
        for _ in range(int(narrow.any()) * MOST_SLIVERS):
            beside = narrow & ~found & (np.append(found[1:], False) | np.append(False, found[:-1]))
            if not beside.any():
                break
            found |= beside
        return found

    def of_rows(self, which: NDArray[np.bool_], ends: Floats) -> Pattern:
        """Return the parts in some of these stretches."""
        kept, parts = which[self._row(ends)], self.parts
        return Pattern(Parts(parts.load[kept], parts.phase_from[kept], parts.speed[kept], parts.bend[kept]))

    def above(self, lift: float) -> Above:
        """Return the part of the load that lies above zero when the load is lifted by `lift` (Pa)."""
        shape, ends, out = self._for_kernel
        part_above(self.parts.load, shape, ends, lift, out)
        return Above(*out[:4].tolist())

    @cached_property
    def _for_kernel(self) -> tuple[Floats, Floats, Floats]:
        """The tables that `part_above` takes."""
        parts = self.parts
        shape, ends = np.array([parts.phase_from, parts.speed, parts.bend]), np.array([*self.ends, self.whole, self.width])
        return shape, ends, np.empty(4 + 2 * len(parts.speed))

    def shares(self, lift: float) -> tuple[Floats, Floats]:
        """Return the area (Pa s) and length (s) above zero of each part, when the load is lifted by `lift` (Pa)."""
        return self._shares(lift, *self._crossings(-lift))

    def _shares(self, lift: float, part: NDArray[np.intp], xi: Floats, rises: NDArray[np.bool_]) -> tuple[Floats, Floats]:
        """Return the same as `shares`, from crossings that are known."""
        inside = self.ends[0] >= -lift
        areas, lengths = self.whole * inside, self.width * inside
        covered, time = self.parts.integral(part, xi), self.parts.phase(part, xi) - self.parts.phase_from[part]
        areas[part] = np.where(rises, self.whole[part] - covered, covered)
        lengths[part] = np.where(rises, self.width[part] - time, time)
        return areas + lift * lengths, lengths

    def _crossings(self, level: float) -> tuple[NDArray[np.intp], Floats, NDArray[np.bool_]]:
        """Return the parts that cross a level (Pa), the places of the crossings, and True for those that cross it upwards."""
        low, high = self.ends
        part = np.flatnonzero((low < level) & (high > level))
        xi = np.array([self.parts.crossing(k, level) for k in part.tolist()])
        return part, xi, self.parts.load[part].sum(axis=1) > self.parts.load[part, 0]
