"""Follow the states of a friction law along a given motion: implicit steps with a measured defect, interval by interval.

Within an interval slip rate and normal load are each a straight line and a sinusoid in time, and the slip rate does not change its
sign. The unknowns are the states at Radau's points of a step. The defect of the polynomial through them, its derivative less the
rate of change that the law gives, is measured halfway between the points; it sets the length of steps, and bounds of the error
follow from it, with the law's own derivatives by its states.
"""

from __future__ import annotations

import math
from typing import NamedTuple

from stickslip.extensions.given_motion.compiled.nodes import (
    BETWEEN_POINTS,
    PLACES_IN_STEP,
    PLACES_OF_POINTS,
    SLOPES,
    SLOPES_BETWEEN,
    STATE_STAGES,
    VALUES_BETWEEN,
)
from stickslip.foundation.arrays import Floats, Floats1, Floats2
from stickslip.foundation.kernels.kernels import entry, inlined, kernel
from stickslip.foundation.kernels.memory.addresses import ahead, call_state_value, floats, room_for

LASTING, RATE, RATE_SLOPE, RATE_TONE, RATE_FREQUENCY, RATE_PHASE, COUNTED, COUNTED_PER_SLIP = range(8)
"""Columns of an interval: how long it lasts (s), |slip rate| (m/s) as a straight line with a sinusoid, and the slip that the law
counts at its start (m), with the change of that per slip."""
LOAD, LOAD_SLOPE, LOAD_TONE, LOAD_FREQUENCY, LOAD_PHASE, LOAD_GROWTH, TURNS_BACK = range(8, 15)
"""Further columns: the normal load as a straight line with a sinusoid, the logarithm (1) of its jump at the start, and 1 if
slip changes its direction there."""
INTERVAL_COLUMNS = 15
"""Number of columns of an interval."""
AT_INTERVAL, SINCE, TRIED = range(3)
"""Numbers that say where a run is: the interval, the time (s) since its start, and the length (s) of the next step."""
LEVELS = 3
"""Numbers before the states, in what says where a run is; behind them are the bounds of their errors and their largest sizes."""
MOST_STATES_HERE = 2
"""Largest number of states of a law (1)."""
MOST_OF_FORMULA = 4
"""Number of states for which a formula's answer has room (1)."""
CHANGE, CHANGE_BY_STATE = 3 + MOST_OF_FORMULA, 3 + 4 * MOST_OF_FORMULA
"""Places in a formula's answer: of the rates of change of states, and of their derivatives by the states."""
ROOM_OF_ANSWER, ROOM_OF_STATES, ROOM_OF_STEP, ROOM_OF_MATRIX = 48, 4, 18, 110
"""Room for the answer of a formula, the states, their values in a step with its bounds, and Newton's equations (numbers)."""
BEHIND_STATES = 12
"""Place of the bounds of a step, behind the states at its points."""
ITERATIONS = 12
"""Newton's iterations in a step (1), after which it is tried again with a shorter length."""
SETTLED_SHARE = 1e-2
"""Newton's iteration ends when the next change is below this share (1) of the allowed error, or is rounding."""
ROUNDING_OF_STATE = 1e-15
"""A change of a state by this share (1) of its size is rounding."""
SHORTEST_STEP = 1e-13
"""A step shorter than this share (1) of its interval cannot be told from nothing: the run ends."""
OF_REST = 0.7
"""A step that is longer than this share (1) of the rest of its interval is all of it, or half."""
SMALL_BESIDE_LARGEST = 1e-3
"""A state smaller than this share (1) of its largest size so far has an absolute error."""
STEPS_PER_PERIOD = 6.0
"""At least so many steps (1) follow one period of a sinusoid."""
FAILED_STEP = -1
"""What `follow_states` returns where no step is short enough."""


class LawWithStates(NamedTuple):
    """The law: addresses of its compiled formula and its constants, numbers of its states, and the tolerance (1)."""

    state_at: int
    constants_at: int
    states: int
    coupling: float
    """How far the first state falls as the normal load grows by a factor e."""
    reverses: Floats1
    """1 for each state that changes its sign where slip turns back."""
    scales: Floats1
    """The size of each state below which its error is absolute."""
    tolerance: float


class KeptSteps(NamedTuple):
    """Room for steps: interval, start, length, and length of the next to be tried (s), states at the points, bounds of errors."""

    steps: Floats2
    states: Floats2
    errors: Floats2


@inlined
def wave_of(amplitude: float, frequency: float, phase: float, time: float) -> float:
    """Return a sinusoid at a time (s)."""
    return amplitude * math.sin(frequency * time + phase) if amplitude != 0.0 else 0.0


@inlined
def wave_integrated(amplitude: float, frequency: float, phase: float, time: float) -> float:
    """Return the integral of a sinusoid from 0 to a time (s), without cancellation at short times."""
    half = 0.5 * frequency * time
    return 2.0 * amplitude * math.sin(half) * math.sin(phase + half) / frequency if amplitude != 0.0 else 0.0


@kernel
def rate_of_change(at: Floats1, law: LawWithStates, time: float, states: Floats, answer: Floats) -> None:
    """Write the rates of change of the states, at a time (s) since the start of an interval, into the answer of the formula."""
    tone, frequency, phase = at[RATE_TONE], at[RATE_FREQUENCY], at[RATE_PHASE]
    rate = max(0.0, at[RATE] + at[RATE_SLOPE] * time + wave_of(tone, frequency, phase, time))
    moved = time * (at[RATE] + 0.5 * at[RATE_SLOPE] * time) + wave_integrated(tone, frequency, phase, time)
    slip = at[COUNTED] + at[COUNTED_PER_SLIP] * moved
    call_state_value(law.state_at, floats(law.constants_at), slip, rate, states, answer)
    if law.coupling != 0.0:
        tone, frequency, phase = at[LOAD_TONE], at[LOAD_FREQUENCY], at[LOAD_PHASE]
        load = at[LOAD] + at[LOAD_SLOPE] * time + wave_of(tone, frequency, phase, time)
        grows = at[LOAD_SLOPE] + frequency * wave_of(tone, frequency, phase + 0.5 * math.pi, time)
        answer[CHANGE] -= law.coupling * grows / load


@kernel
def solved(matrix: Floats, size: int) -> bool:
    """Solve `size` linear equations; the solution replaces the column behind them. Return False if they are singular."""
    width = size + 1
    for k in range(size):
        pivot = k
        for i in range(k + 1, size):
            if abs(matrix[width * i + k]) > abs(matrix[width * pivot + k]):
                pivot = i
        if not 0.0 < abs(matrix[width * pivot + k]) < math.inf:
            return False
        for j in range(k, width):
            matrix[width * k + j], matrix[width * pivot + j] = matrix[width * pivot + j], matrix[width * k + j]
        for i in range(k + 1, size):
            factor = matrix[width * i + k] / matrix[width * k + k]
            if factor != 0.0:
                for j in range(k + 1, width):
                    matrix[width * i + j] -= factor * matrix[width * k + j]
    for i in range(size - 1, -1, -1):
        for j in range(i + 1, size):
            matrix[width * i + size] -= matrix[width * i + j] * matrix[width * j + size]
        matrix[width * i + size] /= matrix[width * i + i]
    return True


@inlined
def size_allowed(law: LawWithStates, now: Floats1, n: int, size: float) -> float:
    """Return the size of a state to which its tolerance is relative."""
    largest = now[LEVELS + 2 * MOST_STATES_HERE + n]
    allowed: float = max(size, law.scales[n], SMALL_BESIDE_LARGEST * largest, 1e-300)
    return allowed


@kernel
def corrected(at: Floats1, law: LawWithStates, now: Floats1, length: float, w: Floats) -> float:
    """Take one of Newton's steps for the states at the points; return its size over the largest allowed, inf if it fails."""
    answer, states, matrix = room_for(ROOM_OF_ANSWER), room_for(ROOM_OF_STATES), room_for(ROOM_OF_MATRIX)
    many, size = law.states, law.states * STATE_STAGES
    width = size + 1
    for i in range(size * width):
        matrix[i] = 0.0
    for i in range(1, PLACES_IN_STEP):
        for n in range(many):
            states[n] = w[PLACES_IN_STEP * n + i]
        rate_of_change(at, law, now[SINCE] + length * PLACES_OF_POINTS[i], states, answer)
        for n in range(many):
            row, slope = (STATE_STAGES * n + i - 1) * width, 0.0
            for j in range(PLACES_IN_STEP):
                slope += SLOPES[i, j] * (w[PLACES_IN_STEP * n + j] - w[PLACES_IN_STEP * n])
                if j > 0:
                    matrix[row + STATE_STAGES * n + j - 1] = SLOPES[i, j]
            for other in range(many):
                matrix[row + STATE_STAGES * other + i - 1] -= length * answer[CHANGE_BY_STATE + MOST_OF_FORMULA * n + other]
            matrix[row + size] = length * answer[CHANGE + n] - slope
    if not solved(matrix, size):
        return math.inf
    share = 0.0
    for n in range(many):
        for i in range(1, PLACES_IN_STEP):
            step = matrix[(STATE_STAGES * n + i - 1) * width + size]
            w[PLACES_IN_STEP * n + i] += step
            value = abs(w[PLACES_IN_STEP * n + i])
            if not math.isfinite(value):
                return math.inf
            noise = ROUNDING_OF_STATE * max(value, abs(w[PLACES_IN_STEP * n]))
            share = max(share, max(0.0, abs(step) - noise) / (law.tolerance * size_allowed(law, now, n, value)))
    return share


@kernel
def settled(at: Floats1, law: LawWithStates, now: Floats1, length: float, w: Floats) -> bool:
    """Solve for the states at the points of a step; return False if Newton's iteration does not converge."""
    before = math.inf
    for _ in range(ITERATIONS):
        share = corrected(at, law, now, length, w)
        if not share < math.inf:
            return False
        if share <= SETTLED_SHARE or (share < 1.0 and share >= 0.5 * before):  # the second: it moves by rounding
            return True
        before = share
    return False


@kernel
def measured(at: Floats1, law: LawWithStates, now: Floats1, length: float, w: Floats) -> float:
    """Return the error of a step as a share of the allowed one, from its defect halfway between the points.

    The room behind `w` receives for each state the largest defect, and the largest derivatives of its rate of change by each state.
    """
    bounds = ahead(w, BEHIND_STATES)
    answer, states = room_for(ROOM_OF_ANSWER), room_for(ROOM_OF_STATES)
    many, share = law.states, 0.0
    for i in range(STATE_STAGES):
        for n in range(many):
            states[n] = w[PLACES_IN_STEP * n]
            for j in range(1, PLACES_IN_STEP):
                states[n] += VALUES_BETWEEN[i, j] * (w[PLACES_IN_STEP * n + j] - w[PLACES_IN_STEP * n])
        rate_of_change(at, law, now[SINCE] + length * BETWEEN_POINTS[i], states, answer)
        for n in range(many):
            slope = 0.0
            for j in range(1, PLACES_IN_STEP):
                slope += SLOPES_BETWEEN[i, j] * (w[PLACES_IN_STEP * n + j] - w[PLACES_IN_STEP * n])
            defect = abs(slope / length - answer[CHANGE + n])
            if not math.isfinite(defect):
                return math.inf
            fades = abs(answer[CHANGE_BY_STATE + (MOST_OF_FORMULA + 1) * n])
            allowed = law.tolerance * size_allowed(law, now, n, abs(states[n]))
            noise = ROUNDING_OF_STATE * max(abs(states[n]), abs(w[PLACES_IN_STEP * n]))
            defect = max(defect, noise / length)
            share = max(share, (defect * length / max(1.0, fades * length) - 20.0 * noise) / allowed)
            bounds[3 * n] = defect if i == 0 else max(bounds[3 * n], defect)
            for other in range(many):
                by_state = answer[CHANGE_BY_STATE + MOST_OF_FORMULA * n + other]
                found = by_state if other == n else abs(by_state)
                bounds[3 * n + 1 + other] = found if i == 0 else max(bounds[3 * n + 1 + other], found)
    return share


@kernel
def note_errors(law: LawWithStates, now: Floats1, length: float, bounds: Floats) -> None:
    """Carry the bounds of the errors of the states over a step: e' <= (derivative by the state) e + defect, and those of others."""
    first, second = now[LEVELS + MOST_STATES_HERE], now[LEVELS + MOST_STATES_HERE + 1]
    for n in range(law.states):
        own, other = (first, second) if n == 0 else (second, first)
        grows = bounds[3 * n + 1 + n]
        driven = bounds[3 * n] + (bounds[3 * n + 2 - n] * other if law.states > 1 else 0.0)
        x = grows * length
        share = (math.exp(x) - 1.0) / x if abs(x) > 1e-5 else 1.0 + 0.5 * x
        now[LEVELS + MOST_STATES_HERE + n] = own * math.exp(x) + driven * length * share


@kernel
def enter_interval(at: Floats1, law: LawWithStates, now: Floats1) -> None:
    """Change the states at the start of an interval: by a jump of the normal load, and where slip turns back."""
    now[LEVELS] -= law.coupling * at[LOAD_GROWTH]
    if at[TURNS_BACK] != 0.0:
        for n in range(law.states):
            if law.reverses[n] != 0.0:
                now[LEVELS + n] = -now[LEVELS + n]


@inlined
def longest_step(at: Floats1) -> float:
    """Return how long (s) a step may be at most: a part of the period of a sinusoid."""
    longest = math.inf
    if at[RATE_TONE] != 0.0:
        longest = 2.0 * math.pi / (STEPS_PER_PERIOD * at[RATE_FREQUENCY])
    if at[LOAD_TONE] != 0.0:
        longest = min(longest, 2.0 * math.pi / (STEPS_PER_PERIOD * at[LOAD_FREQUENCY]))
    return longest


@kernel
def take_step(at: Floats1, law: LawWithStates, now: Floats1, w: Floats) -> float:
    """Take one step in an interval, with the states at its points in `w`; return its length (s), 0 if none is short enough."""
    left = at[LASTING] - now[SINCE]
    length = min(now[TRIED], longest_step(at))
    if length > OF_REST * left:
        length = left if length >= left else 0.5 * left
    while length > SHORTEST_STEP * at[LASTING]:
        for n in range(law.states):
            for i in range(PLACES_IN_STEP):
                w[PLACES_IN_STEP * n + i] = now[LEVELS + n]
        share = measured(at, law, now, length, w) if settled(at, law, now, length, w) else math.inf
        if share <= 1.0:
            note_errors(law, now, length, ahead(w, BEHIND_STATES))
            now[TRIED] = length * min(4.0, 0.9 * max(share, 1e-9) ** (-1.0 / PLACES_IN_STEP))
            return length
        length *= max(0.2, 0.9 * share ** (-1.0 / PLACES_IN_STEP)) if share < math.inf else 0.25
    return 0.0


@entry
def follow_states(intervals: Floats2, law: LawWithStates, now: Floats1, kept: KeptSteps, most: int) -> int:
    """Take at most `most` steps from where `now` is; return their number, FAILED_STEP if no step is short enough."""
    w, many = room_for(ROOM_OF_STEP), law.states
    for count in range(most):
        place = int(now[AT_INTERVAL])
        if place >= len(intervals):
            return count
        at = intervals[place]
        if now[SINCE] == 0.0:
            enter_interval(at, law, now)
        length = take_step(at, law, now, w)
        if length == 0.0:
            return FAILED_STEP
        kept.steps[count, 0], kept.steps[count, 1], kept.steps[count, 2] = now[AT_INTERVAL], now[SINCE], length
        kept.steps[count, 3] = now[TRIED]
        now[SINCE] += length
        for n in range(many):
            for i in range(PLACES_IN_STEP):
                kept.states[count, PLACES_IN_STEP * n + i] = w[PLACES_IN_STEP * n + i]
            now[LEVELS + n] = w[PLACES_IN_STEP * n + PLACES_IN_STEP - 1]
            kept.errors[count, n] = now[LEVELS + MOST_STATES_HERE + n]
            largest = now[LEVELS + 2 * MOST_STATES_HERE + n]
            now[LEVELS + 2 * MOST_STATES_HERE + n] = max(largest, abs(now[LEVELS + n]))
        if now[SINCE] >= at[LASTING] * (1.0 - SHORTEST_STEP):
            now[AT_INTERVAL], now[SINCE] = now[AT_INTERVAL] + 1.0, 0.0
    return most
