"""Merge pieces of the waves in layers: neighbours that one polynomial describes to the tolerance become one piece of load.

The end of each step of the contact, and of each part of a machine's motion, is an end of pieces in all cells for ever after, at
its phase. Where nothing jumps there, the waves go on smoothly. So once a round trip has many more pieces than after the last
time, the waves of the next one are expanded anew as they come to the contact: as many neighbours as one series in xi can describe
in every cell are brought as one piece of load. Jumps of the load, and folds, stay where they are.

The new series of a wave is the polynomial through its values at Chebyshev's points, cut where its terms fall below rounding or
below the differences at the ends of the old pieces. It keeps the values at its own two ends. Its error is measured: the sum of the
terms of Chebyshev's series of its difference from each old piece bounds that difference on the piece.
"""

from __future__ import annotations

import math

import numpy as np

from stickslip.engine.compile.kernels import kernel
from stickslip.engine.memory.addresses import room_for
from stickslip.engine.series.polynomial import copy, evaluate, fill, restrict, total
from stickslip.engine.state.layout import TERMS, Floats
from stickslip.engine.state.workspace import Run
from stickslip.engine.waves.ladder_rows import AIR, row_of, wave_in

FEW = 32
"""Nothing is merged in a round trip with no more pieces than this (1)."""
PAUSE = 128
"""Pieces are merged again after this many round trips (1) at the latest: merging one takes the time of some ten others."""
MOST_TOGETHER = 64
"""Largest number of pieces (1) that are tried as one."""
ENDS = MOST_TOGETHER + 1
"""Largest number of their ends (1)."""
HALVINGS = 8
"""Number of times (1) that a group of pieces is halved until one series describes it."""
ROUNDING = 4e-15
"""Rounding of a wave (1), as a share of the reference strength and of its own size."""
KEPT_ABOVE = 0.1
"""Terms of a new series are kept above this share (1) of the change allowed: below are the errors of the steps that made the waves,
which a series of high degree would follow with coefficients that are large beside the wave."""
SAME_VARIABLE = 1e-11
"""Two pieces next to a fold are written in the root of the same time if it goes on to this share (1) of them."""
LARGEST_TURN = 1.0
"""A tone in the loading is a polynomial to rounding up to this phase (rad)."""
POINTS = 24
"""Number of Chebyshev's points (1) on a new piece."""


def _spectrum() -> Floats:
    """Return the matrix from the values at Chebyshev's points on [0, 1], ascending, to the coefficients of Chebyshev's series."""
    angle = np.pi - (np.arange(POINTS) + 0.5) * np.pi / POINTS
    weights = np.where(np.arange(POINTS) == 0, 1.0, 2.0) / POINTS
    return np.array([weight * np.cos(j * angle) for j, weight in enumerate(weights)])


def _powers() -> Floats:
    """Return the coefficients of Chebyshev's polynomials of 2 x - 1 in powers of x, which are whole numbers, row by row."""
    rows = [[1] + [0] * (TERMS - 1), [-1, 2] + [0] * (TERMS - 2)]
    for _ in range(TERMS - 2):
        last, before = rows[-1], rows[-2]
        rows.append([4 * up - 2 * same - old for up, same, old in zip([0, *last], last, before, strict=False)])
    return np.array(rows, float)


PLACES = 0.5 - 0.5 * np.cos((np.arange(POINTS) + 0.5) * np.pi / POINTS)
SPECTRUM, POWERS = _spectrum(), _powers()


# ---- when -------------------------------------------------------------------------------------------------------------------


@kernel
def plan_merging(run: Run) -> None:
    """Decide whether pieces are merged in the round trip that begins, from the one just closed."""
    counts, state = run.counts, run.state
    pieces = counts.previous_to - counts.previous_from
    if counts.merging == 1:
        state.merged_in_all += state.merged_now
        counts.merge_above = pieces + pieces // 4 + 8
    counts.merging, state.merged_now = 0, 0.0
    if pieces > max(FEW, counts.merge_above) or (pieces > FEW and counts.trip >= counts.merge_at):
        counts.merging, counts.merge_at = 1, counts.trip + PAUSE
        state.merge_within = run.params.tolerance * swing_of_waves(run)


@kernel
def swing_of_waves(run: Run) -> float:
    """Return how far (Pa) a wave in any cell, or impedance times slip rate, goes up and down in the round trip just closed."""
    counts, largest = run.counts, 0.0
    for n in range(counts.previous_from, counts.previous_to):
        largest = max(largest, run.params.impedance * abs(run.history[n].rate[0]))
    for cell in range(counts.cells):
        low, high = math.inf, -math.inf
        for n in range(counts.previous_from, counts.previous_to):
            value = wave_in(run, row_of(run, n), cell)[0]
            low, high = min(low, value), max(high, value)
        largest = max(largest, high - low)
    return largest


# ---- which ------------------------------------------------------------------------------------------------------------------


@kernel
def gather(run: Run, source: int) -> None:
    """Bring the waves of piece `source` of the history, and of those behind it that merge with it, into the air.

    Parts of a piece of load that loading has cut come from the same ones.
    """
    counts, state = run.counts, run.state
    if state.taken == 0.0:
        counts.merged = 0
        if counts.merging == 1:
            merge_ahead(run, source)
    elif counts.merged > 0:
        merge(run, source, counts.merged + 1)
    if counts.merged == 0:
        copy(wave_in(run, row_of(run, source), 0), wave_in(run, AIR, 0), counts.slots * TERMS)
    else:
        lay_out(run, source, counts.merged + 1)


@kernel
def merge_ahead(run: Run, source: int) -> None:
    """Merge as many pieces from `source` on as one series describes, if more than one."""
    many = smooth_ahead(run, source)
    for _ in range(HALVINGS):
        if many == 1:
            return
        error = merge(run, source, many)
        if error < math.inf:
            run.counts.merged = many - 1
            run.state.merged_now = max(run.state.merged_now, error)
            return
        many = (many + 1) // 2


@kernel
def smooth_ahead(run: Run, source: int) -> int:
    """Return the number of pieces from `source` on that follow each other without a jump and in the same variable."""
    counts, history, many = run.counts, run.history, 1
    longest = LARGEST_TURN / run.params.tone_frequency if run.params.tone_frequency > 0.0 else math.inf
    for n in range(source + 1, min(counts.previous_to, source + MOST_TOGETHER)):
        if history[n].phase_to - history[source].phase_from > longest or not follows(run, n):
            break
        many += 1
    return many


@kernel
def follows(run: Run, n: int) -> bool:
    """Return True if the waves of piece n of the history go on from those of the piece before, in the same variable."""
    now, before = run.history[n], run.history[n - 1]
    if now.trip != before.trip or now.phase_from != before.phase_to or (now.bend > 0.0) != (before.bend > 0.0):
        return False
    if (now.bend < 0.0) != (before.bend < 0.0):
        return False
    if now.bend != 0.0:
        reached = root_at_start(before.speed, before.bend) + math.copysign(length_of(before.speed, before.bend), before.bend)
        shorter = min(length_of(before.speed, before.bend), length_of(now.speed, now.bend))
        if abs(root_at_start(now.speed, now.bend) - reached) > SAME_VARIABLE * shorter:
            return False
    for cell in range(run.counts.cells):
        if abs(step_between(run, n, cell)) > run.state.merge_within + rounding_at(run, n, cell):
            return False
    return True


@kernel
def step_between(run: Run, n: int, cell: int) -> float:
    """Return by how much (Pa) the wave in a cell jumps where piece n of the history begins."""
    return wave_in(run, row_of(run, n), cell)[0] - total(wave_in(run, row_of(run, n - 1), cell))


@kernel
def rounding_at(run: Run, n: int, cell: int) -> float:
    """Return the rounding (Pa) of the wave in a cell where piece n of the history begins."""
    return ROUNDING * (abs(run.params.reference) + abs(wave_in(run, row_of(run, n), cell)[0]))


@kernel
def length_of(speed: float, bend: float) -> float:
    """Return the length of a piece in the variable of its series: a time (s), or next to a fold a root of time (s^0.5)."""
    return speed if bend == 0.0 else math.sqrt(abs(bend))


@kernel
def root_at_start(speed: float, bend: float) -> float:
    """Return the root (s^0.5) of the time between the start of a piece next to a fold and that fold."""
    return speed / (2.0 * math.sqrt(abs(bend)))


@kernel
def lay_out(run: Run, source: int, many: int) -> None:
    """Set the phases of the piece of load to those of `many` pieces of the history, from `source` on."""
    first, length = run.history[source], 0.0
    for n in range(source, source + many):
        length += length_of(run.history[n].speed, run.history[n].bend)
    run.state.phase_from, run.state.phase_to = first.phase_from, run.history[source + many - 1].phase_to
    run.state.speed, run.state.bend = length, 0.0
    if first.bend != 0.0:
        run.state.speed = 2.0 * length * root_at_start(first.speed, first.bend)
        run.state.bend = math.copysign(length * length, first.bend)


# ---- how --------------------------------------------------------------------------------------------------------------------


@kernel
def merge(run: Run, source: int, many: int) -> float:
    """Write the waves of `many` pieces of the history as one series each into the air; return the largest error (Pa).

    It is inf if one series does not describe one of them.
    """
    ends, of_point, places = room_for(ENDS), room_for(POINTS), room_for(POINTS)
    ends[0] = 0.0
    for i in range(many):
        ends[i + 1] = ends[i] + length_of(run.history[source + i].speed, run.history[source + i].bend)
    i = 0
    for k in range(POINTS):
        place = PLACES[k] * ends[many]
        for _ in range(many):
            if i + 1 == many or place <= ends[i + 1]:
                break
            i += 1
        of_point[k], places[k] = float(i), (place - ends[i]) / (ends[i + 1] - ends[i])
    error = 0.0
    for cell in range(run.counts.cells):
        if not describe(run, source, many, cell, of_point, places):
            return math.inf
        error = max(error, distance(run, source, many, cell, ends))
        if not error <= run.state.merge_within + rounding_at(run, source, cell):
            return math.inf
    if run.counts.slots > run.counts.cells:
        fill(wave_in(run, AIR, run.counts.cells), 0.0)  # the rate of a machine is found anew
    return error


@kernel
def describe(run: Run, source: int, many: int, cell: int, of_point: Floats, places: Floats) -> bool:
    """Write the new series of the wave in a cell into the air; return False if it has too many terms."""
    values, terms, wave = room_for(POINTS), room_for(POINTS), wave_in(run, AIR, cell)
    begin, last = wave_in(run, row_of(run, source), cell)[0], source + many - 1
    for k in range(POINTS):
        values[k] = evaluate(wave_in(run, row_of(run, source + int(of_point[k])), cell), places[k]) - begin
    noise = KEPT_ABOVE * run.state.merge_within + 0.25 * rounding_at(run, source, cell)
    for n in range(source + 1, source + many):
        noise = max(noise, abs(step_between(run, n, cell)))
    highest = 0
    for j in range(POINTS):
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
    wave[1] += total(wave_in(run, row_of(run, last), cell)) - total(wave)
    return True


@kernel
def distance(run: Run, source: int, many: int, cell: int, ends: Floats) -> float:
    """Return a bound (Pa) on the difference between the new series of the wave in a cell and the old ones."""
    wave, part, values, largest = wave_in(run, AIR, cell), room_for(TERMS), room_for(POINTS), 0.0
    for i in range(many):
        restrict(wave, ends[i] / ends[many], (ends[i + 1] - ends[i]) / ends[many], part)
        old, apart = wave_in(run, row_of(run, source + i), cell), 0.0
        for k in range(TERMS):
            part[k] -= old[k]
        for k in range(POINTS):
            values[k] = evaluate(part, PLACES[k])
        for j in range(TERMS):
            apart += abs(term_of(values, j))
        largest = max(largest, apart)
    return largest


@kernel
def term_of(values: Floats, j: int) -> float:
    """Return term j of Chebyshev's series of a function with the given values at his points."""
    term = 0.0
    for k in range(POINTS):
        term += SPECTRUM[j, k] * values[k]
    return term
