"""Sentences for users on the motion of a contact at the start, and on its stability there."""

from __future__ import annotations

import math

from stickslip.contact import first_rate, resolved
from stickslip.foundation.show import exactly
from stickslip.friction import RateAndState
from stickslip.problem import Problem, driver_of, loading_rate
from stickslip.run.check.asked import CHECK_KINDS
from stickslip.run.reference.rate_and_state import SteadySliding


def start_of(problem: Problem) -> str:
    """Return a sentence on the motion of the contact at t = 0+ and, if it sticks, on the time when it will slip."""
    slip_rate = problem.unit_of("slip_rate")
    if problem.has_initial_rate:
        return f"slides from the start, at {exactly(problem.rate, slip_rate, 6)}: {_why_it_slides(problem)}"
    if not problem.friction.sticks:
        return "creeps from the start, from rest: friction with a state of its own never sticks"
    push = 0.0 if problem.force_in_time is None else problem.force_in_time.first
    jump_of_load = driver_of(problem).jump_at_start(problem)
    what = "the load" if push == 0.0 else "the load, with the force,"
    what = what if jump_of_load == 0.0 else f"{what.rstrip(',')}, with the jump of the reference,"
    push += jump_of_load
    load, excess, unit, pulled = problem.load + push, problem.excess + push, problem.load_unit, problem.first_pull_rate > 0
    rate = first_rate(problem)
    rate = resolved(rate, problem.load, problem.body.total_damping)
    jump = f"; the slip rate jumps to {exactly(rate, slip_rate)}" if rate > 0.0 else ""
    if load < -problem.backward_strength:
        beyond = exactly(-load - problem.backward_strength, unit, 6)
        return f"slips backwards at once: {what} is {beyond} beyond the static strength"
    if excess > 0:
        return f"slips at once: {what} exceeds the static strength by {exactly(excess, unit, 6)}{jump}"
    if excess == 0 and pulled:
        return f"slips at 0+: {what} is the static strength and grows{jump}"
    if rate > 0.0:
        return f"slips at once, because the rule '{problem.rule}' leaves stick below the static strength{jump}"
    if excess == 0:
        held = "stuck until the load grows" if problem.varies else "stays stuck"
        return f"{held}: {what} is the static strength"
    wait = wait_of(problem)
    when = f"; loading reaches the strength after about {wait:.6g} s" if math.isfinite(wait) else ""
    return f"stuck: {what} is {exactly(-excess, unit, 6)} below the static strength{when}"


def _why_it_slides(problem: Problem) -> str:
    """Return where the initial rate of a contact comes from that has a mass and never sticks."""
    if problem.initial_load is None and problem.initial_excess is None:
        return "steady sliding" if problem.initial_rate is not None else "steady sliding at the pull rate"
    if problem.initial_rate is not None:
        return "as initial rate"
    other = other_start(problem)
    return "there the initial load and friction balance" + (f"; {other}" if other else "")


def other_start(problem: Problem) -> str:
    """Return a sentence if a slab or a string would start otherwise with a mass at the contact than without, else ""."""
    return CHECK_KINDS[problem.body.structure].other_start(problem)


def wait_of(problem: Problem) -> float:
    """Return the time (s) that steady loading takes to reach the static strength, an estimate for a slab.

    It is inf if the loading varies in time or never reaches the strength.
    """
    if problem.varies:
        return math.inf
    rate = loading_rate(problem)
    excess = problem.excess + driver_of(problem).jump_at_start(problem)
    return max(-excess, 0.0) / rate if rate > 0 else math.inf


def stability_of(problem: Problem) -> str:
    """Return a sentence on static stability at the start, and on the growth rate (1/s) of a small disturbance.

    Under a law with states there is only steady sliding to speak of, and under rate-and-state friction its critical stiffness.
    """
    body, law = problem.body, problem.friction
    if isinstance(law, RateAndState):
        return _critical_stiffness(problem, law)
    if law.states:
        return ""
    by_slip, by_rate = law.slopes(problem.law_slip).tolist()
    return CHECK_KINDS[body.structure].stability(problem, by_slip, by_rate)


def _critical_stiffness(problem: Problem, law: RateAndState) -> str:
    """Return a sentence on the stiffness of the body and the critical one: sliding at the pull rate is stable above it."""
    body, rate, pull = problem.body, abs(problem.first_pull_rate), "first pull rate" if problem.loading_varies else "pull rate"
    if rate == 0.0:
        return "not pulled at first" if problem.loading_varies else "not pulled: it creeps to a halt, ever more slowly"
    under = ", under the first normal load" if problem.normal_varies else ""
    unit = problem.unit_of("stiffness")
    sliding = SteadySliding(problem.normal, law.a, law.b, law.distance, rate)
    found = CHECK_KINDS[body.structure].critical_stiffness(body, sliding)
    if found is None:
        formula = "(S (b - a) - D V) / Dc" if body.dashpot else "S (b - a) / Dc"
        critical = sliding.critical_stiffness(damping=body.dashpot)
        return f"critical stiffness of slow sliding {formula} = {critical:.6g} {unit}{under}"
    text, critical = found
    return f"{text} = {body.stiffness:.6g} against the critical {critical:.6g} {unit} of steady sliding at the {pull}{under}"
