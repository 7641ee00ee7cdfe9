"""Leaps over the swinging creep of a block: where it creeps, and how far it may leap."""

from __future__ import annotations

import math
from dataclasses import dataclass, field, replace
from functools import cached_property

import numpy as np

from stickslip.engine.creep.averaged import Strength
from stickslip.engine.creep.landing import ROUNDING_OF_NUMBER, SHORTEST_LEAP
from stickslip.engine.creep.leaping_run import LeapingRun
from stickslip.engine.creep.planner import INTERPOLATION, hermite
from stickslip.engine.creep.swing import SAFETY_OF_TERMS, CreepPlace, Swing, SwingingBlock
from stickslip.engine.state.layout import Floats
from stickslip.problem import Problem, default_event_rate

SLOWLY = 0.01
"""Largest relative change of the frequency in a radian: nearer to where creep turns dynamic each cycle is computed."""
TOUCHES = 1e-3
"""Share by which a swing may be larger than one that touches rest: it has just begun from rest, or is about to touch it."""
FIRST_STRIDE = 64.0
"""First stride, in slips of the driver in a radian of the free oscillation."""
AGREE = 1e-9
"""Largest relative difference between the angle over a stride and that over its two halves."""
CLOSE_LANDING = 1e-13
"""Share of a stride within which the place of the landing is found."""
LAG = (10.0 * math.pi) ** 1.5 / (6.0 * math.pi)
"""By this times (w'/w^2)^(3/2) the angle of a swing that touches rest lags, as a share of itself: the rest that it includes."""
MOST_ROUNDS = 30
"""Largest number of rounds of Newton's method to that place."""
BISECTIONS_OF_STRIDE = 30
"""Number of bisections that look for the largest k in a stride."""
MOST_STRIDES = 4000
"""Largest number of strides in a leap."""


@dataclass(frozen=True)
class CreepMark:
    """The creep at the end of a stride."""

    swing: Swing
    action: float  # J, J s
    time: float  # s since the leap began
    missed: float  # estimate of the error of the angle so far, rad


@dataclass(frozen=True)
class SwingLeap:
    """A leap over swinging creep: marks along it, the last of them at or beyond its end, and the whole periods in it."""

    block: SwingingBlock
    marks: list[CreepMark]
    trips: int
    direction: int
    period: float  # s
    slip: float  # m, of the contact where the leap begins, in its direction

    def at(self, time: float) -> CreepMark:
        """Return the creep at a time (s since the leap began)."""
        index = int(np.searchsorted([mark.time for mark in self.marks], time))
        before = self.marks[min(max(index - 1, 0), len(self.marks) - 2)]
        low, high = before.swing.place.slip, self.marks[min(max(index, 1), len(self.marks) - 1)].swing.place.slip
        size, slip, off = before.swing.amplitude, low, math.inf
        for _ in range(MOST_ROUNDS):
            place = self.block.at(slip)
            last, off = abs(off), (time - self.block.time(place, size)) * place.rate
            slip = min(max(slip + off, low), high)
            if abs(off) <= CLOSE_LANDING * (high - low) or abs(off) >= last:
                break
        return reached(self.block, before, slip)

    def error(self, mark: CreepMark) -> float:
        """Return the error of slip (m): at most the whole swing, and no more than the angle may be wrong by."""
        place, slip = mark.swing.place, abs(self.slip) + mark.swing.place.slip
        angle = mark.missed + abs(place.drift) + ROUNDING_OF_NUMBER * (mark.swing.angle + place.frequency * mark.time)
        return (
            mark.swing.amplitude * min(2.0, SAFETY_OF_TERMS * angle)
            + SAFETY_OF_TERMS * place.most * self.block.quickness(place) ** 2
            + ROUNDING_OF_NUMBER * slip
        )


def reached(block: SwingingBlock, before: CreepMark, slip: float) -> CreepMark:
    """Return the creep at a slip of the slow motion (m), from a mark a stride before it."""
    place = block.at(slip)
    if slip == before.swing.place.slip:
        return before
    turned = block.turns(before.swing.place.slip, slip)
    guess = block.time(place, before.swing.amplitude)
    faded = before.action * math.exp(-2.0 * min(place.fades, before.swing.place.fades) * max(guess - before.time, 0.0))
    action = min(faded, block.action(place, place.most), _least_action(block, before.swing.place, place))
    amplitude = block.amplitude(place, action)
    touches = place.most < (1.0 + TOUCHES) * amplitude and place.drift > 0.0
    lags = [max(one.drift, 0.0) ** 1.5 * LAG * turned if touches else 0.0 for one in (before.swing.place, place)]
    missed = before.missed + _missed(before.swing, place, turned) + abs(lags[1] - lags[0])
    if touches:
        missed += 4.0 * place.drift**2 * turned + place.fades / place.frequency * turned
    angle = before.swing.angle + turned - 0.5 * (lags[0] + lags[1])
    return CreepMark(Swing(place, amplitude, angle), action, block.time(place, amplitude), missed)


def _least_action(block: SwingingBlock, begin: CreepPlace, end: CreepPlace) -> float:
    """Return the action (J s) of a swing that just touches rest where k is largest between two places, if that is between them."""
    if not begin.bend > 0.0 > end.bend:
        return math.inf
    low, high = begin.slip, end.slip
    for _ in range(BISECTIONS_OF_STRIDE):
        middle = 0.5 * (low + high)
        low, high = (middle, high) if block.strength.curvature(middle) > 0.0 else (low, middle)
    top = block.at(0.5 * (low + high))
    return block.action(top, top.most)


def _missed(begin: Swing, end: CreepPlace, turned: float) -> float:
    """Return an estimate of the error of the angle (rad) in a stride: what the terms of second order may add to it."""
    place, stride = begin.place, abs(end.slip - begin.place.slip)
    drift, size = max(abs(place.drift), abs(end.drift)), begin.amplitude
    bent = max(abs(place.bend), abs(end.bend)) / min(place.stiffness, end.stiffness)
    bends = abs(end.bend - place.bend) / (stride * min(place.stiffness, end.stiffness)) if stride else 0.0
    shift = drift * drift + (bent * size) ** 2 + bends * size * size
    return turned * shift if place.swings and end.swings else math.inf


@dataclass
class SwingLeaps:
    """Find how far a block's creep may be followed: the error of slip stays below `tolerance` times the slip since the start."""

    problem: Problem
    tolerance: float
    at_end: bool = False
    """True if a longer run would leap farther."""
    slipped: float = field(init=False, default=0.0)

    @cached_property
    def fastest(self) -> float:
        """The slip rate (m/s) from which slip is an event, which no leap passes over."""
        return default_event_rate(self.problem)

    def leap(self, run: LeapingRun, most: int) -> SwingLeap | None:
        """Return a leap over at most so many periods, None if none is worth its cost."""
        self.at_end = False
        direction = int(math.copysign(1.0, self.problem.first_pull_rate))
        if most < SHORTEST_LEAP or run.count.mode != direction or not direction * run.state.rate_now > 0.0:
            return None
        block, self.slipped = self._block(run, direction), abs(float(run.state.slip_now))
        begin = block.start(direction * float(run.state.rate_now))
        if not begin.amplitude <= (1.0 + TOUCHES) * begin.place.most or not self._is_slow(block, begin.place):
            return None
        period = self.problem.round_trip_time
        action = min(block.action(begin.place, begin.amplitude), block.action(begin.place, begin.place.most))
        start = CreepMark(begin, action, block.time(begin.place, begin.amplitude), abs(begin.place.drift))
        leap = SwingLeap(
            block, self._marks(block, start, (most + 3) * period), 0, direction, period, direction * float(run.state.slip_now)
        )
        trips = min(math.floor(leap.marks[-1].time / period) - 3, most)
        self.at_end = trips == most
        while trips >= SHORTEST_LEAP:
            landing = leap.at((trips + 1) * period)
            if leap.error(landing) <= self._allowed(landing.swing.place.slip):
                return replace(leap, trips=trips)
            trips //= 2
        return None

    def _block(self, run: LeapingRun, direction: int) -> SwingingBlock:
        problem, load = self.problem, float(run.state.load_now)
        sign = direction if problem.friction.counts == "net" else 1.0
        speed, body = abs(problem.first_pull_rate), problem.body
        strength = Strength(problem, float(run.state.law_slip), sign, speed * problem.round_trip_time)
        seen = load if direction > 0 else -load - 2.0 * problem.strength
        return SwingingBlock(strength, body.inertia, body.stiffness, body.total_damping, speed, seen)

    def _allowed(self, slip: float) -> float:
        return self.tolerance * (self.slipped + abs(slip))

    def _is_slow(self, block: SwingingBlock, place: CreepPlace) -> bool:
        """Return True if the slow motion is slow, and no swing about it is a slip event."""
        if not (place.frequency > 0.0 and place.slip < block.strength.room):
            return False
        return block.quickness(place) <= SLOWLY and 2.0 * place.rate <= self.fastest

    def _marks(self, block: SwingingBlock, start: CreepMark, end: float) -> list[CreepMark]:
        """Return marks from the start on, up to a time (s) or as far as the creep is slow."""
        marks, stride = [start], FIRST_STRIDE * block.scale
        least = stride / FIRST_STRIDE
        while stride >= least and marks[-1].time < end and len(marks) < MOST_STRIDES:
            mark = self._stride(block, marks[-1], stride)
            if mark is None:
                stride *= 0.5
                continue
            marks.append(mark)
            stride *= 1.5
        return marks

    def _stride(self, block: SwingingBlock, begin: CreepMark, stride: float) -> CreepMark | None:
        """Return the mark one stride of slip (m) later, or None if it cannot be trusted."""
        first, last = begin.swing.place.slip, begin.swing.place.slip + stride
        strength = block.strength
        if not (self._is_slow(block, block.at(last)) and self._is_slow(block, block.at(0.5 * (first + last)))):
            return None
        if not strength.in_sight(first, last) or strength.falls_below_zero(first, last):
            return None
        middle, end = reached(block, begin, 0.5 * (first + last)), reached(block, begin, last)
        centre = middle.swing.place.slip
        halves, whole = block.turns(first, centre) + block.turns(centre, last), block.turns(first, last)
        if not abs(halves - whole) <= AGREE * math.sqrt(max(whole, 1.0)):
            return None
        if not begin.time < middle.time < end.time:
            return None
        return end if self._is_smooth(begin, middle, end) else None

    def _is_smooth(self, begin: CreepMark, middle: CreepMark, end: CreepMark) -> bool:
        """Return True if a cubic between two marks shows the slow motion halfway, too."""
        length, first, last = end.time - begin.time, begin.swing.place, end.swing.place
        cubic = hermite(length, last.slip - first.slip, first.rate, last.rate)
        shown = first.slip + float(cubic @ ((middle.time - begin.time) / length) ** np.arange(4))
        return abs(shown - middle.swing.place.slip) <= INTERPOLATION * self._allowed(last.slip)


def nodes_of(leap: SwingLeap) -> list[tuple[float, float, float]]:
    """Return the time (s), slip (m) and slip rate (m/s) at the ends of the averaged pieces, the last one where the swing begins.

    The first and the last slip are those of the contact; between, the slow motion stands for it.
    """
    until, apart = leap.trips * leap.period, 0.5 * leap.period
    last = leap.at(until).swing
    marks = ((m.time, m.swing.place.slip, m.swing.place.rate) for m in leap.marks)
    inside = [node for node in marks if apart < node[0] < until - apart]
    return [(0.0, 0.0, leap.marks[0].swing.place.rate), *inside, (until, last.slip, last.place.rate)]


@dataclass(frozen=True)
class LastPeriods:
    """The swing in the period on which a leap lands and in the one after it: through a few marks there, which differ little."""

    leap: SwingLeap

    @cached_property
    def _series(self) -> tuple[Floats, Floats]:
        """The coefficients of U, U', w, w'/w^2, a and theta in shares of the two periods, less their first values, and those."""
        places = 0.5 - 0.5 * np.cos(np.pi * np.arange(6) / 5.0)
        swings = [self.leap.at((self.leap.trips + 2.0 * float(place)) * self.leap.period).swing for place in places]
        values = np.array([(*(getattr(one.place, name) for name in OF_PLACE), one.amplitude, one.angle) for one in swings])
        return np.linalg.solve(np.vander(places, increasing=True), values - values[0]), values[0]

    def at(self, share: Floats) -> tuple[Floats, Floats]:
        """Return the slip (m) and the slip rate (m/s) at times since the first of these periods began (as shares of a period)."""
        grown, first = self._series
        slip, rate, w, drift, size, angle = (np.vander(0.5 * share, len(grown), increasing=True) @ grown + first).T
        sine, cosine = np.sin(angle), np.cos(angle)
        return slip - size * sine, np.maximum(rate - size * w * (cosine - 0.5 * drift * sine), 0.0)


OF_PLACE = "slip", "rate", "frequency", "drift"
"""What the last periods know of the slow motion."""


def stretches(leap: SwingLeap) -> Floats:
    """Return the ends of parts of a period (as shares of it), each at most a quarter of a cycle of the swing."""
    fastest = leap.at((leap.trips + 1) * leap.period).swing.place.frequency
    parts = max(math.ceil(fastest * leap.period / (0.5 * math.pi)), 1)
    return np.linspace(0.0, 1.0, parts + 1)
