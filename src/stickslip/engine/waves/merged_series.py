"""Write the waves of pieces that follow each other in layers as one series each, and bound the error (`waves.merged_pieces`).

The series of a wave is the polynomial through its values at Chebyshev's points, cut where its terms fall below a share of the
change that is allowed. It keeps the value at its start, and at its end unless that is a fold. Its error is measured at seven
points of each old piece.

Where time is short beside a round trip, places are counted from the end of the new piece: phases have too few digits there.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from stickslip.engine.series.polynomial import evaluate, fill, mean_of, total
from stickslip.engine.state.layout import TERMS, Floats
from stickslip.engine.state.workspace import Run
from stickslip.engine.waves.ladder_rows import AIR, brought_wave, kept_wave, wave_in
from stickslip.foundation.kernels.kernels import kernel
from stickslip.foundation.kernels.memory.addresses import room_for

IN_TIME, TO_FOLD, MEAN = 0, 1, 2
"""Forms of the waves of merged pieces: series in time, series in the root of the time left, or their means."""
MOST_TOGETHER = 128
"""Merge at most this many pieces (1) to one series."""
ENDS = MOST_TOGETHER + 1
"""Largest number of their ends (1)."""
PIECE_POINTS = 24
"""Number of Chebyshev's points (1) on a new piece."""
CHECKS = 7
"""Compare the new series with the old one at this many points (1) of each old piece, its ends among them."""
WAVE_ROUNDING = 4e-15
"""Rounding of a wave (1), as a share of the reference strength and of its own size."""
KEPT_ABOVE = 0.1
"""Terms of a new series are kept above this share (1) of the change allowed. Below are the errors of the steps that made the waves;
a series that follows them has coefficients of high degree that are large beside the wave."""
BRIEF, LEAST_WEIGHT = 1e-8, 1e-4
"""On pieces shorter than this share (1) of a round trip, which the last steps up to a fold are, a change of the waves weighs less,
in proportion to its time, but at least by the other share (1): by rounding these steps do not know their waves any better."""


def _spectrum() -> Floats:
    """Return the matrix from the values at Chebyshev's points on [0, 1], ascending, to the coefficients of Chebyshev's series."""
    angle = np.pi - (np.arange(PIECE_POINTS) + 0.5) * np.pi / PIECE_POINTS
    weights = np.where(np.arange(PIECE_POINTS) == 0, 1.0, 2.0) / PIECE_POINTS
    return np.array([weight * np.cos(j * angle) for j, weight in enumerate(weights)])


def _powers() -> Floats:
    """Return the coefficients of Chebyshev's polynomials of 2 x - 1 in powers of x, which are whole numbers, row by row."""
    rows = [[1] + [0] * (TERMS - 1), [-1, 2] + [0] * (TERMS - 2)]
    for _ in range(TERMS - 2):
        last, before = rows[-1], rows[-2]
        rows.append([4 * up - 2 * same - old for up, same, old in zip([0, *last], last, before, strict=False)])
    return np.array(rows, float)


CHECK_PLACES = 0.5 - 0.5 * np.cos(np.arange(CHECKS) * np.pi / (CHECKS - 1))
PIECE_PLACES = 0.5 - 0.5 * np.cos((np.arange(PIECE_POINTS) + 0.5) * np.pi / PIECE_POINTS)
SPECTRUM, POWERS = _spectrum(), _powers()


class WaveGroup(NamedTuple):
    """Name pieces of the history that follow each other, and the form of the waves to be written."""

    source: int  # the first of them
    many: int  # their number
    form: int


@kernel
def width_of(run: Run, n: int) -> float:
    """Return how long (s) piece n of the history is, also where its phases have too few digits."""
    return run.history[n].speed + run.history[n].bend


@kernel
def weight_of(run: Run, n: int) -> float:
    """Return the weight (1) of a change of the waves on piece n of the history."""
    return max(min(width_of(run, n) / (BRIEF * run.params.round_trip_time), 1.0), LEAST_WEIGHT)


@kernel
def rounding_at(run: Run, n: int, cell: int) -> float:
    """Return the rounding (Pa) of the wave in a cell where piece n of the history begins."""
    return WAVE_ROUNDING * (abs(run.params.reference) + abs(kept_wave(run, n, cell)[0]))


@kernel
def lay_out(run: Run, group: WaveGroup) -> None:
    """Set the phases of the piece of load to those of a group."""
    width = 0.0
    for n in range(group.source, group.source + group.many):
        width += width_of(run, n)
    run.state.phase_from = run.history[group.source].phase_from
    run.state.phase_to = run.history[group.source + group.many - 1].phase_to
    run.state.speed, run.state.bend = (2.0 * width, -width) if group.form == TO_FOLD else (width, 0.0)


@kernel
def average(run: Run, group: WaveGroup) -> None:
    """Write the means in time of the waves of a group into the air."""
    for slot in range(max(run.counts.slots, 1)):
        pushed = lasted = 0.0
        for n in range(group.source, group.source + group.many):
            width, piece = width_of(run, n), run.history[n]
            pushed += width * mean_of(kept_wave(run, n, slot), piece.speed, piece.bend, width)
            lasted += width
        wave = brought_wave(run, slot)
        fill(wave, 0.0)
        wave[0] = pushed / lasted


@kernel
def merge(run: Run, group: WaveGroup) -> float:
    """Write the waves of a group as one series each into the air; return the largest error (Pa), inf if one is not described so."""
    ends, of_point, places = room_for(ENDS), room_for(PIECE_POINTS), room_for(PIECE_POINTS)
    place_points(run, group, ends, of_point, places)
    error = 0.0
    for cell in range(max(run.counts.cells, 1)):
        if not describe(run, group, cell, of_point, places):
            return math.inf
        if group.form == IN_TIME:
            wave = brought_wave(run, cell)
            wave[1] += total(kept_wave(run, group.source + group.many - 1, cell)) - total(wave)
        error = max(error, distance(run, group, cell, ends))
        if not error <= run.state.merge_within + rounding_at(run, group.source, cell):
            return math.inf
    if run.counts.slots > run.counts.cells:
        fill(wave_in(run, AIR, run.counts.cells), 0.0)  # the rate of a machine is found anew
    return error


@kernel
def place_points(run: Run, group: WaveGroup, ends: Floats, of_point: Floats, places: Floats) -> None:
    """Write the time (s) that is left of a group where each of its pieces begins, and the piece and place xi of each point."""
    source, many = group.source, group.many
    ends[many] = 0.0
    for i in range(many - 1, -1, -1):
        ends[i] = ends[i + 1] + width_of(run, source + i)
    i = 0
    for k in range(PIECE_POINTS):
        left = ends[0] * (1.0 - PIECE_PLACES[k]) * (1.0 - PIECE_PLACES[k] if group.form == TO_FOLD else 1.0)
        for _ in range(many):
            if i + 1 == many or left >= ends[i + 1]:
                break
            i += 1
        of_point[k], places[k] = float(i), place_in(run, source + i, left - ends[i + 1])


@kernel
def place_in(run: Run, n: int, left: float) -> float:
    """Return the place xi in piece n of the history after which a time `left` (s) of it is left."""
    piece = run.history[n]
    at_end = max(piece.speed + 2.0 * piece.bend, 0.0)
    root = at_end + math.sqrt(max(at_end * at_end - 4.0 * piece.bend * left, 0.0))
    return 1.0 - (min(2.0 * left / root, 1.0) if root > 0.0 else 0.0)


@kernel
def place_of(run: Run, group: WaveGroup, i: int, xi: float, ends: Floats) -> float:
    """Return the place in a new piece of the place xi in piece i of its group."""
    piece = run.history[group.source + i]
    left = (ends[i + 1] + (1.0 - xi) * (piece.speed + piece.bend * (1.0 + xi))) / ends[0]
    return 1.0 - (math.sqrt(max(left, 0.0)) if group.form == TO_FOLD else left)


@kernel
def describe(run: Run, group: WaveGroup, cell: int, of_point: Floats, places: Floats) -> bool:
    """Write the new series of the wave in a cell into the air; return False if it has too many terms."""
    values, terms, wave = room_for(PIECE_POINTS), room_for(PIECE_POINTS), brought_wave(run, cell)
    begin = kept_wave(run, group.source, cell)[0]
    for k in range(PIECE_POINTS):
        values[k] = evaluate(kept_wave(run, group.source + int(of_point[k]), cell), places[k]) - begin
    noise = KEPT_ABOVE * run.state.merge_within + 0.25 * rounding_at(run, group.source, cell)
    highest = 0
    for j in range(PIECE_POINTS):
        terms[j] = term_of(values, j)
        if abs(terms[j]) > noise:
            highest = j
    if highest >= TERMS:
        return False
    fill(wave, 0.0)
    for j in range(highest + 1):
        for k in range(j + 1):
            wave[k] += POWERS[j, k] * terms[j]
    wave[0] = begin
    return True


@kernel
def distance(run: Run, group: WaveGroup, cell: int, ends: Floats) -> float:
    """Return the largest difference (Pa) between the new series of the wave in a cell and the old ones, by their weight."""
    wave, largest = brought_wave(run, cell), 0.0
    for i in range(group.many):
        old, apart = kept_wave(run, group.source + i, cell), 0.0
        for k in range(CHECKS):
            apart = max(apart, abs(evaluate(wave, place_of(run, group, i, CHECK_PLACES[k], ends)) - evaluate(old, CHECK_PLACES[k])))
        largest = max(largest, weight_of(run, group.source + i) * apart)
    return largest


@kernel
def term_of(values: Floats, j: int) -> float:
    """Return term j of Chebyshev's series of a function with the given values at his points."""
    term = 0.0
    for k in range(PIECE_POINTS):
        term += SPECTRUM[j, k] * values[k]
    return term
