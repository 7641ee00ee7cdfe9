"""Quantities of travelling slip on a contact, from frames of its motion: times of rupture, number of pulses, and speed."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from stickslip.foundation.arrays import Floats

Integers = NDArray[np.int64]


def rupture_times(times: Floats, rate: Floats, threshold: float) -> Floats:
    """Return the time (s) when each node first slips faster than a threshold (m/s); the slip rate (m/s) has time first.

    |rate| is taken as linear in time between frames; the time is that of the first frame if that is above the threshold, and NaN
    for nodes that never exceed it.
    """
    fast = np.abs(rate) > threshold
    first = fast.argmax(axis=0)
    before = np.maximum(first - 1, 0)
    low = np.abs(np.take_along_axis(rate, before[None], axis=0)[0])
    high = np.abs(np.take_along_axis(rate, first[None], axis=0)[0])
    with np.errstate(divide="ignore", invalid="ignore"):
        share = np.where(first > 0, (threshold - low) / (high - low), 1.0)
    found = times[before] + share * (times[first] - times[before])
    return np.where(fast.any(axis=0), np.where(first > 0, found, times[0]), np.nan)


def pulses(rate: Floats, threshold: float) -> Integers:
    """Return the number of slip pulses that have passed each node; the slip rate (m/s) has time first.

    They are maxima of |rate| above the threshold (m/s), separated by minima below half the lower one: as `pulses` of slip events. A
    maximum counts as soon as the rate has fallen to half of it, and at the end if it is still the largest.
    """
    size = np.abs(rate)
    count, high, low = np.zeros(size.shape[1:], np.int64), size[0].copy(), size[0].copy()
    falls = np.zeros(size.shape[1:], bool)  # True from a counted maximum until the rate has doubled since the minimum after it
    for now in size[1:]:
        low = np.where(falls, np.minimum(low, now), low)
        rises = falls & (now > 2.0 * low) & (now > threshold)
        high = np.where(falls, np.where(rises, now, high), np.maximum(high, now))
        falls = falls & ~rises
        ends = ~falls & (now < 0.5 * high) & (high > threshold)
        count, low, falls = count + ends, np.where(ends, now, low), falls | ends
    return np.asarray(count + (~falls & (high > threshold)), np.int64)


def rupture_speed(distance: float, times: Floats) -> Floats:
    """Return the speed (m/s) of the front at each node of a line, from rupture times (s) at nodes a distance (m) apart.

    It is the inverse of the slope of the rupture time, by central differences; NaN at nodes without neighbours that slip, and inf
    where neighbours begin to slip at once.
    """
    slope = np.full(times.shape, np.nan)
    slope[1:-1] = (times[2:] - times[:-2]) / (2.0 * distance)
    with np.errstate(divide="ignore", invalid="ignore"):
        return np.asarray(1.0 / np.abs(slope), float)
