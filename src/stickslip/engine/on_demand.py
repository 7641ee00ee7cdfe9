"""Parts of the engine that are loaded when a run first needs them; the loop calls them through their addresses.

Most runs need none of them. A part is one function of the run's memory, a task and a number.
"""

from __future__ import annotations

from importlib import import_module
from typing import Any

import numpy as np

from stickslip.engine.state.layout import Counts, EnginePart, Integers, Params
from stickslip.engine.state.workspace import Run
from stickslip.foundation.constants import RIGID
from stickslip.foundation.kernels.lock import made_once
from stickslip.foundation.kernels.uncompiled import UNCOMPILED, handle_of

PART_MODULES = {
    EnginePart.IMPLICIT_STEPS: "contact_step.implicit_step",
    EnginePart.LOADING_HISTORY: "waves.varying_forcing",
    EnginePart.ECHO_QUEUE: "waves.echo_queue",
    EnginePart.MOVING_FOLDS: "folds.fold_ahead",
    EnginePart.DRIVER: "waves.driver",
    EnginePart.LADDER: "waves.ladder",
    EnginePart.FOLDS: "folds.fold",
    EnginePart.NEGATIVE_FRICTION: "contact_step.negative_friction",
    EnginePart.PLAY: "contact.play",
}
"""The module of each part, below `stickslip.engine`, where its function has the name of the part; its address is the field of that
name in `workspace.Run`."""


_ORDER = {part: n for n, part in enumerate(PART_MODULES)}
_PLACES = np.array([Run.places[part.name.lower()].first for part in PART_MODULES])
"""Place of the address of each part in a run's memory, in the order of PART_MODULES."""
_at_hand = np.zeros(len(PART_MODULES), np.int64)
"""Addresses of the parts that this process has compiled or loaded so far, in the order of PART_MODULES; 0 for the others."""


def function_of(part: EnginePart) -> Any:
    """Return the kernel of a part, from its module; do not hold the lock of things made on first use while it is imported."""
    return getattr(import_module(f"stickslip.engine.{PART_MODULES[part]}"), part.name.lower())


@made_once()
def part_at(function: Any) -> int:
    """Return the address of the kernel of a part."""
    if not UNCOMPILED:
        return int(function.address)

    return handle_of(lambda run, task, number: float(function(run.numbers, task, number)))


def lend_part(memory: Integers, part: EnginePart | None = None) -> None:
    """Write the address of a part into a run's memory, by default of the part that the engine has asked for."""
    part = EnginePart(Run(memory).missing) if part is None else part
    n = _ORDER[part]
    memory[_PLACES[n]] = _at_hand[n] = part_at(function_of(part))


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
