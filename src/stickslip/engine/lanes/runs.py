"""Run many members in compiled code: the engine on each of them, and the reduction of its history to a few numbers.

Each thread has one workspace with a lane for each of SIMD_WIDTH members, and starts further members as lanes become free. They take
their explicit steps of slip side by side, unless their law demands steps taken alone (`steps_alone` of the batch): such members run
to their end one after the other, all in the first lane. No Python code runs in between, so threads run in parallel. References to
arrays are counted only when a run has ended.
"""

from __future__ import annotations

import math
from typing import NamedTuple

from stickslip.engine.history.slip_events import EventTurns, events_in, group_turns
from stickslip.engine.history.turning_points import FULL, Known, Search, Spare, Turn, find_turns, known_in, spare_in, turns_in
from stickslip.engine.lanes.lanes import Side, Waits, step_side_by_side
from stickslip.engine.lanes.reduction import (
    REDUCED_COLUMNS,
    FoundEventsInMemory,
    Reduced,
    fold_events,
    fold_first,
    fold_whole,
    reached,
    reduced_at,
)
from stickslip.engine.lanes.workspace import LaneStage, Setups, Workspace
from stickslip.engine.loop import run_until
from stickslip.engine.state.layout import Counts, Floats, Integers, Params, State
from stickslip.engine.state.workspace import ADDRESSES, RUN_SIZE, Run, borrow
from stickslip.foundation.arrays import Floats2, Floats3, Integers1, Integers2
from stickslip.foundation.kernels.kernels import entry, inlined, kernel
from stickslip.foundation.kernels.memory.addresses import CallAt, ahead, call_prepare, floats, integers
from stickslip.foundation.kernels.memory.pointers import numbers_of, whole_numbers_of
from stickslip.foundation.kernels.memory.simd import SIMD_WIDTH
from stickslip.problem import BAD_PARAMETERS, Stop

BUDGET = 200_000
"""Number of steps of the engine after which it returns, so that the flag which stops the batch is checked."""

LENGTHS_OF_RECORDS = Params.total, State.total, Counts.total
"""Lengths of these records."""
run_until_at = CallAt("miidi", "i")
"""Call `loop.run_until`: table and its length, last row, last theta (s), budget."""


class Lane(NamedTuple):
    """A lane of a workspace, as pointers to its entries in the tables."""

    table: Integers  # memory of the run in the lane, see `engine.state.workspace.Run`
    base: Integers  # addresses of the tables that the first member uses in this lane
    stride: Integers  # bytes from a member's tables to those of the next; 0 for a table that all share
    stage: Integers  # Stage.FREE, Stage.UNDER_WAY or Stage.AT_END
    waits: Integers  # what the lane waits for, see `kernels.lanes`
    member: Integers  # index of the member in the lane
    code: Integers  # what the engine returned last
    known: Known  # what is known of each piece


class Group(NamedTuple):
    """Hold members that differ in numbers only, and where their results go."""

    engine: int  # address of `loop.run_until`
    setups: Setups
    wants_events: bool  # True if slip events must be found
    stop: Integers1  # (1,): a flag that ends the whole batch
    codes: Integers1  # (members,): codes of the ends of the runs
    out: Floats2  # (members, Reduced.total)


# ---- functions called through their addresses, so that the code of a batch needs no second copy of the engine ----------------


def engine_address() -> int:
    """Return the address of the machine code of `loop.run_until`."""
    return run_until.address  # type: ignore[attr-defined] # it is an `Entry`


@entry
def fill_constants(prepare: Integers1, numbers: Floats2, constants: Floats3) -> None:
    """Call `prepare` of each piece of the law for each member, to fill `constants`, of shape (members, pieces, size).

    prepare holds the addresses of these functions. A row of `numbers` has the law's parameters and the reference slip (m) of each
    piece.
    """
    members, pieces, size = constants.shape
    source, target, parameters = floats(numbers.ctypes.data), floats(constants.ctypes.data), numbers.shape[1] - pieces
    for n in range(members):
        for i in range(pieces):
            c, own = ahead(target, (n * pieces + i) * size), ahead(source, n * numbers.shape[1])
            call_prepare(prepare[i], own, own[parameters + i], c)


# ---- members in lanes -------------------------------------------------------------------------------------------------------


class Members(NamedTuple):
    """What a group knows of its members, as pointers: counting references to arrays would take longer than a short run."""

    engine: int
    total: int  # number of members
    waits: int  # 1 if they take steps side by side, else 0
    stop: Integers
    codes: Integers
    out: Floats
    params: Floats
    stride: int  # distance between the parameters of two members, 0 if all have the same
    state: Floats
    counts: Integers
    branches: Integers
    last_trip: Integers
    last_phase: Floats
    duration: Floats
    upcoming: Integers  # index of the next member to start
    wants_events: bool
    threshold: Floats
    excess: Floats
    stiffness: Floats
    turns: Turn  # points of the slip rate of a run that has ended
    events: EventTurns
    room: int  # number of points that fit
    spare: Spare


@entry
def run_group(group: Group, base: Integers2, stride: Integers1, work: Workspace) -> int:
    """Run members, each in a lane of the workspace, and write their stop codes and numbers into the group.

    base and stride are those of `workspace.table_of`. Returns SIMD_WIDTH when all members are done or `stop` is set. Otherwise it
    returns the lane that has no room, or needs a part of the engine (code NEED_PART), or whose member has crept for so long (code
    PAUSED) that it should be run alone. Called again, it continues from there.
    """
    first, members = first_lane(work, base, stride), members_of(group, work)
    lanes = len(work.stage)  # no constant: no copy for each
    side = Side(first.table, first.waits, integers(group.setups.jets.ctypes.data), work.block[0], first.known, group.wants_events)
    for n in range(lanes):
        if nth(first, n).stage[0] != LaneStage.FREE:
            point_at(nth(first, n), members, first.member[n])
    while True:
        waiting = 0
        for n in range(lanes):
            lane = nth(first, n)
            if lane.stage[0] == LaneStage.UNDER_WAY and (lane.waits[0] == Waits.NONE or lane.waits[0] == Waits.ALONE):
                advance_member(members, lane)
            while lane.waits[0] == Waits.NONE:
                if lane.stage[0] == LaneStage.UNDER_WAY:
                    return n
                if lane.stage[0] == LaneStage.AT_END and members.wants_events and not fold_events_of(lane, members):
                    return n
                if lane.stage[0] == LaneStage.AT_END:
                    fold_run(lane, members)
                if not start_next(lane, members):
                    break
            waiting += lane.waits[0] != Waits.NONE
        if waiting == 0 or group.stop[0] != 0:
            return SIMD_WIDTH
        step_side_by_side(side)


@kernel
def members_of(group: Group, work: Workspace) -> Members:
    """Return what a group knows of its members, as pointers."""
    setups = group.setups
    return Members(
        group.engine,
        len(group.codes),
        1 if len(setups.jets) > 0 else 0,
        integers(group.stop.ctypes.data),
        integers(group.codes.ctypes.data),
        floats(group.out.ctypes.data),
        floats(setups.params.ctypes.data),
        setups.params.shape[1] if len(setups.params) > 1 else 0,
        floats(setups.state.ctypes.data),
        integers(setups.counts.ctypes.data),
        integers(setups.branches.ctypes.data),
        integers(setups.last_trip.ctypes.data),
        floats(setups.last_phase.ctypes.data),
        floats(setups.duration.ctypes.data),
        integers(work.upcoming.ctypes.data),
        group.wants_events,
        floats(setups.threshold.ctypes.data),
        floats(setups.excess.ctypes.data),
        floats(setups.stiffness.ctypes.data),
        turns_in(work.turns),
        events_in(work.events),
        len(work.turns),
        spare_in(work.spare),
    )


@kernel
def first_lane(work: Workspace, base: Integers, stride: Integers) -> Lane:
    """Return the first lane of a workspace."""
    flags = integers(work.stage.ctypes.data), integers(work.waits.ctypes.data)
    member, code = integers(work.member.ctypes.data), integers(work.code.ctypes.data)
    table, origin = integers(work.table.ctypes.data), integers(base.ctypes.data)
    return Lane(table, origin, integers(stride.ctypes.data), flags[0], flags[1], member, code, known_in(work.known))


@kernel
def nth(lane: Lane, n: int) -> Lane:
    """Return the lane n places after the given one."""
    table, base = ahead(lane.table, n * RUN_SIZE), ahead(lane.base, n * ADDRESSES)
    stage, waits, member, code = ahead(lane.stage, n), ahead(lane.waits, n), ahead(lane.member, n), ahead(lane.code, n)
    known = lane.known[n * borrow(lane.table).capacity]
    return Lane(table, base, lane.stride, stage, waits, member, code, known)


@kernel
def point_at(lane: Lane, members: Members, n: int) -> None:
    """Write into a lane's memory the addresses of the tables of member n, and its number of branches."""
    for k in range(ADDRESSES):
        lane.table[k] = lane.base[k] + n * lane.stride[k]
    run = borrow(lane.table)
    run.branches = members.branches[n]


@kernel
def start_member(run: Run, members: Members, n: int) -> None:
    """Set the numbers, state and counts of member n as at t = 0.

    No caller continues the run after its end, so its end may cut pieces and leaps (`to_the_end`) from the start.
    """
    params, state, counts = numbers_of(run.params), numbers_of(run.state), whole_numbers_of(run.counts)
    for k in range(LENGTHS_OF_RECORDS[0]):
        params[k] = members.params[n * members.stride + k]
    for k in range(LENGTHS_OF_RECORDS[1]):
        state[k] = members.state[k]
    for k in range(LENGTHS_OF_RECORDS[2]):
        counts[k] = members.counts[k]
    run.counts.to_the_end, run.counts.waits = 1, members.waits


@kernel
def advance_member(members: Members, lane: Lane) -> None:
    """Run the lane's member until its next step is to be taken side by side, it ends or pauses, lacks room, or `stop` is set."""
    n, table, code = lane.member[0], lane.table, -1  # Stop.NONE
    first = borrow(lane.table).counts.length
    last_trip, last_phase = members.last_trip[n], members.last_phase[n]
    if lane.waits[0] == Waits.ALONE:
        counts = borrow(lane.table).counts
        counts.waits = 0
        code = run_until_at(members.engine, table, RUN_SIZE, last_trip, last_phase, 1)
        counts.waits = 1
    while code == Stop.NONE and members.stop[0] == 0:
        code = run_until_at(members.engine, table, RUN_SIZE, last_trip, last_phase, BUDGET)
    for k in range(first, borrow(lane.table).counts.length):
        lane.known[k].way, lane.known[k].grown = 0, math.nan
    lane.code[0] = code
    lane.waits[0] = Waits.FRESH if code == Stop.SLIPS else Waits.NONE
    asks = code == Stop.SLIPS or code == Stop.FULL or code == Stop.PAUSED or code == Stop.NEED_PART
    if not asks and code != Stop.NONE:
        lane.stage[0] = LaneStage.AT_END


@kernel
def start_next(lane: Lane, members: Members) -> bool:
    """Start the next member in a lane, and run it until its first step side by side or its end; return False if none is left."""
    for n in range(members.upcoming[0], members.total):
        members.upcoming[0] = n + 1
        if members.branches[n] <= 0:
            members.codes[n] = BAD_PARAMETERS
            continue
        point_at(lane, members, n)
        start_member(borrow(lane.table), members, n)
        lane.stage[0], lane.member[0] = LaneStage.UNDER_WAY, n
        advance_member(members, lane)
        return True
    return False


# ---- reduction --------------------------------------------------------------------------------------------------------------


@kernel
def fold_run(lane: Lane, members: Members) -> None:
    """Write the stop code and the numbers of a run that has ended, but for those of its events; its lane is free then."""
    run, n = borrow(lane.table), lane.member[0]
    members.codes[n] = lane.code[0] if run.counts.length > 0 else BAD_PARAMETERS
    if run.counts.length > 0:
        end = reached(members.duration[n], members.codes[n], run.params.round_trip_time, run.history, run.counts.length)
        out = reduced_of(lane, members)
        fold_whole(run.history, run.counts.length, run.params.round_trip_time, end, out)
        if members.codes[n] not in (Stop.FINISHED, Stop.LOCKED):
            out.sticking = math.nan
    lane.stage[0] = LaneStage.FREE


@kernel
def fold_events_of(lane: Lane, members: Members) -> bool:
    """Write the numbers of the slip events of a run that has ended in a lane; return False if its points lack room."""
    run, n = borrow(lane.table), lane.member[0]
    if run.counts.length == 0:
        return True
    search, out = Search(run.history, lane.known, members.turns, members.room, members.spare), reduced_of(lane, members)
    turns = find_turns(search, (0, run.counts.length), members.threshold[n], run.counts.sticks == 1)
    if turns == FULL:
        return False
    found = FoundEventsInMemory(members.turns, members.events, group_turns(members.turns, turns, members.events), lane.known)
    fold_events(run, found, out)
    if found.number > 0:
        fold_first(run, found, members.excess[n], out)
        out.first_static_drop = members.stiffness[n] * out.first_slip
    return True


@inlined
def reduced_of(lane: Lane, members: Members) -> Reduced:
    """Return the numbers of the member in a lane."""
    return reduced_at(ahead(members.out, lane.member[0] * len(REDUCED_COLUMNS)))
