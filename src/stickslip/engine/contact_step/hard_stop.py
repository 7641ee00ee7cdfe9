"""Hard stops of a rigid body: it bounces off with a share of its slip rate, or rests there, and the stop bears what is too much.

Where a load presses the body to a stop, bounces under a restitution below 1 are infinitely many in a finite time. Those at a rate
of at most `Params.least_bounce` are left out, and so are those that carry it less than some hundred roundings of its slip away: the
body then rests at the stop.
"""

from __future__ import annotations

from stickslip.engine.contact.contact_equation import rest_limit, towards
from stickslip.engine.contact.pieces import note_jump
from stickslip.engine.contact.stiffness import turn_states
from stickslip.engine.series.polynomial import evaluate
from stickslip.engine.state.layout import Cause
from stickslip.engine.state.workspace import Run
from stickslip.foundation.kernels.kernels import inlined, kernel


@inlined
def way_to_stop(run: Run) -> float:
    """Return how far (m) the stop is in the direction of slip; inf without one."""
    return run.params.stop_ahead - run.state.slip_now if run.counts.mode > 0 else run.state.slip_now - run.params.stop_behind


@kernel
def meet_stop(run: Run) -> None:
    """Turn the body round at the stop that it has reached, or bring it to rest there."""
    way, bounce = run.counts.mode, run.params.restitution * abs(run.state.rate_now)
    run.state.slip_now = run.params.stop_ahead if way > 0 else run.params.stop_behind
    load = evaluate(run.load, run.state.xi)
    pulled_off = towards(run, load, -way) > rest_limit(run, -way)
    # A hop under a force F goes no farther than m v^2 / (2 F). Slip would not resolve it, and the rate would no longer fall.
    rounded = run.params.least_hop * abs(run.state.slip_now) * way * (load + run.params.reference)
    if pulled_off or (bounce > run.params.least_bounce and bounce * bounce > rounded):
        run.counts.mode = -way
        turn_states(run, run.state.state_now)
    else:
        run.counts.mode, bounce = 0, 0.0
    note_jump(run, -way * bounce, Cause.STOP)
    run.state.rate_now = -way * bounce
