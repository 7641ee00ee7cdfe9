"""Bound the residual of the governing equations anywhere in an implicit step, or in a part of it.

Let g be the residual of an equation for the polynomials of the step, and y the place in the part minus its middle, in lengths of
the part. g is measured at Chebyshev's RESIDUAL_PLACES of the part. Let p be the polynomial through these values, and w the product
of the y - y_i. If g is analytic on the disc |y| <= R and |g| <= M there, then, by Hermite's formula for the remainder,

    |g - p| <= M R / (R - 1/2) largest |w| on the part / least |w| on the circle |y| = R,

and |p| is at most Lebesgue's constant of these places times the largest value. M follows from ball arithmetic of the law's formula,
as for explicit steps (`contact_step.certificate`). Nothing else about the step is used: not that it obeys the equations at Radau's
points, and not where its error is largest. Where no disc around the whole step has a bound, the step is proven part by part
(`radau.parts`). Source: Davis 1975, Interpolation and Approximation, section 3.6.
"""

from __future__ import annotations

import math
from typing import Any

import numpy as np
from numpy.typing import NDArray

from stickslip.engine.contact.contact_equation import constants_of, static_step
from stickslip.engine.contact.pressing import own_states
from stickslip.engine.contact.stiffness import contact_at
from stickslip.engine.radau.stages import WIDTH_OF_ROW, larger, yielding, yielding_of_state
from stickslip.engine.series.polynomial import ONES, RECIPROCAL, integral, restrict
from stickslip.engine.series.radau_nodes import STAGES
from stickslip.engine.state.layout import STATES, TERMS, Floats, StepProof
from stickslip.engine.state.workspace import Run
from stickslip.foundation.kernels.kernels import kernel
from stickslip.foundation.kernels.memory.addresses import ahead, call_radii
from stickslip.foundation.kernels.memory.pointers import numbers_of, record_at

RESIDUAL_PLACES = 18
"""Number of places (1) of a part where the residual is measured."""
PLACE = 0.5 * np.cos(np.pi * (np.arange(RESIDUAL_PLACES) + 0.5) / RESIDUAL_PLACES)
"""These places (1), relative to the middle of the part and in lengths of it."""
DISCS = np.array([2.8, 2.0, 1.5, 1.2, 1.0, 0.85, 0.75, 0.68, 0.62])
"""Radii (1) of the discs to try around the middle of a part, in lengths of the part."""
FIRST_DISC = 2
"""The first disc to try (1), as an index of DISCS. If it has a bound, larger ones are tried, else smaller ones."""
FINE = 4001
"""Number of places (1) of a part or a circle among which extremes are sought."""
MARGIN_OF_RESIDUAL = 1.02
"""Factor (1) that covers rounding, and extremes between those places."""
ENOUGH = 1e-4
"""A hidden residual below this share (1) of what is allowed is small enough: no better disc is sought."""
CRUDE = 1e-4
"""A residual above this share (1) of the normal load is too large however slow slip is: under rate and state, friction at a slip
rate of 1e-40 m/s is that at any other, and an error that is nothing in the slip rate is all of friction."""
LONG_STEP = 1e-11
"""This holds for steps that last at least this share (1) of a round trip: in a shorter one the acceleration is rounding."""
FAINT = 1e-290
"""And for slip rates (m/s) above this: below, floats lose their digits."""
MOST_HIDDEN = 0.02
"""A part that may hide more than this share (1) of what is allowed has no bound: its parts, or a shorter step, hide far less."""
HOPELESS = 1e100
"""A share (1) above this is infinite: the law has a singularity on the disc."""
PROVEN = 0.02
"""Share (1) of a bound that counts as the error of a step. The bound exceeds the largest residual at the places by Lebesgue's
constant, and a residual changes its sign at each stage, so that its effect on slip and states nearly cancels."""


def _hidden_shares() -> NDArray[np.float64]:
    """Return what a bound M on each of DISCS is multiplied by, to bound the residual between RESIDUAL_PLACES."""
    on_part, circle = np.linspace(-0.5, 0.5, FINE), np.exp(2j * np.pi * np.linspace(0.0, 1.0, FINE))
    largest = np.abs(on_part[:, None] - PLACE).prod(axis=1).max()
    least = np.array([np.abs(radius * circle[:, None] - PLACE).prod(axis=1).min() for radius in DISCS])
    return np.asarray(MARGIN_OF_RESIDUAL * DISCS / (DISCS - 0.5) * largest / least)


def _lebesgue() -> float:
    """Return the largest value on the part of a polynomial whose values at RESIDUAL_PLACES are at most 1."""
    apart, on_part = PLACE[:, None] - PLACE + np.eye(RESIDUAL_PLACES), np.linspace(-0.5, 0.5, FINE)
    weight = on_part[:, None] - PLACE + 1e-300
    basis = weight.prod(axis=1, keepdims=True) / weight / apart.prod(axis=1)
    return float(MARGIN_OF_RESIDUAL * np.abs(basis).sum(axis=1).max())


HIDDEN, LEBESGUE = _hidden_shares(), _lebesgue()
"""Shares (1) for each of DISCS, and Lebesgue's constant (1) of RESIDUAL_PLACES; see above."""
WALK, SIZE, SLOPE = RECIPROCAL[1:], ONES, np.arange(float(TERMS))
"""Weights of coefficients in the integral, the value and the slope of a polynomial; see `moved_on_disc`."""
step_proof_at: Any = record_at(StepProof)
"""Function for compiled code that returns the `StepProof` at a pointer."""


@kernel
def moved_on_disc(c: Floats, weights: Floats, first: int, last: int, radius: float) -> float:
    """Return how far something of a polynomial of degree `last` in y can be from its value at y = 0 on a disc.

    With the weights WALK, SIZE and SLOPE, and a `first` term of 0, 1 and 2, that is its integral, its value and its slope.
    """
    size = 0.0
    for k in range(last, first - 1, -1):
        size = (size + weights[k] * abs(c[k])) * radius
    return size


@kernel
def state_from_middle(run: Run, n: int) -> Floats:
    """Return room for the polynomial of state n around the middle of a part, behind the records `between` in run.matrix."""
    return ahead(run.matrix, WIDTH_OF_ROW * STAGES + TERMS * n)


@kernel
def step_proof(run: Run) -> StepProof:
    """Return the record of what is proven of the step: it lies behind these polynomials."""
    return step_proof_at(ahead(run.matrix, WIDTH_OF_ROW * STAGES + TERMS * STATES))


@kernel
def begin_proof(run: Run, h: float, force: float) -> None:
    """Begin the proof of a step of h seconds that ignores a force (Pa or N); the caller says what is allowed."""
    proof = step_proof(run)
    proof.duration, proof.force, proof.bound, proof.proven_to, proof.lacks_bound = h, force, 0.0, 0.0, 0.0


@kernel
def share_of_part(run: Run, start: float, width: float) -> float:
    """Return the bound on the residuals of a part, as a share of what is allowed, and note that on the contact equation.

    The polynomials of the step are in run.jet and run.state_jet, or the strength in run.jet at rest. The share is infinite if no
    disc around the part has a bound that is small enough: the residual is not measured then.
    """
    put_part(run, start, width)
    contact_in_middle(run)
    if not hide(run) <= MOST_HIDDEN:
        return math.inf
    measure(run)
    proof = step_proof(run)
    bound = LEBESGUE * proof.measured + proof.hidden
    proof.bound = larger(proof.bound, bound)
    share = PROVEN * max(bound * proof.rate_yields - LEBESGUE * proof.rate_rounding, 0.0) / proof.rate_allowed
    long = proof.duration > LONG_STEP * run.params.round_trip_time
    if run.counts.mode != 0 and long and abs(run.trial[0]) > FAINT:
        share = larger(share, bound / (CRUDE * run.params.normal))
    for n in range(own_states(run)):
        missed = (LEBESGUE * proof.state_measured[n] + proof.state_hidden[n]) * proof.state_yields[n]
        share = larger(share, PROVEN * max(missed - LEBESGUE * proof.state_rounding[n], 0.0) / proof.state_allowed[n])
    return larger(0.0, share)


@kernel
def measured_anywhere(run: Run) -> float:
    """Return the largest residual (Pa or N) at RESIDUAL_PLACES of the whole step."""
    put_part(run, 0.0, 1.0)
    contact_in_middle(run)
    measure(run)
    return step_proof(run).measured


@kernel
def put_part(run: Run, start: float, width: float) -> None:
    """Write the polynomials of a part of the step in y: the slip rate into run.trial, the load into run.spare, and the states."""
    proof, middle = step_proof(run), start + 0.5 * width
    restrict(run.jet, middle, width, run.trial)
    restrict(run.load_along_slip, middle, width, run.spare)
    for n in range(run.counts.states):
        restrict(ahead(run.state_jet, TERMS * n), middle, width, state_from_middle(run, n))
    proof.width, proof.walked = width, 0.0
    if run.counts.mode != 0:
        proof.walked = proof.duration * integral(run.jet, middle, 1)


@kernel
def contact_in_middle(run: Run) -> None:
    """Evaluate the contact in the middle of the part, put this centre of its discs into run.ball, and note how errors yield."""
    ball, proof, slips = run.ball, step_proof(run), run.counts.mode != 0
    for n in range(run.counts.states):
        ball.at_state[n] = run.some_state[n] = state_from_middle(run, n)[0]
    ball.at_rate = run.trial[0] if slips else 0.0
    law_slip = run.state.law_slip + run.k.chi * proof.walked
    ball.at_slip = law_slip + run.law[run.counts.piece].slip_shift
    contact_at(run, law_slip, ball.at_rate, run.some_state)
    proof.rate_yields = yielding(run, proof.duration) if slips else 1.0
    for n in range(own_states(run)):
        proof.state_yields[n] = yielding_of_state(run, proof.duration, n)


@kernel
def missing_at(run: Run, rate: float, slope: float, walked: float, load: float) -> float:
    """Return what the contact equation lacks (Pa or N) where run.value and run.some_state belong to.

    `slope` (m/s) is that of the slip rate in y, and `walked` (m) the slip since the start of the step.
    At rest `rate` is the strength, and what the strength lacks is returned.
    """
    params, proof = run.params, step_proof(run)
    if run.counts.mode == 0:
        return rate - params.normal * (run.value.mu + static_step(run, run.some_state))
    missing = load - proof.force - params.damping * rate - params.normal * run.value.mu - params.stiffness * walked
    return missing - params.inertia / (proof.duration * proof.width) * slope


@kernel
def hide(run: Run) -> float:
    """Bound what may be hidden between RESIDUAL_PLACES, by the best of DISCS; return it as a share of what is allowed.

    run.value and run.ball belong to the middle of the part.
    """
    proof, own = step_proof(run), own_states(run)
    lasts = proof.duration * proof.width
    centre = abs(missing_at(run, run.trial[0], run.trial[1], proof.walked, run.spare[0]))
    proof.hidden, least = math.inf, math.inf
    for n in range(own):
        proof.state_measured[n] = abs(run.value.change[n] - state_from_middle(run, n)[1] / lasts)  # for the time being
        proof.state_hidden[n] = math.inf
    least = hide_by_disc(run, FIRST_DISC, centre)
    if least < math.inf:
        for disc in range(FIRST_DISC - 1, -1, -1):
            share = hide_by_disc(run, disc, centre) if least > ENOUGH else least
            if not share < least:
                break
            least = share
    for disc in range(FIRST_DISC + 1, len(DISCS)):
        share = hide_by_disc(run, disc, centre) if least > ENOUGH else least
        if least < math.inf and not share < least:
            break
        least = share
    return least


@kernel
def hide_by_disc(run: Run, disc: int, centre: float) -> float:
    """Bound what may be hidden by one of DISCS, and keep the least bounds; return their share of what is allowed.

    `centre` is the residual in the middle of the part, that of the states is in `state_measured`.
    """
    proof, ball, params, radius, share = step_proof(run), run.ball, run.params, DISCS[disc], 0.0
    lasts, slips, own = proof.duration * proof.width, run.counts.mode != 0, own_states(run)
    put_disc(run, radius)
    if slips:
        moved = moved_on_disc(run.spare, SIZE, 1, run.counts.degree, radius) + params.damping * ball.rate
        moved += params.stiffness * ball.slip + params.inertia / lasts * moved_on_disc(run.trial, SLOPE, 2, STAGES, radius)
    else:
        moved = moved_on_disc(run.trial, SIZE, 1, STAGES, radius)
        moved += params.normal * params.static_excess * ball.state[own] if run.counts.given > 0 else 0.0
    hidden = HIDDEN[disc] * (centre + params.normal * ball.friction + moved)
    proof.hidden = min(proof.hidden, larger(0.0, hidden))
    share = PROVEN * proof.hidden * proof.rate_yields / proof.rate_allowed
    for n in range(own):
        moved = moved_on_disc(state_from_middle(run, n), SLOPE, 2, STAGES, radius) / lasts
        hidden = HIDDEN[disc] * (proof.state_measured[n] + ball.change[n] + moved)
        proof.state_hidden[n] = min(proof.state_hidden[n], larger(0.0, hidden))
        share = max(share, PROVEN * proof.state_hidden[n] * proof.state_yields[n] / proof.state_allowed[n])
    return share if share < HOPELESS else math.inf


@kernel
def put_disc(run: Run, radius: float) -> None:
    """Put the radii of slip, slip rate and states on a disc around the middle of the part, and those of the law, into run.ball."""
    proof, ball, slips = step_proof(run), run.ball, run.counts.mode != 0
    ball.rate = moved_on_disc(run.trial, SIZE, 1, STAGES, radius) if slips else 0.0
    ball.slip = proof.duration * proof.width * moved_on_disc(run.trial, WALK, 0, STAGES, radius) if slips else 0.0
    for n in range(run.counts.states):
        ball.state[n] = moved_on_disc(state_from_middle(run, n), SIZE, 1, STAGES, radius)
    piece = run.counts.piece
    call_radii(run.law[piece].balls_at, constants_of(run, piece), run.jet, numbers_of(ball))


@kernel
def measure(run: Run) -> None:
    """Measure the residuals at RESIDUAL_PLACES of a part: of the contact equation, or the strength at rest, and of the states."""
    proof, own = step_proof(run), own_states(run)
    lasts, slips = proof.duration * proof.width, run.counts.mode != 0
    proof.measured = 0.0
    for n in range(own):
        proof.state_measured[n] = 0.0
    for i in range(RESIDUAL_PLACES):
        y = PLACE[i]
        rate, slope = value_and_slope(run.trial, STAGES, y)
        walked = proof.walked + lasts * integral(run.trial, y, 1) if slips else 0.0
        for n in range(run.counts.states):
            run.some_state[n], run.state_error[n] = value_and_slope(state_from_middle(run, n), STAGES, y)
        contact_at(run, run.state.law_slip + run.k.chi * walked, rate if slips else 0.0, run.some_state)
        load, _ = value_and_slope(run.spare, run.counts.degree, y)
        proof.measured = larger(proof.measured, abs(missing_at(run, rate, slope, walked, load)))
        for n in range(own):
            missing = abs(run.value.change[n] - run.state_error[n] / lasts)
            proof.state_measured[n] = larger(proof.state_measured[n], missing)


@kernel
def value_and_slope(c: Floats, last: int, y: float) -> tuple[float, float]:
    """Return the value and the slope of a polynomial of the given degree."""
    value, slope = c[last], 0.0
    for k in range(last - 1, -1, -1):
        slope = slope * y + value
        value = value * y + c[k]
    return value, slope
