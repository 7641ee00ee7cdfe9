"""The piece of load being worked on, steps into the history, and shocks noted."""

from __future__ import annotations

import math

from stickslip.evolution import layout as at
from stickslip.evolution.compiled import ahead, inlined, kernel
from stickslip.evolution.polynomial import degree, fill
from stickslip.evolution.workspace import DEGREE, REAL, WHOLE, Run

RESOLVED = 1e-12
"""Slips, as a share of a row, of which double precision tells the ends apart well enough."""


@inlined
def theta_at(run: Run, xi: float) -> float:
    """Offset in the round trip at a place in the present piece of load."""
    return run.state[at.THETA_TO] if xi >= 1.0 else run.state[at.THETA_FROM] + xi * (run.state[at.SPEED] + xi * run.state[at.BEND])


@kernel
def xi_at(run: Run, theta: float) -> float:
    """Where in the present piece the offset theta lies."""
    rest = theta - run.state[at.THETA_FROM]
    root = math.sqrt(max(run.state[at.SPEED] * run.state[at.SPEED] + 4.0 * run.state[at.BEND] * rest, 0.0))
    pace = run.state[at.SPEED] + root
    return 2.0 * rest / pace if pace > 0.0 else 0.0


@inlined
def note_degree(run: Run) -> None:
    """A new piece of load: note its degree, beyond which the series of a step is zero too."""
    run.counts[DEGREE] = degree(run.load)
    fill(run.local, 0.0)
    fill(run.seen, 0.0)


@inlined
def record(run: Run, xi_to: float) -> None:
    """Append the step up to xi_to, whose load and rate already stand in the next free row. A step of no length is not kept."""
    xi = run.state[at.XI]
    width = xi_to - xi
    theta_from, theta_to = theta_at(run, xi), theta_at(run, xi_to)
    if theta_to > theta_from:
        n = run.counts[at.LENGTH]
        whole, real = ahead(run.whole, WHOLE * n), ahead(run.real, REAL * n)
        whole[at.S_ROW], whole[at.S_MODE], whole[at.S_PIECE] = run.counts[at.ROW], run.counts[at.MODE], run.counts[at.PIECE]
        whole[at.S_JUMP], whole[at.S_CAUSE], whole[at.S_ECHO_OF] = run.counts[at.JUMP], run.counts[at.CAUSE], run.counts[at.ECHO_OF]
        real[at.S_THETA_FROM], real[at.S_THETA_TO] = theta_from, theta_to
        real[at.S_SPEED] = (run.state[at.SPEED] + 2.0 * run.state[at.BEND] * xi) * width
        real[at.S_BEND] = run.state[at.BEND] * width * width
        real[at.S_SLIP], real[at.S_LAW_SLIP] = run.state[at.SLIP_NOW], run.state[at.LAW_SLIP]
        real[at.S_AMPLIFIED] = run.state[at.AMPLIFIED]
        real[at.S_GAIN] = abs(run.par[at.REFLECTION]) * (run.state[at.GAIN] if run.counts[at.MODE] != 0 else 1.0)
        note_slip(run, n, theta_from)
        run.counts[at.LENGTH] = n + 1
        run.counts[at.JUMP] = run.counts[at.CAUSE] = run.counts[at.STALLED] = 0
    else:
        run.counts[at.STALLED] += 1
    run.state[at.XI] = xi_to


@inlined
def note_slip(run: Run, n: int, theta: float) -> None:
    """Where slip begins, and how many more slips were too short to be resolved than were not."""
    slips, slipped = run.counts[at.MODE] != 0, n > 0 and run.whole[WHOLE * (n - 1) + at.S_MODE] != 0
    if slips and not slipped:
        run.counts[at.SLIP_ROW], run.state[at.SLIP_SINCE] = run.counts[at.ROW], theta
    elif slipped and not slips:
        lasted = (run.counts[at.ROW] - run.counts[at.SLIP_ROW]) * run.par[at.ROW_TIME] + (theta - run.state[at.SLIP_SINCE])
        tiny = lasted < RESOLVED * run.par[at.ROW_TIME]
        run.counts[at.TINY] = run.counts[at.TINY] + 1 if tiny else max(run.counts[at.TINY] - 1, 0)


@inlined
def note_jump(run: Run, rate: float, cause: int) -> None:
    """Mark a shock if the slip rate is about to jump."""
    before = run.state[at.RATE_NOW]
    size = abs(rate - before)
    if size > run.par[at.SMALLEST_JUMP] and size > run.par[at.RELATIVE_JUMP] * max(abs(rate), abs(before)):
        run.counts[at.CAUSE] = cause
        run.counts[at.JUMP] = 1
