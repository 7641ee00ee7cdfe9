"""Machine code of formulas has the bits that numba gives: for every law, every helper and formulas drawn at random."""

from __future__ import annotations

import ctypes
import random
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

from stickslip.batch.kernels.workspace import apart
from stickslip.engine.compiled_formula import CALLED, NAMES
from stickslip.engine.formula_code.formula_machine import MachineCode
from stickslip.engine.formula_code.taylor_series import SIDE_BY_SIDE, SIGNATURES, FormulaWriter
from stickslip.engine.memory.simd import WIDTH
from stickslip.friction import LAWS
from tests.engine.by_numba import by_numba
from tests.engine.drawn import example_law
from tests.engine.formula_texts import NAMES as PARAMETERS
from tests.engine.formula_texts import tree

Block = NDArray[np.float64]
ROOM, TRIES = 160, 20
"""Numbers in an array besides the constants of a formula, and calls of each function."""
WITH_A_STATE = {"prepare", "state_value", "balls"}
WITHOUT = set(SIGNATURES) - {"state_value"}


def compared(writer: FormulaWriter, part: str, rng: np.random.Generator, spoil: str = "") -> tuple[int, int]:
    """How many of the numbers that a function writes have the same bits in both machine codes, and how many it writes.

    All numbers that are not a number count as the same. `spoil` is a statement added at the end of one of both.
    """
    statements, lanes = writer.statements(part), part in SIDE_BY_SIDE
    machine = MachineCode([*statements, *([spoil] if spoil else [])], SIGNATURES[part], lanes, NAMES)
    reference = by_numba(writer, part)
    kinds = [ctypes.c_void_p if name.endswith("[]") else ctypes.c_double for name in SIGNATURES[part]]
    same = written = 0
    for _ in range(TRIES):
        given = [drawn(rng, writer.size + ROOM, kind, lanes) for kind in kinds]
        ours, numbas = (called(ctypes.CFUNCTYPE(None, *kinds)(one.address), given) for one in (machine, reference))
        before = np.concatenate([one.ravel() for one in given if isinstance(one, np.ndarray)])
        touched = (ours.view(np.int64) != before.view(np.int64)) | (numbas.view(np.int64) != before.view(np.int64))
        alike = (ours.view(np.int64) == numbas.view(np.int64)) | (np.isnan(ours) & np.isnan(numbas))
        same, written = same + int((alike & touched).sum()), written + int(touched.sum())
    return same, written


def drawn(rng: np.random.Generator, size: int, kind: Any, lanes: bool) -> Block | float:
    """Random numbers over seven orders of magnitude, half of the arrays without negative ones."""
    if kind is ctypes.c_double:
        return float(rng.normal())
    block = apart(size, WIDTH) if lanes else np.zeros(size)
    block[:] = rng.normal(size=block.shape) * 10.0 ** rng.integers(-3, 4)
    if rng.random() < 0.5:
        np.abs(block, out=block)
    return block


def called(function: Any, given: list[Block | float]) -> Block:
    """Call a function with copies of the arguments, and return the numbers in its arrays."""
    copies = [one.copy() if isinstance(one, np.ndarray) and one.ndim == 1 else one for one in given]
    for n, one in enumerate(given):
        if isinstance(one, np.ndarray) and one.ndim == 2:
            copies[n] = apart(len(one), WIDTH)
            copies[n][:] = one  # type: ignore[index]
    function(*(one.ctypes.data if isinstance(one, np.ndarray) else one for one in copies))
    return np.concatenate([one.ravel() for one in copies if isinstance(one, np.ndarray)])


@pytest.mark.slow
@pytest.mark.sampled(every=24)
@pytest.mark.parametrize("kind", LAWS)
def test_functions_of_a_law_have_the_bits_of_numba(kind: str) -> None:
    law, rng = example_law(kind), np.random.default_rng(1)
    for formula in law.trees()[:1]:
        writer = FormulaWriter(formula, law.parameters(), state_rates=law.state_trees())
        for part in SIGNATURES.keys() & (WITH_A_STATE if law.states else WITHOUT):
            same, written = compared(writer, part, rng)
            assert same == written > 0, part


def random_formula(seed: int) -> None:
    rng, states = random.Random(seed), seed % 3
    formula, rates = tree(rng, 3, states), tuple(tree(rng, 2, states) for _ in range(states))
    writer = FormulaWriter(formula, PARAMETERS, 3, rates)
    part = rng.choice(sorted(WITH_A_STATE if states else WITHOUT))
    same, written = compared(writer, part, np.random.default_rng(seed))
    assert same == written > 0, part


@pytest.mark.parametrize("seed", range(12))
def test_random_formulas_have_the_bits_of_numba(seed: int) -> None:
    random_formula(seed)


@pytest.mark.slow
@pytest.mark.parametrize("first", range(12, 1000, 100))
def test_many_random_formulas_have_the_bits_of_numba(first: int) -> None:
    for seed in range(first, min(first + 100, 1000)):
        random_formula(seed)


class OneCall(FormulaWriter):
    """A function that calls one helper, with numbers of the formula's constants as arguments."""

    helper, count = "", 0

    def statements(self, part: str) -> list[str]:
        return [f"s[0] = {self.helper}({', '.join(f'c[{n}]' for n in range(self.count))})"]


HELPERS = {name: function.__code__.co_argcount for name, function in CALLED.items()}
HELPERS |= dict.fromkeys(("sine", "versine", "exp_above", "sinh_below", "power_of_two", "expm1", "log1p", "tanh", "asinh"), 1)
HELPERS |= {"exp_radius": 3, "sine_radius": 3, "log_radius": 2, "power_radius": 3, "arcsinh_radius": 2, "tanh_radius": 2}
HELPERS |= {"fused": 3, "min": 2, "max": 2, "abs": 1, "sqrt": 1, "sin": 1, "cos": 1, "exp": 1, "log": 1}


@pytest.mark.sampled(every=5)
@pytest.mark.parametrize("part", ["radii", "radii_in_lanes"])
@pytest.mark.parametrize("helper", HELPERS)
def test_helpers_have_the_bits_of_numba(helper: str, part: str) -> None:
    writer = OneCall(example_law("coulomb").trees()[0], example_law("coulomb").parameters())
    writer.helper, writer.count = helper, HELPERS[helper]
    same, written = compared(writer, part, np.random.default_rng(2))
    assert same == written > 0


def test_a_wrong_function_is_noticed() -> None:
    law = example_law("hyperbolic-rate")
    writer = FormulaWriter(law.trees()[0], law.parameters())
    same, written = compared(writer, "value", np.random.default_rng(1), "out[0] = 1.0000000000000002 * (out[0] + 0.0)")
    assert same < written


def test_what_cannot_be_written_is_refused() -> None:
    for statement in ("while True: s[0] = 1.0", "s[0] = not 1.0", "s[0] = s[c]", "s[0] = 1.0 if 1.0 else 2.0"):
        with pytest.raises(NotImplementedError):
            MachineCode([statement], ("c[]", "s[]", "k[]"), False, NAMES)
