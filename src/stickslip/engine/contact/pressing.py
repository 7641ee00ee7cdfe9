"""Normal load that varies in time: two states of the contact that follow from time alone (see `friction.pressed`).

The first is p = S(t) / S(0) - 1, the second its rate of change (1/s). Between breaks of the loading p is a line plus a tone. Its
series is known before a step is made: unlike a state of the law's own it makes no step implicit.
"""

from __future__ import annotations

import math

from stickslip.engine.contact.pieces import phase_at, xi_at
from stickslip.engine.series.polynomial import RECIPROCAL, fill
from stickslip.engine.series.radau_nodes import NODES_OF_STEP, POINT
from stickslip.engine.state.layout import TERMS, Floats, Task
from stickslip.engine.state.workspace import Run
from stickslip.foundation.kernels.kernels import kernel
from stickslip.foundation.kernels.memory.addresses import ahead, call_part

LARGEST_TURN = 1.0
"""The series of a tone is right to rounding up to this phase (rad)."""


@kernel
def own_states(run: Run) -> int:
    """Return the number of states of the law's own: the others follow from time alone and are given."""
    return run.counts.states - run.counts.given


@kernel
def tone_series(run: Run, amplitude: float, phase: float, time: float) -> None:
    """Write into run.spare the coefficients in xi of amplitude sin(frequency t + phase) on a piece that begins at `time` (s)."""
    frequency = run.params.tone_frequency
    turn, bend = frequency * run.state.speed, 2.0 * frequency * run.state.bend
    tone_along(amplitude, (frequency * time + phase, turn, bend), run.spare, run.trial)


@kernel
def pressing_at(run: Run, phase: float, later: float) -> tuple[float, float]:
    """Return p and its rate of change (1/s) a time `later` (s) after a phase (s) of the present round trip."""
    params, segment = run.params, run.loading[run.counts.segment]
    since = (run.counts.trip - segment.trip) * params.round_trip_time + (phase - segment.offset) + later
    p, rate = segment.pressing + segment.pressing_rate * since, segment.pressing_rate
    if params.pressing_tone != 0.0:
        now = run.counts.trip * params.round_trip_time + phase + later
        angle = params.pressing_frequency * now + params.pressing_phase
        p += params.pressing_tone * math.sin(angle)
        rate += params.pressing_tone * params.pressing_frequency * math.cos(angle)
    return p, rate


@kernel
def is_pressing(run: Run) -> bool:
    """Return True if the normal load changes at present."""
    return run.counts.given > 0 and (run.params.pressing_tone != 0.0 or run.loading[run.counts.segment].pressing_rate != 0.0)


@kernel
def press(run: Run, phase: float) -> None:
    """Set the present normal load to that at a phase (s) of the present round trip."""
    first = own_states(run)
    run.state.state_now[first], run.state.state_now[first + 1] = pressing_at(run, phase, 0.0)


@kernel
def tone_along(amplitude: float, angle: tuple[float, float, float], sine: Floats, cosine: Floats) -> None:
    """Write the series of amplitude sin(x) and amplitude cos(x); `angle` is x with its first and second derivative (rad).

    They follow from s' = x' c and c' = -x' s for the sine s and the cosine c.
    """
    at_first, turn, bend = angle
    sine[0], cosine[0] = amplitude * math.sin(at_first), amplitude * math.cos(at_first)
    for k in range(TERMS - 1):
        before = k - 1 if k > 0 else 0
        bent = bend if k > 0 else 0.0
        sine[k + 1] = RECIPROCAL[k + 1] * (turn * cosine[k] + bent * cosine[before])
        cosine[k + 1] = -RECIPROCAL[k + 1] * (turn * sine[k] + bent * sine[before])


@kernel
def states_ahead(run: Run, unit: float) -> None:
    """Write the series of the states from here into run.state_jet, in units of `unit` (in xi); those of the law's own stay."""
    for n in range(run.counts.states):
        fill(ahead(run.state_jet, TERMS * n), 0.0)
    if is_pressing(run):
        call_part(run.loading_history, run, Task.PRESS_AHEAD, unit)
    for n in range(run.counts.states):
        run.state_jet[TERMS * n] = run.state.state_now[n]


@kernel
def press_ahead(run: Run, unit: float) -> None:
    """Write the series of a normal load that changes into the rows of its states but for their first terms, which are zero."""
    params, state, first = run.params, run.state, own_states(run)
    p, change = ahead(run.state_jet, TERMS * first), ahead(run.state_jet, TERMS * (first + 1))
    pace, bend = (state.speed + 2.0 * state.bend * state.xi) * unit, 2.0 * state.bend * unit * unit
    if params.pressing_tone != 0.0:
        frequency, now = params.pressing_frequency, run.counts.trip * params.round_trip_time + phase_at(run, state.xi)
        angle = frequency * now + params.pressing_phase
        tone_along(params.pressing_tone, (angle, frequency * pace, frequency * bend), p, change)
        for k in range(TERMS):
            change[k] *= frequency
    slope = run.loading[run.counts.segment].pressing_rate
    p[1] += slope * pace
    p[2] += 0.5 * slope * bend


@kernel
def before_turn(run: Run, xi_to: float) -> float:
    """Return the place xi_to, or the one before it where the tone of the normal load has turned as far as its series holds."""
    if run.params.pressing_tone == 0.0:
        return xi_to
    phase = phase_at(run, run.state.xi) + LARGEST_TURN / run.params.pressing_frequency
    return min(xi_to, max(xi_at(run, phase), run.state.xi)) if phase < run.state.phase_to else xi_to


@kernel
def press_stages(run: Run, h: float) -> None:
    """Put the normal load at the points of an implicit step of h seconds into its stages."""
    first, phase = own_states(run), phase_at(run, run.state.xi)
    for i in range(NODES_OF_STEP):
        p, rate = pressing_at(run, phase, h * POINT[i])
        run.stage_state[TERMS * first + i], run.stage_state[TERMS * (first + 1) + i] = p, rate


@kernel
def couple(run: Run, before: float, after: float) -> None:
    """Let the state of the law jump with the normal load, from one p to another, as Linker & Dieterich (1992) measured it."""
    if run.params.coupling != 0.0:
        run.state.state_now[0] -= run.params.coupling * math.log((1.0 + after) / (1.0 + before))
