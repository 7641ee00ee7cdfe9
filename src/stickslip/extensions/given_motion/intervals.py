"""A given motion in intervals: in each, slip rate and normal load are smooth, and slip goes in one direction or rests."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from stickslip.extensions.given_motion.compiled import along_motion as at
from stickslip.foundation.arrays import Floats
from stickslip.foundation.errors import InputError
from stickslip.friction import FrictionLaw
from stickslip.problem import LoadingHistory

Places = NDArray[np.int64]
"""Numbers of intervals."""
MOST_INTERVALS = 2_000_000
"""Largest number of intervals of a motion."""
HALVINGS = 80
"""A place where the slip rate passes through 0 is halved in so many times, down to rounding."""
SAME_TIME = 4e-16
"""Two places in time whose distance is below this share (1) of them are one."""


@dataclass(frozen=True, eq=False)
class SmoothPart:
    """The smooth part of a history in each interval: a value and a slope at its start, and a sinusoid with its phase there."""

    value: Floats
    slope: Floats
    tone: float
    frequency: float
    phase: Floats

    @classmethod
    def of(cls, history: LoadingHistory, start: Floats) -> SmoothPart:
        """Return the parts of a history in intervals with these starts (s)."""
        begins, value, slope = history.parts
        n = np.maximum(np.searchsorted(begins, start, side="right") - 1, 0)
        amplitude, frequency, phase = history.tone
        found = np.mod(frequency * start + phase, 2.0 * math.pi)
        return cls(value[n] + slope[n] * (start - begins[n]), slope[n], amplitude, frequency, found)

    def at(self, n: Places, time: Any) -> Floats:
        """Return the values in intervals n at times (s) since their starts."""
        waves = self.tone * np.sin(self.frequency * time + self.phase[n]) if self.tone else 0.0
        return np.asarray(self.value[n] + self.slope[n] * time + waves)

    def integral(self, n: Places, time: Any) -> Floats:
        """Return the integrals of the values from the starts of intervals n to times (s) since then."""
        found = time * (self.value[n] + 0.5 * self.slope[n] * time)
        if self.tone:
            half = 0.5 * self.frequency * time
            found = found + 2.0 * self.tone * np.sin(half) * np.sin(self.phase[n] + half) / self.frequency
        return np.asarray(found)


@dataclass(frozen=True, eq=False)
class MotionInIntervals:
    """A motion in intervals: their starts and lengths (s), what moves and presses in each, and slip at each start (m)."""

    start: Floats
    lasting: Floats
    rate: SmoothPart
    load: SmoothPart
    direction: Floats
    """1 or -1 where the contact slips, 0 where it rests."""
    facing: Floats
    """The direction that counts for states that reverse: that of slip, at rest that of the last slip, at first forward."""
    slip: Floats
    """Net slip (m) at the start of each interval."""
    counted: Floats
    """Slip (m) at the start of each interval, as the law counts it."""
    counts: Floats
    """Change of the counted slip per net slip: 1, -1 backwards along a path, 0 where rest has set it back."""

    @classmethod
    def of(cls, rate: LoadingHistory, load: LoadingHistory, law: FrictionLaw, duration: float, slip: float) -> MotionInIntervals:
        """Divide the motion of a contact into intervals. Raises InputError if there are too many."""
        start = _starts(rate, load, duration)
        lasting = np.diff(np.append(start, duration))
        moving, pressing = SmoothPart.of(rate, start), SmoothPart.of(load, start)
        every = np.arange(len(start))
        middle = moving.at(every, 0.5 * lasting)
        ends = np.maximum(abs(moving.at(every, 0.0 * lasting)), abs(moving.at(every, lasting)))
        rests = (middle == 0.0) & (ends == 0.0) & (moving.slope == 0.0) & (moving.tone == 0.0)
        direction = np.where(rests, 0.0, np.sign(middle))
        last = np.maximum.accumulate(np.where(direction != 0.0, every, -1))
        facing = np.where(last < 0, 1.0, direction[last])
        moved = np.where(rests, 0.0, moving.integral(every, lasting))
        net = slip + np.append(0.0, np.cumsum(moved)[:-1])
        counted, counts = _counted(law, moved, direction, slip)
        return cls(start, lasting, moving, pressing, direction, facing, net, counted, counts)

    def table(self) -> Floats:
        """Return the table of intervals that compiled code reads."""
        found = np.zeros((len(self.start), at.INTERVAL_COLUMNS))
        way, rate, load = np.where(self.direction == 0.0, 1.0, self.direction), self.rate, self.load
        found[:, at.LASTING] = self.lasting
        found[:, at.RATE], found[:, at.RATE_SLOPE] = way * rate.value, way * rate.slope
        found[:, at.RATE_TONE], found[:, at.RATE_FREQUENCY], found[:, at.RATE_PHASE] = way * rate.tone, rate.frequency, rate.phase
        found[:, at.COUNTED], found[:, at.COUNTED_PER_SLIP] = self.counted, self.counts * way
        found[:, at.LOAD], found[:, at.LOAD_SLOPE] = load.value, load.slope
        found[:, at.LOAD_TONE], found[:, at.LOAD_FREQUENCY], found[:, at.LOAD_PHASE] = load.tone, load.frequency, load.phase
        every = np.arange(len(self.start) - 1)
        jump = np.log(load.at(every + 1, 0.0 * every) / load.at(every, self.lasting[:-1]))
        found[1:, at.LOAD_GROWTH] = np.where(abs(jump) > 1e-13, jump, 0.0)
        found[1:, at.TURNS_BACK] = self.facing[1:] != self.facing[:-1]
        found[0, at.TURNS_BACK] = self.facing[0] < 0.0  # users give states in the forward direction
        return found


def _counted(law: FrictionLaw, moved: Floats, direction: Floats, slip: float) -> tuple[Floats, Floats]:
    """Return the slip (m) that a law counts at the start of each interval, and its change per net slip."""
    along = np.where(direction < 0.0, -1.0, 1.0) if law.counts == "path" else np.ones(len(moved))
    began = abs(slip) if law.counts == "path" else slip
    sums = np.append(0.0, np.cumsum(along * moved))
    if law.memory == "all":
        return began + sums[:-1], along
    rests = direction == 0.0
    last = np.maximum.accumulate(np.where(rests, np.arange(len(moved)), -1))
    return sums[:-1] - np.where(last < 0, 0.0, sums[last]), np.where(rests, 0.0, along)


def _starts(rate: LoadingHistory, load: LoadingHistory, duration: float) -> Floats:
    """Return the starts (s) of intervals: kinks and jumps of both histories, and where the slip rate passes through 0."""
    kinks = np.concatenate((rate.parts[0], load.parts[0]))
    starts = np.unique(kinks[kinks < duration])
    if len(starts) > MOST_INTERVALS:
        raise InputError(f"MovedContact: the motion has {len(starts)} kinks, {MOST_INTERVALS} are the most that can be followed")
    found = np.unique(np.concatenate((starts, _zeros(rate, starts, duration))))
    gaps = np.diff(np.append(found, duration))
    return found[gaps > SAME_TIME * duration]


def _zeros(rate: LoadingHistory, starts: Floats, duration: float) -> Floats:
    """Return where (s) a slip rate passes through 0 between the starts of intervals."""
    part, lasting = SmoothPart.of(rate, starts), np.diff(np.append(starts, duration))
    if not part.tone:
        with np.errstate(divide="ignore", invalid="ignore"):
            root = -part.value / part.slope
        return np.asarray((starts + root)[(root > 0.0) & (root < lasting)])
    turns = _turns(part, starts, lasting)
    n = np.maximum(np.searchsorted(starts, turns, side="right") - 1, 0)
    low, high = turns[:-1], np.append(starts, duration)[n[:-1] + 1]
    high = np.minimum(turns[1:], high)
    n = n[:-1]
    first, last = part.at(n, low - starts[n]), part.at(n, high - starts[n])
    passes = first * last < 0.0
    n, low, high, first = n[passes], low[passes], high[passes], first[passes]
    for _ in range(HALVINGS):
        middle = 0.5 * (low + high)
        same = part.at(n, middle - starts[n]) * first > 0.0
        low, high = np.where(same, middle, low), np.where(same, high, middle)
    return np.asarray(0.5 * (low + high))


def _turns(part: SmoothPart, starts: Floats, lasting: Floats) -> Floats:
    """Return the ends of parts (s) between which a slip rate with a sinusoid rises or falls."""
    periods = part.frequency * float(lasting.sum()) / (2.0 * math.pi)
    if periods + len(starts) > MOST_INTERVALS / 4:
        raise InputError(f"MovedContact: the slip rate has {periods:.3g} periods, {MOST_INTERVALS // 4} can be followed")
    found = [np.append(starts, starts[-1] + lasting[-1])]
    with np.errstate(invalid="ignore"):
        angle = np.arccos(np.clip(-part.slope / (part.tone * part.frequency), -1.0, 1.0))
    most = math.ceil(part.frequency * float(lasting.max()) / (2.0 * math.pi)) + 1
    for k in range(-1, most + 1):
        for sign in (1.0, -1.0):
            time = (sign * angle + 2.0 * math.pi * k - part.phase) / part.frequency
            found.append((starts + time)[(time > 0.0) & (time < lasting)])
    return np.unique(np.concatenate(found))
