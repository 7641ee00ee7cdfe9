"""Judge from friction and its derivatives whether steps must be implicit, and when the states of a law at rest are forgotten."""

from __future__ import annotations

import math

from stickslip.engine.compile.kernels import kernel
from stickslip.engine.contact.contact_equation import law_at
from stickslip.engine.memory.addresses import ahead
from stickslip.engine.series.polynomial import copy, evaluate, fill
from stickslip.engine.state.layout import STATES, TERMS, Floats
from stickslip.engine.state.workspace import Run

STIFF, NOT_STIFF = 4.0, 1.5
"""Number of settling times (1) in an explicit step above which the contact is stiff, because only stability can have kept the
step so short; and in an implicit step, below which the contact is no longer stiff."""
SETTLED, NOT_SETTLED = 1.0, 0.2
"""The same two numbers for a massless contact: there the slip rate only decays, and explicit steps would follow the decay to the
smallest number there is."""
PATIENCE = 200
"""Number of explicit steps (1) since slip last began before a massless contact may count as stiff: in fewer, none is."""
CHECKED = 16
"""Number of explicit steps (1) between two checks of the stiffness."""


HANGING = 100.0
"""Error (1) of the force of bristles, in local tolerances, that a swinging contact may be left with when it counts as hanging."""
FORGOTTEN = 1e-18
"""Friction coefficient (1) below which what is left of the state at rest is dropped."""


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
    """Change the sign of those states that do so where slip reverses."""
    for n in range(run.counts.states):
        if (run.counts.reverses >> n) % 2 == 1:
            states[n] = -states[n]


@kernel
def contact_at(run: Run, law_slip: float, rate: float, states: Floats) -> None:
    """Write friction and the change of the states, with their derivatives, into run.value.

    `mu` is then the difference from the static friction coefficient at the start of the run.
    """
    # An iteration may try rates below 0, where a law without states need not hold: continue it linearly.
    below = min(rate, 0.0) if run.counts.states == 0 else 0.0
    law_at(run, run.counts.piece, law_slip, rate - below, states)
    if below < 0.0:
        run.value.mu += run.value.by_rate * below
    run.value.mu += run.law[run.counts.piece].offset


@kernel
def is_implicit(run: Run) -> bool:
    """Return True if the next step must be implicit."""
    return run.counts.states > 0 or run.counts.stiff == 1


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
    limit, least = (STIFF, 0) if run.counts.has_inertia == 1 else (SETTLED, PATIENCE)
    due = run.counts.steps % CHECKED == 0 and run.counts.steps > least
    if due and run.state.last_step * settling_rate(run) > limit:
        run.counts.stiff = 1


@kernel
def hanging_rate(run: Run) -> float:
    """Return the slip rate (m/s) below which a contact with bristles hangs in them: 0 for all other laws.

    An error of the bristles' force by HANGING local tolerances makes such a slip rate in a contact that rests on them. Its sign
    means nothing.
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
    """Return by how much friction grows (1/m) per slip through the states alone, which run.value describes."""
    found = 0.0
    for n in range(run.counts.states):
        found += run.value.by_state[n] * run.value.change_by_rate[n]
    return found


@kernel
def forgotten(run: Run) -> bool:
    """Return True if friction no longer notices what is left of the states at rest, and set the states to zero then.

    States that do not stay at zero at rest are never forgotten: they heal to other values.
    """
    contact_at(run, run.state.law_slip, 0.0, run.state.state_now)
    for n in range(run.counts.states):
        if abs(run.value.by_state[n] * run.state.state_now[n]) > FORGOTTEN:
            return False
    fill(run.some_state, 0.0)
    contact_at(run, run.state.law_slip, 0.0, run.some_state)
    for n in range(run.counts.states):
        if run.value.change[n] != 0.0:
            return False
    copy(run.some_state, run.state.state_now, STATES)
    return True
