"""Merge the strips at the borders of creep: in each round trip slip spreads a little, and each strip would stay a piece for ever.

Before a pulse of a slab under a law of slip some twenty round trips creep ever faster, under the crests of the waves that ring in
it. In each of them slip begins at both borders of each crest on a strip of a millionth of a round trip. Its slip rate is above and
below that of its neighbours in turn, so that it remains a piece of its own: the pieces grow with the square of the round trips,
and their borders cut the pulse, and all that comes after it, into ever smaller pieces.

A strip is therefore taken together with the creep beside it: the echo of the wide piece goes on over the strips, moved so that the
mean of the echo is what it was. Slip at the end of the group is then the same, and within it slip is off by no more than the
difference of the slip rates times the width of the strip (m). This is done where that is less than the tolerance of the slip so
far, and its sum is kept.
"""

from __future__ import annotations

from stickslip.engine.series.polynomial import copy, moment, restrict, total
from stickslip.engine.state.layout import TERMS
from stickslip.engine.state.workspace import Run
from stickslip.foundation.kernels.kernels import kernel

CROWD = 64
"""Strips are merged after a round trip with more pieces (1) than this."""
MOST_TOGETHER = 256
"""Largest number of pieces (1) in a group."""
WIDTH_OF_STRIPS = 1.0 / 64.0
"""Largest width of all strips in a group, as a share of the wide piece (1): so far its series is continued."""


@kernel
def merges_creep(run: Run) -> bool:
    """Return True if strips are merged in this round trip: the run leaps over creep, and has many pieces in a round trip."""
    counts = run.counts
    is_creep = counts.is_algebraic == 0 and counts.has_inertia == 0 and counts.states == 0
    return is_creep and counts.creep_leaps > 0 and counts.lumps == 0 and counts.previous_to - counts.previous_from > CROWD


@kernel
def follows(run: Run, n: int) -> bool:
    """Return True if piece n of the history slips on from the one before it, in the round trip just past."""
    now, before = run.history[n], run.history[n - 1]
    if now.trip != before.trip or now.trip != run.counts.trip - 1 or now.phase_from != before.phase_to:
        return False
    return now.mode == before.mode and now.mode != 0 and now.bend == 0.0 and before.bend == 0.0


@kernel
def plan_group(run: Run, source: int) -> None:
    """Set how many pieces from `source` on are brought as one, and which of them is the wide one: `echo_of`."""
    counts = run.counts
    counts.merged, counts.merged_from, counts.echo_of = 0, source, source
    if not merges_creep(run):
        return
    past = source + 1
    while past < min(counts.previous_to, source + MOST_TOGETHER) and follows(run, past):
        past += 1
    wide = source
    for n in range(source + 1, past):
        if run.history[n].speed > run.history[wide].speed:
            wide = n
    allowed, room = run.params.tolerance * abs(run.state.slip_now), WIDTH_OF_STRIPS * run.history[wide].speed
    shift = strips = 0.0
    for n in range(source, wide):
        shift, strips = shift + shifted(run, n, run.history[wide].rate[0]), strips + run.history[n].speed
    if not (shift <= allowed and strips <= room):
        return
    end, rate = wide + 1, total(run.history[wide].rate)
    while end < past and strips + run.history[end].speed <= room and shift + shifted(run, end, rate) <= allowed:
        shift, strips, end = shift + shifted(run, end, rate), strips + run.history[end].speed, end + 1
    if end > source + 1:
        counts.merged, counts.echo_of = end - source, wide
        run.state.shifted += shift


@kernel
def shifted(run: Run, n: int, rate: float) -> float:
    """Return how far (m) slip may be off within strip n of the history, if its slip rate is the given one (m/s) instead."""
    own = run.history[n].rate
    return run.history[n].speed * max(abs(own[0] - rate), abs(total(own) - rate))


@kernel
def lay_out_group(run: Run) -> None:
    """Set the phases of the piece of load to those of the group."""
    counts, state = run.counts, run.state
    state.phase_from = run.history[counts.merged_from].phase_from
    state.phase_to = run.history[counts.merged_from + counts.merged - 1].phase_to
    state.speed, state.bend = state.phase_to - state.phase_from, 0.0


@kernel
def continue_echo(run: Run, share: float) -> None:
    """Continue the echo of the wide piece, which is in run.load, over its group, with the mean of all echoes in the group.

    `share` is that of a wave that the driver sends back.
    """
    counts, width, z2 = run.counts, run.state.speed, 2.0 * run.params.impedance
    wide = run.history[counts.echo_of]
    restrict(run.load, (run.state.phase_from - wide.phase_from) / wide.speed, width / wide.speed, run.spare)
    copy(run.spare, run.load, TERMS)
    mean = moment(run.load, 1)
    for n in range(counts.merged_from, counts.merged_from + counts.merged):
        piece = run.history[n]
        own = share * (z2 * moment(piece.rate, 1) - moment(piece.load, 1))
        run.load[0] += (own - mean) * piece.speed / width
