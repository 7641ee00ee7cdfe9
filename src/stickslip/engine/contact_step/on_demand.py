"""Implicit steps, compiled apart from the engine when a run needs them first: under a law with a state, or where it is stiff."""

from __future__ import annotations

from functools import cache
from typing import Any

from numba import types

from stickslip.engine.codegen.cache import sealed_cfunc
from stickslip.engine.codegen.uncompiled import UNCOMPILED, handle_of
from stickslip.engine.contact_step.radau_step import stick_with_state
from stickslip.engine.contact_step.taylor_step import slip_implicitly
from stickslip.engine.state.layout import Integers
from stickslip.engine.state.workspace import Run, borrow


def step(memory: int, xi_to: float) -> None:
    """Slip for one implicit step of the run at an address."""
    slip_implicitly(borrow(memory), xi_to)


def rest(memory: int, xi_to: float) -> None:
    """Stay at rest for one step, while the state of the law evolves, in the run at an address."""
    stick_with_state(borrow(memory), xi_to)


@cache
def compiled() -> tuple[Any, Any]:
    """Compile both functions, or take them from the cache on disk. They live as long as the process, and so does their code."""
    kind = sealed_cfunc(types.void(types.int64, types.float64), nopython=True, error_model="numpy", fastmath={"contract"})
    return kind(step), kind(rest)


@cache
def addresses() -> tuple[int, int]:
    """Return the addresses of both functions."""
    if UNCOMPILED:
        return handle_of(slip_implicitly), handle_of(stick_with_state)
    slipping, resting = compiled()
    return int(slipping.address), int(resting.address)


def lend_implicit_steps(memory: Integers) -> None:
    """Write into a run's memory where the implicit steps are."""
    run = Run(memory)
    run.implicit_step, run.implicit_rest = addresses()
