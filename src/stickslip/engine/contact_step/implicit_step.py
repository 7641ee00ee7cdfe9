"""Take one implicit step: of slip, or at rest while the state of the law evolves.

This is a part of the engine that is compiled when a run first needs it (`on_demand`).
"""

from __future__ import annotations

import math

from stickslip.engine.contact.contact_equation import TIE, onset_of_slip
from stickslip.engine.contact.law_knots import settle_piece
from stickslip.engine.contact.pieces import keep_state, record
from stickslip.engine.contact.pressing import is_pressing, own_states
from stickslip.engine.contact.stiffness import contact_at, forgotten, is_no_longer_stiff, states_at_point
from stickslip.engine.contact_step.certificate import NEGLIGIBLE_FRICTION
from stickslip.engine.contact_step.keep_step import keep_step
from stickslip.engine.contact_step.negative_friction import last_place_above_zero, place_below_zero
from stickslip.engine.contact_step.step_events import Cut, cut_at_first_event, resolve, stretch
from stickslip.engine.contact_step.taylor_step import note_shock
from stickslip.engine.radau.step import collocate, prove_anyway
from stickslip.engine.series.polynomial import NONE, copy, fill, scale_low
from stickslip.engine.series.radau_nodes import NODES_OF_STEP
from stickslip.engine.state import layout as at
from stickslip.engine.state.layout import Floats, StepEvent, Task
from stickslip.engine.state.workspace import Run, borrow
from stickslip.foundation.kernels.kernels import entry, kernel
from stickslip.foundation.kernels.memory.addresses import ahead, call_part
from stickslip.problem import Stop

STILL_BRISTLES = 1e-3
"""The slip rate of a contact hanging in bristles is only rounding if it is below this share (1) of the hanging slip rate."""
TRIFLE = 2.0**-30
"""A share of a step (1) so short that nothing happens in it."""


@kernel
def slip_implicitly(run: Run, xi_to: float) -> None:
    """Slip for one implicit step, or up to an arrest, a knot of the law, or the place xi_to."""
    if run.counts.knots_in_rate == 1:
        settle_piece(run, abs(run.state.rate_now))
    length = collocate(run, xi_to - run.state.xi)
    hanging = hangs(run)
    note_shock(run)
    rate = run.history[run.counts.length].rate
    stretch(run, 1.0, rate)
    reached = length >= xi_to - run.state.xi
    if own_states(run) == 0 and is_no_longer_stiff(run):
        run.counts.stiff = 0
    cut = cut_at_edge(run, rate) if hanging else cut_at_first_event(run, rate, 1.0)
    cut = end_above_zero(run, rate, cut)
    keep_state(run, cut.end)
    keep_step(run, rate, cut.end, xi_to if reached and cut.end == 1.0 else run.state.xi + cut.end * length)
    note_negative_friction(run)
    resolve(run, cut)


@kernel
def hangs(run: Run) -> bool:
    """Return True if a contact with bristles hangs in them over the whole step: its slip rate is negligible at all points.

    A slip rate that is only rounding is set to zero, so that a slab does not ring with it; what is missed then is proven.
    """
    if run.counts.reverses == 0:
        return False
    fastest = 0.0
    for i in range(NODES_OF_STEP):
        fastest = max(fastest, abs(run.stage_rate[i]))
    if run.counts.has_inertia == 0 and fastest <= STILL_BRISTLES * run.state.hanging:
        fill(run.jet, 0.0)
        for n in range(run.counts.states):
            fill(ahead(run.state_jet, at.TERMS * n), 0.0)
            run.state_jet[at.TERMS * n] = run.state.state_now[n]
        prove_anyway(run, 1.0)
    return fastest <= run.state.hanging


@kernel
def cut_at_edge(run: Run, rate: Floats) -> Cut:
    """Cut a step, while nothing but the end of a spring moves, where that meets an edge of the play beside it."""
    end = call_part(run.play, run, Task.EDGE_IN_SLIP, 1.0) if run.params.play > 0.0 else NONE
    if end > 1.0 - TIE:
        return Cut(StepEvent.NONE, 0, 1.0)
    stretch(run, end, rate)
    return Cut(StepEvent.EDGE, 0, end)


@kernel
def end_above_zero(run: Run, rate: Floats, cut: Cut) -> Cut:
    """Return the cut that ends a step before friction falls below zero, and note a breach if it is below zero from the start.

    `rate` is cut accordingly.
    """
    below = place_below_zero(run, rate, cut.end)
    if below == NONE:
        return cut
    end = cut.end * last_place_above_zero(run, rate, cut.end, below)
    if end < TRIFLE:
        run.counts.breach = Stop.NEGATIVE_FRICTION
        return cut
    stretch(run, end, rate)
    return Cut(StepEvent.NONE, 0, end)


@kernel
def note_negative_friction(run: Run) -> None:
    """Note a breach if friction is below zero at the end of the step, or at its start if no solution begins there."""
    rate, states = run.state.rate_now, run.state.state_now
    if run.counts.reverses != 0:  # friction may drive slip
        return
    if not math.isfinite(rate):
        rate, states = run.stage_rate[0], states_at_point(run, 0)
    contact_at(run, run.state.law_slip, abs(rate), states)
    if run.params.reference + run.params.normal * run.value.mu < -NEGLIGIBLE_FRICTION * run.params.normal:
        run.counts.breach = Stop.NEGATIVE_FRICTION


@kernel
def stick_with_state(run: Run, xi_to: float) -> bool:
    """Take one step at rest while the states of the law's own change the strength, or join in its change.

    The step ends at xi_to at the latest, or when the load exceeds the strength. Return False if the states do neither: nothing is
    done then.
    """
    if not is_pressing(run) and forgotten(run):
        return False
    width = collocate(run, xi_to - run.state.xi)
    if not math.isfinite(run.jet[0]):
        run.state.rate_now = math.nan
        note_negative_friction(run)
        return True
    reached = width >= xi_to - run.state.xi
    load = run.history[run.counts.length].load
    fill(run.history[run.counts.length].rate, 0.0)
    copy(run.local, load, at.TERMS)
    onset, direction = onset_of_slip(run, load, run.jet)
    end = min(onset, 1.0)
    if end < 1.0:
        scale_low(load, at.TERMS - 1, end)
    keep_state(run, end)
    record(run, xi_to if reached and end == 1.0 else run.state.xi + end * width)
    note_negative_friction(run)
    run.counts.leaving_rest, run.counts.moved = 0, 1
    if onset < NONE:
        run.counts.mode, run.counts.leaving_rest = direction, direction
    return True


@entry
def implicit_steps(memory: int, task: int, xi_to: float) -> float:
    """Take an implicit step up to the place xi_to at most; return 0 if a contact at rest needs none."""
    if task == Task.SLIP_IMPLICITLY:
        slip_implicitly(borrow(memory), xi_to)
        return 1.0
    return 1.0 if stick_with_state(borrow(memory), xi_to) else 0.0
