"""Advance the contact in slip by one Taylor step, cut at the first event in it.

The step is written straight into the next free row of the history: series, length, events; only then is the row kept. The series
is computed in powers of xi divided by a "unit", a length in xi; lengths of steps are given in units.
"""

from __future__ import annotations

import math

from stickslip.engine.contact.contact_equation import (
    TIE,
    constants_of,
    is_outdated,
    load_ahead,
    rate_from_here,
    rate_on_branch,
    static_step,
)
from stickslip.engine.contact.law_knots import settle_piece
from stickslip.engine.contact.pieces import keep_state, note_jump
from stickslip.engine.contact.pressing import states_ahead
from stickslip.engine.contact.stiffness import judge_stiffness
from stickslip.engine.contact.winding import feel_slip
from stickslip.engine.contact_step.certificate import (
    begin_step,
    bound_straight_bit,
    is_negative,
    measure_end,
    proven_length,
    terms_of,
)
from stickslip.engine.contact_step.keep_step import move
from stickslip.engine.contact_step.step_events import cut_at_first_event, growth, resolve, stretch
from stickslip.engine.contact_step.step_plan import StepPlan, plan_step, plan_to_moving_fold
from stickslip.engine.folds.fold import last_to_fold, reach_end
from stickslip.engine.series.polynomial import multiply, total
from stickslip.engine.series.step_size import usable_length
from stickslip.engine.state import layout as at
from stickslip.engine.state.layout import Cause, NearFold, SeriesInput, StepEvent, Task
from stickslip.engine.state.workspace import Run
from stickslip.foundation.kernels.kernels import inlined, kernel
from stickslip.foundation.kernels.memory.addresses import call_jet, call_part
from stickslip.foundation.kernels.memory.pointers import numbers_of
from stickslip.problem import Stop

LONGEST_GUESS = 2.0
"""Guess at the length of the next step, relative to the last one (1)."""
SHORTEST_GUESS = 1e-16
"""Least unit, as a share of the way to go (1). After a last step of almost no length the unit would be so small that high orders
vanish or overflow."""
PASSES = (at.TERMS + 2) // 3
"""Passes (1) until a series under the integral of its own slip has all its terms: each makes three orders more right."""
HALVINGS_OF_STEP = 40
"""Halve a step with friction below zero at most this many times (1): 2^-40 of a step is next to nothing."""


@kernel
def first_unit(run: Run, left: float) -> float:
    """Return the unit (a length in xi) of the next series, from the way (in xi) that is left.

    It is near the length of the coming step, so that no coefficient overflows.
    """
    speed = run.state.speed + 2.0 * run.state.bend * run.state.xi
    return unit_from(left, speed, run.state.last_step) if speed != 0.0 else left


@inlined
def unit_from(left: float, speed: float, last_step: float) -> float:
    """Return the unit (in xi) from the way that is left (in xi), dphase/dxi (s) and the length of the last step (s)."""
    return min(left, max(LONGEST_GUESS * last_step / abs(speed), SHORTEST_GUESS * left))


@kernel
def prepare_series(run: Run, unit: float) -> None:
    """Prepare the input of the series: the numbers in run.k, and load and states ahead, in units of `unit` (in xi)."""
    direction, params, k = run.counts.mode, run.params, run.k
    load_ahead(run, unit)
    k.rate = abs(run.state.rate_now)
    if run.counts.is_algebraic == 1:
        if run.counts.folds_move == 0 or not is_outdated(run):
            k.rate = rate_on_branch(run, run.load_along_slip[0], k.rate)
        else:
            k.rate = rate_from_here(run, run.load_along_slip[0], k.rate)
    if run.counts.knots_in_rate == 1:
        settle_piece(run, k.rate)
    piece = run.counts.piece
    edge = run.counts.leaving_rest != 0
    k.chi = direction if params.counts_net == 1.0 else 1.0
    k.speed = (run.state.speed + 2.0 * run.state.bend * run.state.xi) * unit
    k.bend = 2.0 * run.state.bend * unit * unit
    k.slip, k.offset = run.state.law_slip + run.law[piece].slip_shift, run.law[piece].offset
    k.free = 0.0 if edge else 1.0
    k.force = params.normal * static_step(run, run.state.state_now) if edge else 0.0
    if run.counts.states > 0:
        states_ahead(run, unit)


@kernel
def slip(run: Run, xi_to: float) -> None:
    """Slip for one explicit step, or up to an arrest, the end of a branch, a knot of the law, or the place xi_to."""
    plan = plan_step(run, xi_to)
    if plan.is_over:
        return
    unit = expand_series(run, plan.target)
    if run.counts.folds_move == 1 and run.counts.at_fold not in (NearFold.APPROACHING, NearFold.DEPARTING):
        plan = plan_to_moving_fold(run, unit, plan)
        if plan.is_over:
            return
    note_shock(run)
    take_planned_step(run, plan, unit)
    if run.counts.is_algebraic == 0:
        judge_stiffness(run)


@kernel
def expand_series(run: Run, target: float) -> float:
    """Write the Taylor series of the slip rate's magnitude (m/s) from here into run.jet; return its unit (a length in xi)."""
    is_last = run.counts.at_fold == NearFold.APPROACHING and 1.0 - run.state.xi < last_to_fold(run)
    unit = target - run.state.xi if is_last else first_unit(run, target - run.state.xi)
    calculate_series(run, unit)
    if is_last:
        call_part(run.folds, run, Task.STRAIGHT_TO_FOLD, 0.0)
    elif run.counts.at_fold == NearFold.DEPARTING:
        call_part(run.folds, run, Task.STRAIGHT_FROM_FOLD, 0.0)
    while not math.isfinite(run.jet[at.TERMS - 1]) and unit > 1e-300:
        unit *= 1e-3
        calculate_series(run, unit)
    return unit


@kernel
def calculate_series(run: Run, unit: float) -> None:
    """Write the Taylor series of the slip rate's magnitude (m/s) from here into run.jet, in units of `unit` (in xi)."""
    prepare_series(run, unit)
    piece = run.counts.piece
    for _ in range(1 if run.params.winding == 0.0 else PASSES):
        call_jet(run.law[piece].jet_at, constants_of(run, piece), numbers_of(run.k), run.load_along_slip, run.jet)
        if run.params.winding != 0.0:
            feel_slip(run, run.jet)


@kernel
def note_shock(run: Run) -> None:
    """Note a jump of the slip rate, if there is one, at the beginning of a piece of load or of slip."""
    if run.state.xi == 0.0 and run.counts.arriving != Cause.NO_CAUSE:
        note_jump(run, run.counts.mode * run.jet[0], run.counts.arriving)
    elif run.counts.leaving_rest != 0 and run.counts.has_inertia == 0:
        note_jump(run, run.counts.mode * run.jet[0], Cause.FOLD)


@kernel
def take_planned_step(run: Run, plan: StepPlan, unit: float) -> None:
    """Take an explicit step: choose its length, prove it, cut it at the first event, and keep it.

    `unit` (in xi) is the unit of the series. If friction falls below zero in the step, it is halved until friction does not, or
    until almost nothing of the step is left.
    """
    length, reached = choose_length(run, plan.target, unit, usable_length(run.jet, run.params.tolerance))
    kept = run.history[run.counts.length]
    begin_step(run)
    bound = run.state.residual
    for halving in range(HALVINGS_OF_STEP + 1):
        cut = cut_at_first_event(run, kept.rate, length)
        grown, rate_end = growth(run, kept.rate, length * cut.end, 1.0), total(kept.rate)
        if is_straight(run):
            bound_straight_bit(run, length * cut.end, grown, rate_end)
            break
        run.state.residual = bound + measure_end(run, kept.rate, length * cut.end, grown, rate_end)
        if not (is_negative(run) or hides_negative_friction(run, length * cut.end)):
            break
        if halving == HALVINGS_OF_STEP:
            run.counts.breach = Stop.NEGATIVE_FRICTION
        length *= 0.5 * cut.end
        stretch(run, length, kept.rate)
        reached, run.state.last_step = False, min(run.state.last_step, duration_of(run.k, length))
    multiply(run.local, run.powers, kept.load)
    to = plan.target if reached and cut.end == 1.0 else run.state.xi + cut.end * length * unit
    if run.counts.states > 0:
        keep_state(run, cut.end * length)
    move(run, cut.end * length, grown, rate_end, to)
    resolve(run, cut)
    if cut.event == StepEvent.NONE and plan.ends_branch and (reached or plan.target - run.state.xi < TIE):
        reach_end(run)


@kernel
def hides_negative_friction(run: Run, length: float) -> bool:
    """Return True if friction falls below zero inside an explicit step of the given length (in units)."""
    return run.params.can_be_negative != 0.0 and call_part(run.negative_friction, run, Task.LOOK_BELOW_ZERO, length) != 0.0


@kernel
def is_straight(run: Run) -> bool:
    """Return True on the bits next to a fold that are straight lines in the root of time: their error is known."""
    return run.counts.at_fold != NearFold.NONE and run.jet[2] == 0.0 and run.jet[at.TERMS - 1] == 0.0


@kernel
def choose_length(run: Run, target: float, unit: float, length: float) -> tuple[float, bool]:
    """Return the length (in units) of an explicit step that may be `length` units long, and whether it reaches the target.

    Leaves the slip rate over the step where it will be kept, and the powers of its length in run.powers, as `stretch` does.
    """
    limit = length_to(run, target, unit)
    straight, proven = is_straight(run), min(length, limit)
    if not straight:
        proven = proven_length(run, proven)
        length = proven if proven < min(length, limit) else length
    chosen, reached = settle_length(run, target, unit, length)
    if straight or chosen != proven:
        stretch(run, chosen, terms_of(run))
    return chosen, reached


@inlined
def length_to(run: Run, target: float, unit: float) -> float:
    """Return the way to a place xi = `target`, in units."""
    return (target - run.state.xi) / unit


@inlined
def settle_length(run: Run, target: float, unit: float, length: float) -> tuple[float, bool]:
    """Return the length of a proven step so that no tiny step is left before the target, and whether it reaches the target."""
    limit = length_to(run, target, unit)
    # Store the error-controlled length: truncation at an event must not shrink the next unit.
    run.state.last_step = duration_of(run.k, length)
    reached = length >= limit
    if reached:
        length = limit
    elif length > 0.5 * limit:
        length = 0.5 * limit
    return length, reached


@inlined
def duration_of(k: SeriesInput, length: float) -> float:
    """Return the duration (s) of a step of the given length (in units)."""
    return length * abs(k.speed + 0.5 * k.bend * min(length, 1.0))
