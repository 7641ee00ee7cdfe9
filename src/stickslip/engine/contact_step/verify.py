"""Verify explicit steps: no step goes beyond what its series can see, and every step obeys the contact equation.

The length of a step follows from the last coefficients of its series. Two checks keep that honest. The guards of the law's
formula (see `engine/codegen/guards.py`) end the step before a part of the law that left no trace at its start begins to count.
The finished step is then put into the governing equation at its end, where a series is worst: what is missing must be no more
than the tolerance or rounding allows, or the step is shortened.
"""

from __future__ import annotations

from stickslip.engine.codegen.compiler import call_value, inlined, kernel
from stickslip.engine.codegen.records import numbers_of
from stickslip.engine.contact.contact_equation import constants_of
from stickslip.engine.series.polynomial import moment, multiply, powers_of, total
from stickslip.engine.state.layout import TERMS, Floats, Stop
from stickslip.engine.state.workspace import Run

ALLOWED = 10.0
"""Defect of the contact equation, in units of the local tolerance (1), above which a step is shortened: it is below 1 on smooth
laws."""
ALLOWED_SLOPE = 300.0
"""The same limit for a contact with inertia (1): there the defect is an error of the series' slope, which is larger at the end of
a step, up to 33."""
ROUNDING = 1e-14
"""Rounding of the terms of the contact equation (1), relative to the largest of them."""
HALVINGS = 40
"""Number of halvings of a step (1) before the run ends: 2^-40 of a step is next to nothing."""
NEGLIGIBLE = 1e-9
"""Size of a friction coefficient (1) that may be below zero by rounding."""
TRIFLE = 2.0**-30
"""Share of a step (1) that is so short that nothing happens in it."""
EXTRA = 10.0
"""Factor (1) by which rounding may be larger at one place of a step than at another."""
LOST = 1e-6
"""Share of the terms of the contact equation (1) that is more than rounding in any law: the step does not even begin on the law."""
CLOSE = 0.01
"""Relative accuracy (1) to which the longest step within all guards is found."""


@inlined
def used_up(reach: Floats, powers: Floats) -> float:
    """Return the share of its room (1) that the hardest-pressed guard may have used up at the end of a step.

    `reach` holds the coefficients of the guards' bound, and `powers` the powers of the step's length (in guesses).
    """
    a, b, c, d = reach[1] * powers[1], reach[2] * powers[2], reach[3] * powers[3], reach[4] * powers[4]
    for k in range(5, TERMS - 3, 4):
        a, b = a + reach[k] * powers[k], b + reach[k + 1] * powers[k + 1]
        c, d = c + reach[k + 2] * powers[k + 2], d + reach[k + 3] * powers[k + 3]
    for k in range(TERMS - (TERMS - 5) % 4, TERMS):
        a += reach[k] * powers[k]
    return (a + b) + (c + d)


@kernel
def within_guards(run: Run, length: float) -> float:
    """Return the longest part of a step of the given length (both in guesses) that no guard of the formula ends."""
    powers_of(length, run.powers)
    if not used_up(run.reach, run.powers) > 1.0:
        return length
    low, high = 0.0, length
    for k in range(1, TERMS):  # Each term alone stays below 1 up to `high`, and all of them together up to half of it.
        if run.reach[k] > 0.0:
            high = min(high, run.reach[k] ** (-1.0 / k))
    low = 0.5 * high
    while high - low > CLOSE * high:
        middle = 0.5 * (low + high)
        powers_of(middle, run.powers)
        if used_up(run.reach, run.powers) > 1.0:
            high = middle
        else:
            low = middle
    return low


@inlined
def largest_rate(rate: Floats, rate_end: float) -> float:
    """Return a size of the slip rate (m/s) over a step, from its polynomial on [0, 1] and its value at the end."""
    return max(max(abs(rate[0]), abs(rate_end)), max(abs(rate[1]), max(abs(rate[2]), abs(rate[3]))))


@inlined
def slope_at_end(rate: Floats) -> float:
    """Return p'(1), the slope of the slip rate's polynomial at the end of the step."""
    a, b = rate[1], 2.0 * rate[2]
    for k in range(3, TERMS - 1, 2):
        a, b = a + k * rate[k], b + (k + 1) * rate[k + 1]
    return a + b


@inlined
def load_at_end(run: Run) -> float:
    """Return the load at the end of a step (Pa or N, minus the reference), as seen in the direction of slip.

    run.powers must hold the powers of the step's length.
    """
    if run.counts.degree <= 1:
        return run.load_along_slip[0] + run.powers[1] * run.load_along_slip[1]
    load = run.load_along_slip[0]
    for k in range(1, run.counts.degree + 1):
        load += run.powers[k] * run.load_along_slip[k]
    return load


@inlined
def obeys_contact(run: Run, rate: Floats, length: float, grown: float, rate_end: float) -> bool:
    """Return True if a step of the given length (in guesses) obeys the contact equation at its end, to tolerance or rounding.

    `grown` is the slip in the step (m), `rate_end` the slip rate at its end (m/s); both are unsigned.
    """
    moves = run.counts.has_inertia == 1
    missing, rounding = defect(run, length, grown, rate_end, slope_at_end(rate) if moves else 0.0)
    allowed = ALLOWED_SLOPE if moves else ALLOWED
    return missing <= allowed * run.params.tolerance * largest_rate(rate, rate_end) + rounding + run.state.rounded


@inlined
def is_negative(run: Run) -> bool:
    """Return True if the friction that was evaluated last (in run.value) is below zero: it would drive slip."""
    friction = run.value.mu + run.law[run.counts.piece].offset
    return run.params.reference + run.params.normal * friction < -NEGLIGIBLE * run.params.normal


@inlined
def defect(run: Run, lasting: float, grown: float, rate: float, slope: float) -> tuple[float, float]:
    """Return what the contact equation lacks at a place in a step, and how much of that may be rounding, both as slip rate (m/s).

    Without inertia the equation is Z s + S mu = load; with it the difference is the mass times the acceleration. `lasting` is the
    length of the step up to the place, in guesses; `slope` is the slope of the slip rate there, per that length. A step that
    leaves rest begins by definition without a net force: what the equation lacks at its start it lacks at every place.
    """
    params, value, piece = run.params, run.value, run.counts.piece
    dx, load = run.k.slip + run.k.chi * grown, load_at_end(run)
    call_value(run.law[piece].value_at, constants_of(run, piece), dx, rate, numbers_of(value))
    friction, impedance, normal = value.mu + run.law[piece].offset, params.impedance, params.normal
    missing = load - impedance * rate - normal * friction - run.state.unbalanced
    # Slip rate and slip are rounded too, and the law turns that into an error of friction.
    terms = params.reference + abs(load) + normal * (abs(friction) + abs(value.by_rate * rate) + abs(value.by_slip * dx))
    if run.counts.has_inertia == 0:
        resistance = impedance + normal * max(value.by_rate, 0.0)
        return abs(missing) / resistance, ROUNDING * terms / resistance
    missing -= params.stiffness * grown
    pace = (run.k.speed + run.k.bend * lasting) * lasting / params.inertia
    return abs(missing * pace - slope), ROUNDING * terms * pace


@kernel
def note_rounding(run: Run, length: float) -> None:
    """Measure how much rounding hides the law here: what the contact equation lacks after a step that is next to nothing.

    `length` is that of the step in question, in guesses. Far from the reference of a steep law, rounding may be larger than its
    terms suggest; a shorter step would not cure that.
    """
    powers_of(TRIFLE * length, run.powers)
    multiply(run.jet, run.powers, run.part)
    grown = run.k.speed * TRIFLE * length * moment(run.part, 1)
    grown += run.k.bend * (TRIFLE * length) ** 2 * moment(run.part, 2)
    missing, rounding = defect(run, TRIFLE * length, grown, total(run.part), slope_at_end(run.part))
    run.state.rounded = EXTRA * missing
    if missing * ROUNDING > LOST * rounding:
        run.counts.breach = Stop.OFF_THE_LAW


@kernel
def note_rough_step(run: Run, rate: Floats, rate_end: float) -> None:
    """Count the step if rounding in the law has made it miss the contact equation by more than the tolerance allows."""
    share = run.state.rounded / largest_rate(rate, rate_end)
    if share > (ALLOWED_SLOPE if run.counts.has_inertia == 1 else ALLOWED) * run.params.tolerance:
        run.counts.rough += 1
        run.state.roughest = max(run.state.roughest, share)


@inlined
def begin_verification(run: Run) -> None:
    """Reset what is known of the step at hand: the force that it ignores, and the rounding found in it."""
    run.state.unbalanced = run.state.rounded = 0.0
    if run.k.free == 0.0 and run.counts.is_algebraic == 0:  # An algebraic contact solves its equation at the start too.
        note_unbalanced(run)


@kernel
def note_unbalanced(run: Run) -> None:
    """Note the force (Pa or N) that a step ignores at its start, because it leaves rest without a net force by definition."""
    piece = run.counts.piece
    call_value(run.law[piece].value_at, constants_of(run, piece), run.k.slip, 0.0, numbers_of(run.value))
    balance = run.load_along_slip[0] - run.params.normal * (run.value.mu + run.law[piece].offset)
    run.state.unbalanced = balance - run.k.force
    if run.counts.has_inertia == 0 and abs(run.state.unbalanced) > (LOST + ALLOWED * run.params.tolerance) * run.params.normal:
        run.counts.breach = Stop.OFF_THE_LAW  # A massless contact must balance: no solution begins here.
