"""What slip takes of the integral term of a position loop: ki Q, with Q the integral of slip over time (see `waves.winding_up`).

Pieces of load of a rigid body are straight in time (`State.bend` is 0).
"""

from __future__ import annotations

from stickslip.engine.state.layout import TERMS, Floats
from stickslip.engine.state.workspace import Run
from stickslip.foundation.kernels.kernels import kernel


@kernel
def feel_slip(run: Run, rate: Floats) -> None:
    """Write the load along slip (`load_ahead`) anew, less what slip at a rate (m/s, a series in its unit) takes of the integral."""
    taken, direction = run.params.winding * run.k.speed * run.k.speed, run.counts.mode
    for k in range(2, TERMS):
        run.load_along_slip[k] = direction * run.local[k] - taken * rate[k - 2] / (k * (k - 1))


@kernel
def unwind(run: Run, rate: Floats, duration: float, grown: float, to: float) -> None:
    """Take ki Q from the load of a step, and the force that goes on to fall by ki q per second from the piece of load after it.

    The slip rate's magnitude `rate` (m/s) and the load in the next free row of the history are polynomials on the step, which lasts
    `duration` (s) and ends at xi = to. `grown` is the slip q (m) in it.
    """
    load, pace, taken = run.history[run.counts.length].load, run.state.speed, run.counts.mode * run.params.winding
    whole = 0.0
    for k in range(TERMS - 1, -1, -1):
        part = taken * duration * duration * rate[k] / ((k + 1) * (k + 2))
        whole += part
        if k + 2 < TERMS:
            load[k + 2] -= part
    run.load[0] -= whole - taken * grown * pace * to
    run.load[1] -= taken * grown * pace
