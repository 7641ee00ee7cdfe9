"""Lead slip to and from folds. There a branch ends because g turns, and the slip rate goes as the square root of time."""

from __future__ import annotations

import math

from stickslip.engine.contact.contact_equation import end_branch, friction_at, is_knot, rate_on_branch, towards
from stickslip.engine.contact.pieces import note_degree, phase_at
from stickslip.engine.contact.pressing import own_states, press
from stickslip.engine.series.polynomial import copy, evaluate, fill, restrict, total
from stickslip.engine.state import layout as at
from stickslip.engine.state.layout import Cause, Floats, NearFold, Task
from stickslip.engine.state.workspace import Run, borrow
from stickslip.foundation.kernels.kernels import entry, kernel
from stickslip.foundation.kernels.memory.addresses import call_part
from stickslip.foundation.kernels.memory.pointers import numbers_of

SHORTEST_FOLD = 1e-9
"""A way to a fold shorter than this (in xi) needs no side piece: the square root makes no difference."""
AT_THE_FOLD = 1e-14
"""The load counts as being at the fold within this share of the reference strength (1), the rounding of a load."""
SAME_LOAD = 1e-14
"""Two loads that differ by more than this (relative, 1) are certainly different."""
LAST_TO_FOLD = 1e-4
"""Before a fold that does not move, this last share (1) of the root of time is taken as a straight line: a series over so short a
bit is all rounding."""
DEPARTURE = 1e-10
"""This first share of the way (1) from a fold is taken as a straight line in the root of time. The error of the line is the same
share of the rate's change."""


@kernel
def ends_at_fold(run: Run, way: float) -> bool:
    """Return True if the branch that ends after the given way (in xi) ends because g turns smoothly there.

    Otherwise it ends at a knot of the law, or at a load where the rule prefers another solution.
    """
    branch = run.branch_table[run.counts.branch]
    level = towards(run, evaluate(run.load, run.state.xi + way), run.counts.mode)
    if abs(level - branch.keep_to) < abs(level - branch.keep_from):
        return branch.keep_to == branch.excess_to and not is_knot(run, branch.rate_to)
    return branch.rate_from > 0.0 and branch.keep_from == branch.excess_from and not is_knot(run, branch.rate_from)


@kernel
def share_described(c: Floats) -> float:
    """Return the largest share 2^-n of [0, 1] on which the lower half of a series' coefficients describes it to rounding.

    Only that half is left when the variable of the series is squared (`square_variable`).
    """
    share = 1.0
    for _ in range(60):
        total, tail, power = 0.0, 0.0, 1.0
        for k in range(at.TERMS):
            total += abs(c[k]) * power
            if 2 * k > at.TERMS - 1:
                tail += abs(c[k]) * power
            power *= share
        if tail <= 1e-16 * total:
            break
        share *= 0.5
    return share


@kernel
def square_variable(c: Floats, out: Floats) -> None:
    """Write the coefficients of p(y^2) into out, from those of p, cut to TERMS coefficients."""
    fill(out, 0.0)
    for k in range((at.TERMS + 1) // 2):
        out[2 * k] = c[k]


@kernel
def set_aside(run: Run, width: float) -> None:
    """Keep the present piece of load and the state, to be taken up again at a place that is `width` (in xi) further on."""
    copy(run.load, run.saved_load, at.TERMS)
    copy(numbers_of(run.state), numbers_of(run.saved), at.SAVED)
    run.saved.xi = run.state.xi + width
    if run.state.xi > 0.0:
        run.counts.arriving = Cause.NO_CAUSE


@kernel
def approach_fold(run: Run, width: float) -> float:
    """Replace the piece of load by a side piece that ends at the fold `width` (in xi) ahead.

    The slip rate goes as the square root of the time left, so that root becomes the variable. Returns 0 once the side piece is in
    place, or else the part of the way (in xi) that the contact must slip first.
    """
    backwards, squared = run.trial, run.spare
    restrict(run.load, run.state.xi + width, -width, backwards)  # from the fold backwards: z on [0, 1]
    share = share_described(backwards)
    if run.counts.cells > 0:
        share = min(share, call_part(run.ladder, run, Task.SHARE_DESCRIBED, width))
    if share < 1.0:
        return (1.0 - share) * width
    set_aside(run, width)
    if run.counts.cells > 0:
        call_part(run.ladder, run, Task.WAVES_TO_FOLD, width)
        restrict(run.load, run.state.xi + width, -width, backwards)  # the waves have used its place
    phase_from, phase_to = phase_at(run, run.state.xi), phase_at(run, run.state.xi + width)
    square_variable(backwards, squared)
    restrict(squared, 1.0, -1.0, run.load)
    run.state.phase_from, run.state.phase_to = phase_from, phase_to
    run.state.speed, run.state.bend, run.state.xi = 2.0 * (phase_to - phase_from), phase_from - phase_to, 0.0
    run.state.exit = math.nan
    note_degree(run)
    run.counts.at_fold = NearFold.APPROACHING
    return 0.0


@kernel
def starts_at_fold(run: Run) -> bool:
    """Return True if slip has just begun on a branch exactly at its fold, as it does by the maximal rule under a smooth load."""
    branch = run.counts.branch
    fold = run.branch_table[branch].rate_from
    if run.counts.leaving_rest == 0 or run.counts.at_fold != NearFold.NONE or fold == 0.0 or is_knot(run, fold):
        return False
    level = towards(run, evaluate(run.load, run.state.xi), run.counts.mode)
    return level - run.branch_table[branch].excess_from <= AT_THE_FOLD * run.params.reference


@kernel
def hardening(run: Run, rate: float) -> float:
    """Return how fast friction at a slip rate (m/s) grows (Pa/s), because slip goes on and the normal load changes."""
    friction_at(run, run.state.law_slip, rate)
    sense = run.counts.mode if run.params.counts_net == 1.0 else 1
    grows = run.friction.by_slip * sense * rate
    if run.counts.given > 0:
        first = own_states(run)
        grows += run.params.normal * run.value.by_state[first] * run.state.state_now[first + 1]
    return grows


@kernel
def load_outruns_fold(run: Run) -> bool:
    """Return True if the load grows faster than friction does at the moving fold."""
    fold, xi, direction = run.branch_table[run.counts.branch].rate_from, run.state.xi, run.counts.mode
    grows = hardening(run, fold)
    restrict(run.load, xi, 1.0, run.trial)
    return direction * run.trial[1] > grows * (run.state.speed + 2.0 * run.state.bend * xi)


@kernel
def depart_from_fold(run: Run, left: float) -> None:
    """Replace the first bit of the way from a fold by a side piece, on which the slip rate grows as the square root of time.

    `left` is the way (in xi) to the end of the step. The bit is so short that the load is a straight line in time along it, even
    in the echo of an earlier fold.
    """
    width, forwards = DEPARTURE * left, run.trial
    restrict(run.load, run.state.xi, width, forwards)
    rise, seen = run.counts.mode * forwards[1], SAME_LOAD * abs(run.branch_table[run.counts.branch].excess_from)
    if 0.0 < rise < seen:  # By rounding, the load at the end of the bit would still be the fold's.
        width = min(width * seen / rise, left)
        restrict(run.load, run.state.xi, width, forwards)
    set_aside(run, width)
    square_variable(forwards, run.load)
    if run.counts.cells > 0:
        call_part(run.ladder, run, Task.WAVES_FROM_FOLD, width)
    phase_from, phase_to = phase_at(run, run.state.xi), phase_at(run, run.state.xi + width)
    run.state.phase_from, run.state.phase_to = phase_from, phase_to
    run.state.speed, run.state.bend, run.state.xi = 0.0, phase_to - phase_from, 0.0
    note_degree(run)
    run.counts.at_fold = NearFold.DEPARTING


@kernel
def last_to_fold(run: Run) -> float:
    """Return the share (1) of the root of time before a fold that is taken as a straight line.

    It is larger where the fold moves, because a moving fold is known only as well as the run is accurate.
    """
    if run.counts.folds_move == 0:
        return LAST_TO_FOLD
    return max(LAST_TO_FOLD, 10.0 * math.sqrt(run.params.tolerance))


@kernel
def straight_to_fold(run: Run) -> None:
    """Replace the series of the last bit of the way to a fold by a straight line in the root of time.

    The series would be all rounding. With e the share that `last_to_fold` returns, the line misses e^2 of the rate's change along
    the piece, during e^2 of its time.
    """
    branch = run.branch_table[run.counts.branch]
    low, high = branch.rate_from, branch.rate_to
    fold = low if run.jet[0] - low < high - run.jet[0] else high
    if run.counts.folds_move == 1:
        fold = run.state.fold_rate
    for k in range(2, at.TERMS):
        run.jet[k] = 0.0
    run.jet[1] = fold - run.jet[0]


@kernel
def straight_from_fold(run: Run) -> None:
    """Write the first bit of the way from a fold as a straight line in the root of time: at the fold itself no series exists."""
    fold = run.branch_table[run.counts.branch].rate_from
    weakened = hardening(run, fold) * (run.state.speed + run.state.bend)
    reached = rate_on_branch(run, towards(run, total(run.load), run.counts.mode) - weakened, fold)
    fill(run.jet, 0.0)
    run.jet[0], run.jet[1] = fold, reached - fold


@kernel
def leave_fold_piece(run: Run) -> None:
    """Take up the piece of load again after the side piece next to a fold, and end the branch if the fold is reached."""
    state = run.state
    way = phase_at(run, 1.0) - phase_at(run, 0.0)
    if run.counts.at_fold == NearFold.DEPARTING and way > 0.0:  # The next series converges about as far as the fold is away.
        state.last_step = way
    rate, slipped, law_slip = state.rate_now, state.slip_now, state.law_slip
    last = state.last_step if state.last_step > 0.0 else run.saved.last_step  # The side piece was too short to take time.
    copy(numbers_of(run.saved), numbers_of(run.state), at.SAVED)
    state.rate_now, state.slip_now, state.law_slip, state.last_step = rate, slipped, law_slip, last
    copy(run.saved_load, run.load, at.TERMS)
    if run.counts.cells > 0:
        call_part(run.ladder, run, Task.WAVES_GO_ON, 0.0)
    note_degree(run)
    if run.counts.given > 0:
        press(run, phase_at(run, state.xi))
    reached = run.counts.at_fold == NearFold.APPROACHING
    run.counts.at_fold = NearFold.NONE
    if reached:
        reach_end(run)


@kernel
def reach_end(run: Run) -> None:
    """End the branch: go to another one at once, or, if folds move, when the branches at this slip are known."""
    if run.counts.folds_move == 1:
        run.counts.branch_ended = 1
    else:
        run.counts.stalled += 1  # Counting ends a run that alternates between branches without taking time.
        end_branch(run)


@kernel
def leave_moving_branch(run: Run) -> None:
    """Go from a branch that has ended to another one, now that the branches at this slip are known.

    The rest of a side piece that was made for a fold is walked like any other piece.
    """
    run.counts.branch_ended = 0
    run.counts.stalled += 1
    end_branch(run)
    if run.counts.at_fold != NearFold.NONE:
        run.counts.at_fold = NearFold.PASSING


@entry
def folds(memory: int, task: int, way: float) -> float:
    """Lead slip over the given way (in xi) to a fold or away from one: see `Task`."""
    run = borrow(memory)
    if task == Task.APPROACH_FOLD:
        return approach_fold(run, way)
    if task == Task.DEPART_FROM_FOLD:
        depart_from_fold(run, way)
    elif task == Task.STRAIGHT_TO_FOLD:
        straight_to_fold(run)
    elif task == Task.STRAIGHT_FROM_FOLD:
        straight_from_fold(run)
    else:
        leave_fold_piece(run)
    return 0.0
