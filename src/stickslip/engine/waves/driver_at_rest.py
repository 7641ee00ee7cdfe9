"""A driver that is a machine, while the contact rests for long: its steady rate, and how long the contact then stays at rest.

The waves of the slab die against the proportional gain, and the driver tends to a rate Vd that strains the slab evenly:
the stress grows by G Vd / h, which the integral gain and the far stress make up for, G Vd / h = ki (V0 - Vd) + ds/dt.
"""

from __future__ import annotations

import math

from stickslip.engine.contact.contact_equation import limit_towards
from stickslip.engine.contact.far_end import has_faded
from stickslip.engine.state.layout import NEVER
from stickslip.engine.state.workspace import Run
from stickslip.foundation.kernels.kernels import kernel

STILL_MACHINE = 1e-13
"""A machine has settled when the load that its swings send is less than this share of the load and the reference strength (1)."""


@kernel
def settled_rate(run: Run, segment: int) -> float:
    """Return the rate (m/s) that a machine tends to while the contact rests, if its pull rate stays as in a segment."""
    stiffness, gain = spring_before(run), run.params.driver_gain
    return (gain * run.loading[segment].pull + run.loading[segment].slope) / (gain + stiffness)


@kernel
def spring_before(run: Run) -> float:
    """Return the stiffness G/h (Pa/m) of the slab, or of all layers together."""
    return run.params.driver_spring if run.counts.cells > 0 else 2.0 * run.params.impedance / run.params.round_trip_time


@kernel
def ramp_of_machine(run: Run, segment: int) -> float:
    """Return the growth (Pa) of the load in a round trip at rest at that rate."""
    if run.counts.cells > 0:
        return run.params.driver_spring * run.params.round_trip_time * settled_rate(run, segment)
    return 2.0 * run.params.impedance * settled_rate(run, segment)


@kernel
def trips_of_machine(run: Run, limit: float, room: float, top: float, bottom: float) -> int:
    """Return for how many whole round trips a contact at rest stays at rest, but no more than `room`: 0 until the machine settles.

    `limit` is the load (Pa, minus the reference strength) that ends rest; `top` and `bottom` are the largest values of the load and
    of minus the load in the round trip just past. The round trip before that must have been at rest too, because its waves are the
    ones that the machine has met in this one.
    """
    params, segment = run.params, run.counts.segment
    varies = run.loading[segment].pull_slope != 0.0 or run.loading[segment].tone != 0.0
    swings = 2.0 * params.impedance * run.state.driver_swing > STILL_MACHINE * (abs(params.reference) + max(abs(top), abs(bottom)))
    if varies or swings or run.counts.trips_at_rest < 2:
        return 0
    if run.counts.cells > 0 and not has_faded(run):
        return 0
    ramp = ramp_of_machine(run, segment)
    if ramp == 0.0:
        return int(max(room, 0.0))
    free = limit - top if ramp > 0.0 else limit_towards(run, -1, limit) + 2.0 * params.reference - bottom
    trips = min(math.floor(free / abs(ramp)) - 1.0, room)
    return min(int(max(trips, 0.0)), NEVER) if trips < 9e18 else NEVER
