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
STATE_SCALE, RATE_FLOOR = 17, 18
SHORTEST = 20  # pieces of load that are shorter, s, are lumped while LUMPS is set
HEALED_PIECE = 19  # of the law, where rest heals the contact; -1 where the law remembers all slip
TONE, TONE_FREQUENCY, TONE_PHASE = range(21, 24)  # of a loading that varies: F has TONE sin(TONE_FREQUENCY t + TONE_PHASE)
PARAMETERS = 24

# ---- state: where the contact is, and the piece of load that it meets -------------------------------------------------------
XI, SLIP_NOW, LAW_SLIP, RATE_NOW, LOAD_NOW, LAST_STEP = range(6)
THETA_FROM, THETA_TO, SPEED, BEND = range(6, 10)  # theta = THETA_FROM + SPEED xi + BEND xi^2, xi from 0 to 1
TABLE_SLIP, FOLD_RATE = range(10, 12)  # law slip at which Setup.branch holds; slip rate at the moving fold that is approached
STATE_NOW = 12  # of the friction law, as its formulas see it
NEW_SINCE, TAKEN_TO = 13, 14  # offsets between which the present round trip's pieces are not yet, or no longer, in the trees
AMPLIFIED, GAIN = 15, 16  # what has become of an error of the load in the present piece; by how much slip multiplies it
SLIP_SINCE = 17  # offset at which slip began
KEPT = 18  # of these, what is set aside where another piece comes in between
TAKEN, TAKEN_TO_THETA = 18, 19  # how much of the source of load has been brought, in its xi and as an offset
TARGET = 20  # xi up to which a run may slip that waits for others, to take its step side by side with them
UNBALANCED = 21  # force (Pa or N) that the step at hand ignores by definition, because it leaves rest: see `verify`
ROUNDED = 22  # rounding (m/s) that was found in that step where it seemed not to obey the law
ROUGHEST = 23  # largest share of the slip rate that rounding in the law has taken, where that is more than the tolerance
STATES = 24
assert KEPT <= TERMS  # it is set aside in a row of scratch space

# ---- count: the same in whole numbers ---------------------------------------------------------------------------------------
ROW, SOURCE, MODE, PIECE, BRANCH, EDGE, LENGTH, ROW_FROM, PREVIOUS_FROM, PREVIOUS_TO = range(10)
MOVED, READY, JUMP, CAUSE, ECHO_OF, STUCK_ROWS, STALLED, AT_FOLD, IS_BLOCK, HAS_INERTIA, IS_ALGEBRAIC, ARRIVING = range(10, 22)
HAS_STATE, STICKS, STIFF, STEPS, FOLDS_MOVE, KNOTS_IN_RATE, LEAVING = range(22, 29)
IS_LOCKED, TO_THE_END = 29, 30  # TO_THE_END: the end of the run may cut a piece or a leap, which a longer run would not
SPARSE, BEHIND, AHEAD, NEW_FROM = range(31, 35)  # only echoes that break are met; roots of the trees; first piece not in them
LUMPED, SLIP_ROW, TINY = 35, 36, 37  # the load was lumped; row in which slip began; slips beyond resolution, less others
PAUSE_AT, PAUSE_FOR, CREEP_LEAPS = 38, 39, 40  # row before which `advance` returns; rows to the pause after it; leaps so far
VARIES, SEGMENT, ROW_SEGMENT = 41, 42, 43  # the loading varies; its segment now, and at the end of the row before
WAITS = 44  # explicit steps of slip are left to the caller
CREEP_IN = 45  # round trips with slip that are still to come before `advance` returns for a look at leaps over creep
LUMPS, LUMP_ABOVE, LUMPED_SINCE = 46, 47, 48  # short pieces are lumped; pieces of a round trip above which they are; row since when
ROUGH = 49  # steps with such rounding
BREACH = 50  # why no step can go on from here: OFF_THE_LAW or NEGATIVE_FRICTION; 0 where one can
COUNTS = 51

NEVER = 2**62
"""No row."""

# ---- the vector k that a jet receives (see `generate`) ----------------------------------------------------------------------
K_IMPEDANCE, K_NORMAL, K_CHI, K_SPEED, K_BEND, K_SLIP, K_OFFSET, K_INERTIA, K_STIFFNESS, K_RATE, K_FREE, K_FORCE = range(12)

# ---- READY: what has become of the next piece of load ------------------------------------------------------------------------
MET, BROUGHT = 1, 2

# ---- causes of shocks, and why `advance` returned ---------------------------------------------------------------------------
NO_CAUSE, START, FOLD, ECHO, LOADING, HEALING = range(6)
FULL, FINISHED, LOCKED, STORM, END_AHEAD, FAILED, NEED_BRANCHES, PAUSED, SLIPS, OFF_THE_LAW, NEGATIVE_FRICTION = range(11)


# ---- rows of Setup's tables -------------------------------------------------------------------------------------------------
VALUE_AT, JET_AT, STATE_AT, GUARDS_AT, GUARD_COUNT = range(5)
SLIP_SHIFT, OFFSET, KNOT = range(3)
RATE_FROM, RATE_TO, KEEP_FROM, KEEP_TO, EXCESS_FROM, EXCESS_TO = range(6)
FIRST_THETA, FIRST_LOAD, FIRST_SLOPE, FIRST_JUMP = range(4)
FROM_ROW, FROM_OFFSET, FROM_VALUE, FROM_SLOPE, FROM_JUMP = range(5)

# ---- columns of Store's tables ----------------------------------------------------------------------------------------------
S_ROW, S_MODE, S_PIECE, S_JUMP, S_CAUSE, S_ECHO_OF = range(6)
S_THETA_FROM, S_THETA_TO, S_SPEED, S_BEND, S_SLIP, S_LAW_SLIP, S_AMPLIFIED, S_GAIN = range(8)


class Setup(NamedTuple):
    """A problem as the engine sees it. Nothing here changes during a run, but the branches of a law of slip and slip rate."""

    par: Floats
    address: Integers  # (5, pieces of the law): of `value`, `rate_jet` or `motion_jet`, `state_value`, `guards`; number of guards
    constants: Floats  # (pieces, size): what `prepare` filled for them
    law: Floats  # (3, pieces): slip shift and offset to the piece's reference; law slip (minus the initial one) or rate at its end
    branch: Floats  # (6, branches of the resistance g): rates, loads between which the rule keeps it, loads at its ends
    first: Floats  # (4, pieces + 1): the load of the first round trip, linear between the thetas
    loading: Floats  # (5, segments): row and offset from which each segment of the inflow has arrived, value there, slope, jump


class Store(NamedTuple):
    """The history, one row a piece: load, slip rate and the law's state, if it has one, as polynomials in xi on [0, 1].

    The properties name the columns.
    """

    whole: Integers
    real: Floats
    load: Floats  # (n, TERMS), minus the reference strength
    rate: Floats  # (n, TERMS)
    state: Floats  # (n, TERMS), as the law's formulas see it; (0, TERMS) for a law without one

    @property
    def row(self) -> Integers:
        """Whole round trips before the piece."""
        return self.whole[:, S_ROW]

    @property
    def mode(self) -> Integers:
        """0 stuck, +1 slips forwards, -1 backwards."""
        return self.whole[:, S_MODE]

    @property
    def cause(self) -> Integers:
        """Of a shock where the piece starts, or 0."""
        return self.whole[:, S_CAUSE]

    @property
    def echo_of(self) -> Integers:
        """The piece that comes back from the driver here; -1 in the first round trip, and on a block."""
        return self.whole[:, S_ECHO_OF]

    @property
    def theta_from(self) -> Floats:
        """Offset in the round trip at which the piece starts, s."""
        return self.real[:, S_THETA_FROM]

    @property
    def theta_to(self) -> Floats:
        """Offset at which it ends, s."""
        return self.real[:, S_THETA_TO]

    @property
    def speed(self) -> Floats:
        """theta = theta_from + speed xi + bend xi^2."""
        return self.real[:, S_SPEED]

    @property
    def bend(self) -> Floats:
        """See speed; zero but next to folds."""
        return self.real[:, S_BEND]

    @property
    def slip(self) -> Floats:
        """Slip at the start of the piece, minus the initial slip, m."""
        return self.real[:, S_SLIP]

    @property
    def law_slip(self) -> Floats:
        """Slip that the law counts at the start of the piece, minus its initial value, m."""
        return self.real[:, S_LAW_SLIP]

    @property
    def amplified(self) -> Floats:
        """What has become here of an error of 1 in the load at the start of the run; NaN where that is not known (see `GAIN`)."""
        return self.real[:, S_AMPLIFIED]

    @property
    def gain(self) -> Floats:
        """By how much the echo of an error in the load is larger than the error; NaN where more than the phase decides that."""
        return self.real[:, S_GAIN]


def new_store(capacity: int, has_state: bool = False) -> Store:
    """An empty history with room for so many pieces."""
    load, rate, state = (np.empty((rows, TERMS)) for rows in (capacity, capacity, capacity if has_state else 0))
    return Store(np.empty((capacity, 6), np.int64), np.empty((capacity, 8)), load, rate, state)


def resized(store: Store, length: int, capacity: int) -> Store:
    """The first `length` pieces in a history with room for `capacity`."""
    larger = new_store(capacity, len(store.state) > 0)
    for old, new in zip(store, larger, strict=True):
        new[:length] = old[:length]
    return larger


def trimmed(store: Store, length: int, first: int = 0) -> Store:
    """The history without its spare room, from a piece on (views, not copies)."""
    kept = slice(first, length)
    return Store(store.whole[kept], store.real[kept], store.load[kept], store.rate[kept], store.state[kept])


def keep_only(store: Store, length: int, kept: Integers) -> Integers:
    """Forget all of the first `length` pieces but these, in order of time. Returns where each is now; -1 if it is forgotten."""
    place = np.full(length + 1, -1)  # the last one stands for "none"
    place[kept] = np.arange(len(kept))
    for table in store:
        table[: len(kept)] = table[:length][kept] if len(table) else table[:0]
    store.echo_of[: len(kept)] = place[store.echo_of[: len(kept)]]
    return place
