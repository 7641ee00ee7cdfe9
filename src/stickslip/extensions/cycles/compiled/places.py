"""Load, slip rate and states at places in the pieces of a history; passages of the slip rate; largest slip rates and tractions."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from stickslip.extensions.cycles.compiled.along_run import FIRST_STATE_ROW, LOAD_ROW, RATE_ROW, pieces_of, value_and_slope
from stickslip.foundation.arrays import Floats, Floats1, Floats2, Floats3, Integers1, Integers2
from stickslip.foundation.kernels.kernels import entry, kernel

SAMPLES = np.linspace(0.0, 1.0, 17)
"""Places (1) in each piece between which a passage is looked for."""
MOST_IN_PIECE = len(SAMPLES) // 2 + 1
"""Largest number of passages in a piece (1)."""
MOST_HALVINGS = 200
"""Newton's iterations and halvings to a passage (1)."""
ROUNDING_OF_PLACE, NARROWEST = 1e-16, 4e-16
"""A change of a place, and a distance of two, that is rounding (1)."""
INTERVALS, CLOSER = 32, 6
"""A largest value is looked for between so many parts of each piece (1), and so often again next to the largest."""
OF_RATE, OF_TRACTION = range(2)
"""Slip rate and traction: rows that `write_extremes` writes."""


@entry
def write_values(table: Integers2, states: Floats3, pieces: Integers1, places: Floats1, found: Floats2) -> None:
    """Write load (minus the reference strength), slip rate and states at places (1) in pieces, each in a row."""
    for i in range(len(pieces)):
        one = pieces_of(table)[pieces[i]]
        found[LOAD_ROW, i] = value_and_slope(one.load, places[i])[0]
        found[RATE_ROW, i] = value_and_slope(one.rate, places[i])[0]
        for n in range(len(found) - FIRST_STATE_ROW):
            found[FIRST_STATE_ROW + n, i] = value_and_slope(states[pieces[i], n], places[i])[0]


@kernel
def passage(series: Floats, value: float, low: float, high: float) -> float:
    """Return the place, between two others, where a polynomial passes a value upwards, to rounding."""
    place = 0.5 * (low + high)
    for _ in range(MOST_HALVINGS):
        found, slope = value_and_slope(series, place)
        found -= value
        if found >= 0.0:
            high = place
        else:
            low = place
        new = place - found / slope if slope > 0.0 else low
        if not low < new < high:
            new = 0.5 * (low + high)
        if new == place or high - low <= NARROWEST:
            return place
        if abs(new - place) <= ROUNDING_OF_PLACE:
            return new
        place = new
    return place


@entry
def find_passages(table: Integers2, value: float, pieces: Integers1, places: Floats1) -> int:
    """Write where the slip rate passes a value (m/s) upwards, by piece and place in it (1); return how often it does.

    There must be room for MOST_IN_PIECE in each piece.
    """
    count, below = 0, False
    for n in range(len(table)):
        series = pieces_of(table)[n].rate
        for i in range(len(SAMPLES)):
            stays = value_and_slope(series, SAMPLES[i])[0] < value
            if below and not stays:
                pieces[count], places[count] = n, passage(series, value, SAMPLES[i - 1], SAMPLES[i]) if i > 0 else 0.0
                count += 1
            below = stays
    return count


class DampedMass(NamedTuple):
    """What turns a load into a traction: the damping (N s/m), and the mass (kg)."""

    damping: float
    inertia: float


@kernel
def seen(table: Integers2, body: DampedMass, what: int, piece: int, place: float) -> float:
    """Return the slip rate (m/s), or the traction less the reference strength (N): load less damping and inertia."""
    one = pieces_of(table)[piece]
    rate, slope = value_and_slope(one.rate, place)
    if what == OF_RATE:
        return rate
    load = value_and_slope(one.load, place)[0] - body.damping * rate
    if one.mode == 0 or body.inertia == 0.0:
        return load
    traction: float = load - body.inertia * slope / (one.speed + 2.0 * one.bend * place)
    return traction


@kernel
def refined(table: Integers2, body: DampedMass, what: int, best: tuple[int, float, float], span: tuple[float, float]) -> float:
    """Return the largest value of `seen`, times a sign, near a place where it is large.

    `best` has the piece, the place in it (1) and the value; `span` the end of the piece (1) and the sign.
    """
    piece, middle, value = best
    end, sign = span
    width = end / INTERVALS
    for _ in range(CLOSER):
        low, high, there = max(0.0, middle - width), min(end, middle + width), middle
        for i in range(INTERVALS + 1):
            place = low + (high - low) * i / INTERVALS
            tried = sign * seen(table, body, what, piece, place)
            if tried > value:
                value, there = tried, place
        middle, width = there, 2.0 * width / INTERVALS
    return value


@entry
def write_extremes(table: Integers2, body: DampedMass, first: int, ends: Floats1, found: Floats2) -> None:
    """Write the least and the greatest slip rate, and the same of the traction, in pieces from one on up to their `ends`."""
    for what in range(len(found)):
        for side in range(2):
            sign, piece, middle, value = 2.0 * side - 1.0, 0, 0.0, -math.inf
            for n in range(len(ends)):
                for i in range(INTERVALS + 1):
                    place = ends[n] * i / INTERVALS
                    tried = sign * seen(table, body, what, first + n, place)
                    if tried > value:
                        piece, middle, value = n, place, tried
            found[what, side] = sign * refined(table, body, what, (first + piece, middle, value), (ends[piece], sign))
