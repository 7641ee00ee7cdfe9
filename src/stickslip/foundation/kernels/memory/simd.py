"""Lanes: floats side by side in a register, on which the processor works at once.

A function written for floats serves lanes as well. Compiled for lanes, it computes in each lane exactly what it computes for a
float, bit for bit. It must not contain decisions (if, while) that depend on lanes. Here are the operations that Python lacks, as
plain Python for floats; machine code has rules of its own for them, and for lanes (`kernels.compiler`).
"""

from __future__ import annotations

from typing import Any

import numpy as np

from stickslip.foundation.kernels.processor import PROCESSOR

SIMD_WIDTH = PROCESSOR.lanes
"""Number of lanes."""

ALIGNED = 1.5 * 2.0**52
"""A float (1) whose last bits are those of the whole number that is added to it."""


def fused(a: Any, b: Any, c: Any) -> Any:
    """Return a b + c, of floats or lanes, in one operation where the processor has it: which product is fused shortens chains."""
    return a * b + c


def bits_as_number(x: Any) -> Any:
    """Return the 64 bits of a float that is not negative, or of each lane, read as an integer and converted to a float."""
    return np.float64(np.float64(x).view(np.int64))


def power_of_two(n: Any) -> Any:
    """Return 2^n for a whole number n that is given as a float, or for lanes of such; the result must be a normal number."""
    return np.ldexp(1.0, int(n)) if np.isfinite(n) else np.float64(n)


def chosen(which: int, yes: Any, no: Any) -> Any:
    """Return `yes` where a comparison of lanes holds and `no` elsewhere; a single float holds in every lane."""
    raise NotImplementedError("plain Python has no lanes")


def first_of(bits: int) -> Any:
    """Return the place of the lowest bit that is set in a whole number other than 0."""
    raise NotImplementedError("plain Python has no lanes")


def store_across(rows: Any, targets: Any, first: int) -> Any:
    """Store places `first` to `first` + SIMD_WIDTH - 1 of rows in lanes: for lane n at the address targets[n] + 8 `first`."""
    raise NotImplementedError("plain Python has no lanes")
