"""A rigid block on ground whose acceleration runs in straight lines from sample to sample: exact, by cubics.

The block rests, or slides with the relative acceleration q - y, where q is the load per mass (m/s^2) and y its yield acceleration
in this direction. Within a segment that is linear in time, the relative velocity quadratic and the displacement cubic; sliding
begins at the root of a straight line and ends at the root of a quadratic. After the last sample q is 0.
"""

from __future__ import annotations

import math
from typing import NamedTuple

from stickslip.foundation.arrays import Floats1, Floats2
from stickslip.foundation.kernels.kernels import entry, inlined, kernel

SAMPLES_OF_A_BLOCK = 64
"""Rest passes over so many samples at once where neither the largest nor the smallest of them exceeds a yield acceleration."""
PHASES = 4
"""Largest number of phases of rest and sliding that are looked for in one segment: the load, a straight line, passes each of two
yield accelerations once, so that there is one stop, or a stop, a slip backward, its stop and a slip forward.
"""
DISPLACEMENT, PEAK_DISPLACEMENT, PEAK_VELOCITY, PEAK_TIME, SLIPS, SLIDING_TIME, FIRST_START, LAST_STOP, PIECES = range(9)
"""Columns of the answer: m, m (largest magnitude), m/s (magnitude), s, 1, s, s, s, and the number of pieces that are kept."""
ANSWER_COLUMNS = 9
"""Number of columns of the answer."""
START, BLOCK_PLACE, VELOCITY, ACCELERATION, CHANGE = range(5)
"""Columns of a piece of motion: s, m, m/s, m/s^2, m/s^3."""


class LoadOnBlock(NamedTuple):
    """The load on a block per mass (m/s^2) at even intervals (s), with the largest and the smallest of each block of samples."""

    load: Floats1
    extremes: Floats2
    interval: float


class KeptMotion(NamedTuple):
    """What is kept of a motion: the answer, and pieces as far as there is room."""

    answer: Floats1
    pieces: Floats2


@kernel
def next_above(ground: LoadOnBlock, yields: Floats1, begin: int) -> int:
    """Return the first sample from `begin` on whose load passes a yield acceleration; the number of samples if there is none."""
    count = len(ground.load)
    for block in range(begin // SAMPLES_OF_A_BLOCK, len(ground.extremes)):
        if ground.extremes[block, 0] > yields[0] or ground.extremes[block, 1] < -yields[1]:
            for n in range(max(begin, block * SAMPLES_OF_A_BLOCK), min(count, (block + 1) * SAMPLES_OF_A_BLOCK)):
                if ground.load[n] > yields[0] or ground.load[n] < -yields[1]:
                    return n
    return count


@inlined
def stop_after(velocity: float, acceleration: float, change: float, lasting: float) -> float:
    """Return after which time (s) a relative velocity >= 0 first falls to 0, at most `lasting`; -1 if it does not.

    In the quadratic formula only numbers of one sign are added, so that no digits cancel.
    """
    last = acceleration + change * lasting
    if acceleration >= 0.0 and last >= 0.0:
        return -1.0
    square = acceleration * acceleration - 2.0 * change * velocity
    if square < 0.0:
        return -1.0  # its minimum, where the acceleration is 0, is above 0
    root = math.sqrt(square)
    found = (acceleration + root) / -change if acceleration >= 0.0 else 2.0 * velocity / (root - acceleration)
    # A minimum that lies after the end is not reached: there the velocity itself decides.
    if found < lasting:
        return found
    end = velocity + lasting * (acceleration + 0.5 * lasting * change)
    return lasting if end <= 0.0 else -1.0


@inlined
def onset(now: float, there: float, slope: float, lasting: float, yields: Floats1) -> tuple[float, float, float]:
    """Return where a block at rest slips in the rest of a segment (1, -1, or 0: nowhere), for how long (s), and its acceleration.

    The load per mass (m/s^2) is `now`, and `there` after the time `lasting` (s); the acceleration is the one with which it begins.
    """
    if now > yields[0]:
        return 1.0, lasting, now - yields[0]
    if now < -yields[1]:
        return -1.0, lasting, -now - yields[1]
    if there > yields[0]:
        return 1.0, min((there - yields[0]) / slope, lasting), 0.0
    if there < -yields[1]:
        return -1.0, min((there + yields[1]) / slope, lasting), 0.0
    return 0.0, 0.0, 0.0


@inlined
def note(answer: Floats1, velocity: float, time: float) -> None:
    """Keep a relative velocity (magnitude, m/s) and its time (s) if it is the largest so far."""
    if velocity > answer[PEAK_VELOCITY]:
        answer[PEAK_VELOCITY] = velocity
        answer[PEAK_TIME] = time


@inlined
def keep(kept: KeptMotion, time: float, velocity: float, acceleration: float, change: float) -> None:
    """Keep how the block moves from a time (s) on, if there is room."""
    n = int(kept.answer[PIECES])
    if n < len(kept.pieces):
        kept.pieces[n, START] = time
        kept.pieces[n, BLOCK_PLACE] = kept.answer[DISPLACEMENT]
        kept.pieces[n, VELOCITY] = velocity
        kept.pieces[n, ACCELERATION] = acceleration
        kept.pieces[n, CHANGE] = change
        kept.answer[PIECES] += 1.0


@inlined
def come_to_rest(kept: KeptMotion, time: float) -> None:
    """Keep that the block stops at a time (s)."""
    kept.answer[LAST_STOP] = time
    kept.answer[PEAK_DISPLACEMENT] = max(kept.answer[PEAK_DISPLACEMENT], abs(kept.answer[DISPLACEMENT]))
    keep(kept, time, 0.0, 0.0, 0.0)


@kernel
def slide_through(
    ground: LoadOnBlock, yields: Floats1, n: int, motion: tuple[float, float], kept: KeptMotion
) -> tuple[float, float]:
    """Let a block slide through the segment after sample n.

    Its motion is where it slips (1, -1, or 0: it rests) and its relative velocity (magnitude, m/s); return that at the end.
    """
    answer, (way, velocity), interval = kept.answer, motion, ground.interval
    begin, here, there = n * interval, ground.load[n], ground.load[n + 1]
    slope, inside = (there - here) / interval, 0.0
    for _ in range(PHASES):
        now, lasting = here + slope * inside, interval - inside
        acceleration = now - yields[0] if way > 0.0 else -now - yields[1]
        if way == 0.0:
            way, lasting, acceleration = onset(now, there, slope, lasting, yields)
            if lasting <= 0.0:
                return 0.0, 0.0
            inside = interval - lasting
            answer[SLIPS] += 1.0
            if answer[SLIPS] == 1.0:
                answer[FIRST_START] = begin + inside
        change = way * slope
        keep(kept, begin + inside, way * velocity, way * acceleration, slope)
        stop = stop_after(velocity, acceleration, change, lasting)
        if acceleration > 0.0 and acceleration + change * lasting < 0.0:
            top = -acceleration / change
            note(answer, velocity + 0.5 * acceleration * top, begin + inside + top)
        moved = stop if stop >= 0.0 else lasting
        answer[DISPLACEMENT] += way * moved * (velocity + moved * (0.5 * acceleration + moved * change / 6.0))
        answer[SLIDING_TIME] += moved
        if stop < 0.0:
            velocity = max(0.0, velocity + moved * (acceleration + 0.5 * moved * change))
            note(answer, velocity, begin + interval)
            return way, velocity
        inside += moved
        velocity = way = 0.0
        come_to_rest(kept, begin + inside)
        if inside >= interval:
            break
    return way, velocity


@kernel
def slide_once(ground: LoadOnBlock, yields: Floats1, kept: KeptMotion) -> None:
    """Let a block slide under all samples, and after them, under no load any more, until it rests."""
    load, answer, n = ground.load, kept.answer, 0
    motion = 0.0, 0.0
    answer[:] = 0.0
    answer[FIRST_START] = answer[LAST_STOP] = answer[PEAK_TIME] = math.nan
    keep(kept, 0.0, 0.0, 0.0, 0.0)
    for _ in range(len(load)):
        if motion[0] == 0.0 and not (load[n] > yields[0] or load[n] < -yields[1]):
            n = next_above(ground, yields, n + 1) - 1
        if n >= len(load) - 1:
            break
        motion = slide_through(ground, yields, n, motion, kept)
        n += 1
    way, velocity = motion
    if way != 0.0:
        against, end = yields[0] if way > 0.0 else yields[1], (len(load) - 1) * ground.interval
        stop = velocity / against
        keep(kept, end, way * velocity, -way * against, 0.0)
        answer[DISPLACEMENT] += way * 0.5 * velocity * stop
        answer[SLIDING_TIME] += stop
        come_to_rest(kept, end + stop)


@entry
def slide_blocks(ground: LoadOnBlock, yields: Floats2, answers: Floats2, pieces: Floats2) -> None:
    """Let a block for each row of `yields` (forward, backward; m/s^2) slide; the pieces are those of the last one."""
    for n in range(len(yields)):
        slide_once(ground, yields[n], KeptMotion(answers[n], pieces))
