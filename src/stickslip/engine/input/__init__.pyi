# What others take from engine.input. Each name is imported when it is first used; all else is the room's own.

from stickslip.engine.input.branch_table import (
    is_algebraic,  # Return True if the slip rate is a root of the contact equation, on one of its branches.
)
from stickslip.engine.input.forcing import (
    Inflow,  # Straight segments, each with the time (s) of its arrival, plus a tone.
    far_at_first,  # Return the stress behind the last layer, or behind a slab, at the start, minus the reference strength (Pa).
    inflow_of,  # Return the inflow of a problem.
    # Return the rate (m/s) of a machine when the first wave of the run leaves it, and the force of its integral gain (Pa).
    machine_at_first,
    ramp_per_rate,  # Return the growth of the load at rest in one round trip over the rate of the driver (Pa s/m).
    # Return the rate (m/s) that a machine tends to while the contact rests, under the loading that has arrived at times (s).
    settled_rate,
    # Return the wave beta - 2 Z v, minus the reference strength (Pa), that leaves the contact of a slab just before the start.
    wave_before,
)
from stickslip.engine.input.ladder import (
    ladder_of,  # Return the table of `LadderCell` of a problem; an empty one for a body that is uniform.
    sides_of,  # Yield the sides of the contact as they are at the start.
)
from stickslip.engine.input.prepare import (
    SAFETY,  # Local tolerance per step as a share of rtol: leaves the error of a whole run below rtol (see docs/numerics.md).
)

__all__ = [
    "SAFETY",
    "Inflow",
    "far_at_first",
    "inflow_of",
    "is_algebraic",
    "ladder_of",
    "machine_at_first",
    "ramp_per_rate",
    "settled_rate",
    "sides_of",
    "wave_before",
]
