"""Compile the functions of friction formulas, which the engine calls through their addresses."""

from __future__ import annotations

import ctypes
import weakref
from collections.abc import Callable, Sequence
from typing import Any

from numpy.typing import NDArray

from stickslip.engine.formula_code.formula_machine import MachineCode
from stickslip.engine.formula_code.taylor_series import ORDER, SIDE_BY_SIDE, SIGNATURES, FormulaWriter
from stickslip.engine.series import ball_radii
from stickslip.engine.series.sine import sine, versine
from stickslip.foundation.arrays import Floats
from stickslip.foundation.kernels.lock import LOCK, made_once
from stickslip.foundation.kernels.memory.simd import fused
from stickslip.foundation.kernels.uncompiled import MATHS, UNCOMPILED, as_python, handle_of
from stickslip.friction.formula import OPERATIONS, Expression

CALLED: dict[str, Callable[..., Any]] = {one.__name__: one for operation in OPERATIONS.values() for one in operation.called}
"""The functions that lines of operations call. Many are f(now) - f(reference), now = reference + step: near the reference they have
no cancellation, and far from it they take the values. All numbers are those of a node of a formula and have its unit."""
NAMES: dict[str, Any] = {**vars(ball_radii), **CALLED, "fused": fused, "sine": sine, "versine": versine}
"""All that the text of a formula calls, but for functions of the mathematical library."""


class CompiledFormula:
    """The compiled functions of a friction formula (see `formula_code.taylor_series`); `size` is the number of constants they need.

    Each function is written and compiled when it is first needed, once for all threads: addresses of its machine code are handed
    on, and are good as long as this object lives.
    """

    def __init__(self, formula: Expression, parameters: tuple[str, ...], state_rates: tuple[Expression, ...]) -> None:
        self._writer = FormulaWriter(formula, parameters, ORDER, state_rates)
        self._functions: dict[str, Any] = {}
        self.size = self._writer.size

    def address(self, part: str) -> int:
        """Return the address of one of the functions, given its name in `taylor_series.SIGNATURES`."""
        if part not in self._functions:
            with LOCK:
                if part not in self._functions:
                    self._functions[part] = self._made(part)
        return int(self._functions[part].address)

    def _made(self, part: str) -> Any:
        """Write and compile one of the functions."""
        text = self._writer.statements(part)
        return _Python(part, text) if UNCOMPILED else MachineCode(text, SIGNATURES[part], part in SIDE_BY_SIDE, NAMES)

    def fill(self, values: Floats, reference: float, constants: Floats) -> None:
        """Fill `constants`, of length `size`, from the values of the formula's parameters and the reference slip (m)."""
        self._call("prepare", values, reference, constants)

    def fill_radii(self, constants: Floats, ball: Floats) -> None:
        """Fill in the radii of friction and of dw/dt in `ball`, the numbers of a `layout.Ball` with centres and discs."""
        self._call("balls", constants, ball, ball)

    def _call(self, part: str, *arguments: Floats | float) -> None:
        """Call one of the functions from Python."""
        address = self.address(part)
        if UNCOMPILED:
            self._functions[part].function(*arguments)
            return
        kinds = [ctypes.c_void_p if name.endswith("[]") else ctypes.c_double for name in SIGNATURES[part]]
        given = [one if isinstance(one, float) else one.ctypes.data for one in arguments]
        ctypes.CFUNCTYPE(None, *kinds)(address)(*given)


class _Python:
    """A function of a formula as plain Python, with its handle in place of an address."""

    def __init__(self, part: str, statements: Sequence[str]) -> None:
        names = {**NAMES, **{name: as_python(one) for name, one in CALLED.items()}, **vars(MATHS)}
        head = f"def {part}({', '.join(name.strip('[]') for name in SIGNATURES[part])}):\n"
        exec(head + "".join(f"    {line}\n" for line in statements), names)
        self.function = names[part]
        self.address = handle_of(self.function)


@made_once(32)
def compile_formula(formula: Expression, parameters: tuple[str, ...], state_rates: tuple[Expression, ...]) -> CompiledFormula:
    """Return the compiled functions of a formula; equal formulas share one object in problems that follow each other.

    `state_rates` are the formulas of the time derivatives of the law's states. Who hands on an address makes its table the owner
    of the formula (`keep_with`): the machine code is given back when no table and no later problem needs it.
    """
    return CompiledFormula(formula, parameters, state_rates)


def keep_with(table: NDArray[Any], owners: Sequence[CompiledFormula | NDArray[Any]]) -> None:
    """Keep formulas, or tables that do, alive as long as a table that holds addresses of their functions."""
    weakref.finalize(table, len, tuple(owners)).atexit = False  # it refers to the owners until the table is gone
