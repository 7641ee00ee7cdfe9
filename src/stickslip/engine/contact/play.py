"""Backlash: a play between a rigid body and the end of its spring, where the spring gives no force.

The end of the spring has been pulled as far as D. With the lag e = D - u behind it and half the play b, the spring gives K (e - b)
where e > b, K (e + b) where e < -b, and nothing in between. `Counts.side` is 1, -1 and 0 there; `Params.stiffness` is K or 0, and
the load of the engine grows with D or does not. The lag meets an edge of the play where a polynomial has a root. This is a part of
the engine that is compiled when a run first needs it (`on_demand`).
"""

from __future__ import annotations

import math

from stickslip.engine.contact.contact_equation import TIE
from stickslip.engine.contact.pieces import note_degree, phase_at
from stickslip.engine.contact.pressing import tone_along
from stickslip.engine.series.polynomial import NONE, RECIPROCAL, evaluate, fill, first_descent, restrict
from stickslip.engine.state.layout import TERMS, Floats, Task
from stickslip.engine.state.workspace import Run, borrow
from stickslip.foundation.kernels.kernels import entry, kernel
from stickslip.foundation.kernels.memory.addresses import room_for

ROUNDING = 2.0**-48
"""The lag is at an edge if it is nearer to it than this share (1) of the ways that it follows from, or of that in a round trip."""
LEAST_SHARE = 2.0**-60
"""A step ends no nearer to its start than at this share (1) of it: an edge there is met at once."""


@kernel
def way_pulled(run: Run, way: Floats) -> None:
    """Write how far (m) the end of the spring has been pulled since the start, as a polynomial on the present piece of load."""
    params, pace, one = run.params, run.state.speed, run.loading[run.counts.segment]
    time = run.counts.trip * params.round_trip_time + run.state.phase_from
    since = (run.counts.trip - one.trip) * params.round_trip_time + run.state.phase_from - one.offset
    fill(way, 0.0)
    way[0] = one.pulled + since * (one.pull + 0.5 * since * one.pull_slope)
    way[1] = pace * (one.pull + one.pull_slope * since)
    way[2] = 0.5 * pace * pace * one.pull_slope
    if params.pull_tone != 0.0:
        half, sine, cosine = 0.5 * params.tone_frequency * time, room_for(TERMS), room_for(TERMS)
        way[0] += params.pull_tone * 2.0 / params.tone_frequency * math.sin(half) * math.sin(half + params.pull_phase)
        angle = (params.tone_frequency * time + params.pull_phase, params.tone_frequency * pace, 0.0)
        tone_along(params.pull_tone, angle, sine, cosine)
        for k in range(1, TERMS):
            way[k] += pace * RECIPROCAL[k] * sine[k - 1]


@kernel
def lag_at_rest(run: Run, width: float, lag: Floats) -> None:
    """Write the lag (m) of a body that stays where it is, as a polynomial on the next `width` (in xi) of the piece of load."""
    way = room_for(TERMS)
    way_pulled(run, way)
    restrict(way, run.state.xi, width, lag)
    size = abs(run.params.first_lag) + abs(run.state.slip_now) + abs(way[1]) * run.params.round_trip_time / run.state.speed
    for k in range(TERMS):
        size += abs(way[k])
    lag[0] += run.params.first_lag - run.state.slip_now
    if abs(abs(lag[0]) - run.params.play) <= ROUNDING * size:  # it is at the edge, and its slope says where it goes
        lag[0] = math.copysign(run.params.play, lag[0])


@kernel
def place_of_edge(run: Run, lag: Floats) -> float:
    """Return where on [0, 1] a lag (m, a polynomial) passes an edge of the play, or NONE if it does not."""
    margin, spare, side = room_for(TERMS), room_for(TERMS), run.counts.side
    first = NONE
    for way in (1, -1):
        if side in (0, way):
            sign = way if side != 0 else -way
            for k in range(TERMS):
                margin[k] = sign * lag[k]
            margin[0] += run.params.play if side == 0 else -run.params.play
            first = min(first, first_descent(margin, spare))
    return first


@kernel
def lead_to_edge(run: Run, xi_to: float) -> float:
    """Return the place (in xi) up to which a step may go: xi_to, or that where a body at rest meets an edge of the play.

    Where it is at an edge already, it changes its side, and the step goes nowhere. So does a body that slips and was brought beyond
    an edge by rounding as the piece of load before ended.
    """
    lag, width = room_for(TERMS), xi_to - run.state.xi if run.counts.mode == 0 else 0.0
    lag_at_rest(run, width, lag)
    place = place_of_edge(run, lag)
    if not place < 1.0:
        return xi_to
    to = run.state.xi + place * width
    if place * width > TIE and phase_at(run, to) > phase_at(run, run.state.xi):
        return to
    change_side(run)
    return run.state.xi


@kernel
def edge_in_slip(run: Run, length: float) -> float:
    """Return where on [0, 1] a step of slip of the given length (in units) meets an edge of the play, or NONE.

    The magnitude of its slip rate is in the next free row of the history.
    """
    lag, lasting, rate = room_for(TERMS), run.k.speed * length, run.history[run.counts.length].rate
    lag_at_rest(run, lasting / run.state.speed, lag)
    for k in range(1, TERMS):
        lag[k] -= run.counts.mode * lasting * RECIPROCAL[k] * rate[k - 1]
    return max(place_of_edge(run, lag), LEAST_SHARE)


@kernel
def change_side(run: Run) -> None:
    """Take up the play, or let the spring go, where the lag meets an edge; what is left of the piece of load changes its growth."""
    way, lag = room_for(TERMS), room_for(TERMS)
    lag_at_rest(run, 0.0, lag)
    way_pulled(run, way)
    way[0] -= evaluate(way, run.state.xi)
    taken_up = run.counts.side == 0
    run.counts.side = 0 if not taken_up else 1 if lag[0] > 0.0 else -1
    for k in range(TERMS):
        run.load[k] += (run.params.spring if taken_up else -run.params.spring) * way[k]
    run.counts.stalled += 1
    run.counts.moved = 1  # the period that ends is none like which others follow
    run.params.stiffness = run.k.stiffness = run.params.spring if taken_up else 0.0
    note_degree(run)


@kernel
def let_go(run: Run) -> None:
    """Take what the spring would add to a piece of load from it: the body is in the play."""
    way = room_for(TERMS)
    way_pulled(run, way)
    for k in range(1, TERMS):
        run.load[k] -= run.params.spring * way[k]


@kernel
def keeps_side(run: Run) -> bool:
    """Return True if a body at rest stays on its side of the play while this segment of the loading holds."""
    one = run.loading[run.counts.segment]
    return one.pull_slope == 0.0 and run.params.pull_tone == 0.0 and (one.pull == 0.0 or run.counts.side * one.pull > 0.0)


@entry
def play(memory: int, task: int, number: float) -> float:
    """Serve a run with a play: see `Task`. `number` is the place (in xi) up to which a body rests, or the length of a step."""
    run = borrow(memory)
    if task == Task.LEAD_TO_EDGE:
        return lead_to_edge(run, number)
    if task == Task.EDGE_IN_SLIP:
        return edge_in_slip(run, number)
    if task == Task.KEEPS_SIDE:
        return 1.0 if keeps_side(run) else 0.0
    if task == Task.CHANGE_SIDE:
        change_side(run)
    else:
        let_go(run)
    return 0.0
