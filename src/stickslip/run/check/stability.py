"""Sentences for users on the motion of a contact at the start, and on its stability there."""

from __future__ import annotations

import cmath
import math

from stickslip.contact import first_rate, growth_on_layers, resolved
from stickslip.foundation.names import si_unit
from stickslip.foundation.show import exactly
from stickslip.friction import RateAndState
from stickslip.problem import Problem, loading_rate
from stickslip.problem.bodies import BodyOnCharacteristics, OfLayers, as_waves
from stickslip.run.reference.rate_and_state import SteadySliding
from stickslip.run.reference.slab import growth_rate


def start_of(problem: Problem) -> str:
    """Return a sentence on the motion of the contact at t = 0+ and, if it sticks, on the time when it will slip."""
    slip_rate = problem.unit_of("slip_rate")
    if problem.has_initial_rate:
        return f"slides from the start, at {exactly(problem.rate, slip_rate, 6)}: {_why_it_slides(problem)}"
    if not problem.friction.sticks:
        return "creeps from the start, from rest: friction with a state of its own never sticks"
    excess, unit, pulled = problem.excess, problem.load_unit, problem.first_pull_rate > 0
    rate = first_rate(problem)
    rate = resolved(rate, problem.load, problem.body.damping)
    jump = f"; the slip rate jumps to {exactly(rate, slip_rate)}" if rate > 0.0 else ""
    if problem.load < -problem.strength:
        beyond = exactly(-problem.load - problem.strength, unit, 6)
        return f"slips backwards at once: the load is {beyond} beyond the static strength"
    if excess > 0:
        return f"slips at once: the load exceeds the static strength by {exactly(excess, unit, 6)}{jump}"
    if excess == 0 and pulled:
        return f"slips at 0+: the load is the static strength and grows{jump}"
    if rate > 0.0:
        return f"slips at once, because the rule '{problem.rule}' leaves stick below the static strength{jump}"
    if excess == 0:
        held = "stuck until the load grows" if problem.varies else "stays stuck"
        return f"{held}: the load is the static strength"
    wait = wait_of(problem)
    when = f"; loading reaches the strength after about {wait:.6g} s" if math.isfinite(wait) else ""
    return f"stuck: the load is {exactly(-excess, unit, 6)} below the static strength{when}"


def _why_it_slides(problem: Problem) -> str:
    """Return where the initial rate of a contact comes from that has a mass and never sticks."""
    if problem.initial_load is None and problem.initial_excess is None:
        return "steady sliding" if problem.initial_rate is not None else "steady sliding at the pull rate"
    if problem.initial_rate is not None:
        return "as initial rate"
    other = other_start(problem)
    return "there the initial load and friction balance" + (f"; {other}" if other else "")


def other_start(problem: Problem) -> str:
    """Return a sentence if a slab or a string would start otherwise with a mass at the contact than without, else "".

    A contact without mass takes the slip rate that load and state determine at 0+, and the slab moves as if it had rested before.
    That is so under a law that never sticks.
    """
    loaded = problem.initial_load is not None and problem.initial_rate is None
    if problem.friction.sticks or not problem.body.has_waves or not loaded:
        return ""
    body = problem.body
    return (
        f"without {body.mass_field} the {body.noun} behind the contact starts from rest, which is another start; "
        "with [initial] rate = 0 a mass starts from there, too"
    )


def wait_of(problem: Problem) -> float:
    """Return the time (s) that steady loading takes to reach the static strength, an estimate for a slab.

    It is inf if the loading varies in time or never reaches the strength.
    """
    if problem.varies:
        return math.inf
    rate = loading_rate(problem)
    return max(-problem.excess, 0.0) / rate if rate > 0 else math.inf


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
    if not body.has_waves:
        return _block_stability(body, by_slip, by_rate)
    number = -problem.normal * by_slip / body.stiffness
    if by_slip >= 0:
        return "friction does not weaken with slip at the start; what slip rate does to it: see uniqueness"
    if not body.is_driven_rigidly:
        return f"friction weakens with slip: alpha_w h = {number:.6g} (a rigid driver holds it below 1, this one is not rigid)"
    if number < 1:
        return (
            f"statically stable: alpha_w h = {number:.6g} < 1, friction weakens more slowly than the {body.noun} unloads: it creeps"
        )
    if isinstance(body, OfLayers):
        rate = growth_on_layers(body, -problem.normal * by_slip)
    else:
        rate = growth_rate(as_waves(body), -by_slip)
    return f"statically unstable: alpha_w h = {number:.6g} > 1; a small disturbance grows at {rate:.6g} /s"


def _block_stability(body: BodyOnCharacteristics, by_slip: float, by_rate: float) -> str:
    spring, dash = body.stiffness + body.normal_load * by_slip, body.damping + body.normal_load * by_rate
    swings = cmath.sqrt(dash * dash - 4 * body.inertia * spring)
    fastest = max((-dash + sign * swings for sign in (1, -1)), key=lambda root: root.real)
    growth = fastest / (2 * body.inertia)
    stiffness, impedance = si_unit("stiffness", body.load_unit), si_unit("impedance", body.load_unit)
    values = f"K + S mu'(u) = {spring:.6g} {stiffness}, damping + S mu'(v) = {dash:.6g} {impedance}"
    if spring < 0 or (growth.real > 0 and growth.imag == 0):
        return f"unstable: {values}; a small disturbance grows at {growth.real:.6g} /s"
    if growth.real > 0:
        return f"oscillates with growing amplitude: {values}; growth {growth.real:.6g} /s"
    return f"statically stable: {values}"


def _critical_stiffness(problem: Problem, law: RateAndState) -> str:
    """Return a sentence on the stiffness of the body and the critical one: sliding at the pull rate is stable above it."""
    body, rate, pull = problem.body, abs(problem.first_pull_rate), "first pull rate" if problem.loading_varies else "pull rate"
    if rate == 0.0:
        return "not pulled at first" if problem.loading_varies else "not pulled: it creeps to a halt, ever more slowly"
    under = ", under the first normal load" if problem.normal_varies else ""
    unit = problem.unit_of("stiffness")
    sliding = SteadySliding(problem.normal, law.a, law.b, law.distance, rate)
    if not body.has_waves:
        critical, text = sliding.critical_stiffness(body.inertia, body.damping), "stiffness K"
    elif body.is_driven_rigidly and not body.has_inertia:
        of = f" {as_waves(body).modulus_name.symbol}/h" if body.is_uniform else ""
        critical, text = sliding.critical_stiffness(), f"stiffness{of}"
    else:
        return f"critical stiffness of slow sliding S (b - a) / Dc = {sliding.critical_stiffness():.6g} {unit}{under}"
    return f"{text} = {body.stiffness:.6g} against the critical {critical:.6g} {unit} of steady sliding at the {pull}{under}"
