"""The load of one round trip as a function of the offset in it, and how much of it lies above a level."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from stickslip.engine.series.polynomial import MOST_CROSSINGS, crossings, restrict
from stickslip.engine.state.layout import TERMS, Floats
from stickslip.trajectory.series import horner

SMALLEST = 1e-300
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
    slope, places, spare = np.zeros(TERMS), np.empty(MOST_CROSSINGS), np.empty(TERMS)
    rows: list[tuple[Floats, float, float, float]] = []
    for p, start, a, b in zip(load, phase_from, speed, bend, strict=True):
        slope[:-1] = p[1:] * np.arange(1, TERMS)
        cuts = [0.0, *places[: crossings(slope, places, spare)].tolist(), 1.0]
        for left, right in pairwise(cuts):
            part, width = np.empty(TERMS), right - left
            restrict(p, left, width, part)
            rows.append((part, start + left * (a + left * b), (a + 2.0 * b * left) * width, b * width * width))
    return Parts(*(np.array(column) for column in zip(*rows, strict=True)))


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
        part, xi, rises = self._crossings(-lift)
        areas, lengths = self._shares(lift, part, xi, rises)
        length, before = float(lengths.sum()), np.cumsum(lengths)
        steep = 1.0 / np.maximum(np.abs(self.parts.slope(part, xi)), SMALLEST)
        place = np.clip((before[part] - lengths[part] * rises) / max(length, SMALLEST), 0.0, 1.0)
        return Above(float(areas.sum()), length, float(steep.sum()), float((steep * (place - 0.5) ** 2).sum()))

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
