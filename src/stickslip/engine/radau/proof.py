"""Bound the residual of the governing equations anywhere in an implicit step, by Schwarz's lemma.

Let g be the residual of an equation for the polynomials of the step, at the place x on [0, 1], and y = x - 1/2. At Radau's points
the polynomials obey the equations, so g is zero up to the error of Newton's method. If g is analytic on the disc |y| <= R and
|g| <= M there, then

    |g(x)| <= M product of |R (y - y_i) / (R^2 - y_i y)|

over these points y_i: g divided by the product is analytic, and the product has magnitude 1 on the circle (Blaschke factors). M
follows from ball arithmetic of the law's formula, as for explicit steps (`contact_step.certificate`).
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from stickslip.engine.compile.kernels import kernel
from stickslip.engine.contact.contact_equation import constants_of, static_step
from stickslip.engine.contact.pressing import own_states
from stickslip.engine.contact.stiffness import contact_at
from stickslip.engine.memory.addresses import ahead, call_radii
from stickslip.engine.memory.pointers import numbers_of
from stickslip.engine.radau.stages import WIDTH, yielding, yielding_of_state
from stickslip.engine.series.polynomial import ONES, RECIPROCAL, integral, restrict
from stickslip.engine.series.radau_nodes import POINT, STAGES
from stickslip.engine.state.layout import TERMS, Floats
from stickslip.engine.state.workspace import Run

DISCS = np.array([4.0, 2.8, 2.0, 1.5, 1.2, 1.0, 0.85, 0.75, 0.68, 0.62])
"""Radii (1) of the discs to try around the middle of a step, in lengths of the step."""
PLACES_ON_STEP = 4001
"""The largest product is sought among this many places."""
MARGIN = 1.02
"""Factor (1) that covers rounding, and larger products between those places."""
NEAR_ZERO = 0.1
"""Zero counts as near if the slip rate changes by this share (1) of its value in the middle of a step."""


def _products(zeros: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return the largest product of Blaschke factors on the step, for each of DISCS, if g is zero at the given places on [0, 1]."""
    y, radius = np.linspace(-0.5, 0.5, PLACES_ON_STEP), DISCS[:, None, None]
    own = (zeros - 0.5)[:, None]
    return np.asarray(MARGIN * abs(radius * (y - own) / (radius * radius - own * y)).prod(axis=1).max(axis=1))


AT_STAGES, AT_POINTS = _products(POINT[1:]), _products(POINT)
"""Largest products for functions that are zero at Radau's points, and for functions that are also zero at the start of the step."""


WALK, SIZE, SLOPE = RECIPROCAL[1:], ONES, np.arange(float(TERMS))
"""Weights of coefficients in the integral, the value and the slope of a polynomial; see `moved_on_disc`."""


@kernel
def moved_on_disc(c: Floats, weights: Floats, first: int, radius: float) -> float:
    """Return how far something of a polynomial of degree STAGES in y can be from its value at y = 0 on a disc.

    With the weights WALK, SIZE and SLOPE, and a `first` term of 0, 1 and 2, that is its integral, its value and its slope.
    """
    size = 0.0
    for k in range(STAGES, first - 1, -1):
        size = (size + weights[k] * abs(c[k])) * radius
    return size


@kernel
def state_from_middle(run: Run, n: int) -> Floats:
    """Return room for the polynomial of state n around the middle of a step, behind the records `between` in run.matrix."""
    return ahead(run.matrix, WIDTH * STAGES + TERMS * n)


@kernel
def prove_step(run: Run, h: float, force: float) -> float:
    """Return a bound on the residual of a step of h seconds, as slip rate (m/s); leave those of the states in run.state_error.

    The polynomials are in run.jet and run.state_jet. At rest, run.jet is the strength, and the bound is that of its error (Pa or
    N). The bound on the residual load of the contact equation is added to the measured residual (`stages.defects`) in
    run.state.residual. `force` (Pa or N) is the force that the step ignores.
    """
    slips, rate, load, own = run.counts.mode != 0, run.trial, run.spare, own_states(run)
    restrict(run.jet, 0.5, 1.0, rate)
    restrict(run.load_along_slip, 0.5, 1.0, load)
    params, ball, value = run.params, run.ball, run.value
    at_rate = rate[0] if slips else 0.0
    walked = h * integral(run.jet, 0.5, 1) if slips else 0.0
    law_slip = run.state.law_slip + run.k.chi * walked
    for n in range(run.counts.states):
        state = state_from_middle(run, n)
        restrict(ahead(run.state_jet, TERMS * n), 0.5, 1.0, state)
        ball.at_state[n], run.state_error[n] = state[0], math.inf if n < own else 0.0
    contact_at(run, law_slip, at_rate, ball.at_state)
    if slips:
        missing = load[0] - force - params.damping * rate[0] - params.normal * value.mu - params.stiffness * walked
        missing -= params.inertia / h * rate[1]
    else:
        missing = rate[0] - params.normal * (value.mu + static_step(run, ball.at_state))
    piece, least = run.counts.piece, math.inf
    ball.at_slip, ball.at_rate = law_slip + run.law[piece].slip_shift, at_rate
    for disc in range(len(DISCS)):
        radius = DISCS[disc]
        ball.rate = moved_on_disc(rate, SIZE, 1, radius) if slips else 0.0
        ball.slip = h * moved_on_disc(rate, WALK, 0, radius) if slips else 0.0
        for n in range(run.counts.states):
            ball.state[n] = moved_on_disc(state_from_middle(run, n), SIZE, 1, radius)
        call_radii(run.law[piece].balls_at, constants_of(run, piece), run.jet, numbers_of(ball))
        if slips:
            moved = moved_on_disc(load, SIZE, 1, radius) + params.damping * ball.rate + params.stiffness * ball.slip
            moved += params.inertia / h * moved_on_disc(rate, SLOPE, 2, radius)
            least = min(least, AT_STAGES[disc] * (abs(missing) + params.normal * ball.friction + moved))
        else:
            step = params.static_excess * ball.state[own] if run.counts.given > 0 else 0.0
            changed = params.normal * (ball.friction + step)
            least = min(least, AT_POINTS[disc] * (abs(missing) + changed + moved_on_disc(rate, SIZE, 1, radius)))
        for n in range(own):
            state = state_from_middle(run, n)
            moved = moved_on_disc(state, SLOPE, 2, radius) / h
            lacking = AT_STAGES[disc] * (abs(value.change[n] - state[1] / h) + ball.change[n] + moved)
            run.state_error[n] = min(run.state_error[n], lacking)
    for n in range(run.counts.states):
        run.state_error[n] *= yielding_of_state(run, h, n)
    run.state.residual += least
    return least * yielding(run, h) if slips else least


@kernel
def passes_zero(run: Run) -> bool:
    """Return True if the contact never sticks, and the slip rate comes near zero on the smallest disc that `prove_step` tried."""
    return run.counts.sticks == 0 and run.ball.rate >= NEAR_ZERO * run.ball.at_rate
