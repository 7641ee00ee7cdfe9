"""Find where friction falls below zero inside a step, under a law that is not known to stay above zero.

At the end of each step friction is known anyway (`certificate.is_negative`). A user's formula can dip below zero and return between
two ends, and friction that drives slip must not pass unnoticed.
"""

from __future__ import annotations

from stickslip.engine.contact.stiffness import contact_at, states_in_step
from stickslip.engine.contact_step.certificate import NEGLIGIBLE_FRICTION, rough
from stickslip.engine.contact_step.step_events import growth
from stickslip.engine.series.polynomial import NONE, RECIPROCAL, bound_below, evaluate
from stickslip.engine.state.layout import TERMS, Floats
from stickslip.engine.state.workspace import Run, borrow
from stickslip.foundation.kernels.kernels import entry, kernel

PARTS_OF_STEP = 16
"""A step is divided into this many parts to look for minima of friction. It covers at most about one oscillation of a law, because
the series must resolve it."""
CLOSER = 8.0
"""The places around a minimum move closer by this factor (1) before the minimum is estimated once more."""
FLOOR = -0.5 * NEGLIGIBLE_FRICTION
"""Least friction coefficient (1) inside a step: below the rounding of zero, but above the value that ends a run at a step's end."""
CLEARLY = 1e-3
"""A friction coefficient above this (1) is clearly above zero: it is larger than the error of friction in the series."""


@kernel
def goes_below_zero(run: Run, rate: Floats, length: float) -> bool:
    """Return True if friction falls below zero in an explicit step, whose series are in `rate`, run.load_along_slip and run.powers.

    For most steps a bound excludes it: friction is the load minus radiation, spring and inertia, which are all polynomials.
    """
    if run.params.can_be_negative == 0.0:
        return False
    if run.k.bend == 0.0 and is_clearly_positive(run, rate, run.k.speed * length):
        return False
    return place_below_zero(run, rate, length) != NONE


@kernel
def is_clearly_positive(run: Run, rate: Floats, duration: float) -> bool:
    """Return True if a bound proves that friction is clearly above zero over an explicit step of the given duration (s)."""
    params, friction = run.params, run.spare
    for k in range(TERMS):
        friction[k] = -params.damping * rate[k]
    for k in range(run.counts.degree + 1):
        friction[k] += run.load_along_slip[k] * run.powers[k]
    allowed = rough(run) * params.tolerance * params.damping * abs(rate[0])
    if run.counts.has_inertia == 1:
        for k in range(TERMS - 1):
            friction[k + 1] -= params.stiffness * duration * RECIPROCAL[k + 1] * rate[k]
            friction[k] -= params.inertia / duration * (k + 1) * rate[k + 1]
        allowed = rough(run) * params.tolerance * params.inertia / duration * abs(rate[0])
    friction[0] += params.reference - run.state.unbalanced - CLEARLY * params.normal - allowed
    return friction[0] > 0.0 and bound_below(friction) > 0.0


@kernel
def place_below_zero(run: Run, rate: Floats, length: float) -> float:
    """Return a place on [0, 1] of a step with friction below zero, or NONE if there is none.

    `rate` is the magnitude of the slip rate (m/s) as a polynomial on [0, 1], and `length` the length of the step (in units). A
    minimum between two places is found to about a millionth of the change of friction between them.
    """
    if run.params.can_be_negative == 0.0:
        return NONE
    width = 1.0 / PARTS_OF_STEP
    before, here = friction_in_step(run, rate, length, 0.0), friction_in_step(run, rate, length, width)
    for k in range(2, PARTS_OF_STEP + 1):
        after = friction_in_step(run, rate, length, k * width)
        if here < FLOOR:
            return (k - 1) * width
        if (here <= before or k == 2) and (here <= after or k == PARTS_OF_STEP):  # at the ends the minimum may be next to them
            lowest = place_of_minimum(run, rate, length, (k - 1) * width)
            if friction_in_step(run, rate, length, lowest) < FLOOR:
                return lowest
        before, here = here, after
    return 1.0 if here < FLOOR else NONE


@kernel
def place_of_minimum(run: Run, rate: Floats, length: float, place: float) -> float:
    """Return the place of lowest friction near `place` on [0, 1] of a step, by two parabolas."""
    width = 1.0 / PARTS_OF_STEP
    for _ in range(2):
        here = friction_in_step(run, rate, length, place)
        before, after = friction_in_step(run, rate, length, place - width), friction_in_step(run, rate, length, place + width)
        bend = before - 2.0 * here + after
        if not bend > 0.0:
            return place
        place = min(max(place + 0.5 * width * (before - after) / bend, width / CLOSER), 1.0 - width / CLOSER)
        width /= CLOSER
    return place


@kernel
def last_place_above_zero(run: Run, rate: Floats, length: float, below: float) -> float:
    """Return the place on [0, 1] of a step where friction falls below zero, given a place `below` with friction below zero.

    It is 0 if friction is below zero already at the beginning of the step.
    """
    low, high = 0.0, below
    for _ in range(60):
        middle = 0.5 * (low + high)
        if friction_in_step(run, rate, length, middle) < 0.0:
            high = middle
        else:
            low = middle
    return low


@kernel
def friction_in_step(run: Run, rate: Floats, length: float, place: float) -> float:
    """Return the friction coefficient at a place on [0, 1] of a step that is `length` units long."""
    slip = run.state.law_slip + run.k.chi * growth(run, rate, length, place)
    contact_at(run, slip, max(evaluate(rate, place), 0.0), states_in_step(run, place * length))
    return run.params.reference / run.params.normal + run.value.mu


@entry
def negative_friction(memory: int, task: int, length: float) -> float:
    """Return 1 if friction falls below zero in the explicit step of the given length (in units) that is being made, else 0."""
    run = borrow(memory)
    return 1.0 if goes_below_zero(run, run.history[run.counts.length].rate, length) else 0.0
