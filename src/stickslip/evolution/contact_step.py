"""One step of the contact on a piece of load: stick, or slip, up to whatever comes first.

Ties have a written order: what arrives with the load (an echo, a change of loading) is met before what the contact does by
itself, so an event within TIE of the end of a piece is left to the start of the next one.
"""

from __future__ import annotations

import math

from stickslip.evolution.compiled import call_jet, call_value, kernel
from stickslip.evolution.layout import (
    ARRIVING,
    AT_FOLD,
    BEND,
    BRANCH,
    CAUSE,
    COUNTS_NET,
    EDGE,
    FOLD,
    HAS_INERTIA,
    IMPEDANCE,
    INERTIA,
    IS_ALGEBRAIC,
    IS_BLOCK,
    JUMP,
    K_BEND,
    K_CHI,
    K_FORCE,
    K_FREE,
    K_IMPEDANCE,
    K_INERTIA,
    K_NORMAL,
    K_OFFSET,
    K_RATE,
    K_SLIP,
    K_SPEED,
    K_STIFFNESS,
    LARGEST_DROP,
    LAST_STEP,
    LAW_SLIP,
    LENGTH,
    MODE,
    MOVED,
    NO_CAUSE,
    NORMAL,
    PIECE,
    RATE_NOW,
    REFERENCE,
    ROW,
    SLIP_NOW,
    RELATIVE_JUMP,
    SMALLEST_JUMP,
    SPEED,
    STALLED,
    STATIC_EXCESS,
    STICK_TO,
    STIFFNESS,
    TERMS,
    THETA_FROM,
    THETA_TO,
    TOLERANCE,
    XI,
    Floats,
    Integers,
    Setup,
    Store,
    Work,
)
from stickslip.evolution.polynomial import NONE, evaluate, first_descent, restrict, scale

TIE = 1e-13
SHORTEST_FOLD = 1e-9
LONGEST_GUESS = 2.0


@kernel
def friction_at(setup: Setup, count: Integers, law_slip: float, rate: float, out: Floats) -> None:
    """out: S (mu - mu_reference), and its derivatives with respect to rate and slip, times S."""
    piece = count[PIECE]
    call_value(setup.value_at[piece], setup.constants[piece].ctypes.data, law_slip + setup.slip_shift[piece], rate, out.ctypes.data)
    out[0] = setup.par[NORMAL] * (out[0] + setup.offset[piece])
    out[1] *= setup.par[NORMAL]
    out[2] *= setup.par[NORMAL]


@kernel
def rest_limit(setup: Setup, state: Floats, count: Integers, work: Work) -> float:
    """Load (minus the reference) at which the selection rule leaves rest forwards: the static strength, or below it."""
    friction_at(setup, count, state[LAW_SLIP], 0.0, work.value)
    return work.value[0] + setup.par[NORMAL] * setup.par[STATIC_EXCESS] + setup.par[STICK_TO]


@kernel
def towards(setup: Setup, load: float, direction: int) -> float:
    """The load as seen in the direction of slip, minus the reference."""
    return load if direction > 0 else -load - 2.0 * setup.par[REFERENCE]


@kernel
def rate_on_branch(setup: Setup, state: Floats, count: Integers, work: Work, load: float, guess: float) -> float:
    """The slip rate on the current branch that solves g(s) = load: Newton's method kept inside the branch."""
    branch = count[BRANCH]
    low, high = setup.rate_from[branch], setup.rate_to[branch]
    if load <= setup.excess_from[branch]:
        return low
    if load >= setup.excess_to[branch]:
        return high
    high = min(high, (load + setup.par[LARGEST_DROP]) / setup.par[IMPEDANCE] * (1.0 + 1e-12))
    s = guess if low < guess < high else 0.5 * (low + high)
    for _ in range(200):
        friction_at(setup, count, state[LAW_SLIP], s, work.value)
        error = setup.par[IMPEDANCE] * s + work.value[0] - load
        if error > 0.0:
            high = s
        elif error < 0.0:
            low = s
        else:
            return s
        slope = setup.par[IMPEDANCE] + work.value[1]
        step = s - error / slope if slope > 0.0 else 0.5 * (low + high)
        if not low < step < high:
            step = 0.5 * (low + high)
        if abs(step - s) <= 1e-16 * abs(s) or step == low or step == high:
            return step
        s = step
    return s


@kernel
def choose_branch(setup: Setup, count: Integers, load: float) -> None:
    """Leave rest: the first branch that the rule allows at this load."""
    for branch in range(len(setup.keep_to)):
        if load <= setup.keep_to[branch]:
            count[BRANCH] = branch
            return


@kernel
def leave_branch(setup: Setup, count: Integers, load: float) -> None:
    """The branch ends at this load: go to the nearest allowed one in the direction of the load, or to rest."""
    branch = count[BRANCH]
    if load >= setup.keep_to[branch]:
        for other in range(branch + 1, len(setup.keep_to)):
            if load <= setup.keep_to[other]:
                count[BRANCH] = other
                return
    for other in range(branch - 1, -1, -1):
        if setup.keep_from[other] <= load:
            count[BRANCH] = other
            return
    count[MODE] = 0


@kernel
def note_jump(setup: Setup, state: Floats, count: Integers, rate: float, cause: int) -> None:
    """Mark a shock if the slip rate is about to jump."""
    before = state[RATE_NOW]
    size = abs(rate - before)
    if size > setup.par[SMALLEST_JUMP] and size > setup.par[RELATIVE_JUMP] * max(abs(rate), abs(before)):
        count[CAUSE] = cause
        count[JUMP] = 1


@kernel
def arrive(setup: Setup, state: Floats, count: Integers, work: Work) -> None:
    """A new piece of load begins: does the contact stick or slip under it, which way, on which branch?"""
    load = work.load[0]
    limit = rest_limit(setup, state, count, work)
    mode = count[MODE]
    if mode != 0 and count[IS_ALGEBRAIC] == 1:
        seen, branch = towards(setup, load, mode), count[BRANCH]
        if not setup.keep_from[branch] <= seen <= setup.keep_to[branch]:
            leave_branch(setup, count, seen)
    elif mode != 0 and count[HAS_INERTIA] == 0:
        friction_at(setup, count, state[LAW_SLIP], 0.0, work.value)
        if towards(setup, load, mode) < work.value[0]:
            count[MODE] = 0
    if count[MODE] == 0 and count[EDGE] == 0:
        for direction in (1, -1):
            if towards(setup, load, direction) > limit:
                count[MODE] = direction
                choose_branch(setup, count, towards(setup, load, direction))
    if count[MODE] == 0:
        note_jump(setup, state, count, 0.0, count[ARRIVING])
        state[RATE_NOW] = 0.0


@kernel
def theta_at(state: Floats, xi: float) -> float:
    return state[THETA_TO] if xi >= 1.0 else state[THETA_FROM] + xi * (state[SPEED] + xi * state[BEND])


@kernel
def record(state: Floats, count: Integers, work: Work, store: Store, xi_to: float) -> None:
    """Append the step to the history: work.local and work.rate hold its load and rate on [0, 1]."""
    xi = state[XI]
    width = xi_to - xi
    theta_from, theta_to = theta_at(state, xi), theta_at(state, xi_to)
    if theta_to > theta_from:
        n = count[LENGTH]
        store.row[n], store.theta_from[n], store.theta_to[n] = count[ROW], theta_from, theta_to
        store.speed[n] = (state[SPEED] + 2.0 * state[BEND] * xi) * width
        store.bend[n] = state[BEND] * width * width
        store.mode[n], store.piece[n] = count[MODE], count[PIECE]
        store.jump[n], store.cause[n] = count[JUMP], count[CAUSE]
        store.slip[n], store.law_slip[n] = state[SLIP_NOW], state[LAW_SLIP]
        store.load[n] = work.local
        store.rate[n] = work.rate
        count[LENGTH] = n + 1
        count[JUMP] = count[CAUSE] = count[STALLED] = 0
    else:
        count[STALLED] += 1
    state[XI] = xi_to


@kernel
def stick(setup: Setup, state: Floats, count: Integers, work: Work, store: Store, xi_to: float) -> None:
    """Stay at rest until the load leaves what friction can hold."""
    width = xi_to - state[XI]
    limit = rest_limit(setup, state, count, work)
    restrict(work.load, state[XI], width, work.local)
    onset, direction = NONE, 0
    for way in (1, -1):
        for k in range(TERMS):
            work.gap[k] = -way * work.local[k]
        work.gap[0] = 0.0 if count[EDGE] == way else limit - towards(setup, work.local[0], way)
        first = first_descent(work.gap, 1.0)
        if first < onset:
            onset, direction = first, way
    slips = onset <= 1.0 - TIE
    end = min(onset, 1.0) if slips else 1.0
    scale(work.local, end)
    work.rate[:] = 0.0
    record(state, count, work, store, state[XI] + end * width if slips else xi_to)
    count[EDGE] = 0
    if slips:
        count[MODE], count[EDGE] = direction, direction
        choose_branch(setup, count, limit)


@kernel
def first_guess(state: Floats, left: float) -> float:
    """Length (in xi) in whose units the next series is computed: near the step that will be taken, so that nothing overflows."""
    speed = abs(state[SPEED] + 2.0 * state[BEND] * state[XI])
    return min(left, LONGEST_GUESS * state[LAST_STEP] / speed) if speed > 0.0 else left


@kernel
def series(setup: Setup, state: Floats, count: Integers, work: Work, guess: float) -> None:
    """Taylor series of load (work.local) and slip rate's magnitude (work.jet) from the present state, in units of `guess`."""
    direction, piece, par, k = count[MODE], count[PIECE], setup.par, work.k
    restrict(work.load, state[XI], guess, work.local)
    edge = count[EDGE] != 0
    for i in range(TERMS):
        work.gap[i] = direction * work.local[i]
    work.gap[0] = towards(setup, work.local[0], direction)
    k[K_IMPEDANCE], k[K_NORMAL], k[K_INERTIA], k[K_STIFFNESS] = par[IMPEDANCE], par[NORMAL], par[INERTIA], par[STIFFNESS]
    k[K_CHI] = direction if par[COUNTS_NET] == 1.0 else 1.0
    k[K_SPEED] = (state[SPEED] + 2.0 * state[BEND] * state[XI]) * guess
    k[K_BEND] = 2.0 * state[BEND] * guess * guess
    k[K_SLIP], k[K_OFFSET] = state[LAW_SLIP] + setup.slip_shift[piece], setup.offset[piece]
    k[K_RATE] = abs(state[RATE_NOW])
    k[K_FREE] = 0.0 if edge else 1.0
    k[K_FORCE] = par[NORMAL] * par[STATIC_EXCESS] if edge else 0.0
    if count[IS_ALGEBRAIC] == 1:
        k[K_RATE] = rate_on_branch(setup, state, count, work, work.gap[0], abs(state[RATE_NOW]))
    call_jet(setup.jet_at[piece], setup.constants[piece].ctypes.data, k.ctypes.data, work.gap.ctypes.data, work.jet.ctypes.data)


@kernel
def usable_length(jet: Floats, tolerance: float) -> float:
    """Longest step (in units of the guess) whose last two terms stay below the tolerance, relative to the rate over the step."""
    size = max(abs(jet[0]), 0.5 * abs(jet[1]), 0.25 * abs(jet[2]), 0.125 * abs(jet[3]))
    n = TERMS - 1
    last, before = abs(jet[n]), abs(jet[n - 1])
    length = NONE
    if last > 0.0:
        length = math.exp(math.log(tolerance * size / last) / n)
    if before > 0.0:
        length = min(length, math.exp(math.log(tolerance * size / before) / (n - 1)))
    return length


@kernel
def slip_grown(work: Work, end: float) -> float:
    """Integral of work.rate over the step, up to eta = end; k[K_SPEED] and k[K_BEND] are dtheta/deta = SPEED + BEND eta."""
    total = 0.0
    for k in range(TERMS - 1, -1, -1):
        total = total * end + (work.k[K_SPEED] * work.rate[k] + (work.k[K_BEND] * work.rate[k - 1] if k > 0 else 0.0)) / (k + 1)
    return total * end


@kernel
def knot_crossing(setup: Setup, state: Floats, count: Integers, work: Work) -> float:
    """Where on [0, 1] the slip reaches the next knot of the law; NONE if it does not. Slip is monotone within a step."""
    grown = work.k[K_CHI] * slip_grown(work, 1.0)
    forwards = grown > 0.0
    next_knot = count[PIECE] if forwards else count[PIECE] - 1
    if next_knot < 0 or next_knot >= len(setup.knots):
        return NONE
    distance = setup.knots[next_knot] - state[LAW_SLIP]
    if abs(distance) >= abs(grown):
        return NONE
    low, high = 0.0, 1.0
    for _ in range(60):
        middle = 0.5 * (low + high)
        if abs(work.k[K_CHI] * slip_grown(work, middle)) < abs(distance):
            low = middle
        else:
            high = middle
    return high


@kernel
def branch_exit(setup: Setup, count: Integers, work: Work, width: float) -> float:
    """Where (in units of xi from here, up to width) the load leaves what the rule keeps the branch for; NONE if it stays."""
    branch = count[BRANCH]
    first = NONE
    for upper in (0, 1):
        bound = setup.keep_to[branch] if upper == 1 else setup.keep_from[branch]
        if math.isinf(bound):
            continue
        sign = -1.0 if upper == 1 else 1.0
        for k in range(TERMS):
            work.gap[k] = sign * count[MODE] * work.local[k]
        work.gap[0] = sign * (towards(setup, work.local[0], count[MODE]) - bound)
        if count[EDGE] != 0 and work.gap[0] < 0.0:
            work.gap[0] = 0.0
        first = min(first, first_descent(work.gap, 1.0))
    return first * width


@kernel
def approach_fold(state: Floats, count: Integers, work: Work, width: float) -> float:
    """Prepare the way to a fold at distance `width`: there s goes as the square root of the time left, so that root becomes the variable.

    Returns 0 once the piece is changed, or the part of the way that must be walked first (where the load is not well enough
    described by half the terms that squaring its variable leaves).
    """
    part = work.gap
    restrict(work.load, state[XI] + width, -width, part)  # from the fold backwards, z on [0, 1]
    total, tail = 0.0, 0.0
    share = 1.0
    for _ in range(60):
        total, tail, power = 0.0, 0.0, 1.0
        for k in range(TERMS):
            total += abs(part[k]) * power
            if 2 * k > TERMS - 1:
                tail += abs(part[k]) * power
            power *= share
        if tail <= 1e-16 * total:
            break
        share *= 0.5
    if share < 1.0:
        return (1.0 - share) * width
    work.kept_load[:] = work.load
    work.kept[:] = state
    work.kept[XI] = state[XI] + width
    length = theta_at(state, state[XI] + width) - theta_at(state, state[XI])
    work.local[:] = 0.0
    for k in range((TERMS + 1) // 2):
        work.local[2 * k] = part[k]
    restrict(work.local, 1.0, -1.0, work.load)
    state[THETA_FROM], state[THETA_TO] = theta_at(state, state[XI]), theta_at(state, state[XI] + width)
    state[SPEED], state[BEND], state[XI] = 2.0 * length, -length, 0.0
    count[AT_FOLD] = 1
    return 0.0


@kernel
def way_to_exit(setup: Setup, state: Floats, count: Integers, work: Work, left: float) -> float:
    """Distance (in xi, at most `left`) at which an algebraic contact leaves its branch; NONE if it stays or ends at a fold ahead."""
    restrict(work.load, state[XI], left, work.local)
    way = branch_exit(setup, count, work, left)
    return way if way < left * (1.0 - TIE) else NONE


@kernel
def ends_at_fold(setup: Setup, state: Floats, count: Integers, work: Work, way: float) -> bool:
    """Whether the branch ends there because g turns, and not because the rule prefers another solution."""
    branch = count[BRANCH]
    at = towards(setup, evaluate(work.load, state[XI] + way), count[MODE])
    if abs(at - setup.keep_to[branch]) < abs(at - setup.keep_from[branch]):
        return setup.keep_to[branch] == setup.excess_to[branch]
    return setup.rate_from[branch] > 0.0 and setup.keep_from[branch] == setup.excess_from[branch]


@kernel
def slip(setup: Setup, state: Floats, count: Integers, work: Work, store: Store, xi_to: float) -> None:
    """Slip for one Taylor step, or up to what ends it: arrest, the end of a branch, a knot of the law, the end of the piece."""
    target, leaves = xi_to, False
    if count[IS_ALGEBRAIC] == 1 and count[AT_FOLD] == 0:
        way = way_to_exit(setup, state, count, work, xi_to - state[XI])
        if way == 0.0:
            end_branch(setup, state, count, work)
            return
        if way < NONE:
            leaves, target = True, state[XI] + way
            if state[BEND] == 0.0 and way > SHORTEST_FOLD and ends_at_fold(setup, state, count, work, way):
                first = approach_fold(state, count, work, way)
                if first == 0.0:
                    return
                leaves, target = False, state[XI] + first
    guess = first_guess(state, target - state[XI])
    series(setup, state, count, work, guess)
    while not math.isfinite(work.jet[TERMS - 1]) and guess > 1e-300:
        guess *= 1e-3
        series(setup, state, count, work, guess)
    if state[XI] == 0.0 and count[ARRIVING] != NO_CAUSE:
        note_jump(setup, state, count, count[MODE] * work.jet[0], count[ARRIVING])
    elif count[EDGE] != 0 and count[HAS_INERTIA] == 0:
        note_jump(setup, state, count, count[MODE] * work.jet[0], FOLD)
    take_step(setup, state, count, work, store, target, guess, leaves)


@kernel
def take_step(
    setup: Setup, state: Floats, count: Integers, work: Work, store: Store, target: float, guess: float, leaves: bool
) -> None:
    """Choose the length of the step, cut it at the first event, record it, and do what the event asks for."""
    limit = (target - state[XI]) / guess
    length = usable_length(work.jet, setup.par[TOLERANCE])
    reached = length >= limit
    if reached:
        length = limit
    elif length > 0.5 * limit:
        length = 0.5 * limit
    for k in range(TERMS):
        work.rate[k] = work.jet[k]
    scale(work.rate, length)
    scale(work.local, length)
    work.k[K_SPEED] *= length
    work.k[K_BEND] *= length * length
    arrest = NONE if count[IS_ALGEBRAIC] == 1 else first_descent(work.rate, 1.0)
    knot = knot_crossing(setup, state, count, work) if len(setup.knots) > 0 else NONE
    end = min(arrest, knot)
    if end > 1.0 - TIE:
        arrest, knot, end = NONE, NONE, 1.0
    to = target if reached and end == 1.0 else state[XI] + end * length * guess
    finish_step(setup, state, count, work, store, end, to)
    if arrest == end:
        come_to_rest(setup, state, count, work)
    elif knot == end:
        count[PIECE] += 1 if work.k[K_CHI] > 0.0 else -1
    elif leaves and (reached or target - state[XI] < TIE):
        end_branch(setup, state, count, work)


@kernel
def finish_step(
    setup: Setup, state: Floats, count: Integers, work: Work, store: Store, end: float, to: float
) -> None:
    """Record the step up to eta = end, which is xi = to, and move the state there."""
    direction = count[MODE]
    grown = slip_grown(work, end)
    rate_end = evaluate(work.rate, end)
    if count[IS_BLOCK] == 1:
        subtract_spring(setup, count, work)
        work.load[0] -= setup.par[STIFFNESS] * direction * grown
    state[LAST_STEP] = abs(work.k[K_SPEED] + 0.5 * work.k[K_BEND] * end) * end
    scale(work.rate, end)
    scale(work.local, end)
    for k in range(TERMS):
        work.rate[k] *= direction
    record(state, count, work, store, to)
    count[MOVED], count[EDGE] = 1, 0
    state[SLIP_NOW] += direction * grown
    state[LAW_SLIP] += work.k[K_CHI] * grown
    state[RATE_NOW] = direction * max(rate_end, 0.0)


@kernel
def subtract_spring(setup: Setup, count: Integers, work: Work) -> None:
    """The block unloads its spring as it slips: turn the outer load in work.local into the load on the contact."""
    for k in range(TERMS - 1, 0, -1):
        grown = (work.k[K_SPEED] * work.rate[k - 1] + (work.k[K_BEND] * work.rate[k - 2] if k > 1 else 0.0)) / k
        work.local[k] -= setup.par[STIFFNESS] * count[MODE] * grown


@kernel
def come_to_rest(setup: Setup, state: Floats, count: Integers, work: Work) -> None:
    """The slip rate has reached zero: rest, or slip the other way where the load is beyond the strength there."""
    before = count[MODE]
    state[RATE_NOW] = 0.0
    count[MODE] = 0
    if count[HAS_INERTIA] == 0:
        count[EDGE] = before
        return
    load = evaluate(work.load, state[XI])
    limit = rest_limit(setup, state, count, work)
    for direction in (1, -1):
        if towards(setup, load, direction) > limit:
            count[MODE] = direction


@kernel
def end_branch(setup: Setup, state: Floats, count: Integers, work: Work) -> None:
    """The load has left the interval in which the rule keeps the branch."""
    branch, direction = count[BRANCH], count[MODE]
    seen = towards(setup, evaluate(work.load, state[XI]), direction)
    upper = abs(seen - setup.keep_to[branch]) < abs(seen - setup.keep_from[branch])
    at = setup.keep_to[branch] if upper else setup.keep_from[branch]
    leave_branch(setup, count, at)
    if count[MODE] == 0:
        note_jump(setup, state, count, 0.0, FOLD)
        state[RATE_NOW] = 0.0
    else:
        count[EDGE] = direction
