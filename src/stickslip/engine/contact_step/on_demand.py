"""Implicit steps, compiled apart from the engine when a run needs them first: under a law with a state, or where it is stiff."""

from __future__ import annotations

from functools import cache

from stickslip.engine.codegen.compiler import STEP, address_of, kernel
from stickslip.engine.codegen.uncompiled import UNCOMPILED, handle_of
from stickslip.engine.contact_step.radau_step import stick_with_state
from stickslip.engine.contact_step.taylor_step import slip_implicitly
from stickslip.engine.state.layout import Integers
from stickslip.engine.state.workspace import Run, borrow


@kernel
def step(memory: int, xi_to: float) -> None:
    """Slip for one implicit step of the run at an address."""
    slip_implicitly(borrow(memory), xi_to)


@kernel
def rest(memory: int, xi_to: float) -> None:
    """Stay at rest for one step, while the state of the law evolves, in the run at an address."""
    stick_with_state(borrow(memory), xi_to)


@cache
def addresses() -> tuple[int, int]:
    """Return the addresses of both functions. Compiles them, or takes them from the cache on disk."""
    if UNCOMPILED:
        return handle_of(slip_implicitly), handle_of(stick_with_state)
    return address_of(step, STEP), address_of(rest, STEP)


def lend_implicit_steps(memory: Integers) -> None:
    """Write into a run's memory where the implicit steps are."""
    run = Run(memory)
    run.implicit_step, run.implicit_rest = addresses()
