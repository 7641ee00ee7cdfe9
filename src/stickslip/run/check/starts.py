"""Say what is chosen of a start where its user has given nothing: one sentence for each choice.

What the contact does at t = 0+ is told by `stability.start_of`; here is what body, driver and states were before.
"""

from __future__ import annotations

import math
from collections.abc import Iterator

import numpy as np

from stickslip.foundation.names import KINDS
from stickslip.foundation.show import brief
from stickslip.friction.contract import STATE_NAMES
from stickslip.problem import MAY_VARY, LoadingHistory, Problem, driver_of, far_at_first
from stickslip.problem.bodies import OfLayers

SAME = 1e-12
"""Relative difference (1) between two stresses that is rounding."""


def chosen_starts(problem: Problem) -> list[str]:
    """Return a sentence for each thing that is chosen at the start of a problem, without a capital and without a full stop."""
    found = [*_load(problem), *_states(problem)]
    if problem.body.has_waves:
        found += [*_motion(problem), *_stress(problem), *_driver(problem), *_far_side(problem)]
    return [*found, *_before(problem)]


def _load(problem: Problem) -> Iterator[str]:
    if problem.initial_load is None and problem.initial_excess is None:
        what = "the load and the states are those" if problem.friction.states else "the load is that"
        yield f"{what} of steady sliding: {brief(problem.load, problem.load_unit)}"


def _states(problem: Problem) -> Iterator[str]:
    law = problem.friction
    if law.sticks and law.states and not (problem.has_initial_rate and problem.starts_steadily):
        healed = np.ravel(law.healed_state).tolist()
        for name, state, given, zero in zip(STATE_NAMES, law.states, problem.given_states, healed, strict=False):
            if given == zero:
                yield f"the {name.replace('_', ' ')} of friction is {brief(given, state.unit)}, that of a contact that has healed"
    if law.depends_on_slip and law.memory == "since-arrest" and problem.initial_slip != 0.0:
        yield "the start counts as an arrest, since which friction remembers no slip"


def _motion(problem: Problem) -> Iterator[str]:
    """Yield how the body moves before the start."""
    body, unit = problem.body, problem.unit_of("slip_rate")
    if problem.initial_shear == 0.0:
        if problem.rate != 0.0:
            yield f"the whole {body.noun} moves at {brief(problem.rate, unit)}, as the contact does"
        return
    rates = _rates(problem)
    if len(rates) > 1 and rates[0] != rates[1]:  # sides that are apart: as an observer sees them for whom the other driver rests
        rates[1] = 0.0 - rates[1][0], 0.0 - rates[1][1]
    sides = [f"from {brief(near, unit)} at the contact to {brief(far, unit)} at the driver" for near, far in rates]
    if len(set(sides)) == 1:
        yield f"the {body.noun} is being sheared evenly, {sides[0]}, as if it had been pulled so for long"
    else:
        yield f"both sides are being sheared evenly, {' and '.join(sides)}, as if they had been pulled so for long"


def _rates(problem: Problem) -> list[tuple[float, float]]:
    """Return the velocities (m/s) of the contact and of the driver of each side at the start."""
    body, rate, shear = problem.body, problem.rate, problem.initial_shear
    return body.rates_at_start(rate, shear) if isinstance(body, OfLayers) else [(rate, rate + shear)]


def _stress(problem: Problem) -> Iterator[str]:
    """Yield how the stress changes from place to place before the start."""
    body = problem.body
    if not isinstance(body, OfLayers):
        return
    if body.is_joined:
        shares = " to ".join(f"{one.stiffness / body.stiffness:.6g}" for one in body.stacks)
        far = " and the far stress" * (not problem.is_driven_rigidly)
        yield f"the two sides share the load{far} in proportion to their stiffness: {shares}"
    held = [float(one.held(*both)[-1]) for one, both in zip(body.stacks, _rates(problem), strict=True)]
    if any(held):
        sizes = " and ".join(brief(one, body.load_unit) for one in held if one)
        yield f"the {KINDS[body.load_unit].loads} grows from the contact to the driver by what drag takes, {sizes}"


def _driver(problem: Problem) -> Iterator[str]:
    """Yield how a driver that is a machine begins."""
    body, unit = problem.body, problem.unit_of("slip_rate")
    if math.isinf(body.driver_inertia) and not math.isinf(body.driver_impedance):
        yield "the driver is rigid, because its mass is infinite: its impedance is not felt"
    if not body.has_machine:
        return
    why = "the pull rate" if body.driver_inertia > 0.0 else "at which the forces on it balance"
    gain = ", and its integral gain has nothing to make up for yet" * (body.driver_integral_gain > 0.0)
    yield f"the driver begins at {brief(driver_of(problem).at_first(problem)[0], unit)}, {why}{gain}"


def _far_side(problem: Problem) -> Iterator[str]:
    """Yield what the far stress is, or does, at the start."""
    body, far, unit = problem.body, problem.far_stress, problem.load_unit
    if problem.is_driven_rigidly:
        if far is not None or problem.far_stress_rate != 0.0:
            yield "the far stress is not felt, because the driver is rigid all along"
        return
    inside, loads, layers = problem.stress, KINDS[unit].loads, body if isinstance(body, OfLayers) else None
    if far is None:
        drag = ", and what drag takes" * (layers is not None and layers.has_drag and _rates(problem)[0][1] != 0.0)
        yield f"the far stress is not given: it holds the {loads} in the {body.noun} at the start, {brief(inside, unit)}{drag}"
        return
    first = far.first if isinstance(far, LoadingHistory) else far
    behind = inside if layers is not None and len(layers.stacks) > 1 else far_at_first(problem) + problem.strength
    if abs(first - behind) > SAME * max(abs(first), abs(behind)):
        does = "accelerates the driver" if body.driver_inertia > 0.0 else "comes to the contact as a jump"
        apart = f"{brief(first, unit)} at first, beside {brief(behind, unit)} in the {body.noun}"
        yield f"the far stress is {apart}: the difference {does}"


def _before(problem: Problem) -> Iterator[str]:
    """Yield what was before the start where something varies in time."""
    varying = [name.replace("_", " ") for name in MAY_VARY[:3] if isinstance(getattr(problem, name), LoadingHistory)]
    if varying:
        has = "have their values" if len(varying) > 1 else "has its value"
        yield f"before the start the {' and the '.join(varying)} {has} of 0 s"
    if problem.ground is not None:
        yield "before the start the ground is at rest"
