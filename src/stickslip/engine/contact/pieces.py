"""Place the contact on the present piece of load, append steps to the history, and note shocks."""

from __future__ import annotations

import math

from stickslip.engine.contact.far_end import gain_of_echo
from stickslip.engine.series.polynomial import copy, degree, extremes, fill, scale_low, total, turn_over
from stickslip.engine.state.layout import TERMS, Task
from stickslip.engine.state.workspace import Run
from stickslip.foundation.kernels.kernels import inlined, kernel
from stickslip.foundation.kernels.memory.addresses import ahead, call_part

RESOLVED = 1e-12
"""Shortest slip (duration as a share of a round trip, 1) whose two ends double precision separates well enough."""


@kernel
def phase_at(run: Run, xi: float) -> float:
    """Return the phase (s) in the round trip at the place xi of the present piece of load."""
    return run.state.phase_to if xi >= 1.0 else run.state.phase_from + xi * (run.state.speed + xi * run.state.bend)


@kernel
def xi_at(run: Run, phase: float) -> float:
    """Return the place xi in the present piece of load that has the given phase (s)."""
    rest = phase - run.state.phase_from
    root = math.sqrt(max(run.state.speed * run.state.speed + 4.0 * run.state.bend * rest, 0.0))
    pace = run.state.speed + root
    return 2.0 * rest / pace if pace > 0.0 else 0.0


@kernel
def note_degree(run: Run) -> None:
    """Note the degree of a new piece of load and clear run.local and run.load_along_slip.

    Beyond that degree the load's series over a step is zero too. The load of a position loop has all degrees, since slip bends it.
    """
    run.counts.degree = degree(run.load) if run.params.winding == 0.0 else TERMS - 1
    fill(run.local, 0.0)
    fill(run.load_along_slip, 0.0)


@kernel
def keep_state(run: Run, length: float) -> None:
    """Store the states' series in run.state_jet, up to `length` (in their unit), in the history, and move the states to its end."""
    series = run.counts.states + (1 if run.counts.slots > run.counts.cells else 0)  # behind them, the rate of a machine
    for n in range(run.counts.states):
        kept = ahead(run.history_state, TERMS * (series * run.counts.length + n))
        copy(ahead(run.state_jet, TERMS * n), kept, TERMS)
        if length != 1.0:
            scale_low(kept, TERMS - 1, length)
        run.state.state_now[n] = total(kept)
        if run.counts.mode < 0 and (run.counts.reverses >> n) % 2 == 1:
            turn_over(kept)


@inlined
def record(run: Run, xi_to: float) -> None:
    """Append the step from the present place to xi_to, and move xi there.

    Its load and slip rate are already in the next free piece of the history. A step that takes no time is not kept, but counts as
    stalled.
    """
    xi = run.state.xi
    width = xi_to - xi
    phase_from, phase_to = phase_at(run, xi), phase_at(run, xi_to)
    if phase_to > phase_from:
        n = run.counts.length
        kept = run.history[n]
        kept.trip, kept.mode, kept.law_piece = run.counts.trip, run.counts.mode, run.counts.piece
        kept.jump, kept.cause, kept.echo_of = run.counts.jump, run.counts.cause, run.counts.echo_of
        kept.phase_from, kept.phase_to = phase_from, phase_to
        kept.speed = (run.state.speed + 2.0 * run.state.bend * xi) * width
        kept.bend = run.state.bend * width * width
        kept.slip, kept.law_slip = run.state.slip_now, run.state.law_slip
        kept.amplified = run.state.amplified
        kept.gain = gain_of_echo(run) * (run.state.gain if run.counts.mode != 0 else 1.0)
        kept.residual = run.state.residual
        if run.state.residual > run.state.largest_residual:
            run.state.largest_residual = run.state.residual
        if run.counts.mode != 0:
            run.state.slid += phase_to - phase_from
            if math.isnan(run.state.residual):
                run.state.slid_unproven += phase_to - phase_from
        note_slip(run, n, phase_from)
        if run.counts.cells > 0:
            call_part(run.ladder, run, Task.KEEP_WAVES, xi_to)
        run.counts.length = n + 1
        run.counts.jump = run.counts.cause = run.counts.stalled = 0
    else:
        run.counts.stalled += 1
    run.state.residual = 0.0  # rest without a state is exact, and every other step sets its own
    run.state.xi = xi_to


@kernel
def note_slip(run: Run, n: int, phase: float) -> None:
    """Note where slip begins, and count the slips that were too short to be resolved, minus the others (at least 0).

    n is the piece of the history that is being written, and `phase` (s) the phase at its start.
    """
    slips, slipped = run.counts.mode != 0, n > 0 and run.history[n - 1].mode != 0
    if slips and not slipped:
        run.counts.slip_trip, run.state.slip_since = run.counts.trip, phase
    elif slipped and not slips:
        lasted = (run.counts.trip - run.counts.slip_trip) * run.params.round_trip_time + (phase - run.state.slip_since)
        tiny = lasted < RESOLVED * run.params.round_trip_time
        run.counts.unresolved_slips = run.counts.unresolved_slips + 1 if tiny else max(run.counts.unresolved_slips - 1, 0)


@kernel
def note_jump(run: Run, rate: float, cause: int) -> None:
    """Mark a shock, with its cause, if the slip rate is about to jump to the given rate (m/s, signed)."""
    before = run.state.rate_now
    size = abs(rate - before)
    if size > run.params.smallest_jump and size > run.params.relative_jump * max(abs(rate), abs(before)):
        run.counts.cause = cause
        run.counts.jump = 1


@kernel
def span_of_load(run: Run) -> tuple[float, float]:
    """Return the least and the largest load (Pa or N, minus the reference strength) in the round trip just past."""
    least, largest = math.inf, -math.inf
    for n in range(run.counts.trip_from, run.counts.length):
        low, high = extremes(run.history[n].load)
        least, largest = min(least, low), max(largest, high)
    return least, largest
