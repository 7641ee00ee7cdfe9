"""Parts of the engine that are compiled separately when a run first needs them; the loop calls them through their addresses.

Most runs need none of them, and each costs seconds to compile. A part is one function of the run's memory, a task and a number.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from stickslip.engine.compile.kernels import address_of, kernel
from stickslip.engine.compile.lock import made_once
from stickslip.engine.compile.uncompiled import UNCOMPILED, handle_of
from stickslip.engine.contact.pressing import press_ahead
from stickslip.engine.contact_step.implicit_step import slip_implicitly, stick_with_state
from stickslip.engine.contact_step.negative_friction import goes_below_zero
from stickslip.engine.folds.fold import approach_fold, depart_from_fold, leave_fold_piece, straight_from_fold, straight_to_fold
from stickslip.engine.folds.fold_ahead import way_to_fold
from stickslip.engine.memory.addresses import PART
from stickslip.engine.state.layout import Counts, EnginePart, Integers, Params, Task
from stickslip.engine.state.workspace import Run, borrow
from stickslip.engine.waves.driver import drive
from stickslip.engine.waves.echo_queue import build_queue, end_trip, next_echo
from stickslip.engine.waves.ladder import serve
from stickslip.engine.waves.varying_forcing import enter_segment, take_loading, trips_withstood
from stickslip.foundation.constants import RIGID


@kernel
def implicit_steps(memory: int, task: int, xi_to: float) -> float:
    """Take an implicit step up to the place xi_to at most; return 0 if a contact at rest needs none."""
    if task == Task.SLIP_IMPLICITLY:
        slip_implicitly(borrow(memory), xi_to)
        return 1.0
    return 1.0 if stick_with_state(borrow(memory), xi_to) else 0.0


@kernel
def loading_history(memory: int, task: int, number: float) -> float:
    """Serve a loading that varies: see `Task`.

    Round trips at rest count as long as the load stays below `number` (Pa or N); a normal load is written in units of `number` (in
    xi).
    """
    if task == Task.ENTER_SEGMENT:
        return 1.0 if enter_segment(borrow(memory)) else 0.0
    if task == Task.COUNT_TRIPS_AT_REST:
        return float(trips_withstood(borrow(memory), number))
    if task == Task.TAKE_LOADING:
        take_loading(borrow(memory))
    else:
        press_ahead(borrow(memory), number)
    return 0.0


@kernel
def echo_queue(memory: int, task: int, number: float) -> float:
    """Return the next piece whose echo must be met, close a round trip, or build the queue."""
    if task == Task.NEXT_ECHO:
        return float(next_echo(borrow(memory)))
    if task == Task.END_TRIP:
        end_trip(borrow(memory))
    else:
        build_queue(borrow(memory))
    return 0.0


@kernel
def moving_folds(memory: int, task: int, unit: float) -> float:
    """Return the way (in xi) to the moving fold that the present series, in units of `unit` (in xi), runs into."""
    return way_to_fold(borrow(memory), unit)


@kernel
def driver(memory: int, task: int, number: float) -> float:
    """Add what a machine sends to the piece of load; return the share of the piece that is kept."""
    return drive(borrow(memory))


@kernel
def ladder(memory: int, task: int, number: float) -> float:
    """Serve a body of layers: see `Task`."""
    return serve(borrow(memory), task, number)


@kernel
def folds(memory: int, task: int, way: float) -> float:
    """Lead slip over the given way (in xi) to a fold or away from one: see `Task`."""
    run = borrow(memory)
    if task == Task.APPROACH_FOLD:
        return approach_fold(run, way)
    if task == Task.DEPART_FROM_FOLD:
        depart_from_fold(run, way)
    elif task == Task.STRAIGHT_TO_FOLD:
        straight_to_fold(run)
    elif task == Task.STRAIGHT_FROM_FOLD:
        straight_from_fold(run)
    else:
        leave_fold_piece(run)
    return 0.0


@kernel
def negative_friction(memory: int, task: int, length: float) -> float:
    """Return 1 if friction falls below zero in the explicit step of the given length (in units) that is being made, else 0."""
    run = borrow(memory)
    return 1.0 if goes_below_zero(run, run.history[run.counts.length].rate, length) else 0.0


@made_once()
def part_at(part: Any) -> int:
    """Return the address of a part. Compiles it, or takes it from the cache on disk."""
    if not UNCOMPILED:
        return address_of(part, PART)

    return handle_of(lambda run, task, number: float(part(run.numbers, task, number)))


PARTS = {
    EnginePart.IMPLICIT_STEPS: implicit_steps,
    EnginePart.LOADING_HISTORY: loading_history,
    EnginePart.ECHO_QUEUE: echo_queue,
    EnginePart.MOVING_FOLDS: moving_folds,
    EnginePart.DRIVER: driver,
    EnginePart.LADDER: ladder,
    EnginePart.FOLDS: folds,
    EnginePart.NEGATIVE_FRICTION: negative_friction,
}
"""The function of each part; its address is the field of the same name in `workspace.Run`."""


_ORDER = {part: n for n, part in enumerate(PARTS)}
_PLACES = np.array([Run.places[part.name.lower()].first for part in PARTS])
"""Place of the address of each part in a run's memory, in the order of PARTS."""
_at_hand = np.zeros(len(PARTS), np.int64)
"""Addresses of the parts that this process has compiled or loaded so far, in the order of PARTS; 0 for the others."""


def lend_part(memory: Integers, part: EnginePart | None = None) -> None:
    """Write the address of a part into a run's memory, by default of the part that the engine has asked for."""
    part = EnginePart(Run(memory).missing) if part is None else part
    n = _ORDER[part]
    memory[_PLACES[n]] = _at_hand[n] = part_at(PARTS[part])


def lend_parts_at_hand(memory: Integers) -> None:
    """Write the addresses of all parts that are already compiled into a run's memory, and 0 for those that it must ask for."""
    memory[_PLACES] = _at_hand


def lend_parts_of_batch(memory: Integers, params: Params, counts: Counts) -> None:
    """Write the addresses of the parts that members of a batch with such numbers will probably need.

    A massless contact rarely needs implicit steps: they are lent if already compiled, otherwise when it asks for them.
    """
    lend_parts_at_hand(memory)
    if counts.has_inertia == 1 or counts.states > 0:
        lend_part(memory, EnginePart.IMPLICIT_STEPS)
    if params.can_be_negative != 0.0 and counts.states == counts.given:
        lend_part(memory, EnginePart.NEGATIVE_FRICTION)
    if params.reflection == RIGID and counts.is_block == 0:
        lend_part(memory, EnginePart.ECHO_QUEUE)
