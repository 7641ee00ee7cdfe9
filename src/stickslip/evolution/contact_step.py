"""One step of the contact on a piece of load: stick, or slip, up to whatever comes first.

Ties have a written order: what arrives with the load (an echo, a change of loading) is met before what the contact does by
itself, so an event within TIE of the end of a piece is left to the start of the next one.
"""

from __future__ import annotations

import math

from stickslip.evolution import layout as at
from stickslip.evolution.compiled import call_jet, call_value, inlined
from stickslip.evolution.layout import Floats, Integers, Setup, Store, Work
from stickslip.evolution.polynomial import NONE, RECIPROCAL, copy, evaluate, fill, first_descent, restrict, scale

TIE = 1e-13
SHORTEST_FOLD = 1e-9
LONGEST_GUESS = 2.0


@inlined
def constants_of(setup: Setup, piece: int) -> int:
    """Address of the constants of a piece of the law."""
    return setup.constants.ctypes.data + 8 * piece * setup.constants.shape[1]


@inlined
def friction_at(setup: Setup, count: Integers, law_slip: float, rate: float, out: Floats) -> None:
    """out: S (mu - mu_reference), and its derivatives with respect to rate and slip, times S."""
    piece = count[at.PIECE]
    call_value(
        setup.address[at.VALUE_AT, piece],
        constants_of(setup, piece),
        law_slip + setup.law[at.SLIP_SHIFT, piece],
        rate,
        out.ctypes.data,
    )
    out[0] = setup.par[at.NORMAL] * (out[0] + setup.law[at.OFFSET, piece])
    out[1] *= setup.par[at.NORMAL]
    out[2] *= setup.par[at.NORMAL]


@inlined
def rest_limit(setup: Setup, state: Floats, count: Integers, work: Work) -> float:
    """Load (minus the reference) at which the selection rule leaves rest forwards: the static strength, or below it."""
    friction_at(setup, count, state[at.LAW_SLIP], 0.0, work.value)
    return work.value[0] + setup.par[at.NORMAL] * setup.par[at.STATIC_EXCESS] + setup.par[at.STICK_TO]


@inlined
def towards(setup: Setup, load: float, direction: int) -> float:
    """The load as seen in the direction of slip, minus the reference."""
    return load if direction > 0 else -load - 2.0 * setup.par[at.REFERENCE]


@inlined
def rate_on_branch(setup: Setup, state: Floats, count: Integers, work: Work, load: float, guess: float) -> float:
    """The slip rate on the current branch that solves g(s) = load: Newton's method kept inside the branch."""
    branch = count[at.BRANCH]
    low, high = setup.branch[at.RATE_FROM, branch], setup.branch[at.RATE_TO, branch]
    if load <= setup.branch[at.EXCESS_FROM, branch]:
        return low
    if load >= setup.branch[at.EXCESS_TO, branch]:
        return high
    high = min(high, (load + setup.par[at.LARGEST_DROP]) / setup.par[at.IMPEDANCE] * (1.0 + 1e-12))
    s = guess if low < guess < high else 0.5 * (low + high)
    for _ in range(200):
        friction_at(setup, count, state[at.LAW_SLIP], s, work.value)
        error = setup.par[at.IMPEDANCE] * s + work.value[0] - load
        if error > 0.0:
            high = s
        elif error < 0.0:
            low = s
        else:
            return s
        slope = setup.par[at.IMPEDANCE] + work.value[1]
        step = s - error / slope if slope > 0.0 else 0.5 * (low + high)
        if not low < step < high:
            step = 0.5 * (low + high)
        if abs(step - s) <= 1e-16 * abs(s) or step in (low, high):
            return step
        s = step
    return s


@inlined
def choose_branch(setup: Setup, count: Integers, load: float) -> None:
    """Leave rest: the first branch that the rule allows at this load."""
    for branch in range(setup.branch.shape[1]):
        if load <= setup.branch[at.KEEP_TO, branch]:
            count[at.BRANCH] = branch
            return


@inlined
def leave_branch(setup: Setup, count: Integers, load: float) -> None:
    """The branch ends at this load: go to the nearest allowed one in the direction of the load, or to rest."""
    branch = count[at.BRANCH]
    if load >= setup.branch[at.KEEP_TO, branch]:
        for other in range(branch + 1, setup.branch.shape[1]):
            if load <= setup.branch[at.KEEP_TO, other]:
                count[at.BRANCH] = other
                return
    for other in range(branch - 1, -1, -1):
        if setup.branch[at.KEEP_FROM, other] <= load:
            count[at.BRANCH] = other
            return
    count[at.MODE] = 0


@inlined
def note_jump(setup: Setup, state: Floats, count: Integers, rate: float, cause: int) -> None:
    """Mark a shock if the slip rate is about to jump."""
    before = state[at.RATE_NOW]
    size = abs(rate - before)
    if size > setup.par[at.SMALLEST_JUMP] and size > setup.par[at.RELATIVE_JUMP] * max(abs(rate), abs(before)):
        count[at.CAUSE] = cause
        count[at.JUMP] = 1


@inlined
def arrive(setup: Setup, state: Floats, count: Integers, work: Work) -> None:
    """A new piece of load begins: does the contact stick or slip under it, which way, on which branch?"""
    load = work.load[0]
    limit = rest_limit(setup, state, count, work)
    mode = count[at.MODE]
    if mode != 0 and count[at.IS_ALGEBRAIC] == 1:
        seen, branch = towards(setup, load, mode), count[at.BRANCH]
        if not setup.branch[at.KEEP_FROM, branch] <= seen <= setup.branch[at.KEEP_TO, branch]:
            leave_branch(setup, count, seen)
    elif mode != 0 and count[at.HAS_INERTIA] == 0:
        friction_at(setup, count, state[at.LAW_SLIP], 0.0, work.value)
        if towards(setup, load, mode) < work.value[0]:
            count[at.MODE] = 0
    if count[at.MODE] == 0 and count[at.EDGE] == 0:
        for direction in (1, -1):
            if towards(setup, load, direction) > limit:
                count[at.MODE] = direction
                choose_branch(setup, count, towards(setup, load, direction))
    if count[at.MODE] == 0:
        note_jump(setup, state, count, 0.0, count[at.ARRIVING])
        state[at.RATE_NOW] = 0.0


@inlined
def theta_at(state: Floats, xi: float) -> float:
    return state[at.THETA_TO] if xi >= 1.0 else state[at.THETA_FROM] + xi * (state[at.SPEED] + xi * state[at.BEND])


@inlined
def record(state: Floats, count: Integers, work: Work, store: Store, xi_to: float) -> None:
    """Append the step to the history: work.local and work.rate hold its load and rate on [0, 1]."""
    xi = state[at.XI]
    width = xi_to - xi
    theta_from, theta_to = theta_at(state, xi), theta_at(state, xi_to)
    if theta_to > theta_from:
        n = count[at.LENGTH]
        whole, real, load, rate = store.whole, store.real, store.load, store.rate
        whole[n, at.S_ROW], whole[n, at.S_MODE], whole[n, at.S_PIECE] = count[at.ROW], count[at.MODE], count[at.PIECE]
        whole[n, at.S_JUMP], whole[n, at.S_CAUSE] = count[at.JUMP], count[at.CAUSE]
        real[n, at.S_THETA_FROM], real[n, at.S_THETA_TO] = theta_from, theta_to
        real[n, at.S_SPEED] = (state[at.SPEED] + 2.0 * state[at.BEND] * xi) * width
        real[n, at.S_BEND] = state[at.BEND] * width * width
        real[n, at.S_SLIP], real[n, at.S_LAW_SLIP] = state[at.SLIP_NOW], state[at.LAW_SLIP]
        for k in range(at.TERMS):
            load[n, k] = work.local[k]
            rate[n, k] = work.rate[k]
        count[at.LENGTH] = n + 1
        count[at.JUMP] = count[at.CAUSE] = count[at.STALLED] = 0
    else:
        count[at.STALLED] += 1
    state[at.XI] = xi_to


@inlined
def stick(setup: Setup, state: Floats, count: Integers, work: Work, store: Store, xi_to: float) -> None:
    """Stay at rest until the load leaves what friction can hold."""
    width = xi_to - state[at.XI]
    limit = rest_limit(setup, state, count, work)
    restrict(work.load, state[at.XI], width, work.local)
    onset, direction = NONE, 0
    for way in (1, -1):
        for k in range(at.TERMS):
            work.gap[k] = -way * work.local[k]
        work.gap[0] = 0.0 if count[at.EDGE] == way else limit - towards(setup, work.local[0], way)
        first = first_descent(work.gap, work.bernstein)
        if first < onset:
            onset, direction = first, way
    slips = onset <= 1.0 - TIE
    end = min(onset, 1.0) if slips else 1.0
    scale(work.local, end)
    fill(work.rate, 0.0)
    record(state, count, work, store, state[at.XI] + end * width if slips else xi_to)
    count[at.EDGE] = 0
    if slips:
        count[at.MODE], count[at.EDGE] = direction, direction
        choose_branch(setup, count, limit)


@inlined
def first_guess(state: Floats, left: float) -> float:
    """Length (in xi) in whose units the next series is computed: near the step that will be taken, so that nothing overflows."""
    speed = abs(state[at.SPEED] + 2.0 * state[at.BEND] * state[at.XI])
    return min(left, LONGEST_GUESS * state[at.LAST_STEP] / speed) if speed > 0.0 else left


@inlined
def series(setup: Setup, state: Floats, count: Integers, work: Work, guess: float) -> None:
    """Taylor series of load (work.local) and slip rate's magnitude (work.jet) from the present state, in units of `guess`."""
    direction, piece, par, k = count[at.MODE], count[at.PIECE], setup.par, work.k
    restrict(work.load, state[at.XI], guess, work.local)
    edge = count[at.EDGE] != 0
    for i in range(at.TERMS):
        work.gap[i] = direction * work.local[i]
    work.gap[0] = towards(setup, work.local[0], direction)
    k[at.K_IMPEDANCE], k[at.K_NORMAL] = par[at.IMPEDANCE], par[at.NORMAL]
    k[at.K_INERTIA], k[at.K_STIFFNESS] = par[at.INERTIA], par[at.STIFFNESS]
    k[at.K_CHI] = direction if par[at.COUNTS_NET] == 1.0 else 1.0
    k[at.K_SPEED] = (state[at.SPEED] + 2.0 * state[at.BEND] * state[at.XI]) * guess
    k[at.K_BEND] = 2.0 * state[at.BEND] * guess * guess
    k[at.K_SLIP], k[at.K_OFFSET] = state[at.LAW_SLIP] + setup.law[at.SLIP_SHIFT, piece], setup.law[at.OFFSET, piece]
    k[at.K_RATE] = abs(state[at.RATE_NOW])
    k[at.K_FREE] = 0.0 if edge else 1.0
    k[at.K_FORCE] = par[at.NORMAL] * par[at.STATIC_EXCESS] if edge else 0.0
    if count[at.IS_ALGEBRAIC] == 1:
        k[at.K_RATE] = rate_on_branch(setup, state, count, work, work.gap[0], abs(state[at.RATE_NOW]))
    call_jet(setup.address[at.JET_AT, piece], constants_of(setup, piece), k.ctypes.data, work.gap.ctypes.data, work.jet.ctypes.data)


@inlined
def usable_length(jet: Floats, tolerance: float) -> float:
    """Longest step (in units of the guess) whose last two terms stay below the tolerance, relative to the rate over the step."""
    size = max(abs(jet[0]), 0.5 * abs(jet[1]), 0.25 * abs(jet[2]), 0.125 * abs(jet[3]))
    n = at.TERMS - 1
    last, before = abs(jet[n]), abs(jet[n - 1])
    steepest = -NONE
    if last > 0.0:
        steepest = math.log(last / (tolerance * size)) * RECIPROCAL[n]
    if before > 0.0:
        steepest = max(steepest, math.log(before / (tolerance * size)) * RECIPROCAL[n - 1])
    return math.exp(-steepest)


@inlined
def slip_grown(work: Work, end: float) -> float:
    """Integral of work.rate over the step, up to eta = end; dtheta/deta is K_SPEED + K_BEND eta."""
    straight, bent = 0.0, 0.0
    for k in range(at.TERMS - 1, -1, -1):
        straight = straight * end + RECIPROCAL[k + 1] * work.rate[k]
    if work.k[at.K_BEND] != 0.0:
        for k in range(at.TERMS - 1, -1, -1):
            bent = bent * end + RECIPROCAL[k + 2] * work.rate[k]
    return end * (work.k[at.K_SPEED] * straight + work.k[at.K_BEND] * end * bent)


@inlined
def knot_crossing(setup: Setup, state: Floats, count: Integers, work: Work) -> float:
    """Where on [0, 1] the slip reaches the next knot of the law; NONE if it does not. Slip is monotone within a step."""
    grown = work.k[at.K_CHI] * slip_grown(work, 1.0)
    forwards = grown > 0.0
    next_knot = count[at.PIECE] if forwards else count[at.PIECE] - 1
    if next_knot < 0 or next_knot >= setup.law.shape[1] - 1:
        return NONE
    distance = setup.law[at.KNOT, next_knot] - state[at.LAW_SLIP]
    if abs(distance) >= abs(grown):
        return NONE
    low, high = 0.0, 1.0
    for _ in range(60):
        middle = 0.5 * (low + high)
        if abs(work.k[at.K_CHI] * slip_grown(work, middle)) < abs(distance):
            low = middle
        else:
            high = middle
    return high


@inlined
def branch_exit(setup: Setup, count: Integers, work: Work, width: float) -> float:
    """Where (in units of xi from here, up to width) the load leaves what the rule keeps the branch for; NONE if it stays."""
    branch = count[at.BRANCH]
    first = NONE
    for upper in (0, 1):
        bound = setup.branch[at.KEEP_TO, branch] if upper == 1 else setup.branch[at.KEEP_FROM, branch]
        if math.isinf(bound):
            continue
        sign = -1.0 if upper == 1 else 1.0
        for k in range(at.TERMS):
            work.gap[k] = sign * count[at.MODE] * work.local[k]
        work.gap[0] = sign * (towards(setup, work.local[0], count[at.MODE]) - bound)
        if count[at.EDGE] != 0 and work.gap[0] < 0.0:
            work.gap[0] = 0.0
        first = min(first, first_descent(work.gap, work.bernstein))
    return first * width


@inlined
def approach_fold(state: Floats, count: Integers, work: Work, width: float) -> float:
    """Prepare the way to a fold at distance `width`: s goes as the square root of the time left, so that becomes the variable.

    Returns 0 once the piece is changed, or the part of the way that must be walked first (where the load is not well enough
    described by half the terms that squaring its variable leaves).
    """
    part = work.gap
    restrict(work.load, state[at.XI] + width, -width, part)  # from the fold backwards, z on [0, 1]
    total, tail = 0.0, 0.0
    share = 1.0
    for _ in range(60):
        total, tail, power = 0.0, 0.0, 1.0
        for k in range(at.TERMS):
            total += abs(part[k]) * power
            if 2 * k > at.TERMS - 1:
                tail += abs(part[k]) * power
            power *= share
        if tail <= 1e-16 * total:
            break
        share *= 0.5
    if share < 1.0:
        return (1.0 - share) * width
    copy(work.load, work.kept_load)
    copy(state, work.kept)
    work.kept[at.XI] = state[at.XI] + width
    length = theta_at(state, state[at.XI] + width) - theta_at(state, state[at.XI])
    fill(work.local, 0.0)
    for k in range((at.TERMS + 1) // 2):
        work.local[2 * k] = part[k]
    restrict(work.local, 1.0, -1.0, work.load)
    state[at.THETA_FROM], state[at.THETA_TO] = theta_at(state, state[at.XI]), theta_at(state, state[at.XI] + width)
    state[at.SPEED], state[at.BEND], state[at.XI] = 2.0 * length, -length, 0.0
    count[at.AT_FOLD] = 1
    return 0.0


@inlined
def way_to_exit(setup: Setup, state: Floats, count: Integers, work: Work, left: float) -> float:
    """Distance (in xi, at most `left`) at which an algebraic contact leaves its branch; NONE if it stays."""
    restrict(work.load, state[at.XI], left, work.local)
    way = branch_exit(setup, count, work, left)
    return way if way < left * (1.0 - TIE) else NONE


@inlined
def ends_at_fold(setup: Setup, state: Floats, count: Integers, work: Work, way: float) -> bool:
    """Whether the branch ends there because g turns, and not because the rule prefers another solution."""
    branch = count[at.BRANCH]
    level = towards(setup, evaluate(work.load, state[at.XI] + way), count[at.MODE])
    if abs(level - setup.branch[at.KEEP_TO, branch]) < abs(level - setup.branch[at.KEEP_FROM, branch]):
        return setup.branch[at.KEEP_TO, branch] == setup.branch[at.EXCESS_TO, branch]
    return setup.branch[at.RATE_FROM, branch] > 0.0 and setup.branch[at.KEEP_FROM, branch] == setup.branch[at.EXCESS_FROM, branch]


@inlined
def slip(setup: Setup, state: Floats, count: Integers, work: Work, store: Store, xi_to: float) -> None:
    """Slip for one Taylor step, or up to what ends it: arrest, the end of a branch, a knot of the law, the end of the piece."""
    target, leaves = xi_to, False
    if count[at.IS_ALGEBRAIC] == 1 and count[at.AT_FOLD] == 0:
        way = way_to_exit(setup, state, count, work, xi_to - state[at.XI])
        if way == 0.0:
            end_branch(setup, state, count, work)
            return
        if way < NONE:
            leaves, target = True, state[at.XI] + way
            if state[at.BEND] == 0.0 and way > SHORTEST_FOLD and ends_at_fold(setup, state, count, work, way):
                first = approach_fold(state, count, work, way)
                if first == 0.0:
                    return
                leaves, target = False, state[at.XI] + first
    guess = first_guess(state, target - state[at.XI])
    series(setup, state, count, work, guess)
    while not math.isfinite(work.jet[at.TERMS - 1]) and guess > 1e-300:
        guess *= 1e-3
        series(setup, state, count, work, guess)
    if state[at.XI] == 0.0 and count[at.ARRIVING] != at.NO_CAUSE:
        note_jump(setup, state, count, count[at.MODE] * work.jet[0], count[at.ARRIVING])
    elif count[at.EDGE] != 0 and count[at.HAS_INERTIA] == 0:
        note_jump(setup, state, count, count[at.MODE] * work.jet[0], at.FOLD)
    take_step(setup, state, count, work, store, target, guess, leaves)


@inlined
def take_step(
    setup: Setup, state: Floats, count: Integers, work: Work, store: Store, target: float, guess: float, leaves: bool
) -> None:
    """Choose the length of the step, cut it at the first event, record it, and do what the event asks for."""
    limit = (target - state[at.XI]) / guess
    length = usable_length(work.jet, setup.par[at.TOLERANCE])
    reached = length >= limit
    if reached:
        length = limit
    elif length > 0.5 * limit:
        length = 0.5 * limit
    power = 1.0
    for k in range(at.TERMS):
        work.rate[k] = work.jet[k] * power
        work.local[k] *= power
        power *= length
    work.k[at.K_SPEED] *= length
    work.k[at.K_BEND] *= length * length
    arrest = NONE if count[at.IS_ALGEBRAIC] == 1 else first_descent(work.rate, work.bernstein)
    knot = knot_crossing(setup, state, count, work) if setup.law.shape[1] > 1 else NONE
    end = min(arrest, knot)
    if end > 1.0 - TIE:
        arrest, knot, end = NONE, NONE, 1.0
    to = target if reached and end == 1.0 else state[at.XI] + end * length * guess
    finish_step(setup, state, count, work, store, end, to)
    if arrest == end:
        come_to_rest(setup, state, count, work)
    elif knot == end:
        count[at.PIECE] += 1 if work.k[at.K_CHI] > 0.0 else -1
    elif leaves and (reached or target - state[at.XI] < TIE):
        end_branch(setup, state, count, work)


@inlined
def finish_step(setup: Setup, state: Floats, count: Integers, work: Work, store: Store, end: float, to: float) -> None:
    """Record the step up to eta = end, which is xi = to, and move the state there."""
    direction = count[at.MODE]
    grown = slip_grown(work, end)
    rate_end = evaluate(work.rate, end)
    if count[at.IS_BLOCK] == 1:
        subtract_spring(setup, count, work)
        work.load[0] -= setup.par[at.STIFFNESS] * direction * grown
    state[at.LAST_STEP] = abs(work.k[at.K_SPEED] + 0.5 * work.k[at.K_BEND] * end) * end
    if end < 1.0:
        scale(work.rate, end)
        scale(work.local, end)
    if direction < 0:
        for k in range(at.TERMS):
            work.rate[k] = -work.rate[k]
    record(state, count, work, store, to)
    count[at.MOVED], count[at.EDGE] = 1, 0
    state[at.SLIP_NOW] += direction * grown
    state[at.LAW_SLIP] += work.k[at.K_CHI] * grown
    state[at.RATE_NOW] = direction * max(rate_end, 0.0)


@inlined
def subtract_spring(setup: Setup, count: Integers, work: Work) -> None:
    """The block unloads its spring as it slips: turn the outer load in work.local into the load on the contact."""
    for k in range(at.TERMS - 1, 0, -1):
        grown = work.k[at.K_SPEED] * work.rate[k - 1] + (work.k[at.K_BEND] * work.rate[k - 2] if k > 1 else 0.0)
        work.local[k] -= setup.par[at.STIFFNESS] * count[at.MODE] * RECIPROCAL[k] * grown


@inlined
def come_to_rest(setup: Setup, state: Floats, count: Integers, work: Work) -> None:
    """The slip rate has reached zero: rest, or slip the other way where the load is beyond the strength there."""
    before = count[at.MODE]
    state[at.RATE_NOW] = 0.0
    count[at.MODE] = 0
    if count[at.HAS_INERTIA] == 0:
        count[at.EDGE] = before
        return
    load = evaluate(work.load, state[at.XI])
    limit = rest_limit(setup, state, count, work)
    for direction in (1, -1):
        if towards(setup, load, direction) > limit:
            count[at.MODE] = direction


@inlined
def end_branch(setup: Setup, state: Floats, count: Integers, work: Work) -> None:
    """The load has left the interval in which the rule keeps the branch."""
    branch, direction = count[at.BRANCH], count[at.MODE]
    seen = towards(setup, evaluate(work.load, state[at.XI]), direction)
    upper = abs(seen - setup.branch[at.KEEP_TO, branch]) < abs(seen - setup.branch[at.KEEP_FROM, branch])
    level = setup.branch[at.KEEP_TO, branch] if upper else setup.branch[at.KEEP_FROM, branch]
    leave_branch(setup, count, level)
    if count[at.MODE] == 0:
        note_jump(setup, state, count, 0.0, at.FOLD)
        state[at.RATE_NOW] = 0.0
    else:
        count[at.EDGE] = direction
