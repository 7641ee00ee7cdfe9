"""Call the engine of single runs through its address, so that the code compiled for a batch needs no second copy of it."""

from __future__ import annotations

from functools import cache
from typing import Any

from numba import types
from numba.extending import intrinsic

from stickslip.engine.codegen.compiler import address_of
from stickslip.engine.loop import run_until

ARGUMENTS = (types.Array(types.int64, 1, "C"), types.int64, types.float64, types.int64)
"""Types of the arguments of `loop.run_until`: table, last row, last theta (s), budget."""


@cache
def engine_address() -> int:
    """Return the address of the machine code of `loop.run_until`; compile it if no single run has done so."""
    return address_of(run_until, ARGUMENTS)


@intrinsic
def run_until_at(typingctx: Any, address: Any, table: Any, last_trip: Any, last_phase: Any, budget: Any) -> Any:
    """Call `loop.run_until`, whose machine code is at `address`, and return the code with which it stops."""

    def codegen(context: Any, builder: Any, signature: Any, args: Any) -> Any:
        convention = context.call_conv
        function = builder.inttoptr(args[0], convention.get_function_type(types.int64, ARGUMENTS).as_pointer())
        _, code = convention.call_function(builder, function, types.int64, ARGUMENTS, args[1:])
        return code

    return types.int64(types.int64, *ARGUMENTS), codegen
