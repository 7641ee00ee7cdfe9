"""Machine code of formulas computes what their text says: for laws, every helper and random formulas, in floats and in lanes."""

from __future__ import annotations

import ctypes
import random
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

from stickslip.engine.compiled_formula import CALLED, NAMES
from stickslip.engine.formula_code.formula_machine import MachineCode
from stickslip.engine.formula_code.taylor_series import SIDE_BY_SIDE, SIGNATURES, FormulaWriter
from stickslip.engine.lanes.workspace import apart
from stickslip.engine.series import ball_radii
from stickslip.foundation.kernels.memory.simd import SIMD_WIDTH
from stickslip.foundation.kernels.uncompiled import MATHS
from stickslip.friction import LAWS
from tests.core.engine.drawn import example_law
from tests.core.engine.formula_texts import NAMES as PARAMETERS
from tests.core.engine.formula_texts import tree
from tests.core.engine.formulas import FLOATS

Block = NDArray[np.float64]

ROOM, TRIES = 160, 20
"""Numbers in an array besides the constants of a formula, and calls of each function."""
CLOSE = 1e-9
"""Relative difference that rounding may make: machine code may fuse a product and a sum."""

WITH_A_STATE = {"prepare", "state_value", "balls"}
WITHOUT = set(SIGNATURES) - {"state_value"}
IN_PYTHON = {**vars(MATHS), **vars(ball_radii), **FLOATS}
IN_PYTHON |= {"fused": lambda a, b, c: a * b + c, "power_of_two": lambda n: np.ldexp(1.0, int(n))}


def agreement(writer: FormulaWriter, part: str, rng: np.random.Generator) -> float:
    """Return the share of the numbers written by the machine code of a function that are those of its text, run as Python."""
    statements, lanes, names = writer.statements(part), part in SIDE_BY_SIDE, SIGNATURES[part]
    machine = MachineCode(statements, names, lanes, NAMES)
    kinds = [ctypes.c_void_p if name.endswith("[]") else ctypes.c_double for name in names]
    code, alike = compile("\n".join(statements), part, "exec"), list[Block]()
    for _ in range(TRIES):
        given = [drawn(rng, writer.size + ROOM, kind, lanes) for kind in kinds]
        plain = [one if isinstance(one, float) else np.array(one, ndmin=2).reshape(len(one), -1) for one in given]
        before = np.concatenate([one.ravel() for one in plain if isinstance(one, np.ndarray)])
        for lane in range(SIMD_WIDTH if lanes else 1):
            columns = [one if isinstance(one, float) else one[:, lane] for one in plain]
            with np.errstate(all="ignore"):
                exec(code, IN_PYTHON | dict(zip((name.strip("[]") for name in names), columns, strict=True)))
        ctypes.CFUNCTYPE(None, *kinds)(machine.address)(*(one if isinstance(one, float) else one.ctypes.data for one in given))
        ours, theirs = (np.concatenate([one.ravel() for one in each if isinstance(one, np.ndarray)]) for each in (given, plain))
        alike.append(np.isclose(ours, theirs, rtol=CLOSE, atol=0.0, equal_nan=True)[(ours != before) | (theirs != before)])
    return float(np.concatenate(alike).mean())


def drawn(rng: np.random.Generator, size: int, kind: Any, lanes: bool) -> Block | float:
    """Random numbers over seven orders of magnitude, half of the arrays without negative ones."""
    if kind is ctypes.c_double:
        return float(rng.normal())
    block = apart(size, SIMD_WIDTH) if lanes else np.zeros(size)
    block[:] = rng.normal(size=block.shape) * 10.0 ** rng.integers(-3, 4)
    if rng.random() < 0.5:
        np.abs(block, out=block)
    return block


@pytest.mark.sampled(every=13)
@pytest.mark.parametrize("kind", LAWS)
def test_functions_of_a_law_do_what_their_text_says(kind: str) -> None:
    law, rng = example_law(kind), np.random.default_rng(1)
    writer = FormulaWriter(law.trees()[0], law.parameters(), state_rates=law.state_trees())
    for part in SIGNATURES.keys() & (WITH_A_STATE if law.states else WITHOUT):
        assert agreement(writer, part, rng) > 0.97, part


@pytest.mark.sampled(every=8)
@pytest.mark.parametrize("seed", range(24))
def test_random_formulas_do_what_their_text_says(seed: int) -> None:
    rng, states = random.Random(seed), seed % 3
    formula, rates = tree(rng, 3, states), tuple(tree(rng, 2, states) for _ in range(states))
    writer = FormulaWriter(formula, PARAMETERS, 3, rates)
    part = rng.choice(sorted(WITH_A_STATE if states else WITHOUT))
    assert agreement(writer, part, np.random.default_rng(seed)) > 0.97, part


class OneCall(FormulaWriter):
    """A function that calls one helper, with numbers of the formula's constants as arguments."""

    helper, count = "", 0

    def statements(self, part: str) -> list[str]:
        return [f"s[0] = {self.helper}({', '.join(f'c[{n}]' for n in range(self.count))})"]


HELPERS = {name: function.__code__.co_argcount for name, function in CALLED.items()}
HELPERS |= dict.fromkeys(("sine", "versine", "exp_above", "sinh_below", "expm1", "log1p", "tanh", "asinh"), 1)
HELPERS |= {"exp_radius": 3, "sine_radius": 3, "log_radius": 2, "power_radius": 3, "arcsinh_radius": 2, "tanh_radius": 2}
HELPERS |= {"fused": 3, "min": 2, "max": 2, "abs": 1, "sqrt": 1, "sin": 1, "cos": 1, "exp": 1, "log": 1}


@pytest.mark.sampled(every=10)
@pytest.mark.parametrize("part", ["radii", "radii_in_lanes"])
@pytest.mark.parametrize("helper", HELPERS)
def test_helpers_do_what_their_text_says(helper: str, part: str) -> None:
    writer = OneCall(example_law("coulomb").trees()[0], example_law("coulomb").parameters())
    writer.helper, writer.count = helper, HELPERS[helper]
    assert agreement(writer, part, np.random.default_rng(2)) == 1.0


def test_what_cannot_be_written_is_refused() -> None:
    for statement in ("while True: s[0] = 1.0", "s[0] = not 1.0", "s[0] = s[c]", "s[0] = 1.0 if 1.0 else 2.0"):
        with pytest.raises(NotImplementedError):
            MachineCode([statement], ("c[]", "s[]", "k[]"), False, NAMES)
