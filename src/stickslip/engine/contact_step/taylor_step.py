"""Advance the contact in slip by one Taylor step, cut at the first event in it.

The step is written straight into the next free row of the history: series, length, events, and only then is the row kept. A
"guess" is the length (in xi) in whose units the series is computed; lengths of steps are given in guesses.
"""

from __future__ import annotations

import math

from stickslip.engine.codegen.compiler import call_jet, kernel
from stickslip.engine.codegen.records import numbers_of
from stickslip.engine.contact_step.append_segment import note_jump, record
from stickslip.engine.contact_step.contact_equation import (
    TIE,
    branch_exit,
    constants_of,
    friction_at,
    load_ahead,
    rate_from_here,
    rate_on_branch,
)
from stickslip.engine.contact_step.fold import (
    APPROACHING,
    DEPARTING,
    SHORTEST_FOLD,
    approach_fold,
    depart_from_fold,
    ends_at_fold,
    last_to_fold,
    load_outruns_fold,
    reach_end,
    starts_at_fold,
    straight_from_fold,
    straight_to_fold,
)
from stickslip.engine.contact_step.fold_ahead import way_to_fold
from stickslip.engine.contact_step.law_knots import pass_rate_knot, rate_knot_crossing, settle_piece
from stickslip.engine.contact_step.radau_step import (
    NOT_STIFF,
    collocate,
    judge_stiffness,
    keep_state,
    note_negative_friction,
    settling_rate,
)
from stickslip.engine.contact_step.stick import come_to_rest
from stickslip.engine.contact_step.verify import (
    HALVINGS,
    begin_verification,
    is_negative,
    note_rough_step,
    note_rounding,
    obeys_contact,
    within_guards,
)
from stickslip.engine.series.polynomial import (
    NONE,
    RECIPROCAL,
    evaluate,
    first_descent,
    integral,
    magnitude,
    multiply,
    powers_of,
    total,
)
from stickslip.engine.series.step_size import usable_length
from stickslip.engine.state import layout as at
from stickslip.engine.state.layout import Cause, Floats, Stop
from stickslip.engine.state.workspace import Run

LONGEST_GUESS = 2.0
"""Guess at the length of the next step, relative to the last one (1)."""
SHORTEST_GUESS = 1e-16
"""Least guess as a share of the way to go (1): in units of a last step of next to no length, high orders would vanish or
overflow."""
NO_EVENT, ARREST, KNOT = range(3)
"""Codes of what may end a step early: the slip rate reaches zero, or slip (or its rate) reaches a knot of the law."""


@kernel
def first_guess(run: Run, left: float) -> float:
    """Return the length (in xi) in whose units the next series is computed, from the way (in xi) that is left.

    It is near the length of the step that will be taken, so that no coefficient overflows.
    """
    speed = abs(run.state.speed + 2.0 * run.state.bend * run.state.xi)
    return min(left, max(LONGEST_GUESS * run.state.last_step / speed, SHORTEST_GUESS * left)) if speed > 0.0 else left


@kernel
def series(run: Run, guess: float) -> None:
    """Write the Taylor series of the slip rate's magnitude (m/s) from here into run.jet, in units of `guess` (in xi)."""
    prepare_series(run, guess)
    piece = run.counts.piece
    call_jet(run.law[piece].jet_at, constants_of(run, piece), numbers_of(run.k), run.seen, run.jet)


@kernel
def prepare_series(run: Run, guess: float) -> None:
    """Prepare what the series is made of: the load ahead (run.seen), in units of `guess` (in xi), and the numbers in run.k."""
    direction, par, k = run.counts.mode, run.par, run.k
    load_ahead(run, guess)
    k.rate = abs(run.state.rate_now)
    if run.counts.is_algebraic == 1:
        if run.counts.folds_move == 0 or run.state.table_slip == run.state.law_slip:
            k.rate = rate_on_branch(run, run.seen[0], k.rate)
        else:
            k.rate = rate_from_here(run, run.seen[0], k.rate)
    if run.counts.knots_in_rate == 1:
        settle_piece(run, k.rate)
    piece = run.counts.piece
    edge = run.counts.edge != 0
    k.chi = direction if par.counts_net == 1.0 else 1.0
    k.speed = (run.state.speed + 2.0 * run.state.bend * run.state.xi) * guess
    k.bend = 2.0 * run.state.bend * guess * guess
    k.slip, k.offset = run.state.law_slip + run.law[piece].slip_shift, run.law[piece].offset
    k.free = 0.0 if edge else 1.0
    k.force = par.normal * par.static_excess if edge else 0.0


@kernel
def stretch(run: Run, length: float, rate: Floats) -> None:
    """Write the slip rate's magnitude over a step of the given length (in guesses) into `rate`, as a polynomial on [0, 1]."""
    powers_of(length, run.powers)
    multiply(run.jet, run.powers, rate)


@kernel
def growth(run: Run, rate: Floats, length: float, end: float) -> float:
    """Return the slip (m, unsigned) in a step of the given length (in guesses) up to the place `end` on [0, 1].

    It is the integral of the rate over dtheta = (A + B eta) d eta.
    """
    straight = run.k.speed * length * integral(rate, end, 1)
    if run.k.bend == 0.0:
        return straight
    return straight + run.k.bend * length * length * integral(rate, end, 2)


@kernel
def knot_crossing(run: Run, rate: Floats, length: float, end: float) -> float:
    """Return where on [0, end] slip reaches the next knot of the law, or NONE if it does not.

    The rate does not change its sign before `end`, so slip is monotone and bisection finds the place.
    """
    grown = run.k.chi * growth(run, rate, length, end)
    next_knot = run.counts.piece if grown > 0.0 else run.counts.piece - 1
    if next_knot < 0 or next_knot >= run.pieces - 1:
        return NONE
    distance = abs(run.law[next_knot].knot - run.state.law_slip)
    if distance >= abs(grown):
        return NONE
    low, high = 0.0, end
    for _ in range(60):
        middle = 0.5 * (low + high)
        if abs(growth(run, rate, length, middle)) < distance:
            low = middle
        else:
            high = middle
    return high


@kernel
def next_knot(run: Run, rate: Floats, length: float, end: float) -> tuple[float, int]:
    """Return where on [0, end] the step leaves the present piece of the law, and whether upwards (1) or downwards (-1).

    The place is NONE if the step stays in the piece.
    """
    if run.counts.knots_in_rate == 1:
        return rate_knot_crossing(run, rate)
    return knot_crossing(run, rate, length, end), 1 if run.k.chi > 0.0 else -1


@kernel
def pass_knot(run: Run, turn: int) -> None:
    """Enter the next piece of the law, upwards (turn is 1) or downwards (-1), or end the branch where g falls in that piece."""
    if run.counts.knots_in_rate == 0:
        run.counts.piece += turn
    elif not pass_rate_knot(run, turn):
        reach_end(run)


@kernel
def end_of_branch(run: Run, xi_to: float) -> tuple[float, bool, bool]:
    """Find where an algebraic contact leaves its branch, and prepare the way to a smooth fold.

    Returns the xi up to which to slip, whether the branch ends there, and whether this call has already done all that can be done
    now (the branch has ended, or the piece of load has been replaced by a side piece).
    """
    moves = run.counts.folds_move == 1
    if math.isnan(run.state.exit) and not moves:
        run.state.exit = branch_exit(run)
    way = run.state.exit - run.state.xi
    if not run.state.exit < xi_to:
        return xi_to, False, False
    if way <= 0.0:
        reach_end(run)
        return xi_to, False, True
    if not moves and run.state.bend == 0.0 and way > SHORTEST_FOLD and ends_at_fold(run, way):
        first = approach_fold(run, way)
        return run.state.xi + first, False, first == 0.0
    return run.state.exit, True, False


@kernel
def look_for_fold(run: Run, guess: float, target: float, leaves: bool) -> tuple[float, bool, bool]:
    """Find where the series runs into a fold that moves with slip, if that is before the target (in xi).

    Returns the same three values as `end_of_branch`; target and leaves are unchanged if no fold is met.
    """
    way = way_to_fold(run, guess)
    if not way < target - run.state.xi:
        return target, leaves, False
    if way <= TIE:
        run.state.rate_now = run.counts.mode * run.state.fold_rate
        reach_end(run)
        return target, False, True
    if run.state.bend == 0.0 and way > SHORTEST_FOLD:
        first = approach_fold(run, way)
        return run.state.xi + first, False, first == 0.0
    return run.state.xi + way, False, False


@kernel
def slip(run: Run, xi_to: float) -> None:
    """Slip for one explicit step, or up to what ends it: arrest, the end of a branch, a knot of the law, or the place xi_to."""
    target, leaves, done = xi_to, False, False
    if run.counts.is_algebraic == 1 and (run.counts.at_fold == 0 or run.counts.folds_move == 1):
        target, leaves, done = end_of_branch(run, xi_to)
        if not done and starts_at_fold(run):
            if run.counts.folds_move == 0 or load_outruns_fold(run):
                depart_from_fold(run, target - run.state.xi)
            else:
                run.counts.stalled += 1  # Slip would end where it starts, again and again.
            return
    if done:
        return
    guess = first_guess(run, target - run.state.xi)
    at_last = run.counts.at_fold == APPROACHING and 1.0 - run.state.xi < last_to_fold(run)
    if at_last:
        guess = target - run.state.xi
    series(run, guess)
    if at_last:
        straight_to_fold(run)
    elif run.counts.at_fold == DEPARTING:
        straight_from_fold(run)
    while not math.isfinite(run.jet[at.TERMS - 1]) and guess > 1e-300:
        guess *= 1e-3
        series(run, guess)
    if run.counts.folds_move == 1 and run.counts.at_fold not in (APPROACHING, DEPARTING):
        target, leaves, done = look_for_fold(run, guess, target, leaves)
        if done:
            return
    note_shock(run)
    take_step(run, target, guess, leaves)
    if run.counts.has_inertia == 1:
        judge_stiffness(run)


@kernel
def note_shock(run: Run) -> None:
    """Note a jump of the slip rate, if there is one, where a piece of load or slip itself begins."""
    if run.state.xi == 0.0 and run.counts.arriving != Cause.NO_CAUSE:
        note_jump(run, run.counts.mode * run.jet[0], run.counts.arriving)
    elif run.counts.edge != 0 and run.counts.has_inertia == 0:
        note_jump(run, run.counts.mode * run.jet[0], Cause.FOLD)


@kernel
def slip_implicitly(run: Run, xi_to: float) -> None:
    """Slip for one implicit step, or up to what ends it: arrest, a knot of the law, or the place xi_to."""
    if run.counts.knots_in_rate == 1:
        settle_piece(run, abs(run.state.rate_now))
    guess = collocate(run, xi_to - run.state.xi)
    note_shock(run)
    rate = run.history[run.counts.length].rate
    stretch(run, 1.0, rate)
    reached = guess >= xi_to - run.state.xi
    if run.counts.has_state == 0 and run.k.speed * settling_rate(run) < NOT_STIFF:
        run.counts.stiff = 0
    event, turn, end = first_event(run, rate, 1.0)
    keep_state(run, end)
    keep_step(run, rate, end, xi_to if reached and end == 1.0 else run.state.xi + end * guess)
    note_negative_friction(run)
    end_step(run, xi_to, event, turn, False, reached)


@kernel
def take_step(run: Run, target: float, guess: float, leaves: bool) -> None:
    """Take an explicit step: choose its length, cut it at the first event, shorten it until it obeys the law, and record it.

    `target` and `guess` are in xi; `leaves` says that the branch ends at the target.
    """
    length, reached = choose_length(run, target, guess, usable_length(run.jet, run.par.tolerance))
    rate, load = run.history[run.counts.length].rate, run.history[run.counts.length].load
    begin_verification(run)
    stretch(run, length, rate)
    event, turn, end = first_event(run, rate, length)
    grown, rate_end = growth(run, rate, length * end, 1.0), total(rate)
    for halving in range(HALVINGS + 1):
        if is_straight(run) or (obeys_contact(run, rate, length * end, grown, rate_end) and not is_negative(run)):
            break
        if halving == HALVINGS:
            run.counts.breach = Stop.NEGATIVE_FRICTION if is_negative(run) else Stop.OFF_THE_LAW
            break
        if run.state.rounded == 0.0:
            note_rounding(run, length)
        length *= 0.5 * end
        reached, run.state.last_step = False, min(run.state.last_step, duration_of(run, length))
        stretch(run, length, rate)
        event, turn, end = first_event(run, rate, length)
        grown, rate_end = growth(run, rate, length * end, 1.0), total(rate)
    if run.state.rounded > 0.0:
        note_rough_step(run, rate, rate_end)
    multiply(run.local, run.powers, load)
    to = target if reached and end == 1.0 else run.state.xi + end * length * guess
    move(run, rate, end * length, grown, rate_end, to)
    end_step(run, target, event, turn, leaves, reached)


@kernel
def is_straight(run: Run) -> bool:
    """Return True on the bits next to a fold that are straight lines in the root of time: what these miss is known."""
    return run.counts.at_fold != 0 and run.jet[2] == 0.0 and run.jet[at.TERMS - 1] == 0.0


@kernel
def choose_length(run: Run, target: float, guess: float, length: float) -> tuple[float, bool]:
    """Return the length (in guesses) of an explicit step that may be `length` guesses long, and whether it reaches the target."""
    limit = (target - run.state.xi) / guess
    if run.law[run.counts.piece].guard_count > 0 and not is_straight(run):
        seen = within_guards(run, min(length, limit))
        length = seen if seen < min(length, limit) else length
    # Store the error-controlled length: truncation at an event must not shrink the next guess.
    run.state.last_step = duration_of(run, length)
    reached = length >= limit
    if reached:
        length = limit
    elif length > 0.5 * limit:
        length = 0.5 * limit
    return length, reached


@kernel
def duration_of(run: Run, length: float) -> float:
    """Return the duration (s) of a step of the given length (in guesses)."""
    return length * abs(run.k.speed + 0.5 * run.k.bend * min(length, 1.0))


@kernel
def first_event(run: Run, rate: Floats, length: float) -> tuple[int, int, float]:
    """Find what ends a step of the given length (in guesses) early, and cut the step there.

    Returns the event, the direction in which a knot is passed (1 upwards, -1 downwards), and the share of the step up to the
    event.
    """
    arrest = NONE
    if (run.counts.is_algebraic == 0 or run.counts.folds_move == 1) and rate[0] <= magnitude(rate):
        arrest = first_descent(rate, run.spare)
    knot, turn = next_knot(run, rate, length, min(arrest, 1.0)) if run.pieces > 1 else (NONE, 0)
    end = min(arrest, knot)
    if end > 1.0 - TIE:
        return NO_EVENT, 0, 1.0
    if end < 1.0:
        stretch(run, length * end, rate)
    return ARREST if arrest == end else KNOT, turn, end


@kernel
def end_step(run: Run, target: float, event: int, turn: int, leaves: bool, reached: bool) -> None:
    """Do what the event at the end of a step requires: come to rest, pass a knot, or end the branch."""
    if event == ARREST:
        come_to_rest(run)
    elif event == KNOT:
        pass_knot(run, turn)
    elif leaves and (reached or target - run.state.xi < TIE):
        reach_end(run)


@kernel
def keep_step(run: Run, rate: Floats, length: float, to: float) -> None:
    """Record the step, which is `length` guesses long and ends at xi = to, and move the state there."""
    multiply(run.local, run.powers, run.history[run.counts.length].load)
    move(run, rate, length, growth(run, rate, length, 1.0), total(rate), to)


@kernel
def move(run: Run, rate: Floats, length: float, grown: float, rate_end: float, to: float) -> None:
    """Record the step and move the state to its end, at xi = to.

    Load and rate (m/s, as a magnitude) are in the next free row of the history. `grown` is the slip (m) in the step and
    `rate_end` the rate at its end (m/s), both unsigned.
    """
    direction = run.counts.mode
    load = run.history[run.counts.length].load
    speed, bend = run.k.speed * length, run.k.bend * length * length
    if run.counts.is_block == 1:
        unload_spring(direction * run.par.stiffness * speed, direction * run.par.stiffness * bend, rate, load)
        run.load[0] -= run.par.stiffness * direction * grown
    if direction < 0:
        for k in range(at.TERMS):
            rate[k] = -rate[k]
    note_gain(run, rate)
    record(run, to)
    run.counts.moved, run.counts.edge = 1, 0
    run.state.slip_now += direction * grown
    run.state.law_slip += run.k.chi * grown
    run.state.rate_now = direction * max(rate_end, 0.0)


@kernel
def note_gain(run: Run, rate: Floats) -> None:
    """Note the factor |2 Z / g'(v) - 1| by which slip multiplies an error of the load.

    It follows from Z v + S mu(v) = load, and from 2 Z v - load, which goes back to the driver. The gain is NaN where slip,
    inertia or a state decide too, because the fate of an error is then not a matter of its phase alone.
    """
    if run.counts.is_algebraic == 1 and run.counts.folds_move == 0:
        friction_at(run, run.state.law_slip, abs(evaluate(rate, 0.5)))
        run.state.gain = abs(2.0 * run.par.impedance / (run.par.impedance + run.friction.by_rate) - 1.0)
    else:
        run.state.gain = math.nan


@kernel
def unload_spring(straight: float, bent: float, rate: Floats, load: Floats) -> None:
    """Take stiffness times slip from the outer load, in place, because a block unloads its spring as it slips.

    `straight` and `bent` are the stiffness times A and times B of dtheta = (A + B eta) d eta (N s/m, signed).
    """
    for k in range(1, at.TERMS):
        load[k] -= straight * RECIPROCAL[k] * rate[k - 1]
    if bent != 0.0:
        for k in range(2, at.TERMS):
            load[k] -= bent * RECIPROCAL[k] * rate[k - 2]
