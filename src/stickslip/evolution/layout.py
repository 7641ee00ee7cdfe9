"""What the compiled engine reads and writes: named places in plain arrays.

Loads are differences from the reference strength (static strength at the start), slips differences from the initial slip.
Time is a round trip (`row`) and an offset theta in it; a block has rows too, one period of free oscillation long.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from stickslip.evolution.generate import ORDER

Floats = NDArray[np.float64]
Integers = NDArray[np.int64]

TERMS = ORDER + 1

# ---- Setup.par: the problem's numbers ----------------------------------------------------------------------------------------
ROW_TIME, IMPEDANCE, NORMAL, INERTIA, STIFFNESS, REFLECTION, INFLOW, INFLOW_RATE = range(8)
REFERENCE, LARGEST_DROP, COUNTS_NET, STATIC_EXCESS, STICK_TO, RAMP, TOLERANCE, SMALLEST_JUMP, RELATIVE_JUMP = range(8, 17)
PARAMETERS = 17

# ---- state: where the contact is, and the piece of load that it meets -------------------------------------------------------
XI, SLIP_NOW, LAW_SLIP, RATE_NOW, LOAD_NOW, LAST_STEP = range(6)
THETA_FROM, THETA_TO, SPEED, BEND = range(6, 10)  # theta = THETA_FROM + SPEED xi + BEND xi^2, xi from 0 to 1
STATES = 10

# ---- count: the same in whole numbers ---------------------------------------------------------------------------------------
ROW, SOURCE, MODE, PIECE, BRANCH, EDGE, LENGTH, ROW_FROM, PREVIOUS_FROM, PREVIOUS_TO = range(10)
MOVED, READY, JUMP, CAUSE, LEAP, STUCK_ROWS, STALLED, AT_FOLD, IS_BLOCK, HAS_INERTIA, IS_ALGEBRAIC, ARRIVING = range(10, 22)
COUNTS = 22

# ---- the vector k that a jet receives (see `generate`) ----------------------------------------------------------------------
K_IMPEDANCE, K_NORMAL, K_CHI, K_SPEED, K_BEND, K_SLIP, K_OFFSET, K_INERTIA, K_STIFFNESS, K_RATE, K_FREE, K_FORCE = range(12)

# ---- causes of shocks, and why `advance` returned ---------------------------------------------------------------------------
NO_CAUSE, START, FOLD, ECHO, LOADING = range(5)
FULL, FINISHED, LOCKED, STORM, PAUSED, FAILED = range(6)


class Setup(NamedTuple):
    """A problem as the engine sees it; nothing here changes during a run."""

    par: Floats
    value_at: Integers  # address of `value`, for each piece of the law
    jet_at: Integers  # address of `rate_jet` or `motion_jet`
    constants: Floats  # (pieces, size): what `prepare` filled
    slip_shift: Floats  # initial law slip minus the piece's own reference slip
    offset: Floats  # mu(reference of the piece, 0+) - mu_static at the start
    knots: Floats  # law slip at which a piece ends, minus the initial law slip
    rate_from: Floats  # branches of the resistance g(s), and the interval of load in which the rule keeps each
    rate_to: Floats
    keep_from: Floats
    keep_to: Floats
    excess_from: Floats
    excess_to: Floats
    first_theta: Floats  # the load of the first round trip: linear between these
    first_load: Floats
    first_slope: Floats
    first_jump: Integers


class Store(NamedTuple):
    """The history, one entry a piece: load and slip rate as polynomials in xi on [0, 1]."""

    row: Integers
    theta_from: Floats
    theta_to: Floats
    speed: Floats
    bend: Floats
    mode: Integers  # 0 stuck, +1 slips forwards, -1 backwards
    piece: Integers  # of the friction law
    jump: Integers  # whether what leaves the contact jumps where the piece starts
    cause: Integers  # of a shock where the piece starts
    slip: Floats  # at the start, minus the initial slip
    law_slip: Floats
    load: Floats  # (n, TERMS)
    rate: Floats  # (n, TERMS)


class Work(NamedTuple):
    """Scratch space, and the piece of load being worked on."""

    load: Floats  # of the whole piece, in xi
    local: Floats  # of the step at hand, in eta on [0, 1]
    jet: Floats
    rate: Floats
    gap: Floats
    k: Floats
    value: Floats
    kept_load: Floats  # the piece that goes on behind a fold
    kept: Floats


def new_store(capacity: int) -> Store:
    """An empty history with room for so many pieces."""
    floats = {name: np.empty(capacity) for name in ("theta_from", "theta_to", "speed", "bend", "slip", "law_slip")}
    integers = {name: np.empty(capacity, np.int64) for name in ("row", "mode", "piece", "jump", "cause")}
    return Store(**floats, **integers, load=np.empty((capacity, TERMS)), rate=np.empty((capacity, TERMS)))


def resized(store: Store, length: int, capacity: int) -> Store:
    """The first `length` pieces in a history with room for `capacity`."""
    larger = new_store(capacity)
    for old, new in zip(store, larger, strict=True):
        new[:length] = old[:length]
    return larger


def new_work() -> Work:
    """Scratch space for one run."""
    series = [np.zeros(TERMS) for _ in range(6)]
    return Work(*series[:5], k=np.zeros(12), value=np.zeros(3), kept_load=series[5], kept=np.zeros(STATES))


def trimmed(store: Store, length: int) -> Store:
    """The history without its spare room (views, not copies)."""
    return Store(*(array[:length] for array in store))
