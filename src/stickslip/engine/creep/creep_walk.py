"""The round trip on which a leap over creep lands: its load, slip rate and slip, as pieces of the history."""

from __future__ import annotations

from dataclasses import dataclass, field
from itertools import pairwise

import numpy as np

from stickslip.engine.creep.averaged import AveragedCreep, Creep
from stickslip.engine.series.polynomial import restrict
from stickslip.engine.state.layout import TERMS, Floats

GAP_OF_PARTS = 1e-12
"""Two parts of a pattern are side by side if the gap between them is within this share of the offset."""
ROUNDS_AT_BORDER = 4
"""Number of fixed-point iterations that match the strength at a border to the slip there, and the first slip to the mean slip."""


@dataclass(frozen=True)
class Piece:
    """A piece of the history, seen in the direction of slip."""

    slips: bool
    phase_from: float  # s
    speed: float
    bend: float
    slip: float  # at its start, m, counted as in `Creep`
    load: Floats  # Pa, minus the reference strength
    rate: Floats  # m/s

    @property
    def phase_to(self) -> float:
        """The offset of the end of the piece, s."""
        return self.phase_from + self.speed + self.bend

    @property
    def grown(self) -> float:
        """The slip over the piece, m."""
        powers = np.arange(1, TERMS + 1)
        return float((self.speed * self.rate / powers).sum() + (2.0 * self.bend * self.rate / (powers + 1)).sum())


@dataclass
class Walk:
    """Walk through the round trip from start to end: rest, slip that has just begun, and creep at its mean rate.

    Slip begins at rate 0 where the load has just reached the strength, and one round trip later it is twice as fast as the mean.
    After that, rates above and below the mean alternate from one round trip to the next and from place to place. Nothing depends
    on them, so the mean replaces them, and the many pieces become one. `core_from` is the offset (s) at which such full creep
    began, or None outside it.
    """

    averaged: AveragedCreep
    creep: Creep
    slip: float
    pieces: list[Piece] = field(default_factory=list)
    core_from: float | None = None

    def __post_init__(self) -> None:
        self.first, strength = self.slip, self.averaged.strength
        self.friction = strength(self.first), strength.slope(self.first), 0.5 * strength.curvature(self.first)

    def through(self) -> None:
        """Walk through all parts of the pattern."""
        parts, end = self.averaged.pattern.parts, 0.0
        for k in range(len(parts.speed)):
            if float(parts.phase_from[k]) > (1.0 + GAP_OF_PARTS) * end and self.core_from is not None:
                self._close_core(end)  # what lies between rests
            self._part(k)
            end = float(parts.phase_from[k] + parts.speed[k] + parts.bend[k])
        self._close_core(end)

    def _part(self, k: int) -> None:
        """Walk through a monotone part: rest below the strength, slip that begins just above it, full creep above that."""
        parts = self.averaged.pattern.parts
        load = parts.load[k].copy()
        load[0] += self.averaged.gain * self.creep.trips
        begin, cuts = float(parts.phase_from[k]), [0.0, 1.0]
        for _ in range(ROUNDS_AT_BORDER):  # the strength at a border depends on the slip up to it
            strength = self._strength_at(begin + self._phase(k, cuts[-2] if load[0] > load.sum() else 0.0))
            levels = (strength, strength + self.averaged.impedance * self.creep.mean_rate)
            low, high = sorted((load[0], load.sum()))
            inside = [level - (load[0] - parts.load[k, 0]) for level in levels if low < level < high]
            cuts = [0.0, *sorted(parts.crossing(k, level) for level in inside), 1.0]
        for left, right in pairwise(cuts):
            if right > left:
                self._stretch(k, load, left, right, levels)

    def _phase(self, k: int, xi: float) -> float:
        parts = self.averaged.pattern.parts
        return float(xi * (parts.speed[k] + xi * parts.bend[k]))

    def _strength_at(self, phase: float) -> float:
        """Return the strength at an offset phase (s), if the contact creeps up to there at its mean rate.

        The creep is counted from the start of the full creep under way; without one, the slip is that at the present place of the
        walk.
        """
        creeping = phase - self.core_from if self.core_from is not None else 0.0
        return self._strength(self.slip + self.creep.mean_rate * max(creeping, 0.0))

    def _strength(self, slip: float) -> float:
        """Return the friction within the round trip, to second order in the slip, which hardly grows over it."""
        grown = slip - self.first
        return self.friction[0] + grown * (self.friction[1] + grown * self.friction[2])

    def _stretch(self, k: int, load: Floats, left: float, right: float, levels: tuple[float, float]) -> None:
        """Write the interval of a part that lies between two cuts."""
        parts, width = self.averaged.pattern.parts, right - left
        part = np.empty(TERMS)
        restrict(load, left, width, part)
        middle = float(part @ 0.5 ** np.arange(TERMS))
        begin = float(parts.phase_from[k]) + self._phase(k, left)
        if middle >= levels[1]:
            self.core_from = begin if self.core_from is None else self.core_from
            return
        self._close_core(begin)
        slips, rate = middle >= levels[0], np.zeros(TERMS)
        if slips:
            rate[:] = part / self.averaged.impedance
            rate[0] -= levels[0] / self.averaged.impedance
        speed = float(parts.speed[k] + 2.0 * parts.bend[k] * left) * width
        self._keep(Piece(slips, begin, speed, float(parts.bend[k]) * width * width, self.slip, part, rate))

    def _close_core(self, end: float) -> None:
        """Write the full creep that has lasted up to `end` (s) as one piece, whose rate follows the mean as it changes."""
        if self.core_from is None:
            return
        begin, length = self.core_from, end - self.core_from
        self.core_from = None
        done = (self.slip - self.first) / self.creep.rate
        rate, load, grown = np.zeros(TERMS), np.zeros(TERMS), np.zeros(TERMS)
        rate[0] = self.creep.mean_rate + self.creep.mean_bend * (done - 0.5)
        rate[1] = self.creep.mean_bend * self.creep.mean_rate / self.creep.rate * length
        grown[1:3] = length * rate[0], 0.5 * length * rate[1]
        slope = self.friction[1] + 2.0 * self.friction[2] * (self.slip - self.first)
        load += slope * grown + self.friction[2] * np.convolve(grown, grown)[:TERMS] + self.averaged.impedance * rate
        load[0] += self._strength(self.slip)
        self._keep(Piece(True, begin, length, 0.0, self.slip, load, rate))

    def _keep(self, piece: Piece) -> None:
        self.pieces.append(piece)
        self.slip += piece.grown


def last_pieces(averaged: AveragedCreep, creep: Creep) -> list[Piece]:
    """Return the pieces of the round trip whose slips at start and end have the mean `creep.slip`."""
    first = creep.slip - 0.5 * creep.rate
    for _ in range(ROUNDS_AT_BORDER):
        walk = Walk(averaged, creep, first)
        walk.through()
        first = creep.slip - 0.5 * (walk.slip - walk.first)
    return walk.pieces
