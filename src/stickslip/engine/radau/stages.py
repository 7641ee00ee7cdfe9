"""Solve for the stages of an implicit step: slip rate and states at Radau's points, by Newton's method.

    M v' = load - K q - Z v - S mu(u, v, w),    u' = v,    w' = F(u, v, w)

A contact without mass (M = 0) and one without a state obey the same equations with terms left out. v >= 0 is the magnitude of the
slip rate, w the state or the two states, and q the slip since the start of the step. A step lasts h seconds; places in it run from
0 to 1.
"""

from __future__ import annotations

import math
from typing import Any

from stickslip.engine.contact.pressing import own_states, press_stages
from stickslip.engine.contact.stiffness import contact_at, states_at_point
from stickslip.engine.series.polynomial import evaluate, fill
from stickslip.engine.series.radau_nodes import (
    DERIVATIVE,
    DERIVATIVE_IN_MIDDLE,
    INTEGRAL,
    INTEGRAL_TO_MIDDLE,
    INTEGRAL_TWICE,
    MIDDLE,
    NODES_OF_STEP,
    POINT,
    STAGES,
    VALUE_IN_MIDDLE,
)
from stickslip.engine.state.layout import STATES, TERMS, Between, Floats
from stickslip.engine.state.workspace import Run
from stickslip.foundation.kernels.kernels import kernel
from stickslip.foundation.kernels.memory.addresses import ahead
from stickslip.foundation.kernels.memory.pointers import record_at

NUDGE = 1e-15
"""A relative change (1) of 4 ulp or more, which counts as rounding."""
ITERATIONS = 40
"""After this many Newton iterations (1) the step counts as unsolved."""
NEWTON_ROUNDING = 1e-15
"""Rounding of the load in Newton's method, relative to its terms (1)."""
WIDTH_OF_ROW = (1 + STATES) * STAGES + 1
"""Length of a row of Newton's equations (1), with the right-hand side."""
between_at: Any = record_at(Between)
"""Function for compiled code that returns the `Between` at a pointer."""


@kernel
def rate_at_load(run: Run, load: float, guess: float) -> float:
    """Return the slip rate (m/s) of a massless contact with its present state under a load (minus the reference).

    Friction of such a law does not fall with the rate, so the solution is unique.
    """
    damping, normal = run.params.damping, run.params.normal
    low, high = 0.0, (load + run.params.reference) / damping
    if run.counts.reverses != 0:  # friction at rest is that of the state alone
        contact_at(run, run.state.law_slip, 0.0, run.state.state_now)
        high = (load - normal * run.value.mu) / damping
    if high <= 0.0:
        return 0.0
    s = guess if low < guess < high else 0.5 * high
    for _ in range(200):
        contact_at(run, run.state.law_slip, s, run.state.state_now)
        error = damping * s + normal * run.value.mu - load
        if error > 0.0:
            high = s
        else:
            low = s
        step = s - error / (damping + normal * run.value.by_rate)
        if not low < step < high and step != s:  # where Newton has converged, s itself bounds the interval
            step = math.sqrt(low * high) if low > 0.0 else 1e-3 * high
        if abs(step - s) <= 1e-15 * abs(s) or high <= low:
            return step
        s = step
    return s


@kernel
def assemble(run: Run, h: float, force: float) -> None:
    """Write Newton's equations at the present stages into run.matrix, for a step of h seconds.

    `force` (Pa or N) is the part of the load that the step ignores.
    """
    params, v, m = run.params, run.stage_rate, run.matrix
    moving, states = run.counts.mode != 0, own_states(run)
    mass, chi = params.inertia / h, run.k.chi * h
    size = STAGES * (1 + states)
    for i in range(1, NODES_OF_STEP):
        row, walked, wound, change = ahead(m, WIDTH_OF_ROW * (i - 1)), 0.0, 0.0, 0.0
        for j in range(NODES_OF_STEP):
            walked += INTEGRAL[i, j] * v[j]
            wound += INTEGRAL_TWICE[i, j] * v[j]
            change += DERIVATIVE[i, j] * v[j]
        contact_at(run, run.state.law_slip + chi * walked, v[i], states_at_point(run, i))
        value = run.value
        resisted = params.damping * v[i] + params.normal * value.mu + params.stiffness * h * walked
        by_walk, by_wind = params.stiffness * h + params.normal * value.by_slip * chi, params.winding * h * h
        for j in range(1, NODES_OF_STEP):
            row[j - 1] = mass * DERIVATIVE[i, j] + by_walk * INTEGRAL[i, j] if moving else 0.0
            row[j - 1] += by_wind * INTEGRAL_TWICE[i, j] if moving else 0.0
        row[i - 1] += params.damping + params.normal * value.by_rate if moving else 1.0
        resisted += by_wind * wound
        row[size] = evaluate(run.load_along_slip, POINT[i]) - force - resisted - mass * change if moving else 0.0
        for n in range(states):
            assemble_state(run, h, i, n)
            own = ahead(row, STAGES * (1 + n))
            for j in range(STAGES):
                own[j] = 0.0
            own[i - 1] = params.normal * value.by_state[n] if moving else 0.0


@kernel
def assemble_state(run: Run, h: float, i: int, n: int) -> None:
    """Write Newton's equation of state n at point i into run.matrix; run.value belongs to that point."""
    value, moving, chi = run.value, run.counts.mode != 0, run.k.chi * h
    w, row, evolved = ahead(run.stage_state, TERMS * n), ahead(run.matrix, WIDTH_OF_ROW * (STAGES * (1 + n) + i - 1)), 0.0
    for j in range(NODES_OF_STEP):
        evolved += DERIVATIVE[i, j] * w[j]
    for j in range(1, NODES_OF_STEP):
        row[j - 1] = -h * value.change_by_slip[n] * chi * INTEGRAL[i, j] if moving else 0.0
    row[i - 1] -= h * value.change_by_rate[n]
    for other in range(own_states(run)):
        own = ahead(row, STAGES * (1 + other))
        for j in range(1, NODES_OF_STEP):
            own[j - 1] = DERIVATIVE[i, j] if other == n else 0.0
        own[i - 1] -= h * value.change_by_state[STATES * n + other]
    row[STAGES * (1 + own_states(run))] = h * value.change[n] - evolved


@kernel
def eliminate(m: Floats, size: int) -> bool:
    """Solve `size` linear equations in the rows of m; the solution replaces the last column. Return False if they are singular."""
    for i in range(size):
        row, largest = ahead(m, WIDTH_OF_ROW * i), 0.0
        for j in range(size):
            largest = max(largest, abs(row[j]))
        if not 0.0 < largest < math.inf:
            return False
        for j in range(size + 1):
            row[j] /= largest
    for k in range(size):
        pivot = k
        for i in range(k + 1, size):
            if abs(m[WIDTH_OF_ROW * i + k]) > abs(m[WIDTH_OF_ROW * pivot + k]):
                pivot = i
        if m[WIDTH_OF_ROW * pivot + k] == 0.0:
            return False
        for j in range(k, size + 1):
            m[WIDTH_OF_ROW * k + j], m[WIDTH_OF_ROW * pivot + j] = m[WIDTH_OF_ROW * pivot + j], m[WIDTH_OF_ROW * k + j]
        for i in range(k + 1, size):
            factor = m[WIDTH_OF_ROW * i + k] / m[WIDTH_OF_ROW * k + k]
            if factor != 0.0:
                for j in range(k + 1, size + 1):
                    m[WIDTH_OF_ROW * i + j] -= factor * m[WIDTH_OF_ROW * k + j]
    for i in range(size - 1, -1, -1):
        for j in range(i + 1, size):
            m[WIDTH_OF_ROW * i + size] -= m[WIDTH_OF_ROW * i + j] * m[WIDTH_OF_ROW * j + size]
        m[WIDTH_OF_ROW * i + size] /= m[WIDTH_OF_ROW * i + i]
    return True


@kernel
def size_of_load(run: Run) -> float:
    """Return the size (Pa or N) of the terms that make up the load on the present piece: the load is rounded relative to it."""
    size = run.params.reference
    for k in range(TERMS):
        size += abs(run.load[k])
    return size


@kernel
def rounding_of_slip(run: Run) -> float:
    """Return the change of friction (Pa or N) per relative change of the law's slip, from the slope in run.value.

    If a contact settles against a steep barrier, its last slips are closer together than floats.
    """
    return run.params.normal * abs(run.value.by_slip * (run.state.law_slip + run.law[run.counts.piece].slip_shift))


@kernel
def correct(run: Run, size: int, rounding: float) -> float:
    """Add the solution of Newton's equations to the stages; return the size of the change, relative to the stages.

    `rounding` is the rounding of the load (Pa or N). A change of the slip rate counts as none if the rounding of load or slip can
    explain it.
    """
    v, m = run.stage_rate, run.matrix
    fastest, moved, evolved = run.state.hanging + 1e-300, 0.0, 0.0
    for i in range(1, NODES_OF_STEP):
        step = m[WIDTH_OF_ROW * (i - 1) + size]
        v[i] += step
        moved, fastest = max(moved, abs(step)), max(fastest, abs(v[i]))
        if not math.isfinite(v[i]):
            return math.inf
    for n in range(own_states(run)):
        w, farthest, changed = ahead(run.stage_state, TERMS * n), run.params.state_scale[n] + 1e-300, 0.0
        for i in range(1, NODES_OF_STEP):
            step = m[WIDTH_OF_ROW * (STAGES * (1 + n) + i - 1) + size]
            w[i] += step
            changed, farthest = max(changed, abs(step)), max(farthest, abs(w[i]))
            if not math.isfinite(w[i]):
                return math.inf
        evolved = max(evolved, changed / farthest)
    if rounding > 0.0:
        # run.value still belongs to the last stage.
        rounding += NEWTON_ROUNDING * rounding_of_slip(run)
        moved = max(moved - rounding / abs(run.params.damping + run.params.normal * run.value.by_rate), 0.0)
    return max(moved / fastest, evolved)


@kernel
def solve_stages(run: Run, h: float, force: float, share: float) -> bool:
    """Find slip rates and states at the points of a step of h seconds, from the values at its start; return False on failure.

    Newton's method begins with the values at the start or, if share > 0, with the polynomials of a longer step; this step is the
    given share of the longer one. On success `look_between` has been called.
    """
    for i in range(1, NODES_OF_STEP):
        run.stage_rate[i] = run.stage_rate[0]
        if share > 0.0 and run.counts.mode != 0:  # At rest run.jet holds the strength.
            run.stage_rate[i] = evaluate(run.jet, share * POINT[i])
    for n in range(own_states(run)):
        w = ahead(run.stage_state, TERMS * n)
        for i in range(1, NODES_OF_STEP):
            w[i] = evaluate(ahead(run.state_jet, TERMS * n), share * POINT[i]) if share > 0.0 else w[0]
    if run.counts.given > 0:
        press_stages(run, h)
    size = STAGES * (1 + own_states(run))
    before, rounding = math.inf, NEWTON_ROUNDING * size_of_load(run) if run.counts.has_inertia == 0 else 0.0
    for _ in range(ITERATIONS):
        assemble(run, h, force)
        if not eliminate(run.matrix, size):
            return False
        change = correct(run, size, rounding)
        # Newton's method squares its error: the next change would be lost in the tolerance, or only rounding is left.
        if change <= 1e-2 * math.sqrt(run.params.tolerance) or 0.1 * before < change < 1e-9:
            look_between(run)
            return True
        if math.isinf(change):
            return False
        before = change
    return False


@kernel
def between(run: Run, i: int) -> Between:
    """Return the record of the i-th place of `look_between`: it lies in run.matrix, which is free between Newton's iterations."""
    return between_at(ahead(run.matrix, WIDTH_OF_ROW * i))


@kernel
def look_between(run: Run) -> None:
    """Put slip rate and states halfway between the points, with derivatives and integral, into the records `between`."""
    v = run.stage_rate
    for i in range(STAGES):
        rate, acceleration, walked = 0.0, 0.0, 0.0
        for j in range(NODES_OF_STEP):
            rate += VALUE_IN_MIDDLE[i, j] * v[j]
            acceleration += DERIVATIVE_IN_MIDDLE[i, j] * v[j]
            walked += INTEGRAL_TO_MIDDLE[i, j] * v[j]
        row = between(run, i)
        row.rate, row.acceleration, row.walked = rate, acceleration, walked
        for n in range(run.counts.states):
            w, state, evolved = ahead(run.stage_state, TERMS * n), 0.0, 0.0
            for j in range(NODES_OF_STEP):
                state += VALUE_IN_MIDDLE[i, j] * w[j]
                evolved += DERIVATIVE_IN_MIDDLE[i, j] * w[j]
            row.state[n], row.evolved[n] = state, evolved


@kernel
def contact_between(run: Run, i: int, h: float, nudge: float) -> None:
    """Evaluate the contact at the i-th place of `look_between`, with all arguments larger by a relative nudge (1)."""
    row = between(run, i)
    slip = run.state.law_slip + run.k.chi * h * row.walked
    for n in range(run.counts.states):
        run.some_state[n] = row.state[n] * (1.0 + nudge)
    contact_at(run, slip * (1.0 + nudge), row.rate * (1.0 + nudge), run.some_state)


@kernel
def yielding(run: Run, h: float) -> float:
    """Return the error of slip rate per residual load over a step of h seconds.

    The residual of a derivative changes its sign at every point, so that it adds up over at most 1 / STAGES of the step.
    """
    resistance = abs(run.params.damping + run.params.normal * run.value.by_rate) + STAGES * run.params.inertia / h
    return 1.0 / resistance if run.counts.mode != 0 else 0.0


@kernel
def yielding_of_state(run: Run, h: float, n: int) -> float:
    """Return the error of state n per residual of its rate of change (s) over a step of h seconds, like `yielding`."""
    return h / (STAGES + h * abs(run.value.change_by_state[STATES * n + n]))


@kernel
def defects(run: Run, h: float, force: float) -> float:
    """Return the residual of the equations halfway between the points, for the polynomials through the stages.

    The result is in units of slip rate; the residual of each state is left in run.state_error, in units of the state. The residual
    load (Pa or N) of the contact equation in slip is left in run.state.residual.
    """
    params, value, missed, lacking = run.params, run.value, 0.0, 0.0
    fill(run.state_error, 0.0)
    for i in range(STAGES):
        middle = between(run, i)
        contact_between(run, i, h, 0.0)
        resisted = params.damping * middle.rate + params.normal * value.mu + params.stiffness * h * middle.walked
        missing = evaluate(run.load_along_slip, MIDDLE[i]) - force - resisted - params.inertia / h * middle.acceleration
        missed = larger(missed, abs(missing) * yielding(run, h))
        lacking = max(lacking, abs(missing))
        for n in range(own_states(run)):
            missing = abs(value.change[n] - middle.evolved[n] / h) * yielding_of_state(run, h, n)
            run.state_error[n] = larger(run.state_error[n], missing)
    run.state.residual = lacking + abs(force) if run.counts.mode != 0 else 0.0
    return missed


@kernel
def rounding_of_law(run: Run, h: float) -> float:
    """Return the error of the slip rate (m/s) through rounding in the law's formulas, by nudging the arguments by a few ulp.

    The error of each state is left in run.state_noise. A formula may lose any number of digits; only an evaluation shows how many.
    """
    value, lost = run.value, 0.0
    fill(run.state_noise, 0.0)
    change, by_change = run.state_error, ahead(run.state_error, STATES)
    for i in range(STAGES):
        contact_between(run, i, h, 0.0)
        friction, by_load = value.mu, yielding(run, h)
        for n in range(run.counts.states):
            change[n], by_change[n] = value.change[n], yielding_of_state(run, h, n)
        for nudge in (-NUDGE, NUDGE):
            contact_between(run, i, h, nudge)
            lost = max(lost, abs(value.mu - friction) * run.params.normal * by_load)
            for n in range(run.counts.states):
                run.state_noise[n] = max(run.state_noise[n], abs(value.change[n] - change[n]) * by_change[n])
    return lost


@kernel
def larger(x: float, y: float) -> float:
    """Return the larger of two numbers, or infinity if the second is not a number."""
    return math.inf if math.isnan(y) else max(x, y)
