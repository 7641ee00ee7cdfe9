"""Merge pieces of the waves in layers: neighbours that one series describes to the tolerance become one piece of load.

The end of each step of the contact, and of each part of a machine's motion, is an end of pieces in all cells for ever after, at
its phase. Where nothing jumps there, the waves go on smoothly. So once a round trip has more pieces than after the last time, and
else from time to time, the waves of the next one are expanded anew as they come to the contact: as many neighbours as one series
in xi can describe in every cell are brought as one piece of load. Jumps of the load, and folds, stay where they are.

Up to a fold the slip rate goes as the root of the time left. Steps that come to it in another variable get shorter and shorter;
the waves are then written in that root, up to the jump where such steps end. `waves.merged_series` makes the series.

Where a round trip has too many pieces even so, because the load has as many jumps, short pieces are lumped: the waves of a group
that is as long as the shortest event are replaced by their means.
"""

from __future__ import annotations

import math

from stickslip.engine.series.polynomial import copy, total
from stickslip.engine.state.layout import TERMS
from stickslip.engine.state.workspace import Run
from stickslip.engine.waves.ladder_rows import AIR, kept_wave, row_of, wave_in
from stickslip.engine.waves.merged_series import (
    IN_TIME,
    MEAN,
    MOST_TOGETHER,
    TO_FOLD,
    WaveGroup,
    average,
    lay_out,
    merge,
    rounding_at,
    weight_of,
    width_of,
)
from stickslip.foundation.kernels.kernels import kernel

FEW, MANY = 4, 32
"""Nothing is merged in a round trip with no more pieces than the first number (1), and growth counts beyond the second."""
CROWD = 1024
"""Merge pieces as often as possible where a round trip has so many (1) or more."""
PAUSE = 128
"""Pieces are merged after this many round trips (1) at the latest: merging one takes the time of some ten others."""
LOOSER = 10.0
"""Merging may change the one wave of a uniform body by this factor (1) more: by the tolerance of the run and not that of a step."""
HALVINGS_OF_GROUP = 8
"""Halve a group of pieces at most this many times (1), until one series describes it."""
SHORTER = 0.125
"""Steps that come to a fold, as only an algebraic contact has it, are at least this much (1) shorter at its end than at first."""
LARGEST_TURN = 1.0
"""A tone in the loading is a polynomial to rounding up to this phase (rad)."""


# ---- when -------------------------------------------------------------------------------------------------------------------


@kernel
def plan_merging(run: Run) -> None:
    """Decide whether pieces are merged in the round trip that begins, from the one just closed.

    Growth is counted from the round trip after a merged one: there the contact has cut merged pieces into the steps it needs. In
    a crowd it is counted from the merged one itself: merging every second one then saves as much time as it takes, and memory.
    """
    counts, state = run.counts, run.state
    pieces = counts.previous_to - counts.previous_from
    if counts.slots == 0:
        counts.merged = 0
    if counts.merge_at == 0:
        counts.merge_at = counts.trip + PAUSE
    if counts.merging == 1:
        counts.merging, counts.merge_above = 0, pieces + pieces // 4 if pieces > CROWD else 0
        state.merged_in_all += state.merged_now
        state.merged_now = 0.0
    elif counts.slots == 0 and run.params.damper_pace == 0.0 and pieces <= CROWD:
        return  # where the echoes of kinks do not shrink, they are left as they are while they are few
    elif counts.merge_above == 0 and pieces > MANY:
        counts.merge_above = pieces + pieces // 4 + 8
    elif (pieces > MANY and pieces > counts.merge_above) or (pieces > FEW and counts.trip >= counts.merge_at):
        counts.merging, counts.merge_at = 1, counts.trip + PAUSE
        counts.smooth_to, counts.merge_guess = 0, MOST_TOGETHER
        state.merge_within = run.params.tolerance * swing_of_waves(run) * (LOOSER if counts.slots == 0 else 1.0)


@kernel
def swing_of_waves(run: Run) -> float:
    """Return how far (Pa) a wave in any cell, or impedance times slip rate, goes up and down in the round trip just closed."""
    counts, largest = run.counts, 0.0
    for n in range(counts.previous_from, counts.previous_to):
        largest = max(largest, run.params.impedance * abs(run.history[n].rate[0]))
    for cell in range(counts.cells):
        low, high = math.inf, -math.inf
        for n in range(counts.previous_from, counts.previous_to):
            value = kept_wave(run, n, cell)[0]
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
        average(run, WaveGroup(source, counts.merged, MEAN))
    elif counts.merged > 0:
        merge(run, WaveGroup(source, counts.merged, counts.merged_as))
    if counts.slots == 0:
        bring_wave(run, source)
    elif counts.merged == 0:
        copy(wave_in(run, row_of(run, source), 0), wave_in(run, AIR, 0), counts.slots * TERMS)
    else:
        lay_out(run, WaveGroup(source, counts.merged, counts.merged_as))


@kernel
def bring_wave(run: Run, source: int) -> None:
    """Bring the wave of a uniform body: that of one piece of the history, or one series for several, which is in the load."""
    if run.counts.merged == 0:
        copy(kept_wave(run, source, 0), run.load, TERMS)
    else:
        lay_out(run, WaveGroup(source, run.counts.merged, run.counts.merged_as))


@kernel
def merge_ahead(run: Run, source: int) -> None:
    """Merge as many pieces from `source` on as one series describes. One next to a fold is at least written in time."""
    counts = run.counts
    if counts.smooth_to <= source + 1:
        counts.smooth_to = source + smooth_ahead(run, source)
    many = fitting_tone(run, source, counts.smooth_to - source)
    leads_to_fold = counts.is_algebraic == 1 and many > 1 and width_of(run, source + many - 1) < SHORTER * width_of(run, source)
    if leads_to_fold and keep_merged(run, WaveGroup(source, many, TO_FOLD)):
        return
    many = min(many, counts.merge_guess)
    for _ in range(HALVINGS_OF_GROUP):
        if many == 1 and run.history[source].bend == 0.0:
            break
        if keep_merged(run, WaveGroup(source, many, IN_TIME)) or many == 1:
            break
        many = (many + 1) // 2
    counts.merge_guess = 4 * many


@kernel
def keep_merged(run: Run, group: WaveGroup) -> bool:
    """Merge a group, and note it; return False if one series does not describe its waves."""
    error = merge(run, group)
    if not error < math.inf:
        return False
    run.counts.merged, run.counts.merged_as = group.many, group.form
    run.state.merged_now = max(run.state.merged_now, error)
    return True


@kernel
def smooth_ahead(run: Run, source: int) -> int:
    """Return the number of pieces from `source` on that follow each other without a jump."""
    many = 1
    for n in range(source + 1, min(run.counts.previous_to, source + MOST_TOGETHER)):
        if not follows(run, n):
            break
        many += 1
    return many


@kernel
def fitting_tone(run: Run, source: int, many: int) -> int:
    """Return how many of these pieces are so short together that a tone in the loading is a polynomial on them."""
    if run.params.tone_frequency == 0.0:
        return many
    longest = LARGEST_TURN / run.params.tone_frequency
    for n in range(source + 1, source + many):
        if run.history[n].phase_to - run.history[source].phase_from > longest:
            return n - source
    return many


@kernel
def follows(run: Run, n: int) -> bool:
    """Return True if the waves of piece n of the history go on from those of the piece before."""
    now, before = run.history[n], run.history[n - 1]
    if now.trip != before.trip or now.phase_from != before.phase_to:
        return False
    weight = min(weight_of(run, n), weight_of(run, n - 1))
    for cell in range(max(run.counts.cells, 1)):
        step = kept_wave(run, n, cell)[0] - total(kept_wave(run, n - 1, cell))
        if weight * abs(step) > run.state.merge_within + rounding_at(run, n, cell):
            return False
    return True


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
    average(run, WaveGroup(source, many, MEAN))
