"""The records and tables that the compiled engine reads and writes: named places in plain arrays.

Loads are differences from the reference strength (the static strength at the start), in Pa for a slab and N for a block. Slips
are differences from the initial slip, in m. A time is a round trip (`trip`) and a phase (s) in it. A block has round trips too:
one period of free oscillation, or longer where it never sticks. The comment beside a field is its definition; a unit of 1 means
a pure number.
"""

from __future__ import annotations

from enum import IntEnum
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from stickslip.engine.formula_code.taylor_series import ORDER
from stickslip.foundation.kernels.memory.records import MemoryRecord, floats_inside
from stickslip.friction.formula import expression

Floats = NDArray[np.float64]
Integers = NDArray[np.int64]

TERMS = ORDER + 1
"""Coefficients of every polynomial and series (1): the orders 0 to ORDER."""
STATES = len(expression.STATES)
"""Largest number of states of a law (1); there is room for as many everywhere."""


class Params(MemoryRecord):
    """Hold the numbers of a problem, in SI.

    They are constant during a run, except `stick_to` under a law of slip and slip rate, `reflection` of a driver that changes, and
    `stiffness` under a play.
    """

    round_trip_time: (
        float  # s: two-way travel time of a slab; length of a round trip of a block (a period, or longer where it never sticks)
    )
    damping: float  # force over slip rate in the contact equation, Pa s/m: radiation damping Z of a slab; N s/m: damping of a block
    impedance: float  # Pa s/m: wave impedance Z of a slab, whose contact sends and receives waves; N s/m: sqrt(K m) of a block
    normal: float  # Pa: normal stress on a slab; N: normal force on a block
    inertia: float  # kg/m^2: mass of a slab's contact, 0 if it has none; kg: mass of a block
    stiffness: float  # N/m: stiffness of a block's spring; 0 for a slab
    reflection: float  # 1: share of a wave that a slab's driver sends back at present, from -1 (rigid) to +1 (dead load)
    inflow: float  # Pa: load that a slab's steady driver sends, at t = 0; 0 for a loading that varies
    inflow_rate: float  # Pa/s: growth of that inflow
    reference: float  # Pa or N: reference strength (static strength at the start); loads are measured from it
    largest_drop: float  # Pa or N: reference strength minus the least friction of the law, or 0 if that is negative
    can_be_negative: float  # 1 if the law is not known to stay above zero, else 0
    counts_net: float  # 1 if the law counts net slip, 0 if it counts the path
    static_excess: float  # 1: static friction coefficient minus that of sliding at slip rate 0
    stick_to: float  # Pa or N: load that ends rest, minus the static strength at the present slip; never above 0
    backward_piece: float  # first piece of the law that holds in backward slip; 0 if all hold both ways
    backward_branch: float  # first row of the table of branches that holds in backward slip; 0 if all hold both ways
    backward_excess: float  # 1: `static_excess` in backward slip, where the law differs
    backward_stick_to: float  # Pa or N: `stick_to` in backward slip, where the law differs
    ramp: float  # Pa or N: growth of the load at rest in one round trip; 0 for a loading that varies
    tolerance: float  # 1: local error allowed to a step, relative to the slip rate
    first_disc: float  # disc on which the run tries to prove its first step, as an index of `contact_step.certificate.RATIOS`
    smallest_jump: float  # m/s: changes of the slip rate up to this size are not noted as shocks
    relative_jump: float  # 1: nor are changes up to this share of the slip rate
    rate_floor: float  # m/s: errors of an implicit step are relative to the slip rate, or to this if it is larger
    healed_piece: float  # piece of the law that holds after healing, for a law that forgets slip at an arrest; else -1
    shortest: float  # s: pieces of load shorter than this are lumped while `Counts.lumps` is set
    tone_frequency: float  # rad/s: angular frequency of the tone in an inflow (`LoadingSegment.tone`)
    inflow_from: float  # s: an inflow is added from this phase of the first round trip on: h/c, or 0 for a slab on moving ground
    pressing_tone: float  # 1: amplitude of the tone in the normal load, as a share of that at t = 0 (`contact.pressing`)
    pressing_frequency: float  # rad/s: angular frequency of that tone
    pressing_phase: float  # rad: phase of that tone at t = 0
    driver_inertia: float  # kg/m^2: mass of a driver that is a machine (`waves.driver`)
    driver_impedance: float  # Pa s/m: its proportional gain
    driver_gain: float  # Pa/m: its integral gain
    driver_spring: float  # Pa/m: stiffness of all layers before it, of a body of layers
    damper_pace: float  # 1/s: how fast the damper of a column takes up what it meets (`waves.damper`); 0 of any other driver
    damper_share: float  # 1: share of a sharp front that it sends back
    pull_share: float  # m/(Pa s): tone of its pull rate over the tone of its drive
    winding: float  # N/(m s): integral gain of a position loop (`contact.winding`); 0 of any other body
    first_lag: float  # m: how far slip is behind the reference of a position loop, or the end of a spring with play, at the start
    pull_tone: float  # m/s: amplitude of a tone in the rate of that reference, or of that end
    pull_phase: float  # rad: phase of that tone at t = 0
    stop_ahead: float  # m: slip where a hard stop bars the way forwards (`contact_step.hard_stop`); inf without one
    stop_behind: float  # m: slip where another bars the way backwards; -inf without one
    restitution: float  # 1: share of the slip rate with which a body bounces off a stop
    least_bounce: float  # m/s: a body that would bounce off at no more than this rate stays at the stop
    least_hop: float  # 1/kg: twice the share of the way to a stop below which a hop off it is rounding, over the inertia
    play: float  # m: half the backlash between a rigid body and its spring (`contact.play`); 0 without
    spring: float  # N/m: stiffness of that spring, where `stiffness` is 0 in the play
    slow: float  # m/s: a block whose slip rate stays below this creeps; 0 for a slab
    coupling: float  # 1: how far a state falls as the normal load grows by a factor e (Linker & Dieterich 1992: alpha / b)
    state_scale: Floats = floats_inside(STATES)  # units of the states: sizes below which errors are no longer relative


class State(MemoryRecord):
    """Hold the place and motion of the contact, and the piece of load that it meets."""

    xi: float  # 1: place in the present piece of load, from 0 to 1
    slip_now: float  # m: slip, minus the initial slip
    law_slip: float  # m: slip as the law counts it, minus its initial value
    rate_now: float  # m/s: slip rate, with its sign
    load_now: float  # N: load of a block at the end of the period before, minus the reference strength
    last_step: float  # s: length that the error allowed the last step to have
    phase_from: float  # s: phase at the start of the piece of load; phase = phase_from + speed xi + bend xi^2
    phase_to: float  # s: phase at the end of the piece of load
    speed: float  # s: dphase/dxi at xi = 0
    bend: float  # s: coefficient of xi^2 in the phase, 0 except next to folds
    table_slip: float  # m: law slip (minus its initial value) of the present table of branches
    fold_rate: float  # m/s: magnitude of the slip rate at the moving fold that the contact approaches
    state_now: Floats = floats_inside(STATES)  # units of the states: state variables of the law, as its formulas see them
    new_since: float  # s: pieces of the present round trip from this phase on are in no tree of echoes yet
    taken_to: float  # s: echoes of earlier round trips up to this phase have been taken out of the tree that is ahead
    amplified: float  # 1: size in the present piece of load of an error of 1 in the load at the start; NaN if not known
    gain: float  # 1: the last step of slip multiplies an error of the load by abs(2 Z / g' - 1); NaN if not known
    slip_since: float  # s: phase when slip began, in round trip `Counts.slip_trip`
    taken: float  # 1: how far (xi) a varying loading has delivered the present source piece; 0 if a new source piece is next
    taken_to_phase: float  # s: phase that belongs to `taken`
    target: float  # 1: in a step beside other runs, a waiting run may slip up to this xi
    unbalanced: float  # Pa or N: force that the step at hand ignores by definition, because it leaves rest
    residual: float  # Pa or N: bound on the residual of the contact equation in the step at hand (`contact_step.certificate`)
    largest_residual: float  # Pa or N: largest such bound of any step so far
    slid: float  # s: time of slip so far, without what is left to the caller
    slid_unproven: float  # s: time of slip so far in steps without a bound
    missed: float  # Pa or N: largest residual that was measured at places of these steps
    roughest: float  # 1: largest error of the slip rate by rounding in the law, relative, in any rough step (`Counts.rough`)
    exit: float  # 1: xi where an algebraic contact leaves its branch; inf if not on this piece, NaN if not known yet
    hanging: float  # m/s: slip rate below which a contact with bristles hangs in them; 0 under any other law
    driver_rate: float  # m/s: rate of a driver that is a machine, h/c before its wave reaches the end of the present piece of load
    driver_push: float  # Pa: force of its integral gain then
    driver_swing: float  # m/s: bound on how far its rate has been from that of a long rest, in this round trip
    merge_within: float  # Pa: change of a wave that merging pieces is allowed in this round trip (`waves.merged_pieces`)
    merged_now: float  # Pa: largest such change in this round trip
    merged_in_all: float  # Pa: sum of those of all round trips before
    table_pressing: float  # 1: growth of the normal load (`contact.pressing`) of the present table of branches
    shifted: float  # m: sum of the bounds on how far slip is off within merged strips of creep (`waves.merged_creep`)


SAVED = State.places["taken"].first
"""Number of leading fields of `State` that are set aside with the piece of load while a side piece next to a fold replaces it."""


class Counts(MemoryRecord):
    """Hold the whole numbers of the state: places in the history, flags, codes."""

    trip: int  # present round trip, from 0
    source: int  # index of the next piece of load: of the first load (round trip 0, block), else counted from `previous_from`
    mode: int  # 0 at rest, +1 in forward slip, -1 in backward slip
    piece: int  # piece of the law that holds
    branch: int  # branch on which an algebraic contact slips, as an index of the table of branches
    leaving_rest: int  # +1 or -1: the load is exactly where slip in this direction begins, or a branch was just left; else 0
    length: int  # number of pieces in the history
    trip_from: int  # first piece of the history in this round trip
    previous_from: int  # first piece of the history in the last round trip that was recorded before this one
    previous_to: int  # first piece after that round trip
    moved: int  # 1 if there was slip in this round trip
    ready: int  # progress of the next piece of load, as a code of `Incoming`
    jump: int  # 1 if load or slip rate jumps where the next piece of the history begins
    cause: int  # cause of the shock there, as a code of `Cause`; 0 if the slip rate does not jump
    echo_of: int  # piece of the history whose echo the present piece of load is; -1 if it is none
    trips_at_rest: int  # number of round trips at rest that were closed since the last slip; -1 after a break of the loading
    stalled: int  # number of steps in a row that took no time, with changes of branch
    at_fold: int  # kind of side piece next to a fold, as a code of `NearFold`
    is_block: int  # 1 for a block, 0 for a slab
    has_inertia: int  # 1 if the contact has mass, so that its slip rate cannot jump
    is_algebraic: int  # 1 if the slip rate is a root of the contact equation: no mass, a law of slip rate, no state of its own
    arriving: int  # cause of a jump at the start of the present piece of load, as a code of `Cause`; 0 without a jump
    states: int  # number of state variables of the law
    reverses: int  # sum of 2^n over the numbers n of the states that change their sign where slip reverses
    sticks: int  # 1 if the law knows rest
    stiff: int  # 1 while a contact with mass is stiff and takes implicit steps
    steps: int  # number of explicit steps since slip last began from rest
    folds_move: int  # 1 if the branches change with slip, or at present with the normal load
    knots_in_rate: int  # 1 if the knots of the law are slip rates, 0 if they are slips
    branch_ended: int  # 1 if a moving branch has ended and the next one has not been chosen yet
    is_locked: int  # 1 if no load to come can move the contact
    to_the_end: int  # 1 if the end of the run may cut a piece or a leap, as it would not do in a longer run
    sparse: int  # 1 if the contact meets only echoes that may make it slip (`waves.echo_queue`)
    behind: int  # root of the tree of echoes that the round trip has passed, or -1
    ahead: int  # root of the tree of echoes that it has yet to meet, or -1
    new_from: int  # first piece of the history that is in no tree yet
    lumped: int  # 1 if the present piece of load was replaced by its mean
    slip_trip: int  # round trip when slip last began
    unresolved_slips: int  # number of slips too short to be resolved, less the number of other slips, never below 0
    pause_at: int  # `run_until` returns before this round trip
    pause_for: int  # number of round trips that the next pause waits, set by the caller
    creep_leaps: int  # number of leaps over creep so far
    varies: int  # 1 if the loading varies in time other than as a ramp
    one_way: int  # 1 if the contact never slips backwards
    segment: int  # segment of the loading that holds at present
    trip_segment: int  # segment of the loading at the end of the round trip before
    waits: int  # 1 if explicit steps of slip are left to the caller
    creep_in: int  # number of round trips with slip before `run_until` pauses for a look at leaps over creep; none if not above 0
    lumps: int  # 1 if short pieces of load are lumped
    lump_above: int  # lumping begins when a round trip has more pieces than this
    lumped_since: int  # short pieces are lumped from this round trip on
    unproven: int  # number of implicit steps without a bound
    disc: int  # disc of the last explicit step's proof, as an index of `contact_step.certificate.RATIOS`
    rough: int  # number of steps where rounding in the law hides more than the tolerance
    breach: int  # OFF_THE_LAW, NEGATIVE_FRICTION or FAILED if no step can be made from here, else 0
    given: int  # number of states, the last ones, that follow from time alone (`contact.pressing`)
    driven: int  # 1 if the driver is a machine (`waves.driver`)
    side: int  # side of the play on which the spring pulls (1) or pushes (-1), 0 inside it or without one
    driver_trip: int  # round trip up to which a machine has been followed
    degree: int  # degree of the present piece of load: its coefficients beyond are zero
    cells: int  # number of cells of a body of layers (`waves.ladder`); 0 for any other body
    first_side: int  # number of those on the first side of the contact
    slots: int  # number of waves in a row of these: one for each cell, and the rate of a driver that is a machine
    joined: int  # 1 if both sides move with the contact, as the two parts of a bowed string; 0 if slip is between them
    wave_shift: int  # row of waves of piece n: n + wave_shift, modulo their number
    folds_follow_slip: int  # 1 if the branches change with slip
    merging: int  # 1 if pieces of waves are merged in this round trip (`waves.merged_pieces`)
    merged: int  # number of pieces whose waves are the present piece of load, if they were merged; else 0
    merged_from: int  # first of them, in creep beside rest (`waves.merged_creep`)
    merged_as: int  # their form (`waves.merged_pieces`)
    smooth_to: int  # first piece of the round trip before that does not follow without a jump, as far as is known
    merge_guess: int  # number of pieces that are first tried as one
    merge_above: int  # they are merged when a round trip has more pieces than this
    merge_at: int  # and in this round trip, if not before


class SeriesInput(MemoryRecord):
    """Hold the input of a law's compiled series (`taylor_series`); generated code reads it by number, k[0], k[1], ..."""

    damping: float  # k[0], Pa s/m or N s/m: as in `Params`
    normal: float  # k[1], Pa or N: as in `Params`
    chi: float  # k[2], +1 or -1: change of the law's slip over the slip q in the direction of motion
    speed: float  # k[3], s: A in dt/deta = A + B eta, where eta is the distance in xi in units of the series
    bend: float  # k[4], s: B there, not 0 only next to folds (2 `State.bend` times the square of that unit)
    slip: float  # k[5], m: law slip at the start of the step, minus the reference slip of the piece of the law
    offset: float  # k[6], 1: sliding friction coefficient at that reference, minus the static coefficient at the start of the run
    inertia: float  # k[7], kg/m^2 or kg: as in `Params`
    stiffness: float  # k[8], N/m: as in `Params`
    rate: float  # k[9], m/s: magnitude of the slip rate at the start of the step
    free: float  # k[10], 0 if the contact leaves rest exactly at its strength (no net force by definition), else 1
    force: float  # k[11], Pa or N: the net force if `free` is 0 (the step from static to sliding friction); else 0


class Ball(MemoryRecord):
    """Hold the input and output of a law's compiled radii (`balls`); generated code reads it by number, k[0], k[1], ..."""

    slip: float  # k[0], m: radius of the disc of the law slip
    rate: float  # k[1], m/s: radius of that of the slip rate
    state: Floats = floats_inside(STATES)  # from k[2] on, units of the states: radii of those of the states
    friction: float  # 1: result, how far mu may be from its value at the centre
    change: Floats = floats_inside(STATES)  # units of the states over s: the same for their rates of change
    at_slip: float  # m: law slip at the centre, minus the reference slip of the piece of the law; this and what follows for `balls`
    at_rate: float  # m/s: slip rate at the centre
    at_state: Floats = floats_inside(STATES)  # units of the states: states at the centre


NO_DISC = -1
"""`Counts.disc` before the engine has begun a run."""
NEVER = 2**62
"""Number of a round trip that never comes."""


class Incoming(IntEnum):
    """State the progress of the next piece of load."""

    NONE = 0
    """The last piece is used up, and the next one has not been brought yet."""
    MET = 1
    """The contact has met the piece and moves along it."""
    BROUGHT = 2
    """The piece has been brought, and the contact has not responded to it yet."""


class Cause(IntEnum):
    """Name what makes the slip rate jump."""

    NO_CAUSE = 0
    START = 1
    """The run begins in motion."""
    FOLD = 2
    """A branch of slip rates ends, or slip begins on a branch other than the one next to rest."""
    ECHO = 3
    """A jump of the load comes back from the driver."""
    LOADING = 4
    """The loading jumps."""
    HEALING = 5
    """Rest gives the contact its initial strength back."""
    STOP = 6
    """The body meets a hard stop."""


class NearFold(IntEnum):
    """Name the kinds of side pieces next to a fold (`folds.fold`)."""

    NONE = 0
    APPROACHING = 1
    """The side piece ends at the fold."""
    DEPARTING = 2
    """It starts at the fold."""
    PASSING = 3
    """The branch has ended before the side piece did; its rest is walked like any other piece."""


class StepEvent(IntEnum):
    """Name the events that end a step of slip early. If two coincide, the lower number counts."""

    NONE = 0
    ARREST = 1
    """The slip rate reaches zero."""
    KNOT = 2
    """Slip, or the slip rate, reaches a knot of the law."""
    STOP = 3
    """Slip reaches a hard stop."""
    EDGE = 4
    """The lag of slip meets an edge of the play."""


class EnginePart(IntEnum):
    """Name the parts of the engine that are compiled apart (`on_demand`)."""

    NONE = 0
    IMPLICIT_STEPS = 1
    LOADING_HISTORY = 2
    ECHO_QUEUE = 3
    MOVING_FOLDS = 4
    DRIVER = 5
    LADDER = 6
    FOLDS = 7
    NEGATIVE_FRICTION = 8
    PLAY = 9


class Task(IntEnum):
    """Name the tasks of the parts of the engine that are compiled apart (`on_demand`)."""

    SLIP_IMPLICITLY = 0
    """Slip for one implicit step."""
    ENTER_SEGMENT = 1
    """Enter the segment of the loading that has arrived where the piece of load begins."""
    TAKE_LOADING = 2
    """Cut the piece of load where the loading breaks, and add the loading to it."""
    COUNT_TRIPS_AT_REST = 3
    """Find for how many round trips a contact at rest withstands the loading."""
    NEXT_ECHO = 4
    """Find the next echo that must be met."""
    END_TRIP = 5
    """Close a round trip that meets only such echoes."""
    BUILD_QUEUE = 6
    """Build the queue of echoes."""
    LOOK_FOR_FOLD = 7
    """Find the way to the moving fold into which the series runs."""
    DRIVE = 8
    """Add what a driver that is a machine sends, and cut the piece of load where its series would not be exact enough."""
    CROSS_CELLS = 9
    """Let the waves of a body of layers cross two cells, and bring what arrives at the contact."""
    SEND_IN = 10
    """Put a piece of inflow, which stands in place of the load, among these waves, and bring what arrives at the contact."""
    CUT_WAVES = 11
    """Restrict these waves to a part of the piece of load."""
    KEEP_WAVES = 12
    """Keep these waves, and the one that leaves the contact, with the piece of the history that is being recorded."""
    SHARE_DESCRIBED = 13
    """Find the share of the way back from a fold on which the waves can be written in the root of time."""
    WAVES_TO_FOLD = 14
    WAVES_FROM_FOLD = 15
    WAVES_GO_ON = 16
    """Set the waves aside and write them in the root of time, before or behind a fold; take them up again."""
    IS_SETTLED = 17
    """Find whether the waves of each round trip at rest are those of the one before, but for the ramp."""
    STICK_WITH_STATE = 18
    """Take a step at rest, if the state of the law still changes there."""
    PRESS_AHEAD = 19
    """Write the series of a normal load that changes."""
    APPROACH_FOLD = 20
    STRAIGHT_TO_FOLD = 21
    DEPART_FROM_FOLD = 22
    STRAIGHT_FROM_FOLD = 23
    LEAVE_FOLD = 24
    """Lead slip to a fold or away from it (`folds.fold`)."""
    LOOK_BELOW_ZERO = 25
    """Find whether friction falls below zero in an explicit step."""
    PLAN_MERGING = 26
    """Decide whether pieces of waves are merged in the round trip that begins."""
    GATHER_WAVES = 27
    """Bring the wave that left a uniform body with a piece of the history, and with those behind it that merge with it."""
    LEAD_TO_EDGE = 28
    EDGE_IN_SLIP = 29
    CHANGE_SIDE = 30
    LET_GO = 31
    KEEPS_SIDE = 32
    """Find edges of a play and pass them, take the spring from a piece of load, find whether rest lasts (`contact.play`)."""


# ---- records in tables ------------------------------------------------------------------------------------------------------


class LawPiece(MemoryRecord):
    """Hold one piece of the friction law: the functions of its formula, its reference slip, and the knot at its end."""

    value_at: int  # address of `value`; 0 for a law with a state, which has the next but one instead
    jet_at: int  # address of `rate_jet` or `motion_jet`; 0 for a law with a state of its own
    state_at: int  # address of `state_value`; 0 for a law without a state
    radii_at: int  # address of `radii`, for explicit steps; 0 for a law with a state of its own
    balls_at: int  # address of `balls`, for implicit steps; 0 if they are not needed
    slip_shift: float  # m: initial slip of the law minus the reference slip of the piece
    offset: float  # 1: sliding friction coefficient at that reference, minus the static coefficient at the start of the run
    knot: float  # m (minus the initial slip of the law) or m/s: end of the piece; inf for the last one


class BranchRow(MemoryRecord):
    """Hold one branch of the contact equation: slip rates between which g(v) = Z v + S mu rises, and the loads that keep it.

    Loads are in Pa, minus the reference strength. The rule never takes a branch with keep_from > keep_to.
    """

    rate_from: float  # m/s
    rate_to: float  # m/s; inf for the fastest branch
    keep_from: float  # Pa: the selection rule keeps the branch from this load on
    keep_to: float  # Pa: and up to this load
    excess_from: float  # Pa: g at rate_from
    excess_to: float  # Pa: g at rate_to


class FirstLoad(MemoryRecord):
    """Hold one piece of the load of the first round trip, which is linear; the last record only holds the end, in `phase`."""

    phase: float  # s: phase at the start of the piece
    load: float  # Pa or N, minus the reference strength
    slope: float  # Pa/s or N/s
    jump: float  # 1 if the load jumps there, else 0


class LoadingSegment(MemoryRecord):
    """Hold one straight segment of a loading that varies: the inflow of a slab (Pa), the growth of a block's load (N/s)."""

    trip: float  # round trip of the segment's arrival at the contact
    offset: float  # s: phase of its arrival
    value: float  # inflow there; of a machine the force that drives it, kp V0 + far stress, minus the reference strength (Pa)
    slope: float  # its growth per second
    pull: float  # m/s: pull rate V0 of a machine, of a position loop, or of a spring with play, there, but for its tone
    pull_slope: float  # m/s^2: how fast it grows
    pulled: float  # m: way of that loop's reference, or of that spring's end, since the start, but for its tone; its rate is `pull`
    jump: float  # 1 if the inflow or the normal load jumps there, else 0
    pressing: float  # 1: growth of the normal load since t = 0 there, but for its tone, as a share of that at t = 0
    pressing_rate: float  # 1/s: how fast it grows
    curve: float  # Pa/s^2: half the second derivative of a slab's inflow
    step: float  # N: by how much the load of a block jumps where the segment begins
    tone: float  # Pa (slab) or N/s (block): amplitude of a tone in the inflow, tone sin(tone_frequency t + tone_phase)
    tone_phase: float  # rad: phase of the tone at t = 0
    shakes: float  # 1 while the ground under a slab or layers moves, or its motion is on its way back in a slab, else 0
    reflection: float  # 1: `Params.reflection` while the segment holds
    ground: float  # m/s: velocity of the ground under layers there, but for its tone (`waves.shaken_ladder`); see also `damper`
    ground_slope: float  # m/s^2: how fast it grows
    ground_curve: float  # m/s^3: half its second derivative
    ground_tone: float  # m/s: amplitude of its tone, ground_tone sin(tone_frequency t + ground_phase)
    ground_phase: float  # rad: phase of that tone at t = 0


class LadderCell(MemoryRecord):
    """Hold one cell of a body of layers (`waves.ladder`); loads are minus the reference strength."""

    impedance: float  # Pa s/m
    reflection: float  # 1: share of a wave from the contact that comes back at the far end of the cell
    reflection_beyond: float  # 1: share of a wave towards the contact that goes back there; -`reflection` where there is no drag
    is_last: float  # 1 if a driver is there, else 0
    pulled: float  # 1: share in this driver's inflow of an inflow that varies; 0 without a driver
    inflow: float  # Pa: what a steady driver sends, at t = 0; 0 without one
    inflow_rate: float  # Pa/s: how fast it grows
    inflow_before: float  # Pa: what a driver sends that keeps the initial state as it is, and reflects all
    wave: float  # Pa: wave that left the even place of the cell one round trip before t = 0
    growth: float  # Pa/s: how fast it grew
    ramp_share: float  # 1: how much it grows with the ramp of the load at rest; below 0 if it leaves the contact


class HistoryPiece(MemoryRecord):
    """Hold one piece of the history: a step of the contact, with load and slip rate as polynomials in xi on [0, 1]."""

    trip: int  # whole round trips before the piece
    mode: int  # 0 at rest, +1 in forward slip, -1 in backward slip
    law_piece: int  # piece of the law that holds
    jump: int  # 1 if load or slip rate jumps where the piece begins
    cause: int  # cause of the shock there, as a code of `Cause`; 0 if there is none
    echo_of: int  # piece whose echo is the load; -1 in the first round trip and on a block
    phase_from: float  # s: phase at its start; phase = phase_from + speed xi + bend xi^2
    phase_to: float  # s: phase at its end
    speed: float  # s
    bend: float  # s: zero except next to folds
    slip: float  # m: slip where it begins, minus the initial slip
    law_slip: float  # m: slip that the law counts there, minus its initial value
    amplified: float  # 1: size in this piece of an error of 1 in the load at the start of the run; NaN if not known (see `gain`)
    gain: float  # 1: factor from an error in its load to its echo; NaN if it depends on more than the phase
    residual: float  # Pa or N: bound on the residual of the contact equation on the piece (`contact_step.certificate`)
    load: Floats = floats_inside(TERMS)  # Pa or N, minus the reference strength
    rate: Floats = floats_inside(TERMS)  # m/s, with its sign


class EchoNode(MemoryRecord):
    """Hold a node of the trees of echoes (`waves.echo_queue`): node n belongs to piece n of the history."""

    left: int  # child whose pieces begin before this one, or -1
    right: int  # child whose pieces begin after it, or -1
    first_up: int  # piece of the subtree that breaks first in forward slip
    first_down: int  # piece of the subtree that breaks first in backward slip
    trip: int  # round trip of the piece
    rank: int  # priority in the tree
    phase: float  # s: phase at the start of the piece
    high: float  # Pa: largest value of its echo, minus the reference strength, without the ramp
    low: float  # Pa: largest value of minus its echo


# ---- scratch space ----------------------------------------------------------------------------------------------------------


class LawValue(MemoryRecord):
    """Hold what a law's formula returns: the friction coefficient and, for a law with states, their rates of change."""

    mu: float  # 1: friction coefficient minus that at the reference of the piece of the law
    by_rate: float  # s/m: its derivative with respect to slip rate
    by_slip: float  # 1/m: with respect to slip
    by_state: Floats = floats_inside(STATES)  # with respect to each state; this and all that follows only for a law with states
    change: Floats = floats_inside(STATES)  # rate of change of each state, in 1/s times its unit
    change_by_rate: Floats = floats_inside(STATES)
    change_by_slip: Floats = floats_inside(STATES)
    change_by_state: Floats = floats_inside(STATES * STATES)  # a row for each state: with respect to each state


class Friction(MemoryRecord):
    """Hold friction at the contact, as `contact_equation.friction_at` writes it."""

    stress: float  # Pa or N: S times `coefficient`
    by_rate: float  # Pa s/m or N s/m: its derivative with respect to slip rate
    by_slip: float  # Pa/m or N/m: its derivative with respect to slip
    coefficient: float  # 1: friction coefficient minus the static one at the start of the run


class Between(MemoryRecord):
    """Hold the polynomials of an implicit step at one place between its points; derivatives are with respect to that place."""

    rate: float  # m/s
    acceleration: float  # m/s: derivative of the slip rate
    walked: float  # m/s: integral of the slip rate
    state: Floats = floats_inside(STATES)  # units of the states
    evolved: Floats = floats_inside(STATES)  # units of the states: their derivatives


class StepProof(MemoryRecord):
    """Hold what is to be proven of an implicit step, and what has been found on the part of it that was looked at last."""

    duration: float  # s: of the step
    force: float  # Pa or N: the part of the load that the step ignores
    rate_allowed: float  # m/s at slip, Pa or N at rest: allowed error of the slip rate, or of the strength
    rate_rounding: float  # the same unit: rounding of the defect, which counts as nothing
    width: float  # 1: length of the part, as a share of the step
    walked: float  # m: slip from the start of the step to the middle of the part
    measured: float  # Pa or N: largest residual at places of the part
    hidden: float  # Pa or N: bound on the residual between these places, beyond what is measured
    bound: float  # Pa or N: largest bound on the residual of any part so far
    proven_to: float  # 1: place up to which the step is proven
    lacks_bound: float  # 1 if a part has no bound, because the law is singular where the slip rate is zero
    rate_yields: float  # m/s over Pa or N, or 1 at rest: error of the slip rate, or of the strength, per residual
    state_allowed: Floats = floats_inside(STATES)  # units of the states: allowed errors
    state_rounding: Floats = floats_inside(STATES)  # units of the states: rounding of the defect
    state_measured: Floats = floats_inside(STATES)  # units of the states over s: as `measured`, for the rates of change
    state_hidden: Floats = floats_inside(STATES)  # units of the states over s: as `hidden`
    state_yields: Floats = floats_inside(STATES)  # s: error of each state per residual


# ---- a problem and its history ----------------------------------------------------------------------------------------------


class Setup(NamedTuple):
    """Hold a problem as the engine sees it. It is constant during a run, except the branches of a law of slip and slip rate."""

    params: Params
    law: Integers  # table of LawPiece
    constants: Floats  # (pieces of the law, size): constants from the formula's `prepare`
    branches: Floats  # table of Branch
    first_load: Floats  # table of FirstLoad
    loading: Floats  # table of LoadingSegment
    ladder: Floats  # table of LadderCell


class Store(NamedTuple):
    """Hold a history. Each field of `HistoryPiece` is an attribute too: a view of the table, with one entry for each piece."""

    pieces: Integers  # table of HistoryPiece
    state: Floats  # (n, states, TERMS): states of the law, as its formulas see them; no rows for a law without a state

    def __getattr__(self, field: str) -> Any:
        return getattr(HistoryPiece.of(self.pieces), field)


def new_store(capacity: int, states: int = 0) -> Store:
    """Return an empty history with room for `capacity` pieces."""
    return Store(HistoryPiece.table(capacity), np.zeros((capacity if states else 0, states, TERMS)))


def resized(table: NDArray[Any], length: int, capacity: int) -> NDArray[Any]:
    """Return the first `length` rows of a table in a new one with room for `capacity`; a table without rows stays so."""
    larger = np.zeros((capacity if len(table) else 0, *table.shape[1:]), table.dtype)
    larger[:length] = table[:length]
    return larger


def resized_store(store: Store, length: int, capacity: int) -> Store:
    """Return the first `length` pieces in a new history with room for `capacity`."""
    return Store(resized(store.pieces, length, capacity), resized(store.state, length, capacity))


def trimmed(store: Store, length: int, first: int = 0) -> Store:
    """Return the pieces from `first` to `length` - 1 of a history without its spare room, as views."""
    return Store(store.pieces[first:length], store.state[first:length])


def keep_only(store: Store, length: int, kept: Integers) -> Integers:
    """Keep only the given ones, in order of time, of the first `length` pieces of a history.

    Return the new index of each old piece, or -1 if it was dropped; the last entry, for no piece, is -1, too.
    """
    place = np.full(length + 1, -1)  # an `echo_of` of -1 reads the last entry, and so stays -1
    place[kept] = np.arange(len(kept))
    for table in store:
        table[: len(kept)] = table[:length][kept] if len(table) else table[:0]
    store.echo_of[: len(kept)] = place[store.echo_of[: len(kept)]]
    return place
