"""What the compiled engine reads and writes: named places in plain arrays.

Loads are differences from the reference strength (static strength at the start), slips differences from the initial slip.
Time is a round trip (`row`) and an offset theta in it; a block has rows too, one period of free oscillation long.
"""

from __future__ import annotations

from enum import IntEnum
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from stickslip.engine.codegen.records import Record
from stickslip.engine.codegen.taylor_series import ORDER

Floats = NDArray[np.float64]
Integers = NDArray[np.int64]

TERMS = ORDER + 1


class Params(Record):
    """The problem's numbers, in SI. Nothing here changes during a run, but `stick_to` under a law of slip and slip rate."""

    row_time: float  # s: a round trip of the slab, a period of the block
    impedance: float  # Z of a slab, damping of a block
    normal: float  # normal stress, or force
    inertia: float  # mass of the contact, or of the block
    stiffness: float  # of a block's spring; 0 for a slab
    reflection: float  # of the driver
    inflow: float  # what a steady driver sends, and how that grows in a second
    inflow_rate: float
    reference: float  # static strength at the start, from which loads are differences
    largest_drop: float
    counts_net: float  # 1 where the law counts net slip, 0 where it counts the path
    static_excess: float
    stick_to: float  # load (minus the reference) at which a contact at rest begins to slip
    ramp: float  # by how much the load at rest grows in a round trip
    tolerance: float  # local error of a step, relative
    smallest_jump: float  # m/s: smaller changes of the slip rate are no shocks
    relative_jump: float
    state_scale: float
    rate_floor: float  # m/s: slip rates below are not resolved
    healed_piece: float  # of the law, where rest heals the contact; -1 where the law remembers all slip
    shortest: float  # s: pieces of load that are shorter are lumped while `Counts.lumps` is set
    tone: float  # of a loading that varies: the inflow has tone sin(tone_frequency t + tone_phase)
    tone_frequency: float
    tone_phase: float


class State(Record):
    """Where the contact is, and the piece of load that it meets."""

    xi: float  # place in the piece of load, from 0 to 1
    slip_now: float  # m, minus the initial slip
    law_slip: float  # m, as the law counts it, minus its initial value
    rate_now: float  # m/s
    load_now: float  # of a block at the end of the period before
    last_step: float  # s: what the error allowed the last step to be
    theta_from: float  # s, offset in the round trip: theta = theta_from + speed xi + bend xi^2
    theta_to: float
    speed: float
    bend: float
    table_slip: float  # law slip at which the branches hold
    fold_rate: float  # m/s, at the moving fold that is approached
    state_now: float  # of the friction law, as its formulas see it
    new_since: float  # offsets between which the present round trip's pieces are not yet, or no longer, in the trees of echoes
    taken_to: float
    amplified: float  # what has become of an error of the load in the present piece
    gain: float  # by how much slip multiplies it
    slip_since: float  # offset at which slip began
    taken: float  # how much of the source of load has been brought, in its xi and as an offset
    taken_to_theta: float
    target: float  # xi up to which a run may slip that waits for others, to take its step side by side with them
    unbalanced: float  # force (Pa or N) that the step at hand ignores by definition, because it leaves rest: see `verify`
    rounded: float  # m/s: rounding that was found in that step where it seemed not to obey the law
    roughest: float  # largest share of the slip rate that rounding in the law has taken, where that is more than the tolerance
    exit: float  # xi at which an algebraic contact leaves its branch (inf: not on this piece); nan where it is not known yet


KEPT = State.places["taken"].first
"""Places of the state that are set aside where another piece of load comes in between."""


class Counts(Record):
    """The state in whole numbers: places in the history, flags, codes."""

    row: int  # round trip, from 0
    source: int  # where the next piece of load comes from
    mode: int  # 0 stuck, +1 slips forwards, -1 backwards
    piece: int  # of the law
    branch: int
    edge: int  # slip begins here, in this direction; 0 elsewhere
    length: int  # pieces of the history
    row_from: int  # first piece of this round trip, and those of the one before
    previous_from: int
    previous_to: int
    moved: int  # there was slip in this round trip
    ready: int  # what has become of the next piece of load: 0, MET or BROUGHT
    jump: int  # the next piece of the history begins with a jump of the slip rate, and why
    cause: int
    echo_of: int
    stuck_rows: int
    stalled: int  # steps that took no time, one after the other
    at_fold: int
    is_block: int
    has_inertia: int
    is_algebraic: int
    arriving: int  # the piece of load begins with a jump, for this cause
    has_state: int
    sticks: int
    stiff: int
    steps: int
    folds_move: int
    knots_in_rate: int
    leaving: int  # a moving branch has ended
    is_locked: int
    to_the_end: int  # the end of the run may cut a piece or a leap, which a longer run would not
    sparse: int  # only echoes that break are met
    behind: int  # roots of the trees of echoes
    ahead: int
    new_from: int  # first piece that is not in them
    lumped: int  # the load was lumped
    slip_row: int  # round trip in which slip began
    tiny: int  # slips beyond resolution, less others
    pause_at: int  # row before which `advance` returns; rows to the pause after it
    pause_for: int
    creep_leaps: int
    varies: int  # the loading; its segment now, and at the end of the row before
    segment: int
    row_segment: int
    waits: int  # explicit steps of slip are left to the caller
    creep_in: int  # round trips with slip that are still to come before `advance` returns for a look at leaps over creep
    lumps: int  # short pieces are lumped; pieces of a round trip above which they are; row since when
    lump_above: int
    lumped_since: int
    rough: int  # steps in which rounding in the law hides more than the tolerance
    breach: int  # why no step can go on from here: OFF_THE_LAW or NEGATIVE_FRICTION; 0 where one can
    degree: int  # of the piece of load: its coefficients beyond are zero


class Series(Record):
    """What a jet receives (see `codegen.taylor_series`), in this order."""

    impedance: float
    normal: float
    chi: float
    speed: float
    bend: float
    slip: float
    offset: float
    inertia: float
    stiffness: float
    rate: float
    free: float
    force: float


NEVER = 2**62
"""No row."""


class Incoming(IntEnum):
    """State what has become of the next piece of load."""

    NONE = 0
    """The last one is done with, and none has been brought yet."""
    MET = 1
    """The contact has met it and moves on it."""
    BROUGHT = 2
    """It is there, and the contact has not answered it."""


class Cause(IntEnum):
    """Name what makes the slip rate jump."""

    NO_CAUSE = 0
    START = 1
    """The run begins in motion."""
    FOLD = 2
    """A branch of slip rates ends, or slip begins on another one than that next to rest."""
    ECHO = 3
    """A jump comes back from the driver."""
    LOADING = 4
    """The loading jumps."""
    HEALING = 5
    """Rest gives the contact its first strength back."""


class Stop(IntEnum):
    """Say why the engine returned."""

    FULL = 0
    """The history has no room for another step."""
    FINISHED = 1
    LOCKED = 2
    """Nothing will ever move the contact again."""
    STORM = 3
    """Events follow each other without any time between them."""
    END_AHEAD = 4
    """What comes next depends on where the run ends: the caller sets `to_the_end`."""
    FAILED = 5
    """A number is not finite."""
    NEED_BRANCHES = 6
    """The caller must put the branches at the present slip into the tables."""
    PAUSED = 7
    """The round trip before which the caller wanted to look has been reached."""
    SLIPS = 8
    """An explicit step of slip is left to the caller, who takes it side by side with others."""
    OFF_THE_LAW = 9
    """No step from here obeys the contact equation."""
    NEED_IMPLICIT_STEPS = 11
    """The caller must lend the implicit steps, which are compiled when they are first needed."""
    NEGATIVE_FRICTION = 10
    """Friction is below zero from here on."""


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

    par: Params
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
