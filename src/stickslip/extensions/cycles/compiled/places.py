"""Places in the pieces of a history: load, slip rate and states there, and where the slip rate passes a value."""

from __future__ import annotations

import numpy as np

from stickslip.engine import TERMS
from stickslip.engine.series.polynomial import evaluate
from stickslip.extensions.cycles.compiled.along_run import FIRST_STATE_ROW, LOAD_ROW, RATE_ROW, pieces_of
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


@entry
def write_values(table: Integers2, states: Floats3, pieces: Integers1, places: Floats1, found: Floats2) -> None:
    """Write load (minus the reference strength), slip rate and states at places (1) in pieces, each in a row."""
    for i in range(len(pieces)):
        one = pieces_of(table)[pieces[i]]
        found[LOAD_ROW, i], found[RATE_ROW, i] = evaluate(one.load, places[i]), evaluate(one.rate, places[i])
        for n in range(len(found) - FIRST_STATE_ROW):
            found[FIRST_STATE_ROW + n, i] = evaluate(states[pieces[i], n], places[i])


@kernel
def passage(series: Floats, value: float, low: float, high: float) -> float:
    """Return the place, between two others, where a polynomial passes a value upwards, to rounding."""
    place = 0.5 * (low + high)
    for _ in range(MOST_HALVINGS):
        found, slope = 0.0, 0.0
        for k in range(TERMS - 1, -1, -1):
            slope = slope * place + found
            found = found * place + series[k]
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
            stays = evaluate(series, SAMPLES[i]) < value
            if below and not stays:
                pieces[count], places[count] = n, passage(series, value, SAMPLES[i - 1], SAMPLES[i]) if i > 0 else 0.0
                count += 1
            below = stays
    return count
