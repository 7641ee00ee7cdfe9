"""Take implicit steps, for contacts with a state of their own and for stiff contacts with mass.

Such a contact settles far faster than anything else happens; explicit steps could not be longer than the settling time.
"""

from __future__ import annotations

import math

from stickslip.engine.contact.contact_equation import TIE, load_ahead, static_step, step_at_rest
from stickslip.engine.contact.pressing import own_states
from stickslip.engine.contact.stiffness import contact_at, hanging_rate, states_at_point, states_in_step, turn_states
from stickslip.engine.contact.winding import feel_slip
from stickslip.engine.radau.parts import share_of_step
from stickslip.engine.radau.proof import begin_proof, measured_anywhere, step_proof
from stickslip.engine.radau.stages import (
    defects,
    larger,
    rate_at_load,
    rounding_of_law,
    rounding_of_slip,
    size_of_load,
    solve_stages,
)
from stickslip.engine.series.polynomial import evaluate, fill, first_descent, restrict, total, turn_over
from stickslip.engine.series.radau_nodes import MIDDLE, NODES_OF_STEP, STAGES, TO_POWERS_SUM, interpolate, last_terms
from stickslip.engine.state.layout import STATES, TERMS
from stickslip.engine.state.workspace import Run
from stickslip.foundation.kernels.kernels import kernel
from stickslip.foundation.kernels.memory.addresses import ahead
from stickslip.problem import Stop

ATTEMPTS = 80
"""An implicit step fails after this many attempts (1), each shorter."""
DOUBLINGS = 2000
"""Number of doublings (1) that lead from any rate to any other."""
LONGEST_GROWTH = 4.0
"""Largest growth (as an exponent, 1) of a disturbance over a step."""
NUMBER_ROUNDING = 1e-15
"""Rounding of a number in double precision (1), relative to its terms."""
LOAD_ROUNDING = 1e-14
"""A load below this share (1) of its coefficients is zero: it is rounding at a passage through zero."""
LITTLE = 2.0**-10
"""If forces balance now, the load after this share (1) of the way to go decides."""
BALANCED = 1e-7
"""Forces balance now if the net force is below this share (1) of the one at that place: motion until exact balance is lost in
rounding."""
DEFECT_ROUNDING = 1e-14
"""Rounding of the defect, as a share (1) of the largest slip rate or state: derivatives of polynomials lose two digits."""
ALLOWED = 0.1
"""Share of the defect (1) that counts: it changes its sign at every point, and its effect on slip and state nearly cancels."""
LEAST_TREND = 0.7
"""After a step that had to be shortened, the next one may be longer by a factor of at most its own shortening, but at least this
(1)."""
LAW_ROUNDING = 5.0
"""Allowance for rounding of the law, as a multiple (1) of the largest rounding seen in a few evaluations."""
LARGEST_ROUNDING, PATIENCE = 1e3, 8
"""The error of a step is taken to be rounding if it has not halved in PATIENCE consecutive attempts, each shorter (1). A step with
an error above LARGEST_ROUNDING tolerances (1) is never kept."""
SHORTEST_PROVEN = 0.1
"""A step without a bound is shortened to the part that has one, but at a time to no less than this share (1) of its length."""
UNSEEN_SETTLING = 1e-3
"""The settling time of mass is far shorter than a step if it is below this share (1) of it."""


@kernel
def growth_rate(run: Run, least: float) -> float:
    """Return the growth rate (1/s) of a disturbance of slip rate and state at the start of the step; 0 if none grows.

    Under a law of two states the result is at most twice the rate, and 0 if no disturbance grows faster than `least` (1/s).

    An implicit step much longer than 1 over that rate would follow an unstable solution as if it were stable. With mass the effect
    of slip is left out: such a contact takes explicit steps out of rest, and later the solution itself grows with the disturbance.
    """
    params, value = run.params, run.value
    contact_at(run, run.state.law_slip, run.stage_rate[0], states_at_point(run, 0))
    resistance = params.damping + params.normal * value.by_rate
    if own_states(run) > 1:
        faster = least
        for _ in range(DOUBLINGS):
            if not grows_faster(run, resistance, faster):
                break
            faster *= 2.0
        return faster if faster > least else 0.0
    if run.counts.has_inertia == 0:
        if own_states(run) == 0:
            return max(-run.k.chi * params.normal * value.by_slip / resistance, 0.0)
        by_rate = value.change_by_rate[0]
        return max(value.change_by_state[0] - by_rate * params.normal * value.by_state[0] / resistance, 0.0)
    mass = params.inertia
    if own_states(run) == 0:
        return max(-resistance / mass, 0.0)
    trace = value.change_by_state[0] - resistance / mass
    product = (params.normal * value.by_state[0] * value.change_by_rate[0] - resistance * value.change_by_state[0]) / mass
    root = trace * trace - 4.0 * product
    growth = 0.5 * (trace + math.sqrt(root)) if root > 0.0 else 0.5 * trace
    if growth > 0.0 and trace < 0.0 and root > 0.0:
        growth = -2.0 * product / (math.sqrt(root) - trace)  # This form of the same root has no cancellation.
    return max(growth, 0.0)


@kernel
def grows_faster(run: Run, resistance: float, rate: float) -> bool:
    """Return True if a disturbance of the slip rate and two states grows faster than a rate (1/s), by Hurwitz's criterion.

    run.value describes the law, and `resistance` (Pa s/m or N s/m) is the slope of load against slip rate. The slip rate is
    eliminated first: it may settle faster than the states change by twenty orders of magnitude. Source: Gantmacher 1959, The
    Theory of Matrices, vol. 2, ch. XV.
    """
    params, value = run.params, run.value
    settling = resistance + params.inertia * rate  # 0 or less: the slip rate itself grows that fast
    if settling <= 0.0:
        return True
    push = params.normal / settling
    a = value.change_by_state[0] - rate - value.change_by_rate[0] * push * value.by_state[0]
    b = value.change_by_state[1] - value.change_by_rate[0] * push * value.by_state[1]
    c = value.change_by_state[STATES] - value.change_by_rate[1] * push * value.by_state[0]
    d = value.change_by_state[STATES + 1] - rate - value.change_by_rate[1] * push * value.by_state[1]
    det = a * d - b * c
    if params.inertia == 0.0:
        return a + d >= 0.0 or det <= 0.0
    fast = settling / params.inertia  # the characteristic polynomial x^3 + p x^2 + q x + fast det, in the shifted rate
    held, freed = value.change_by_state[0] + value.change_by_state[STATES + 1] - 2.0 * rate, fast * (a + d)
    minor = (value.change_by_state[0] - rate) * (value.change_by_state[STATES + 1] - rate)
    minor -= value.change_by_state[1] * value.change_by_state[STATES]
    p, q = fast - held, minor - freed
    return p <= 0.0 or det <= 0.0 or p * q <= fast * det


@kernel
def start_of_step(run: Run) -> float:
    """Put slip rate and state at the start of the step into the stages, and return the force (Pa or N) that the step ignores.

    It is 0 except where slip leaves rest, because the net force is zero by definition there; see also `begin_step`.
    """
    state, force = run.state, 0.0
    for n in range(run.counts.states):
        run.stage_state[TERMS * n] = state.state_now[n]
    run.stage_rate[0] = abs(state.rate_now)
    if run.counts.mode == 0:
        run.stage_rate[0] = 0.0
    elif run.counts.leaving_rest != 0 and (run.counts.has_inertia == 1 or step_at_rest(run) == 0.0):
        contact_at(run, state.law_slip, 0.0, state.state_now)
        force = run.load_along_slip[0] - run.params.normal * (run.value.mu + static_step(run, state.state_now))
        if run.counts.has_inertia == 0:
            run.stage_rate[0] = 0.0
    elif run.counts.has_inertia == 0:
        run.stage_rate[0] = rate_at_load(run, run.load_along_slip[0], abs(state.rate_now))
        for rate in (0.0, run.stage_rate[0]):
            contact_at(run, state.law_slip, rate, state.state_now)
            if run.counts.states > 0 and run.params.damping + run.params.normal * run.value.by_rate <= 0.0:
                run.counts.breach = Stop.OFF_THE_LAW  # several slip rates may balance the load, and nothing selects one
    return force


@kernel
def strength_ahead(run: Run) -> float:
    """Put the static strength (minus the reference) over a step at rest into run.jet, from the states at its points.

    Returns its error between the points, or its last terms if they are larger, in units of the tolerance.
    """
    params = run.params
    largest, missed = NUMBER_ROUNDING / params.tolerance * params.reference + abs(run.load_along_slip[0]), 0.0
    for i in range(NODES_OF_STEP):
        contact_at(run, run.state.law_slip, 0.0, states_at_point(run, i))
        run.stage_rate[i] = params.normal * (run.value.mu + static_step(run, run.some_state))
        largest = max(largest, abs(run.stage_rate[i]))
    interpolate(run.stage_rate, run.jet, run.spare)
    for i in range(STAGES):
        contact_at(run, run.state.law_slip, 0.0, states_in_step(run, MIDDLE[i]))
        strength = params.normal * (run.value.mu + static_step(run, run.some_state))
        missed = larger(missed, abs(strength - evaluate(run.jet, MIDDLE[i])))
    fill(run.stage_rate, 0.0)
    return max(missed, last_terms(run.jet)) / (params.tolerance * largest)


@kernel
def error_of(run: Run, force: float, lost: float) -> float:
    """Return the error of the step's polynomials, in units of the tolerance plus the rounding of slip rate and state.

    Two errors are compared: the last terms of the polynomials, as an estimate of the change by further points, and the residual of
    the governing equations between the points. The larger one counts. If it is small enough, a share of the proven bound (`proof`)
    counts too, because the bound also sees features of the law between all these places. Under a law that never sticks, a step past
    a slip rate of zero needs no proof: friction need not be analytic there. `force` (Pa or N) is the force that the step ignores;
    `lost` (m/s) and run.state_noise are the known rounding of the law itself, in the slip rate and in each state.
    """
    params, value, h = run.params, run.value, run.k.speed
    fastest = max(params.rate_floor, run.state.hanging)
    for i in range(NODES_OF_STEP):
        fastest = max(fastest, abs(run.stage_rate[i]))
    # run.value is from the latest evaluation, at or near the end of the step.
    resistance = params.damping + params.normal * value.by_rate + params.inertia / h
    noise = NUMBER_ROUNDING * (size_of_load(run) + rounding_of_slip(run)) / resistance if resistance > 0.0 else 0.0
    for n in range(run.counts.states):
        settles = value.change_by_state[STATES * n + n]
        run.state_noise[n] += noise * abs(value.change_by_rate[n] / settles) if settles != 0.0 else noise
    missed = ALLOWED * max(defects(run, h, force) - DEFECT_ROUNDING * fastest, 0.0)
    error = max(last_terms(run.jet), missed) / (params.tolerance * fastest + noise + lost)
    for n in range(run.counts.states):
        farthest = farthest_state(run, n)
        missed = ALLOWED * max(run.state_error[n] - DEFECT_ROUNDING * farthest, 0.0)
        missed = max(last_terms(ahead(run.state_jet, TERMS * n)), missed)
        error = max(error, missed / (params.tolerance * farthest + run.state_noise[n]))
    if run.counts.mode == 0:
        error = max(error, strength_ahead(run))
    begin_proof(run, h, force)
    proof = step_proof(run)
    proof.rate_allowed, proof.rate_rounding = params.tolerance * fastest + noise + lost, DEFECT_ROUNDING * fastest
    if run.counts.mode == 0:
        held = params.reference + abs(run.load_along_slip[0])
        noise = NUMBER_ROUNDING * params.reference / params.tolerance
        proof.rate_allowed, proof.rate_rounding = params.tolerance * held + noise + lost, 0.0
    for n in range(run.counts.states):
        farthest = farthest_state(run, n)
        proof.state_allowed[n] = params.tolerance * farthest + run.state_noise[n]
        proof.state_rounding[n] = DEFECT_ROUNDING * farthest
    return error if error > 1.0 else proven_error(run, error)


@kernel
def proven_error(run: Run, error: float) -> float:
    """Return the error of a step after its proof, and note the bound on its residual. `step_proof` says what is allowed.

    A step that has no bound is shortened to the part that has, and never kept.
    """
    share = noted_share(run)
    if share < math.inf:
        return max(error, share) if share > 1.0 else error
    proven_to = max(step_proof(run).proven_to, SHORTEST_PROVEN)
    return max(proven_to ** -(STAGES + 1.0), 2.0 * LARGEST_ROUNDING)


@kernel
def noted_share(run: Run) -> float:
    """Return the share of the step (`radau.parts.share_of_step`), and note the bound on its residual: NaN if there is none."""
    proof = step_proof(run)
    share = share_of_step(run)
    run.state.residual = proof.bound + (abs(proof.force) if run.counts.mode != 0 else 0.0)
    if proof.lacks_bound != 0.0 or share == math.inf:
        run.state.residual = math.nan
    return share


@kernel
def prove_anyway(run: Run, error: float) -> None:
    """Note the bound of a step that is kept although its error is this many times what is allowed, and then more is allowed."""
    proof = step_proof(run)
    begin_proof(run, proof.duration, proof.force)
    proof.rate_allowed *= error
    for n in range(run.counts.states):
        proof.state_allowed[n] *= error
    noted_share(run)


@kernel
def note_unproven(run: Run) -> None:
    """Count a step that is kept without a bound, and measure what it misses at places."""
    run.counts.unproven += 1
    run.state.missed = larger(run.state.missed, measured_anywhere(run))


@kernel
def farthest_state(run: Run, n: int) -> float:
    """Return the largest magnitude of state n at the points of the step, or its `state_scale` if that is larger."""
    farthest = run.params.state_scale[n] + 1e-300
    for i in range(NODES_OF_STEP):
        farthest = max(farthest, abs(run.stage_state[TERMS * n + i]))
    return farthest


@kernel
def settle_start(run: Run) -> bool:
    """Return False if a slip rate rises from rest but its polynomial falls at first: the polynomial is not good enough.

    Leading coefficients that are negative only by the rounding of the interpolation are set to zero. The true ones may be zero: the
    slip rate of a contact with mass leaves rest as the square of time, or as a higher power.
    """
    if run.counts.mode == 0 or run.stage_rate[0] != 0.0 or run.stage_rate[1] <= 0.0:
        return True
    fastest = 0.0
    for i in range(1, NODES_OF_STEP):
        fastest = max(fastest, abs(run.stage_rate[i]))
    if fastest <= run.state.hanging:
        return True
    for k in range(1, NODES_OF_STEP):
        if run.jet[k] >= 0.0:
            return True
        if run.jet[k] < -NUMBER_ROUNDING * TO_POWERS_SUM[k] * fastest:
            return False
        run.jet[k] = 0.0
    return True


@kernel
def missed_at_turn(run: Run) -> float:
    """Return what the step before missed of the contact equation (Pa or N), if a contact with mass turns at its end; else 0.

    A mass turns where its slip rate is zero. Where friction follows the load closely the load is zero there, too, up to this miss,
    and its sign means nothing.
    """
    if run.counts.has_inertia == 0 or run.state.rate_now != 0.0 or run.counts.length == 0:
        return 0.0
    missed = run.history[run.counts.length - 1].residual
    return missed if missed < math.inf else 0.0


@kernel
def turn_with_load(run: Run, left: float) -> float:
    """Turn slip of a contact that never rests in the direction of the load; return how long it keeps it (in xi, at most `left`).

    Friction of such a contact is an odd function of the slip rate, zero at rest. Without mass the slip rate always has the sign of
    the load; a contact with mass turns when its slip rate is zero. The sign is never taken from the polynomial of the slip rate:
    near a load of zero the rate may be far smaller than the error of the polynomial.
    """
    part, direction, rounding = run.trial, 1, LOAD_ROUNDING * size_of_load(run)
    restrict(run.load, run.state.xi, left, part)
    part[0] += run.params.reference
    if part[0] < 0.0:
        turn_over(part)
        direction = -1
    first = first_descent(part, run.spare) if part[0] > rounding else 0.0
    if first <= TIE or (first <= LITTLE and part[0] <= missed_at_turn(run)):
        if first <= TIE:
            run.load[0] -= direction * part[0]  # The stages must see the load pass through zero here, too.
        part[0] = 0.0
        first = first_descent(part, run.spare)
        if first <= TIE:
            turn_over(part)
            first, direction = first_descent(part, run.spare), -direction
    if part[0] == 0.0 and math.isinf(first) and size_of_load(run) == run.params.reference:
        return left  # The load is zero throughout.
    run.counts.mode = direction
    return min(first, 1.0) * left if run.counts.has_inertia == 0 and first > TIE else left


@kernel
def turn_with_bristles(run: Run, left: float) -> None:
    """Turn slip of a contact with bristles (its state reverses with slip) in the direction of the net force at zero slip rate.

    Friction at zero slip rate is that of the state alone. If it balances the load, the load a little later decides. Without mass
    the slip rate always has this direction; a contact with mass turns when its slip rate is zero.
    """
    contact_at(run, run.state.law_slip, 0.0, run.state.state_now)
    load_ahead(run, left * LITTLE)
    held = run.params.normal * run.value.mu
    force, later = run.load_along_slip[0] - held, total(run.load_along_slip) - held
    rounding = LOAD_ROUNDING * size_of_load(run) + run.state.hanging * run.params.damping
    if run.counts.has_inertia == 1:
        rounding = max(run.params.tolerance * abs(held), BALANCED * abs(later))
        if abs(force) <= rounding:
            run.load[0] -= run.counts.mode * force  # The stages must see the forces balance here, too.
    if force < -rounding or (force <= rounding and later < -rounding):
        run.counts.mode, force = -run.counts.mode, -force
        turn_states(run, run.state.state_now)
    if run.counts.has_inertia == 0 and force < 0.0:
        run.load[0] -= run.counts.mode * force  # Slip begins at rate zero: its rounding must not be a step in the slip rate.


@kernel
def judged_error(run: Run, force: float, before: float) -> float:
    """Return the error of the step's polynomials like `error_of`, or infinity if they are no solution at all.

    `before` is the error of a longer step. An error that has not halved since may be rounding in the law, which is then measured.
    """
    fill(run.state_noise, 0.0)
    error = error_of(run, force, 0.0)
    if error > 1.0 and error > 0.5 * before:
        lost = rounding_of_law(run, run.k.speed)
        for n in range(run.counts.states):
            run.state_noise[n] *= LAW_ROUNDING
        error = error_of(run, force, LAW_ROUNDING * lost)
    return error if settle_start(run) else math.inf


@kernel
def first_length(run: Run, left: float) -> float:
    """Return the first length (in xi, at most `left`) to try for an implicit step: it must resolve a growing disturbance."""
    speed = abs(run.state.speed)
    trial = min(left, run.state.last_step / speed)
    if 0.5 * left < trial < left:
        trial = 0.5 * left
    load_ahead(run, trial)
    start_of_step(run)
    growth = growth_rate(run, LONGEST_GROWTH / (trial * speed)) if run.counts.mode != 0 else 0.0
    return LONGEST_GROWTH / (growth * speed) if growth * trial * speed > LONGEST_GROWTH else trial


@kernel
def collocate(run: Run, left: float) -> float:
    """Make polynomials of slip rate and state (run.jet, run.state_jet) for an implicit step, and return its length (in xi).

    The step is repeated, shorter, until it is proven and its error is below the tolerance. If the error has not halved in PATIENCE
    consecutive attempts, it is taken to be rounding. The polynomials are NaN if all attempts fail.
    """
    speed = abs(run.state.speed)
    run.state.hanging = hanging_rate(run)
    if run.counts.sticks == 0 and (run.counts.has_inertia == 0 or run.state.rate_now == 0.0):
        if run.counts.reverses != 0:
            turn_with_bristles(run, left)
        else:
            left = turn_with_load(run, left)
    trial = longest = first_length(run, left)
    before, in_vain, solution_over = math.inf, 0, 0.0
    for _ in range(ATTEMPTS):
        force = begin_step(run, trial)
        solved = solve_stages(run, run.k.speed, force, trial / solution_over if solution_over > 0.0 else 0.0)
        solution_over = trial if solved else 0.0
        if solved:
            interpolate(run.stage_rate, run.jet, run.spare)
            for n in range(run.counts.states):
                interpolate(ahead(run.stage_state, TERMS * n), ahead(run.state_jet, TERMS * n), run.spare)
            if run.params.winding != 0.0 and run.counts.mode != 0:
                feel_slip(run, run.jet)
            error = judged_error(run, force, before)
            factor = 0.9 * min(max(error, 1e-12), 1e12) ** (-1.0 / (STAGES + 1.0))
            in_vain = in_vain + 1 if 0.5 * before < error < LARGEST_ROUNDING else 0
            if error <= 1.0 or in_vain >= PATIENCE:
                if error > 1.0 and not settles_unseen(run, error):
                    run.counts.rough += 1
                    run.state.roughest = max(run.state.roughest, error * run.params.tolerance)
                if error > 1.0:
                    prove_anyway(run, error)
                # Where this step had to shrink, the next one probably has to shrink as well.
                change = max(trial / longest, LEAST_TREND) if before < math.inf else 5.0
                if math.isnan(run.state.residual):
                    note_unproven(run)
                run.state.last_step = speed * (trial * min(factor, change) if error <= 1.0 else longest)
                return trial
            before = error
            trial *= max(min(factor, 0.8), 0.1)
        else:
            before = math.inf
            trial *= 0.25
    fill(run.jet, math.nan)
    for n in range(STATES):
        fill(ahead(run.state_jet, TERMS * n), math.nan)
    return trial


@kernel
def settles_unseen(run: Run, error: float) -> bool:
    """Return True if the error of a step (in units of the tolerance) is only the lag of mass at its start.

    When the load bends, the slip rate of a mass lags behind by M v' over the slope of load against slip rate, and settles to this
    lag in a time far shorter than the step. No polynomial of the step follows that, however short the step. It is no rounding, and
    the bound contains it.
    """
    params, fastest = run.params, 0.0
    resistance = params.damping + params.normal * run.value.by_rate
    if run.counts.mode == 0 or resistance <= 0.0 or params.inertia > UNSEEN_SETTLING * run.k.speed * resistance:
        return False
    for i in range(NODES_OF_STEP):
        fastest = max(fastest, abs(run.stage_rate[i]))
    return error * params.tolerance * fastest <= params.inertia / run.k.speed * abs(run.jet[1]) / resistance


@kernel
def begin_step(run: Run, trial: float) -> float:
    """Prepare the load and the start of an implicit step of length `trial` (in xi); return the force (Pa or N) that it ignores."""
    load_ahead(run, trial)
    is_odd = run.counts.sticks == 0 and run.counts.reverses == 0
    if is_odd and abs(run.load_along_slip[0] + run.params.reference) <= LOAD_ROUNDING * size_of_load(run):
        run.load_along_slip[0] = -run.params.reference  # The load passes through zero here: slip begins at rate zero.
    run.k.speed, run.k.bend = run.state.speed * trial, 0.0
    run.k.chi = run.counts.mode if run.params.counts_net == 1.0 else 1.0
    force = start_of_step(run)
    against = run.load_along_slip[0] + run.params.reference
    return against if is_odd and -missed_at_turn(run) <= against < 0.0 else force
