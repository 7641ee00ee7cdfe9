"""Folds: where the branch of slip rates ends because g turns, and the slip rate goes as the square root of the time left."""

from __future__ import annotations

from stickslip.evolution import layout as at
from stickslip.evolution.branch import end_branch, towards
from stickslip.evolution.compiled import inlined
from stickslip.evolution.layout import Floats
from stickslip.evolution.polynomial import copy, evaluate, fill, restrict
from stickslip.evolution.record import note_degree, theta_at
from stickslip.evolution.workspace import Run

SHORTEST_FOLD = 1e-9
"""Way (in xi) below which the square root makes no difference."""
APPROACHING, DEPARTING = 1, 2
AT_THE_FOLD = 1e-14
DEPARTURE = 1e-10
"""Share of the way that is walked as a straight line in the root of time: the line misses this share of the rate's change."""


@inlined
def ends_at_fold(run: Run, way: float) -> bool:
    """Whether the branch ends there because g turns, and not because the rule prefers another solution."""
    branch = run.counts[at.BRANCH]
    level = towards(run, evaluate(run.load, run.state[at.XI] + way), run.counts[at.MODE])
    if abs(level - run.keep_to[branch]) < abs(level - run.keep_from[branch]):
        return run.keep_to[branch] == run.excess_to[branch]
    return run.rate_from[branch] > 0.0 and run.keep_from[branch] == run.excess_from[branch]


@inlined
def share_described(c: Floats) -> float:
    """How far from 0 (as 2^-n) the first half of a series describes it to rounding: squaring its variable leaves no more terms."""
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


@inlined
def square_variable(c: Floats, out: Floats) -> None:
    """p(y^2) from p, cut to the terms that there are."""
    fill(out, 0.0)
    for k in range((at.TERMS + 1) // 2):
        out[2 * k] = c[k]


@inlined
def set_aside(run: Run, width: float) -> None:
    """Keep the present piece of load, to be taken up again `width` further."""
    copy(run.load, run.kept_load, at.TERMS)
    copy(run.state, run.kept, at.STATES)
    run.kept[at.XI] = run.state[at.XI] + width


@inlined
def approach_fold(run: Run, width: float) -> float:
    """Prepare the way to a fold at distance `width`: s goes as the square root of the time left, so that becomes the variable.

    Returns 0 once the piece is changed, or the part of the way that must be walked first.
    """
    backwards, squared = run.part, run.spare
    restrict(run.load, run.state[at.XI] + width, -width, backwards)  # from the fold, z on [0, 1]
    share = share_described(backwards)
    if share < 1.0:
        return (1.0 - share) * width
    set_aside(run, width)
    theta_from, theta_to = theta_at(run, run.state[at.XI]), theta_at(run, run.state[at.XI] + width)
    square_variable(backwards, squared)
    restrict(squared, 1.0, -1.0, run.load)
    run.state[at.THETA_FROM], run.state[at.THETA_TO] = theta_from, theta_to
    run.state[at.SPEED], run.state[at.BEND], run.state[at.XI] = 2.0 * (theta_to - theta_from), theta_from - theta_to, 0.0
    note_degree(run)
    run.counts[at.AT_FOLD] = APPROACHING
    return 0.0


@inlined
def starts_at_fold(run: Run) -> bool:
    """Whether slip has just been taken up on a branch at its very fold, as the maximal rule does it under a smooth load."""
    branch = run.counts[at.BRANCH]
    if run.counts[at.EDGE] == 0 or run.state[at.BEND] != 0.0 or run.rate_from[branch] == 0.0:
        return False
    level = towards(run, evaluate(run.load, run.state[at.XI]), run.counts[at.MODE])
    return level - run.excess_from[branch] <= AT_THE_FOLD * run.par[at.REFERENCE]


@inlined
def depart_from_fold(run: Run, left: float) -> None:
    """Prepare the first bit of the way from a fold, on which the rate grows as the root of time."""
    width, forwards = DEPARTURE * left, run.part
    if run.state[at.XI] > 0.0:
        run.counts[at.ARRIVING] = at.NO_CAUSE
    restrict(run.load, run.state[at.XI], width, forwards)
    set_aside(run, width)
    square_variable(forwards, run.load)
    theta_from, theta_to = theta_at(run, run.state[at.XI]), theta_at(run, run.state[at.XI] + width)
    run.state[at.THETA_FROM], run.state[at.THETA_TO] = theta_from, theta_to
    run.state[at.SPEED], run.state[at.BEND], run.state[at.XI] = 0.0, theta_to - theta_from, 0.0
    note_degree(run)
    run.counts[at.AT_FOLD] = DEPARTING


@inlined
def leave_fold_piece(run: Run) -> None:
    """The piece next to a fold is done: take up the piece of load where it was left, and jump if the fold is reached."""
    state = run.state
    way = theta_at(run, 1.0) - theta_at(run, 0.0)
    if run.counts[at.AT_FOLD] == DEPARTING and way > 0.0:  # the next series reaches about as far as the fold is away
        state[at.LAST_STEP] = way
    rate, slipped, law_slip, last = state[at.RATE_NOW], state[at.SLIP_NOW], state[at.LAW_SLIP], state[at.LAST_STEP]
    copy(run.kept, run.state, at.STATES)
    state[at.RATE_NOW], state[at.SLIP_NOW], state[at.LAW_SLIP], state[at.LAST_STEP] = rate, slipped, law_slip, last
    copy(run.kept_load, run.load, at.TERMS)
    note_degree(run)
    reached = run.counts[at.AT_FOLD] == APPROACHING
    run.counts[at.AT_FOLD] = 0
    if reached:
        end_branch(run)
