"""The parts of a run of a uniform body, each with what disturbances of the start have made of the wave that left the contact.

On a part the disturbed wave is a polynomial, known by its values at Radau's points. One round trip later it is a disturbance of the
load, as large as the driver sends back. While the contact rests the wave that leaves it is the load with its sign reversed, so that
a rest that was not recorded is looked up one round trip earlier.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from stickslip.extensions.cycles.compiled.along_run import RunNumbers
from stickslip.extensions.cycles.compiled.radau import radau_coefficients, radau_places
from stickslip.foundation.arrays import Floats, Floats1, Floats2
from stickslip.foundation.kernels.kernels import kernel

WAVE_POINTS = 10
"""Points on a part (1), one for each term of the mesh's polynomials."""
WAVE_PLACES = radau_places(WAVE_POINTS)
"""Where they are on the part (1)."""
WAVE_COEFFICIENTS = radau_coefficients(WAVE_PLACES)
"""Integrals from 0 to each of them of the polynomials that are 1 at one and 0 at all others."""
WEIGHTS_OF_POINTS = np.array([1.0 / np.prod(np.delete(one - WAVE_PLACES, n)) for n, one in enumerate(WAVE_PLACES)])
"""Weights of barycentric interpolation: Berrut & Trefethen 2004, SIAM Rev. 46, 501."""
LAST_TERM = np.linalg.inv(np.polynomial.legendre.legvander(2.0 * WAVE_PLACES - 1.0, WAVE_POINTS - 1))[-1]
"""From values at the points to the last coefficient of a series of Legendre's polynomials."""
SAME_MOMENT = 1e-11
"""Moments closer than this share (1) of a round trip are one."""
MOST_TRIPS_AT_REST = 100_000
"""Largest number of round trips (1) of a rest that was not recorded."""


class WavesOfRun(NamedTuple):
    """A run of a uniform body, for compiled code."""

    run: RunNumbers
    starts: Floats1
    """When each piece starts, s."""
    lasts: Floats1
    """How long each lasts, s."""
    trip: float
    """Length of a round trip, s."""
    back: float
    """The share of a wave that the driver sends back (1)."""
    impedance: float
    """Of the waves that slip sends out, Pa s/m."""
    first: int
    """The first piece behind the wave with which the run begins."""
    at_onset: int
    """1 if the run begins and returns at an onset after a rest, 0 where the slip rate passes a value."""


class PartsOfRun(NamedTuple):
    """Disturbances along a run, in columns."""

    ends: Floats2
    """When each part begins and ends, s."""
    waves: Floats2
    """Disturbances of the wave that left the contact at the points of each part, Pa."""
    loads: Floats2
    """Those of the load at the points of the part at hand, Pa."""
    now: Floats2
    """Those of load, slip rate and states at the end of the last part."""
    later: Floats2
    """Room for those at the next end."""
    moved: Floats1
    """By how much the last event, or the return, comes earlier, s."""


class PartHeard(NamedTuple):
    """Where a disturbance of the load comes from."""

    part: int
    share: float
    """What is left of the wave of that part (1)."""
    delay: float
    """How long ago (s) it left."""
    until: float
    """The time (s) up to which the load is the echo of that part."""


@kernel
def latest_part(ends: Floats2, count: int, time: float) -> int:
    """Return the last part, of a number of them, that begins at a time (s) or before."""
    low, high = 0, count
    for _ in range(64):
        if high - low <= 1:
            return low
        middle = (low + high) // 2
        if ends[middle, 0] <= time:
            low = middle
        else:
            high = middle
    return low


@kernel
def echo_behind(waves: WavesOfRun, ends: Floats2, count: int, time: float, delay: float) -> PartHeard:
    """Return what is heard behind a time (s): what left the contact a delay (s) earlier, or longer ago if it has rested since."""
    same, share, until = SAME_MOMENT * waves.trip, 1.0, 1e300
    for _ in range(MOST_TRIPS_AT_REST):
        part = latest_part(ends, count, time - delay + same)
        if time - delay + same < ends[part, 1]:
            return PartHeard(part, share, delay, min(until, ends[part, 1] + delay))
        if part + 1 < count:
            until = min(until, ends[part + 1, 0] + delay)
        share *= -waves.back
        delay += waves.trip
    return PartHeard(0, 0.0, delay, until)


@kernel
def write_interpolation(place: float, weights: Floats) -> None:
    """Write the shares (1) of the values at the points in the value at a place (1) of a part."""
    total = 0.0
    for k in range(WAVE_POINTS):
        if place == WAVE_PLACES[k]:
            for n in range(WAVE_POINTS):
                weights[n] = 0.0
            weights[k] = 1.0
            return
        weights[k] = WEIGHTS_OF_POINTS[k] / (place - WAVE_PLACES[k])
        total += weights[k]
    for k in range(WAVE_POINTS):
        weights[k] /= total


@kernel
def add_row(target: Floats1, share: float, source: Floats1) -> None:
    """Add a share (1) of one row of disturbances to another."""
    for c in range(len(target)):
        target[c] += share * source[c]


@kernel
def set_row(target: Floats1, share: float, source: Floats1) -> None:
    """Put a share (1) of one row of disturbances in the place of another."""
    for c in range(len(target)):
        target[c] = share * source[c]
