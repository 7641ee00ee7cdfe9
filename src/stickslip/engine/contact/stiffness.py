"""Judge from friction and its derivatives whether steps must be implicit, and when a contact at rest has forgotten its states."""

from __future__ import annotations

import math

from stickslip.engine.contact.contact_equation import law_at
from stickslip.engine.contact.pressing import own_states
from stickslip.engine.series.polynomial import copy, evaluate, fill
from stickslip.engine.state.layout import STATES, TERMS, Floats
from stickslip.engine.state.workspace import Run
from stickslip.foundation.kernels.kernels import kernel
from stickslip.foundation.kernels.memory.addresses import ahead

STIFF, NOT_STIFF = 4.0, 1.5
"""The contact becomes stiff if an explicit step spans more than STIFF settling times (1): only stability can have kept it so short.
It is no longer stiff if an implicit step spans fewer than NOT_STIFF."""
SETTLED, NOT_SETTLED = 1.0, 0.2
"""The same two numbers for a massless contact. Its slip rate only decays, and explicit steps would follow the decay down to the
smallest float."""
STEPS_BEFORE_STIFF = 200
"""A massless contact may count as stiff only after this many explicit steps (1) since slip last began."""
STEPS_BETWEEN_CHECKS = 16
"""Number of explicit steps (1) between two checks of the stiffness."""


HANGING = 100.0
"""A contact counts as hanging in its bristles if their force is within this many local tolerances (1) of balance."""
FORGOTTEN = 1e-18
"""The remainder of a state at rest is dropped when it changes the friction coefficient (1) by less than this."""


@kernel
def states_in_step(run: Run, place: float) -> Floats:
    """Return the states at a place of the step in run.state_jet, in units of the series; the row holds until the next call."""
    for n in range(run.counts.states):
        run.some_state[n] = evaluate(ahead(run.state_jet, TERMS * n), place)
    return run.some_state


@kernel
def states_at_point(run: Run, i: int) -> Floats:
    """Return the states at Radau's point i of an implicit step, as a row that holds until the next call."""
    for n in range(run.counts.states):
        run.some_state[n] = run.stage_state[TERMS * n + i]
    return run.some_state


@kernel
def turn_states(run: Run, states: Floats) -> None:
    """Change the sign of the states that reverse with slip."""
    for n in range(run.counts.states):
        if (run.counts.reverses >> n) % 2 == 1:
            states[n] = -states[n]


@kernel
def contact_at(run: Run, law_slip: float, rate: float, states: Floats) -> None:
    """Write friction and the change of the states, with their derivatives, into run.value.

    `mu` is then the difference from the static friction coefficient at the start of the run.
    """
    # An iteration may try rates below 0, where a law without states of its own need not hold: continue it linearly.
    below = min(rate, 0.0) if own_states(run) == 0 else 0.0
    law_at(run, run.counts.piece, law_slip, rate - below, states)
    if below < 0.0:
        run.value.mu += run.value.by_rate * below
    run.value.mu += run.law[run.counts.piece].offset


@kernel
def is_implicit(run: Run) -> bool:
    """Return True if the next step must be implicit."""
    return own_states(run) > 0 or run.counts.stiff == 1


@kernel
def settling_rate(run: Run) -> float:
    """Return the rate (1/s) at which the slip rate settles: (Z + S dmu/dv) / M with mass, S dmu/du / (Z + S dmu/dv) without."""
    contact_at(run, run.state.law_slip, abs(run.state.rate_now), run.state.state_now)
    resistance = run.params.damping + run.params.normal * run.value.by_rate
    if run.counts.has_inertia == 1:
        return resistance / run.params.inertia
    return run.k.chi * run.params.normal * run.value.by_slip / resistance


@kernel
def is_no_longer_stiff(run: Run) -> bool:
    """Return True if the implicit step that was just made is so short that an explicit one would do."""
    return run.k.speed * settling_rate(run) < (NOT_STIFF if run.counts.has_inertia == 1 else NOT_SETTLED)


@kernel
def judge_stiffness(run: Run) -> None:
    """Check now and then, after an explicit step, whether the contact has become stiff."""
    run.counts.steps += 1
    limit, least = (STIFF, 0) if run.counts.has_inertia == 1 else (SETTLED, STEPS_BEFORE_STIFF)
    due = run.counts.steps % STEPS_BETWEEN_CHECKS == 0 and run.counts.steps > least
    if due and run.state.last_step * settling_rate(run) > limit:
        run.counts.stiff = 1


@kernel
def hanging_rate(run: Run) -> float:
    """Return the slip rate (m/s) below which a contact with bristles hangs in them: 0 for all other laws.

    An error of HANGING local tolerances in the bristles' force alone makes a contact at rest on them slip at this rate. The sign of
    such a slip rate means nothing.
    """
    if run.counts.reverses == 0:
        return 0.0
    params, value = run.params, run.value
    copy(run.state.state_now, run.some_state, STATES)
    turn_states(run, run.some_state)
    contact_at(run, run.state.law_slip, 0.0, run.some_state)
    against = abs(stiffness_of_states(run))
    contact_at(run, run.state.law_slip, 0.0, run.state.state_now)
    # Bristles that are bent as far as they go yield in this direction, but not in the other.
    stiffest = max(against, abs(stiffness_of_states(run)))
    resistance = params.damping + math.sqrt(params.inertia * params.normal * stiffest)
    return HANGING * params.tolerance * params.normal * abs(value.mu) / resistance if resistance > 0.0 else 0.0


@kernel
def stiffness_of_states(run: Run) -> float:
    """Return how much friction grows per slip (1/m) through the states alone, from the derivatives in run.value."""
    found = 0.0
    for n in range(run.counts.states):
        found += run.value.by_state[n] * run.value.change_by_rate[n]
    return found


@kernel
def forgotten(run: Run) -> bool:
    """Return True if the remainder of the states at rest no longer affects friction, and then set the states to zero.

    States that do not stay at zero at rest are never forgotten: they heal to other values. Those that follow from time stay.
    """
    contact_at(run, run.state.law_slip, 0.0, run.state.state_now)
    own = own_states(run)
    for n in range(own):
        if abs(run.value.by_state[n] * run.state.state_now[n]) > FORGOTTEN:
            return False
    fill(run.some_state, 0.0)
    for n in range(own, run.counts.states):
        run.some_state[n] = run.state.state_now[n]
    contact_at(run, run.state.law_slip, 0.0, run.some_state)
    for n in range(own):
        if run.value.change[n] != 0.0:
            return False
    copy(run.some_state, run.state.state_now, STATES)
    return True
