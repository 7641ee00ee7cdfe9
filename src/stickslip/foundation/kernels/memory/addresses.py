"""Addresses and bits, which compiled code reads, writes and calls.

The functions here are plain Python, for use without compiler; machine code has rules of its own for them (`kernels.compiler`).
The engine calls formulas and parts of itself through their addresses, so that a new law compiles nothing of the engine.
"""

from __future__ import annotations

from typing import Any, ClassVar

import numpy as np

from stickslip.foundation.kernels.uncompiled import Pointer, call, pointer_at


class CallAt:
    """A function for compiled code that calls another one at an address, its first argument, as C does.

    `kinds` are those of the other arguments: m for memory (a record, or a pointer to numbers), p for a pointer to floats, d for a
    float, i for a whole number; `result` is d or i, or empty if there is none.
    """

    known: ClassVar[list[CallAt]] = []
    """All such functions, for which `kernels.compiler` has rules."""

    def __init__(self, kinds: str, result: str = "") -> None:
        self.kinds, self.result = kinds, result
        self.known.append(self)

    def __call__(self, handle: int, *arguments: Any) -> Any:
        """Call the function with the given handle, which takes the place of the address in plain Python."""
        return call(handle, *arguments)


call_prepare = CallAt("pdp")
"""Call `prepare(parameters, reference, c)` of a formula."""
call_value, call_state_value = CallAt("pddp"), CallAt("pddpp")
"""Call `value(c, dx, s, out)` or `state_value(c, dx, s, states, out)` of a formula."""
call_values = call_radii = CallAt("ppp")
"""Call `values_in_lanes(c, at, out)`, or `radii(c, s, k)` or `balls(c, s, k)`; `at` holds slip (m) and slip rate (m/s)."""
call_jet = CallAt("pppp")
"""Call `rate_jet(c, k, L, s)` or `motion_jet(c, k, L, s)`."""
call_part = CallAt("mid", "d")
"""Call a part of the engine that is machine code of its own: part(memory of the run, task, number) -> float."""


def floats(address: int) -> Any:
    """Return the pointer to floats at an address."""
    return pointer_at(address, np.float64)


def integers(address: int) -> Any:
    """Return the pointer to 64-bit integers at an address."""
    return pointer_at(address, np.int64)


def ahead(pointer: Any, n: int) -> Any:
    """Return the pointer to the number n places after the one that `pointer` points to."""
    return pointer.ahead(n)


def room_for(n: int) -> Any:
    """Return a pointer to room for n floats that lasts as long as the function that asks for it; n is a constant."""
    return Pointer(np.full(n, np.nan))


def bits_of(number: float) -> Any:
    """Return the 64 bits of a float as an integer."""
    return np.float64(number).view(np.int64)


def float_of(bits: int) -> Any:
    """Return the float with the given 64 bits."""
    return np.int64(bits).view(np.float64)
