"""Parts of the engine that are compiled separately when a run first needs them; the loop calls them through their addresses.

Most runs need none of them, and each costs seconds to compile. A part is one function of the run's memory, a task and a number.
"""

from __future__ import annotations

from functools import cache
from typing import Any

from stickslip.engine.compile.kernels import address_of, kernel
from stickslip.engine.compile.uncompiled import UNCOMPILED, handle_of
from stickslip.engine.folds.fold_ahead import way_to_fold
from stickslip.engine.memory.addresses import PART
from stickslip.engine.radau.step import collocate
from stickslip.engine.state.layout import Counts, EnginePart, Integers, Params, Task
from stickslip.engine.state.workspace import Run, borrow
from stickslip.engine.waves.driver import drive
from stickslip.engine.waves.echo_queue import build_queue, end_trip, next_echo
from stickslip.engine.waves.ladder import serve
from stickslip.engine.waves.varying_forcing import enter_segment, take_loading, trips_withstood
from stickslip.foundation.constants import RIGID


@kernel
def implicit_steps(memory: int, task: int, left: float) -> float:
    """Make the polynomials of an implicit step over the way `left` (in xi) at most; return the length of the step (in xi)."""
    return collocate(borrow(memory), left)


@kernel
def loading_history(memory: int, task: int, limit: float) -> float:
    """Serve a loading that varies: see `Task`. Round trips at rest count as long as the load stays below `limit` (Pa or N)."""
    if task == Task.ENTER_SEGMENT:
        return 1.0 if enter_segment(borrow(memory)) else 0.0
    if task == Task.TAKE_LOADING:
        take_loading(borrow(memory))
        return 0.0
    return float(trips_withstood(borrow(memory), limit))


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


@cache
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
}
"""The function of each part; its address is the field of the same name in `workspace.Run`."""


_at_hand: dict[EnginePart, int] = {}
"""Addresses of the parts that this process has compiled or loaded so far."""


def lend_part(memory: Integers, part: EnginePart | None = None) -> None:
    """Write the address of a part into a run's memory, by default of the part that the engine has asked for."""
    run = Run(memory)
    part = EnginePart(run.missing) if part is None else part
    _at_hand[part] = part_at(PARTS[part])
    setattr(run, part.name.lower(), _at_hand[part])


def lend_parts_at_hand(memory: Integers) -> None:
    """Write the addresses of all parts that are already compiled into a run's memory, so that it need not ask for them."""
    run = Run(memory)
    for part, address in _at_hand.items():
        setattr(run, part.name.lower(), address)


def lend_parts_of_batch(memory: Integers, params: Params, counts: Counts) -> None:
    """Write the addresses of the parts that members of a batch with such numbers will probably need.

    Batches have no loading histories. A massless contact rarely needs implicit steps: they are lent if already compiled, otherwise
    when it asks for them.
    """
    Run(memory).implicit_steps = _at_hand.get(EnginePart.IMPLICIT_STEPS, 0)
    if counts.has_inertia == 1 or counts.states > 0:
        lend_part(memory, EnginePart.IMPLICIT_STEPS)
    if params.reflection == RIGID and counts.is_block == 0:
        lend_part(memory, EnginePart.ECHO_QUEUE)
