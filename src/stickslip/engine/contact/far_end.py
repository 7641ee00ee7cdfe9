"""The far end of a slab, as the contact sees it: the share of a wave that the driver sends back. Kernels ask nowhere else.

Callers first enter the segment of the loading that holds when the wave comes back (`counts.segment`), which sets the share of a
driver that changes. A block has no far end: nothing comes back.
"""

from __future__ import annotations

import math

from stickslip.engine.state.layout import Task
from stickslip.engine.state.workspace import Run
from stickslip.foundation.constants import DEAD_LOAD, RIGID
from stickslip.foundation.kernels.kernels import kernel
from stickslip.foundation.kernels.memory.addresses import call_part


@kernel
def sent_back(run: Run) -> float:
    """Return the factor (1) that a wave has gained on its way back: -1 rigid driver, 0 if nothing comes back, +1 dead load.

    It is -1 for a machine, too: what its own motion sends is added to the echo (`waves.driver`).
    """
    return run.params.reflection


@kernel
def gain_of_echo(run: Run) -> float:
    """Return the factor (1) from the size of an error of a wave to that of its echo; NaN if there is more than one echo."""
    return math.nan if run.counts.driven == 1 or run.counts.cells > 0 else abs(sent_back(run))


@kernel
def is_rigid(run: Run) -> bool:
    """Return True for a slab under a rigid driver: a load at rest comes back whole, plus the same ramp in each round trip."""
    return run.params.reflection == RIGID and is_plain_slab(run)


@kernel
def was_rigid(run: Run) -> bool:
    """Return True if a driver of a loading that varies was rigid in the round trips at rest before this one."""
    return run.loading[run.counts.trip_segment].reflection == RIGID and is_plain_slab(run)


@kernel
def is_plain_slab(run: Run) -> bool:
    """Return True for a slab of one layer whose driver is no machine: each wave comes back once, as it went."""
    return not (run.counts.is_block == 1 or run.counts.driven == 1 or run.counts.cells > 0)


@kernel
def is_dead_load(run: Run) -> bool:
    """Return True for a slab under a dead load: each second round trip at rest is the same."""
    return run.params.reflection == DEAD_LOAD and run.counts.cells == 0


FADED = 1e-17
"""The differences between round trips at rest have faded when they have shrunk to this factor (1), below rounding."""


@kernel
def has_faded(run: Run) -> bool:
    """Return True if the round trips of a slab at rest, but for the ramp, no longer differ: differences fade by |r| in each."""
    if run.counts.cells > 0:
        return call_part(run.ladder, run, Task.IS_SETTLED, 0.0) == 1.0
    return run.counts.trips_at_rest > 0 and abs(run.params.reflection) ** (run.counts.trips_at_rest - 1) < FADED
