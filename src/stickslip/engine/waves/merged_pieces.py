"""Merge pieces of the waves in layers: neighbours that one polynomial describes to the tolerance become one piece of load.

The end of each step of the contact, and of each part of a machine's motion, is an end of pieces in all cells for ever after, at
its phase. Where nothing jumps there, the waves go on smoothly. So once a round trip has many more pieces than after the last
time, the waves of the next one are expanded anew as they come to the contact: as many neighbours as one series in xi can describe
in every cell are brought as one piece of load. Jumps of the load, and folds, stay where they are.

Up to a fold the slip rate goes as the root of the time left. Steps that come to it in another variable get shorter and shorter; from
the second time on the waves are written in that root, up to the jump in which such steps end.

The new series of a wave is the polynomial through its values at Chebyshev's points, cut where its terms fall below rounding or
below the differences at the ends of the old pieces. It keeps the values at its start, and at its end unless that is a fold. Its error is measured at as many points of each old piece, and bounded by the
sum of the terms of Chebyshev's series through these.

Where a round trip has too many pieces even so, because the load has as many jumps, short pieces are lumped: the waves of a group
that is as long as the shortest event are replaced by their means.
"""

from __future__ import annotations

import math

import numpy as np

from stickslip.engine.compile.kernels import kernel
from stickslip.engine.memory.addresses import room_for
from stickslip.engine.series.polynomial import copy, evaluate, fill, mean_of, total
from stickslip.engine.state.layout import TERMS, Floats
from stickslip.engine.state.workspace import Run
from stickslip.engine.waves.ladder_rows import AIR, row_of, wave_in

IN_TIME, TO_FOLD, MEAN = 0, 1, 2
"""Forms of the waves of merged pieces: series in time, series in the root of the time left, or their means."""
FEW, MANY = 4, 32
"""Nothing is merged in a round trip with no more pieces than the first number (1), and growth counts beyond the second."""
PAUSE = 128
"""Pieces are merged after this many round trips (1) at the latest: merging one takes the time of some ten others."""
MOST_TOGETHER = 128
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
SHORTER = 0.125
"""Steps that come to a fold are at least this much (1) shorter at its end than at first."""
BRIEF, LEAST_WEIGHT = 1e-8, 1e-4
"""On pieces shorter than this share (1) of a round trip, which steps up to a fold are in the end, a change of the waves weighs less,
in proportion to its time, but at least by the other share (1): by rounding these steps do not know their waves any better."""
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
    if counts.merge_at == 0:
        counts.merge_at = counts.trip + PAUSE
    if pieces > max(MANY, counts.merge_above) or (pieces > FEW and counts.trip >= counts.merge_at):
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
        counts.merged = counts.merged_as = 0
        if counts.merging == 1:
            merge_ahead(run, source)
        if counts.lumps == 1:
            lump_ahead(run, source)
    elif counts.merged_as == MEAN:
        average(run, source, counts.merged)
    elif counts.merged > 0:
        merge(run, source, counts.merged, counts.merged_as)
    if counts.merged == 0:
        copy(wave_in(run, row_of(run, source), 0), wave_in(run, AIR, 0), counts.slots * TERMS)
    else:
        lay_out(run, source, counts.merged)


@kernel
def merge_ahead(run: Run, source: int) -> None:
    """Merge as many pieces from `source` on as one series describes. One next to a fold is at least written in time."""
    many = smooth_ahead(run, source)
    if many > 1 and grows_shorter(run, source, source + many - 1) and keep_merged(run, source, many, TO_FOLD):
        return
    for _ in range(HALVINGS):
        if (many == 1 and run.history[source].bend == 0.0) or keep_merged(run, source, many, IN_TIME) or many == 1:
            return
        many = (many + 1) // 2


@kernel
def keep_merged(run: Run, source: int, many: int, form: int) -> bool:
    """Merge pieces from `source` on, and note it; return False if one series does not describe them."""
    error = merge(run, source, many, form)
    if not error < math.inf:
        return False
    run.counts.merged, run.counts.merged_as = many, form
    run.state.merged_now = max(run.state.merged_now, error)
    return True


@kernel
def smooth_ahead(run: Run, source: int) -> int:
    """Return the number of pieces from `source` on that follow each other without a jump."""
    counts, history, many = run.counts, run.history, 1
    longest = LARGEST_TURN / run.params.tone_frequency if run.params.tone_frequency > 0.0 else math.inf
    for n in range(source + 1, min(counts.previous_to, source + MOST_TOGETHER)):
        if history[n].phase_to - history[source].phase_from > longest or not follows(run, n):
            break
        many += 1
    return many


@kernel
def grows_shorter(run: Run, first: int, last: int) -> bool:
    """Return True if the last of some pieces is much shorter than the first, as steps up to a fold are."""
    return width_of(run, last) < SHORTER * width_of(run, first)


@kernel
def follows(run: Run, n: int) -> bool:
    """Return True if the waves of piece n of the history go on from those of the piece before."""
    now, before = run.history[n], run.history[n - 1]
    if now.trip != before.trip or now.phase_from != before.phase_to:
        return False
    weight = min(weight_of(run, n), weight_of(run, n - 1))
    for cell in range(run.counts.cells):
        if weight * abs(step_between(run, n, cell)) > run.state.merge_within + rounding_at(run, n, cell):
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
def width_of(run: Run, n: int) -> float:
    """Return how long (s) piece n of the history is, also where its phases have too few digits."""
    return run.history[n].speed + run.history[n].bend


@kernel
def weight_of(run: Run, n: int) -> float:
    """Return the weight (1) of a change of the waves on piece n of the history."""
    return max(min(width_of(run, n) / (BRIEF * run.params.round_trip_time), 1.0), LEAST_WEIGHT)


@kernel
def lay_out(run: Run, source: int, many: int) -> None:
    """Set the phases of the piece of load to those of `many` pieces of the history, from `source` on."""
    width = 0.0
    for n in range(source, source + many):
        width += width_of(run, n)
    run.state.phase_from, run.state.phase_to = run.history[source].phase_from, run.history[source + many - 1].phase_to
    run.state.speed, run.state.bend = (2.0 * width, -width) if run.counts.merged_as == TO_FOLD else (width, 0.0)


@kernel
def lump_ahead(run: Run, source: int) -> None:
    """Take pieces from `source` on together until they are as long as the shortest event, unless they are merged to that length.

    They are left alone where a piece begins that is as long by itself.
    """
    counts, shortest = run.counts, run.params.shortest
    many, width = max(counts.merged, 1), 0.0
    for n in range(source, source + many):
        width += width_of(run, n)
    if width >= shortest:
        return
    for n in range(source + many, counts.previous_to):
        if width >= shortest or width_of(run, n) >= shortest:
            break
        width += width_of(run, n)
        many += 1
    counts.merged, counts.merged_as = many, MEAN
    average(run, source, many)


# ---- how --------------------------------------------------------------------------------------------------------------------


@kernel
def merge(run: Run, source: int, many: int, form: int) -> float:
    """Write the waves of `many` pieces of the history as one series each into the air; return the largest error (Pa).

    They are series in time or, if the form is TO_FOLD, in the root of the time left. The error is inf if one series does not describe one
    of them.
    """
    ends, of_point, places = room_for(ENDS), room_for(POINTS), room_for(POINTS)
    ends[many] = 0.0
    for i in range(many - 1, -1, -1):  # counted from the end, where pieces may be as short as the rounding of a phase
        ends[i] = ends[i + 1] + width_of(run, source + i)
    i = 0
    for k in range(POINTS):
        left = ends[0] * (1.0 - PLACES[k]) * (1.0 - PLACES[k] if form == TO_FOLD else 1.0)
        for _ in range(many):
            if i + 1 == many or left >= ends[i + 1]:
                break
            i += 1
        of_point[k], places[k] = float(i), place_in(run, source + i, left - ends[i + 1])
    error = 0.0
    for cell in range(run.counts.cells):
        if not describe(run, source, many, cell, of_point, places):
            return math.inf
        if form == IN_TIME:
            keep_end(run, source + many - 1, cell)
        error = max(error, distance(run, source, many, cell, ends, form))
        if not error <= run.state.merge_within + rounding_at(run, source, cell):
            return math.inf
    if run.counts.slots > run.counts.cells:
        fill(wave_in(run, AIR, run.counts.cells), 0.0)  # the rate of a machine is found anew
    return error


@kernel
def average(run: Run, source: int, many: int) -> None:
    """Write the means in time of the waves of `many` pieces of the history into the air."""
    for slot in range(run.counts.slots):
        pushed = lasted = 0.0
        for n in range(source, source + many):
            width, piece = width_of(run, n), run.history[n]
            pushed += width * mean_of(wave_in(run, row_of(run, n), slot), piece.speed, piece.bend, width)
            lasted += width
        wave = wave_in(run, AIR, slot)
        fill(wave, 0.0)
        wave[0] = pushed / lasted


@kernel
def place_in(run: Run, n: int, left: float) -> float:
    """Return the place xi in piece n of the history from which a time `left` (s) is left of it."""
    piece = run.history[n]
    at_end = max(piece.speed + 2.0 * piece.bend, 0.0)
    root = at_end + math.sqrt(max(at_end * at_end - 4.0 * piece.bend * left, 0.0))
    return 1.0 - (min(2.0 * left / root, 1.0) if root > 0.0 else 0.0)


@kernel
def place_of(run: Run, n: int, xi: float, past: float, whole: float, form: int) -> float:
    """Return the place in a new piece, of `whole` seconds, of the place xi in piece n of the history, `past` seconds before its end."""
    piece = run.history[n]
    left = (past + (1.0 - xi) * (piece.speed + piece.bend * (1.0 + xi))) / whole
    return 1.0 - (math.sqrt(max(left, 0.0)) if form == TO_FOLD else left)


@kernel
def describe(run: Run, source: int, many: int, cell: int, of_point: Floats, places: Floats) -> bool:
    """Write the new series of the wave in a cell into the air; return False if it has too many terms."""
    values, terms, wave = room_for(POINTS), room_for(POINTS), wave_in(run, AIR, cell)
    begin = wave_in(run, row_of(run, source), cell)[0]
    for k in range(POINTS):
        values[k] = evaluate(wave_in(run, row_of(run, source + int(of_point[k])), cell), places[k]) - begin
    noise = KEPT_ABOVE * run.state.merge_within + 0.25 * rounding_at(run, source, cell)
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
    return True


@kernel
def keep_end(run: Run, last: int, cell: int) -> None:
    """Let the new series of the wave in a cell end where piece `last` of the history ends."""
    wave = wave_in(run, AIR, cell)
    wave[1] += total(wave_in(run, row_of(run, last), cell)) - total(wave)


@kernel
def distance(run: Run, source: int, many: int, cell: int, ends: Floats, form: int) -> float:
    """Return a bound (Pa) on the difference between the new series of the wave in a cell and the old ones."""
    wave, values, largest = wave_in(run, AIR, cell), room_for(POINTS), 0.0
    for i in range(many):
        old, apart = wave_in(run, row_of(run, source + i), cell), 0.0
        for k in range(POINTS):
            place = place_of(run, source + i, PLACES[k], ends[i + 1], ends[0], form)
            values[k] = evaluate(wave, place) - evaluate(old, PLACES[k])
        for j in range(POINTS):
            apart += abs(term_of(values, j))
        largest = max(largest, weight_of(run, source + i) * apart)
    return largest


@kernel
def term_of(values: Floats, j: int) -> float:
    """Return term j of Chebyshev's series of a function with the given values at his points."""
    term = 0.0
    for k in range(POINTS):
        term += SPECTRUM[j, k] * values[k]
    return term
