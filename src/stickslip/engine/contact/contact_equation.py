"""Solve the contact equation at one load: evaluate friction and static strength, and choose the branch by the selection rule."""

from __future__ import annotations

import math

from stickslip.engine.contact.pieces import note_jump
from stickslip.engine.contact.pressing import is_pressing, own_states
from stickslip.engine.series.polynomial import NONE, evaluate, first_descent, restrict, restrict_low
from stickslip.engine.state import layout as at
from stickslip.engine.state.layout import BranchRow, Cause, Floats, Incoming
from stickslip.engine.state.workspace import Run
from stickslip.foundation.kernels.kernels import kernel
from stickslip.foundation.kernels.memory.addresses import ahead, call_state_value, call_value
from stickslip.foundation.kernels.memory.pointers import numbers_of
from stickslip.problem import Stop

TIE = 1e-13
"""An event closer (in xi) to the end of a piece than this waits for the start of the next piece, because changes that arrive with
the load come first."""
SAME_LEVEL = 1e-14
"""Two levels of the load that differ by less than this share of the normal load (1) are one: the rest is rounding."""
NEAR_KNOT = 1e-12
"""A slip rate closer to a knot than this (relative, 1) counts as being at the knot."""


@kernel
def constants_of(run: Run, piece: int) -> Floats:
    """Return a pointer to the constants of a piece of the law."""
    return ahead(run.constants, piece * run.size)


@kernel
def first_piece(run: Run) -> int:
    """Return the first piece of the law that holds in the present direction of slip, or in the one that a contact at rest faces."""
    return int(run.params.backward_piece) if run.counts.piece >= run.params.backward_piece else 0


@kernel
def last_piece(run: Run) -> int:
    """Return the last piece of the law that holds in that direction."""
    return run.pieces - 1 if run.counts.piece >= run.params.backward_piece else int(run.params.backward_piece) - 1


@kernel
def face(run: Run, direction: int) -> None:
    """Set the piece of the law to the one for slip from here in a direction, at slip rate 0, if friction differs by direction."""
    if run.params.backward_piece > 0.0:
        piece = int(run.params.backward_piece) if direction < 0 else 0
        reached = 0.0 if run.counts.knots_in_rate == 1 else run.state.law_slip
        while reached >= run.law[piece].knot:  # the last one has no end
            piece += 1
        run.counts.piece = piece


@kernel
def piece_at(run: Run, rate: float) -> int:
    """Return the piece of the law at a slip rate (m/s), or, if the knots are in slip, the piece that slip has reached."""
    if run.counts.knots_in_rate == 0:
        return run.counts.piece
    piece, last = first_piece(run), last_piece(run)
    while piece < last and rate >= run.law[piece].knot:
        piece += 1
    return piece


@kernel
def is_knot(run: Run, rate: float) -> bool:
    """Return True if the law has a knot at this slip rate (m/s)."""
    if run.counts.knots_in_rate == 1:
        for knot in range(first_piece(run), last_piece(run)):
            if abs(run.law[knot].knot - rate) <= NEAR_KNOT * rate:
                return True
    return False


@kernel
def law_at(run: Run, piece: int, law_slip: float, rate: float, states: Floats) -> None:
    """Write the formula of a piece of the law but for its offset, its derivatives, and the change of the states into run.value.

    `law_slip` is the slip as the law counts it (m), and `rate` the magnitude of the slip rate (m/s).
    """
    formula_at(run, piece, law_slip + run.law[piece].slip_shift, rate, states)


@kernel
def formula_at(run: Run, piece: int, slip: float, rate: float, states: Floats) -> None:
    """Do the same as `law_at` at a slip (m) that is counted from the reference slip of the piece."""
    law, constants, value = run.law[piece], constants_of(run, piece), numbers_of(run.value)
    if run.counts.states > 0:
        call_state_value(law.state_at, constants, slip, rate, states, value)
    else:
        call_value(law.value_at, constants, slip, rate, value)


@kernel
def friction_at(run: Run, law_slip: float, rate: float) -> None:
    """Write friction at a slip (m, as the law counts it) and a slip rate (m/s, magnitude) into run.friction."""
    friction_of(run, piece_at(run, rate), law_slip, rate)


@kernel
def friction_of(run: Run, piece: int, law_slip: float, rate: float) -> None:
    """Write friction into run.friction as `friction_at` does, by the formula of the given piece of the law."""
    value, friction = run.value, run.friction
    law_at(run, piece, law_slip, rate, run.state.state_now)
    friction.coefficient = value.mu + run.law[piece].offset
    friction.stress = run.params.normal * friction.coefficient
    friction.by_rate = value.by_rate * run.params.normal
    friction.by_slip = value.by_slip * run.params.normal


@kernel
def step_at_rest(run: Run) -> float:
    """Return the step from sliding to static friction (1) in the direction that the contact faces, under the first normal load."""
    backward = run.params.backward_piece
    return run.params.backward_excess if 0.0 < backward <= run.counts.piece else run.params.static_excess


@kernel
def static_step(run: Run, states: Floats) -> float:
    """Return the step from sliding to static friction (1, as a share of the normal load at t = 0) under the present normal load."""
    step = step_at_rest(run)
    return step * (1.0 + states[own_states(run)]) if run.counts.given > 0 else step


@kernel
def rest_limit(run: Run, direction: int) -> float:
    """Return the load (Pa or N, as seen in a direction, minus the reference) where the selection rule leaves rest in it.

    It is the static strength, or less if the rule lets slip begin below it. A strength that is not finite ends the run: no load
    would ever exceed a strength that is not a number.
    """
    face(run, direction)
    friction_at(run, run.state.law_slip, 0.0)
    if not math.isfinite(run.friction.stress):
        run.counts.breach = Stop.FAILED
    # The step to static friction is added to the coefficient before any product, so that the two cancel exactly if they cancel.
    coefficient = run.friction.coefficient + static_step(run, run.state.state_now)
    two_ways = run.params.backward_piece > 0.0
    return run.params.normal * coefficient + (run.params.backward_stick_to if two_ways and direction < 0 else run.params.stick_to)


@kernel
def limit_towards(run: Run, direction: int, forward: float) -> float:
    """Return the load (Pa or N, as seen in a direction) that ends rest in it: `forward`, unless friction differs by direction."""
    return forward if run.params.backward_piece == 0.0 else rest_limit(run, direction)


@kernel
def is_barred(run: Run, direction: int) -> bool:
    """Return True if slip in a direction cannot begin: the contact slips the other way only, or is at a hard stop."""
    if direction > 0:
        return run.state.slip_now >= run.params.stop_ahead
    return run.counts.one_way == 1 or run.state.slip_now <= run.params.stop_behind


@kernel
def towards(run: Run, load: float, direction: int) -> float:
    """Return the load (Pa or N, minus the reference) as seen in the direction of slip, again minus the reference.

    It sees no load at all in a direction that is barred to slip.
    """
    if is_barred(run, direction):
        return -math.inf
    return load if direction > 0 else -load - 2.0 * run.params.reference


@kernel
def load_ahead(run: Run, unit: float) -> None:
    """Write the series of the load from the present place into run.local, in powers of the distance divided by `unit` (in xi).

    run.load_along_slip receives the same series as seen in the direction of slip.
    """
    load, local, seen, direction, n = run.load, run.local, run.load_along_slip, run.counts.mode, run.counts.degree
    if n <= 1:
        local[0] = load[0] + run.state.xi * load[1]
        local[1] = unit * load[1]
        seen[1] = direction * local[1]
    else:
        restrict_low(load, n, run.state.xi, unit, local)
        for k in range(1, n + 1):
            seen[k] = direction * local[k]
    seen[0] = towards(run, local[0], direction)


@kernel
def onset_of_slip(run: Run, load: Floats, strength: Floats) -> tuple[float, int]:
    """Return where on [0, 1] the load first exceeds the strength (both minus the reference), and the direction of the slip.

    The place is NONE, and the direction 0, if the load stays within the strength.
    """
    part, onset, direction = run.trial, NONE, 0
    for way in (1, -1):
        if is_barred(run, way):
            continue
        for k in range(at.TERMS):
            part[k] = strength[k] - way * load[k]
        limit = limit_towards(run, way, strength[0])
        part[0] = 0.0 if run.counts.leaving_rest == way else limit - towards(run, load[0], way)
        first = first_descent(part, run.spare)
        if first < onset:
            onset, direction = first, way
    return onset, direction


@kernel
def rate_on_branch(run: Run, load: float, guess: float) -> float:
    """Return the slip rate (m/s) on the current branch that solves g(s) = load, by Newton's method kept inside the branch."""
    branch = run.branch_table[run.counts.branch]
    low, high = branch.rate_from, branch.rate_to
    if load <= branch.excess_from:
        return low
    if load >= branch.excess_to:
        return high
    high = min(high, (load + run.params.largest_drop) / run.params.damping * (1.0 + 1e-12))
    s = guess if low < guess < high else 0.5 * (low + high)
    for _ in range(200):
        friction_at(run, run.state.law_slip, s)
        error = run.params.damping * s + run.friction.stress - load
        if error > 0.0:
            high = s
        elif error < 0.0:
            low = s
        else:
            return s
        slope = run.params.damping + run.friction.by_rate
        step = s - error / slope if slope > 0.0 else 0.5 * (low + high)
        if not low < step < high and step != s:  # where Newton has converged, s itself bounds the interval
            step = 0.5 * (low + high)
        if abs(step - s) <= 1e-16 * abs(s) or step in (low, high):
            return step
        s = step
    return s


@kernel
def rate_from_here(run: Run, load: float, guess: float) -> float:
    """Return the slip rate (m/s) next to the guess that solves g(s) = load; the branches need not be known.

    Newton's method continues as long as it reduces the error.
    """
    s = best = guess
    least = math.inf
    for _ in range(20):
        friction_at(run, run.state.law_slip, s)
        error = run.params.damping * s + run.friction.stress - load
        slope = run.params.damping + run.friction.by_rate
        if abs(error) >= least:
            return best
        best, least = s, abs(error)
        if error == 0.0 or slope <= 0.0:
            return best
        s = max(s - error / slope, 0.0)
    return best


@kernel
def is_outdated(run: Run) -> bool:
    """Return True if the table of branches was made for another slip or another normal load."""
    if run.counts.is_algebraic == 0:
        return False
    if run.counts.given > 0 and run.state.table_pressing != run.state.state_now[own_states(run)]:
        return True
    return run.counts.folds_follow_slip == 1 and run.state.table_slip != run.state.law_slip


@kernel
def needs_branches(run: Run) -> bool:
    """Return True if a choice among branches is due while the table of branches is outdated.

    A rest under a normal load that changes needs no branches before it ends.
    """
    if not is_outdated(run):
        return False
    meets_jump = run.counts.ready == Incoming.BROUGHT and run.counts.arriving != Cause.NO_CAUSE
    rests = run.counts.mode == 0 and (run.counts.leaving_rest != 0 or not is_pressing(run))
    return run.counts.branch_ended == 1 or rests or meets_jump or run.counts.folds_move == 0


@kernel
def is_taken(branch: BranchRow, load: float) -> bool:
    """Return True if the rule ever takes the branch, and keeps it at this load (Pa, minus the reference) or at a higher one."""
    return branch.keep_from <= branch.keep_to and load <= branch.keep_to


@kernel
def first_branch(run: Run) -> int:
    """Return the first branch in the present direction of slip."""
    return int(run.params.backward_branch) if run.counts.mode < 0 else 0


@kernel
def end_of_branches(run: Run) -> int:
    """Return the number of the branch after the last one in the present direction of slip."""
    return int(run.params.backward_branch) if run.counts.mode > 0 and run.params.backward_branch > 0.0 else run.branches


@kernel
def choose_branch(run: Run, load: float) -> None:
    """Leave rest for the first branch that the rule allows at this load (minus the reference)."""
    run.state.exit = math.nan
    for n in range(first_branch(run), end_of_branches(run)):
        if is_taken(run.branch_table[n], load):
            run.counts.branch = n
            return


@kernel
def settle_branch(run: Run, load: float) -> None:
    """Set the branch on which a contact in slip meets a jump of the normal load, to `load` (Pa, minus the reference).

    The slip rate moves towards the load. If the new branches leave out the present one, it comes to the nearest branch on its way.
    """
    rate, table = abs(run.state.rate_now), run.branch_table
    if table[run.counts.branch].rate_from <= rate <= table[run.counts.branch].rate_to:
        return
    friction_at(run, run.state.law_slip, rate)
    rises = load > run.params.damping * rate + run.friction.stress
    for n in range(run.branches):
        if rises and table[n].rate_from > rate:
            run.counts.branch = n
            return
        if not rises and table[run.branches - 1 - n].rate_to < rate:
            run.counts.branch = run.branches - 1 - n
            return
    run.counts.mode = 0  # it falls, and there is no slower branch


@kernel
def leave_branch(run: Run, load: float) -> None:
    """Leave the branch, which ends at this load, for the nearest allowed one in the direction of the load, or for rest."""
    branch = run.counts.branch
    run.state.exit = math.nan
    if load >= run.branch_table[branch].keep_to:
        for other in range(branch + 1, end_of_branches(run)):
            if is_taken(run.branch_table[other], load):
                run.counts.branch = other
                return
    for other in range(branch - 1, first_branch(run) - 1, -1):
        if run.branch_table[other].keep_from <= min(load, run.branch_table[other].keep_to):
            run.counts.branch = other
            return
    run.counts.mode = 0


@kernel
def branch_exit(run: Run) -> float:
    """Return the next xi where the load leaves the interval of loads that keep the branch.

    The result is inf if this does not happen on the present piece of load.
    """
    branch, mode, part, xi = run.branch_table[run.counts.branch], run.counts.mode, run.trial, run.state.xi
    first = NONE
    for upper in (0, 1):
        bound = branch.keep_to if upper == 1 else branch.keep_from
        if math.isinf(bound):
            continue
        sign = -1.0 if upper == 1 else 1.0
        restrict(run.load, xi, 1.0 - xi, part)
        start = sign * (towards(run, part[0], mode) - bound)
        for k in range(at.TERMS):
            part[k] *= sign * mode
        part[0] = 0.0 if run.counts.leaving_rest != 0 and start < 0.0 else start
        first = min(first, first_descent(part, run.spare))
    return xi + first * (1.0 - xi) if first < 1.0 - TIE else NONE


@kernel
def end_branch(run: Run) -> None:
    """Leave the branch for another one or for rest, because the load has left the interval of loads that keep it."""
    branch, direction = run.branch_table[run.counts.branch], run.counts.mode
    seen = towards(run, evaluate(run.load, run.state.xi), direction)
    upper = abs(seen - branch.keep_to) < abs(seen - branch.keep_from)
    level = branch.keep_to if upper else branch.keep_from
    leave_branch(run, level)
    if run.counts.mode == 0:
        note_jump(run, 0.0, Cause.FOLD)
        run.state.rate_now = 0.0
        if abs(level - rest_limit(run, direction)) <= SAME_LEVEL * run.params.normal:
            run.counts.leaving_rest = direction  # Rest ends where the branch does: the slope of the load decides.
    else:
        run.counts.leaving_rest = direction
