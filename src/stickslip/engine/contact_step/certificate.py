"""Prove every explicit step by Schwarz's lemma, and shorten the step where the proof needs it.

Let g be the residual of the contact equation along a step, with the polynomials of the step put in, for xi on [0, 1]:

    g = Z v + S mu(u, v) - load, with inertia times dt/dxi / m, plus dv/dxi.

The first n Taylor coefficients of g vanish, because the series of the step was made so: n is ORDER + 1, and ORDER with inertia. If
g is analytic on the disc |xi| <= r, and |g| <= M there, then |g(xi)| <= M (xi / r)^n on the disc. M follows from one evaluation of
the law's formula in ball arithmetic (`formula_code.balls`). Anything hidden in the law, such as a singularity, a narrow feature or
an overflow, makes M large or infinite, wherever in the disc it lies.

A bound is expressed as a share: the slip rate that the residual makes, in units of the tolerance times the slip rate of the step.
The proof relies on the series for the vanishing of the first coefficients of g. As a check, g is measured at the end of the step
and added to the bound: if a coefficient does not vanish, by rounding or by a fault, g is largest there. A value above the tolerance
is noted. `solution.observables.proof` proves finished steps without the series. Bounds are calculated in floats: the rounding of a
few hundred operations is far below MARGIN_OF_BOUNDS.
"""

from __future__ import annotations

import math

import numpy as np

from stickslip.engine.contact.contact_equation import constants_of, formula_at
from stickslip.engine.series.polynomial import bound_of_slope, bounds_on_disc, multiply, powers_of, variation_on_disc
from stickslip.engine.series.step_size import quick_exp2, quick_log2
from stickslip.engine.state.layout import TERMS, Ball, Floats, LawValue, SeriesInput
from stickslip.engine.state.workspace import Run
from stickslip.foundation.kernels.kernels import inlined, kernel
from stickslip.foundation.kernels.memory.addresses import ahead, call_radii
from stickslip.foundation.kernels.memory.pointers import numbers_of
from stickslip.problem import Stop

ALLOWED, ALLOWED_SLOPE = 100.0, 1000.0
"""Largest share of a step (1), in units of the local tolerance, which is a tenth of rtol. The second number is for a contact with
inertia: the bound then applies to the slope of the series, whose error is larger than that of the series."""
ROUGH, ROUGH_SLOPE = 10.0, 300.0
"""Rounding above this share (1) is noted. Smooth laws were measured to stay below 1, and below 33 with inertia."""
MARGIN_OF_BOUNDS = 1.01
"""Factor (1) that covers the rounding of bounds."""
RATIOS = np.array([8.0, 6.4, 5.2, 4.4, 3.8, 3.3, 2.9, 2.5, 2.2, 1.9, 1.65, 1.45, 1.3, 1.2])
"""Radii of the discs to try, in lengths of the step (1)."""
SHRUNK, SHRUNK_SLOPE = RATIOS ** -float(TERMS), RATIOS ** -float(TERMS - 1)
"""On the step g is smaller than on each of the discs by these factors (1), without and with inertia."""
SMALLEST_RATE = 1e-300
"""Least slip rate times tolerance (m/s) in a share's denominator: a contact may slip at a rate of exactly zero for a while."""
FIRST_RATIO, NEXT_RATIO, STRAIGHT_DISCS = 4.0, 8.0, 9
"""Discs for a bit next to a fold (1): radius of the first in lengths of the bit, factor from one to the next, and their number."""
ATTEMPTS = 60
"""Shorten a step this many times (1) before the run ends: each time at least to LONGEST of its length."""
HOPELESS = 1e100
"""A share above this (1) means that the law has a singularity on the disc, which is therefore too large."""
SHORTEST, LONGEST = 0.2, 0.9
"""Shorten a step without a proof at a time by a factor (1) between these two."""
SAFETY_OF_LENGTH = 0.98
"""Safety factor (1): the estimated length tends to be 2 % too long."""
NEARLY_SMALL = LONGEST ** (1.0 - TERMS)
"""A share falls at least by this factor (1) if the step is shortened to LONGEST of its length. A share that is nearly small enough
is reduced in this way: it costs one evaluation on a disc, and the search for a better disc costs several."""
TERM_ROUNDING = 1e-14
"""Rounding of the terms of the contact equation (1), relative to the largest of them."""
NEGLIGIBLE_FRICTION = 1e-9
"""A friction coefficient (1) may be below zero by this much through rounding."""
LOST = 1e-6
"""If a step begins with an imbalance above this share of the terms of the contact equation (1), the run ends: no law has so much
rounding."""


# ---- the bound: these functions work on lanes, too -------------------------------------------------------------------------


@inlined
def put_discs(k: SeriesInput, terms: Floats, ratio: float, length: float, ball: Ball) -> None:
    """Put radii and centres of slip (m) and slip rate (m/s) on a disc into `ball`.

    `terms` are those of the slip rate at the end of a step of the given length (in units); the radius of the disc is `ratio` times
    that length. With a bend, the integral of a term of order n >= 1 is at most a third of the term times the square of the radius.
    """
    (rate, mean), start, radius = bounds_on_disc(terms, ratio), abs(terms[0]), ratio * length
    ball.rate = rate
    ball.slip = radius * (abs(k.speed) * (start + mean) + abs(k.bend) * radius * (0.5 * start + (1.0 / 3.0) * rate))
    ball.at_slip, ball.at_rate = k.slip, terms[0]  # for formulas that keep no centres beside the series


@inlined
def load_on_disc(load: Floats, powers: Floats, ratio: float, degree: int) -> float:
    """Return how far a load of the given degree can be from its value at the centre of a disc (Pa or N).

    `powers` are those of a length (in units), and the radius of the disc is `ratio` times that length.
    """
    if degree <= 1:
        return abs(load[1]) * powers[1] * ratio
    return variation_on_disc(load, powers, ratio)


@inlined
def force_on_disc(k: SeriesInput, ball: Ball, load: float) -> float:
    """Return a bound (Pa or N) on how far the sum of load, spring, radiation and friction is from its value at a disc's centre."""
    return MARGIN_OF_BOUNDS * (k.damping * ball.rate + k.normal * ball.friction + k.stiffness * ball.slip + load)


@inlined
def size_of_rate(terms: Floats) -> float:
    """Return a size of the slip rate (m/s) over a step, from the terms of its series at the end."""
    return max(max(abs(terms[0]), abs(terms[1])), max(abs(terms[2]), abs(terms[3])))


@inlined
def shortened(length: float, share: float, largest: float) -> float:
    """Return the length (in units) that brings a step's share down to the largest allowed one."""
    root = quick_exp2((quick_log2(largest) - quick_log2(share)) * (1.0 / (TERMS - 1)))
    return length * min(max(SAFETY_OF_LENGTH * root, SHORTEST), LONGEST)


@inlined
def imbalance(k: SeriesInput, load: float, value: LawValue, rate_end: float, unbalanced: float) -> float:
    """Return load minus radiation and friction (Pa or N), minus the force that was unbalanced at the start of the step."""
    return load - k.damping * rate_end - k.normal * (value.mu + k.offset) - unbalanced


@inlined
def missed_by_rate(k: SeriesInput, missing: float, value: LawValue) -> float:
    """Return the slip rate (m/s) that makes up for a missing load, for a contact without inertia."""
    return abs(missing) / (k.damping + k.normal * max(value.by_rate, 0.0))


@inlined
def missed_by_motion(k: SeriesInput, missing: float, rate: Floats, length: float, grown: float) -> float:
    """Return by how much the slope of the slip rate (m/s per step) is wrong at the end of a step, for a contact with inertia."""
    pace = (k.speed + k.bend * length) * length / k.inertia
    return abs((missing - k.stiffness * grown) * pace - slope_at_end(rate))


@inlined
def force_of_slope(k: SeriesInput, length: float) -> float:
    """Return the force of inertia (Pa or N) per slope of the slip rate (m/s per step) at the end of a step."""
    return k.inertia / (length * abs(k.speed + k.bend * length))


@inlined
def size_at_end(rate: Floats, rate_end: float) -> float:
    """Return the size of the slip rate (m/s) over a step, for comparison with errors at its end."""
    return max(max(abs(rate[0]), abs(rate_end)), max(abs(rate[1]), max(abs(rate[2]), abs(rate[3]))))


@inlined
def slope_at_end(rate: Floats) -> float:
    """Return p'(1), the slope of the slip rate's polynomial at the end of the step."""
    a, b = rate[1], 2.0 * rate[2]
    for k in range(3, TERMS - 1, 2):
        a, b = a + k * rate[k], b + (k + 1) * rate[k + 1]
    return a + b


@inlined
def load_at_end(load: Floats, powers: Floats, degree: int) -> float:
    """Return a load of the given degree at the end of a step (Pa or N), from the powers of the step's length.

    It is the load minus the reference, as seen in the direction of slip.
    """
    end = load[0] + powers[1] * load[1]
    for k in range(2, degree + 1):
        end += powers[k] * load[k]
    return end


# ---- a step of a single run ------------------------------------------------------------------------------------------------


@kernel
def share_at(run: Run, length: float) -> float:
    """Return the bound, as a share, on the residual of a step of the given length (in units), by the disc of the step before.

    Leaves the powers of the length in run.powers, and the terms of the slip rate at the end of the step where it will be kept.
    """
    powers_of(length, run.powers)
    multiply(run.jet, run.powers, terms_of(run))
    return share_on_disc(run, length, run.counts.disc)


@inlined
def terms_of(run: Run) -> Floats:
    """Return the room for the terms (m/s) of the slip rate's series at the end of a step: the next free row of the history."""
    return run.history[run.counts.length].rate


@kernel
def share_on_disc(run: Run, length: float, disc: int) -> float:
    """Return what `share_at` does after it was called for this length, by disc number `disc` of RATIOS."""
    terms, ratio, piece = terms_of(run), RATIOS[disc], run.counts.piece
    put_discs(run.k, terms, ratio, length, run.ball)
    put_states(run, ratio)
    call_radii(run.law[piece].radii_at, constants_of(run, piece), run.jet, numbers_of(run.ball))
    force = force_on_disc(run.k, run.ball, load_on_disc(run.load_along_slip, run.powers, ratio, run.counts.degree))
    if run.params.winding != 0.0:  # the load has the integral of slip but for its last terms, whose bound is that of all
        force += run.params.winding * ratio * length * abs(run.k.speed) * run.ball.slip
    if run.counts.has_inertia == 1:
        missed = (length * abs(run.k.speed) / run.k.inertia * force + bound_of_slope(terms, ratio)) * SHRUNK_SLOPE[disc]
    else:
        missed = force / resistance(run) * SHRUNK[disc]
    share = missed / max(run.params.tolerance * size_of_rate(terms), SMALLEST_RATE)
    return min(HOPELESS, share)  # also if it is not a number


@inlined
def put_states(run: Run, ratio: float) -> None:
    """Put radii and centres of the states on a disc into `ball`; its radius is `ratio` times the length that has run.powers."""
    for n in range(run.counts.states):
        series = ahead(run.state_jet, TERMS * n)
        run.ball.state[n], run.ball.at_state[n] = variation_on_disc(series, run.powers, ratio), series[0]


@inlined
def resistance(run: Run) -> float:
    """Return Z, or g'(v) on a branch where friction grows with the slip rate (Pa s/m): it turns a missing load into a slip rate."""
    return run.k.damping + (max(run.friction.by_rate, 0.0) if run.counts.is_algebraic == 1 else 0.0)


@inlined
def allowed(run: Run) -> float:
    """Return the largest share of a step (1)."""
    return ALLOWED_SLOPE if run.counts.has_inertia == 1 else ALLOWED


@inlined
def rough(run: Run) -> float:
    """Return the share (1) above which rounding is noted."""
    return ROUGH_SLOPE if run.counts.has_inertia == 1 else ROUGH


@kernel
def proven_length(run: Run, length: float) -> float:
    """Return a length (in units) of a proven step, at most the given one; note the bound in run.state.residual.

    The disc of the step before is tried first. A step that is nearly proven is shortened at once; if that does not help, a better
    disc is sought. If no length can be proven the run ends: `breach` is OFF_THE_LAW.
    """
    share = share_at(run, length)
    attempt = 0
    while not share <= allowed(run) and attempt < ATTEMPTS:
        enough = allowed(run) * (NEARLY_SMALL if attempt == 0 else 1.0)
        if not share <= enough:
            share = least_share(run, length, share, enough)
        if not share <= allowed(run):
            length = shortened(length, share, allowed(run))
            share = share_at(run, length)
        attempt += 1
    if not share <= allowed(run):
        run.counts.breach = Stop.OFF_THE_LAW
    note_residual(run, length, share)
    return length


@kernel
def least_share(run: Run, length: float, share: float, enough: float) -> float:
    """Return the least share of the step on any disc, or the first that is at most `enough`; the present disc has `share`.

    As a function of the disc, the share falls to a single minimum and then rises, because radii have power series without negative
    coefficients (Hadamard's three circles theorem). So the search goes from disc to disc in the falling direction. If a disc
    reaches a singularity, it goes on to smaller ones.
    """
    first = run.counts.disc
    for way in (1, -1):
        disc = first + way
        while 0 <= disc < len(RATIOS) and not share <= enough:
            other = share_on_disc(run, length, disc)
            if share <= other and share < HOPELESS:
                break
            share, run.counts.disc = other, disc
            disc += way
        if run.counts.disc != first:
            break
    return share


@inlined
def note_residual(run: Run, length: float, share: float) -> None:
    """Note the bound on the residual load (Pa or N) of a step of the given length (in units), from its share."""
    load = run.k.inertia / (length * abs(run.k.speed)) if run.counts.has_inertia == 1 else resistance(run)
    run.state.residual = load * share * run.params.tolerance * size_of_rate(terms_of(run))


# ---- bits next to a fold -----------------------------------------------------------------------------------------------------


@kernel
def bound_straight_bit(run: Run, length: float, grown: float, rate_end: float) -> None:
    """Note the bound of a bit next to a fold, where the slip rate is a straight line in the root of time.

    The contact equation holds at the beginning of the bit, and at its end up to the residual measured there. With two zeros, at 0
    and 1, Schwarz's lemma gives |g| <= M x (1 - x) / (r^2 - x), at most M / (4 (r^2 - 1)). The bit is `length` units long, `grown`
    is the slip (m) in it and `rate_end` the slip rate (m/s) at its end; run.powers must hold the powers of its length, and the
    next free row of the history the slip rate.
    """
    piece, least, ratio = run.counts.piece, math.inf, FIRST_RATIO
    for _ in range(STRAIGHT_DISCS):
        put_discs(run.k, terms_of(run), ratio, length, run.ball)
        put_states(run, ratio)
        call_radii(run.law[piece].radii_at, constants_of(run, piece), run.jet, numbers_of(run.ball))
        force = force_on_disc(run.k, run.ball, load_on_disc(run.load_along_slip, run.powers, ratio, run.counts.degree))
        bound = force / (4.0 * (ratio * ratio - 1.0))
        if bound < least:
            least = bound
        ratio *= NEXT_RATIO
    run.state.residual = least + abs(missing_at_end(run, grown, rate_end))


# ---- rounding ---------------------------------------------------------------------------------------------------------------


@kernel
def begin_step(run: Run) -> None:
    """Note the force (Pa or N) that a step ignores at its start, because it leaves rest without a net force by definition.

    A massless contact must be in balance: otherwise no solution begins here.
    """
    run.state.unbalanced = 0.0
    if run.k.free != 0.0 or run.counts.is_algebraic == 1:  # An algebraic contact solves its equation at the start too.
        return
    piece = run.counts.piece
    formula_at(run, piece, run.k.slip, 0.0, run.state.state_now)
    balance = run.load_along_slip[0] - run.params.normal * (run.value.mu + run.law[piece].offset)
    run.state.unbalanced = balance - run.k.force
    if run.counts.has_inertia == 0 and abs(run.state.unbalanced) > (LOST + ROUGH * run.params.tolerance) * run.params.normal:
        run.counts.breach = Stop.OFF_THE_LAW


@inlined
def missing_at_end(run: Run, grown: float, rate_end: float) -> float:
    """Return the residual (Pa or N) of the contact equation at the end of a step, without the forces of inertia and of a spring.

    `grown` is the slip (m) in the step and `rate_end` the slip rate (m/s) at its end; run.powers must hold the powers of its
    length. Friction at the end is left in run.value.
    """
    for n in range(run.counts.states):
        run.some_state[n] = load_at_end(ahead(run.state_jet, TERMS * n), run.powers, TERMS - 1)
    formula_at(run, run.counts.piece, run.k.slip + run.k.chi * grown, rate_end, run.some_state)
    load = load_at_end(run.load_along_slip, run.powers, run.counts.degree)
    return imbalance(run.k, load, run.value, rate_end, run.state.unbalanced)


@inlined
def measure_end(run: Run, rate: Floats, length: float, grown: float, rate_end: float) -> float:
    """Return the residual of the contact equation at the end of a step plus the force ignored at its start (Pa or N, magnitudes).

    A residual above the tolerance is noted. `rate` is the slip rate on [0, 1], `length` the length of the step (in units), `grown`
    the slip in it (m) and `rate_end` the slip rate at its end (m/s). Friction at the end is left in run.value.
    """
    missing, size = missing_at_end(run, grown, rate_end), size_at_end(rate, rate_end)
    if run.counts.has_inertia == 1:
        missed = missed_by_motion(run.k, missing, rate, length, grown)
        missing = missed * force_of_slope(run.k, length)
    else:
        missed = missed_by_rate(run.k, missing, run.value)
    if missed > rough(run) * run.params.tolerance * size:
        note_rounding(run, missed, size, length)
    return abs(missing) + abs(run.state.unbalanced)


@kernel
def note_rounding(run: Run, missed: float, size: float, length: float) -> None:
    """Count a step if rounding in the law hides more than the tolerance: a residual of `missed` (m/s) beyond ordinary rounding.

    `size` is that of the slip rate (m/s). The rounding of terms of their size, and of slip rate and slip themselves, is ordinary
    and no fault of the law.
    """
    params, value = run.params, run.value
    friction = value.mu + run.law[run.counts.piece].offset
    slip = run.k.slip + run.k.chi * run.state.slip_now
    terms = params.reference + abs(run.load_along_slip[0]) + params.normal * (abs(friction) + abs(value.by_rate * size))
    terms += params.normal * abs(value.by_slip * slip)
    if run.counts.has_inertia == 1:
        known = TERM_ROUNDING * terms * abs(run.k.speed) * length / params.inertia
    else:
        known = TERM_ROUNDING * terms / (params.damping + params.normal * max(value.by_rate, 0.0))
    if missed > known + rough(run) * params.tolerance * size:
        run.counts.rough += 1
        run.state.roughest = max(run.state.roughest, missed / size)
        if missed * TERM_ROUNDING > LOST * known:
            run.counts.breach = Stop.OFF_THE_LAW


@inlined
def is_negative(run: Run) -> bool:
    """Return True if the friction that was evaluated last (in run.value) is below zero: it would drive slip."""
    friction = run.value.mu + run.law[run.counts.piece].offset
    return run.params.reference + run.params.normal * friction < -NEGLIGIBLE_FRICTION * run.params.normal
