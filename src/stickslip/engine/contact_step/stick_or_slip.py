"""Treat the contact at rest: its response to a new piece of load, healing, the end of rest, and the arrest of slip."""

from __future__ import annotations

import math

from stickslip.engine.contact.contact_equation import (
    SAME_LEVEL,
    TIE,
    choose_branch,
    face,
    friction_at,
    is_outdated,
    leave_branch,
    limit_towards,
    needs_branches,
    onset_of_slip,
    rest_limit,
    settle_branch,
    step_at_rest,
    towards,
)
from stickslip.engine.contact.pieces import keep_state, note_jump, record
from stickslip.engine.contact.pressing import is_pressing, own_states, states_ahead
from stickslip.engine.contact.stiffness import turn_states
from stickslip.engine.series.polynomial import evaluate, fill, restrict, scale_low
from stickslip.engine.state.layout import TERMS, Cause, Floats
from stickslip.engine.state.workspace import Run
from stickslip.foundation.kernels.kernels import kernel

TOUCH = 10.0
"""A rest shorter than sqrt(10 local tolerances) round trips, which is sqrt(rtol), is a brush with v = 0, not an arrest (1)."""


@kernel
def arrive(run: Run) -> None:
    """Decide how the contact answers a new piece of load: whether it sticks or slips, in which direction, and on which branch."""
    load = run.load[0]
    if run.counts.sticks == 0:
        if run.counts.has_inertia == 0 and run.counts.reverses == 0 and load != -run.params.reference:
            run.counts.mode = 1 if load > -run.params.reference else -1
        return
    mode = run.counts.mode
    if mode != 0 and run.counts.folds_move == 1 and run.counts.arriving == Cause.NO_CAUSE:
        pass  # The load continues without a jump, and so does the slip rate.
    elif mode != 0 and run.counts.is_algebraic == 1:
        seen = towards(run, load, mode)
        if run.counts.given > 0 and run.counts.arriving == Cause.LOADING:
            settle_branch(run, seen)
        branch = run.counts.branch
        if run.counts.mode != 0 and not run.branch_table[branch].keep_from <= seen <= run.branch_table[branch].keep_to:
            leave_branch(run, seen)
    elif mode != 0 and run.counts.has_inertia == 0:
        friction_at(run, run.state.law_slip, 0.0)
        if towards(run, load, mode) < run.friction.stress:
            run.counts.mode = 0
    if run.counts.mode == 0 and run.counts.leaving_rest == 0:
        limit = rest_limit(run, 1)
        for direction in (1, -1):
            if run.counts.mode == 0 and towards(run, load, direction) > limit_towards(run, direction, limit):
                start_slip(run, direction, towards(run, load, direction))
    if run.counts.mode == 0:
        note_jump(run, 0.0, run.counts.arriving)
        run.state.rate_now = 0.0


@kernel
def start_slip(run: Run, direction: int, load: float) -> None:
    """Leave rest in a direction, at a load that is seen that way (Pa or N, minus the reference).

    If the branches at this normal load are not known yet, the end of rest is only noted: it follows at once when they are.
    """
    if is_outdated(run):
        run.counts.leaving_rest = direction
        return
    run.counts.mode = direction
    face(run, direction)
    choose_branch(run, load)


@kernel
def end_of_rest(run: Run, load: Floats, width: float) -> tuple[float, int]:
    """Return the place on [0, 1] of an interval of load where rest ends, or NONE if rest lasts, and the direction of slip.

    The interval is `width` (in xi) long. The strength is that of the present states, and goes with the normal load.
    """
    strength = run.jet
    fill(strength, 0.0)
    strength[0] = rest_limit(run, 1)
    if run.counts.states > 0:
        states_ahead(run, width)
    if is_pressing(run):
        first = own_states(run)
        by_pressing = run.params.normal * (run.value.by_state[first] + run.params.static_excess)
        for k in range(1, TERMS):
            strength[k] = by_pressing * run.state_jet[TERMS * first + k]
    return onset_of_slip(run, load, strength)


@kernel
def is_arrest(run: Run, lasting: float) -> bool:
    """Return True if a rest that would last this long (s, without healing) is an arrest and not a brush with v = 0.

    A creeping block may touch v = 0 tangentially. The error of the rate is of the order of the tolerance and makes a rest whose
    duration is of the order of the tolerance's root. A contact without mass stops because the load falls, and stays at rest.
    """
    return run.counts.has_inertia == 0 or lasting > math.sqrt(TOUCH * run.params.tolerance) * run.params.round_trip_time


@kernel
def heal(run: Run, load: float) -> None:
    """Let a law that remembers slip since the last arrest forget it, so that friction is that of the start again.

    The contact slips at once if the healed strength cannot hold the load (Pa or N, minus the reference).
    """
    before = rest_limit(run, 1)
    run.state.law_slip, run.counts.piece = 0.0, int(run.params.healed_piece)
    limit = rest_limit(run, 1)
    if limit == before:
        return
    run.counts.leaving_rest = 0
    if run.counts.folds_move == 1:
        return  # The branches at the healed slip must be found first.
    for direction in (1, -1):
        beyond = towards(run, load, direction) - limit
        if abs(beyond) <= SAME_LEVEL * run.params.normal:
            run.counts.leaving_rest = direction  # Decide by the slope of the load, not by its rounding.
        elif beyond > 0.0:
            run.counts.mode = direction
            if run.counts.has_inertia == 0:
                note_jump(run, direction * beyond / run.params.damping, Cause.HEALING)


@kernel
def stick(run: Run, xi_to: float) -> None:
    """Stay at rest up to the place xi_to, or until the load exceeds the strength."""
    width, load = xi_to - run.state.xi, run.history[run.counts.length].load
    restrict(run.load, run.state.xi, width, load)
    onset, direction = end_of_rest(run, load, width)
    if run.params.healed_piece >= 0.0 and is_arrest(run, min(onset, 1.0) * width * run.state.speed):
        heal(run, load[0])
        if run.counts.mode != 0 or needs_branches(run):
            return
        onset, direction = end_of_rest(run, load, width)
    slips = onset <= 1.0 - TIE
    if slips:
        scale_low(load, TERMS - 1, onset)
    fill(run.history[run.counts.length].rate, 0.0)
    keep_state(run, onset if slips else 1.0)
    record(run, run.state.xi + onset * width if slips else xi_to)
    run.counts.leaving_rest = 0
    if slips:
        run.counts.leaving_rest = direction
        run.counts.stiff = run.counts.steps = 0
        start_slip(run, direction, rest_limit(run, direction))


@kernel
def come_to_rest(run: Run) -> None:
    """Bring the contact, whose slip rate has reached zero, to rest, or let it slip the way the load exceeds the strength.

    Under a law that never sticks, slip turns round at once.
    """
    before = run.counts.mode
    run.state.rate_now = 0.0
    if run.counts.sticks == 0:
        run.counts.mode = -before
        turn_states(run, run.state.state_now)
        return
    run.counts.mode = 0
    if run.counts.has_inertia == 0:
        run.counts.leaving_rest = before if step_at_rest(run) == 0.0 else 0
        return
    load = evaluate(run.load, run.state.xi)
    limit = rest_limit(run, 1)
    for direction in (1, -1):
        if towards(run, load, direction) > limit_towards(run, direction, limit):
            run.counts.mode = direction
            face(run, direction)
            return
