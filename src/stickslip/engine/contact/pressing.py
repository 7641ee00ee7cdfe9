"""Normal load that varies in time: two states of the contact that follow from time alone (see `friction.pressed`).

The first is p = S(t) / S(0) - 1, the second its rate of change (1/s). Between breaks of the loading p is a line plus a tone.
"""

from __future__ import annotations

import math

from stickslip.engine.compile.kernels import kernel
from stickslip.engine.contact.pieces import phase_at
from stickslip.engine.series.radau_nodes import POINT, POINTS
from stickslip.engine.state.layout import TERMS
from stickslip.engine.state.workspace import Run


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
    first = run.counts.states - run.counts.given
    run.state.state_now[first], run.state.state_now[first + 1] = pressing_at(run, phase, 0.0)


@kernel
def press_stages(run: Run, h: float) -> None:
    """Put the normal load at the points of an implicit step of h seconds into its stages."""
    first, phase = run.counts.states - run.counts.given, phase_at(run, run.state.xi)
    for i in range(POINTS):
        p, rate = pressing_at(run, phase, h * POINT[i])
        run.stage_state[TERMS * first + i], run.stage_state[TERMS * (first + 1) + i] = p, rate


@kernel
def couple(run: Run, before: float, after: float) -> None:
    """Let the state of the law jump with the normal load, from one p to another, as Linker & Dieterich (1992) measured it."""
    if run.params.coupling != 0.0:
        run.state.state_now[0] -= run.params.coupling * math.log((1.0 + after) / (1.0 + before))
