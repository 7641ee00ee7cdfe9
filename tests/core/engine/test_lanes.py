"""Lanes do what floats do, bit for bit: arithmetic, the functions of the engine that serve both, and series of every formula."""

from __future__ import annotations

import ctypes
import math
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

from stickslip.engine.lanes.workspace import apart
from stickslip.engine.series.polynomial import (
    bound_below,
    bound_of_slope,
    bounds_on_disc,
    magnitude,
    moment,
    multiply,
    powers_of,
    total,
)
from stickslip.engine.series.sine import sine, versine
from stickslip.engine.series.step_size import length_at
from stickslip.engine.state.layout import TERMS
from stickslip.foundation.kernels.memory.addresses import ahead, floats, integers
from stickslip.foundation.kernels.memory.pointers import rows_of
from stickslip.foundation.kernels.memory.simd import SIMD_WIDTH, chosen, store_across
from tests.core.engine.compiled import compiled
from tests.core.engine.formulas import FORMULAS, JET, functions_of

Block = Any

FUNCTIONS: dict[str, Callable[[Any], Any]] = {
    "sums": lambda c: c[0] + 2.0 * c[1] - c[2] / 3.0 + 1 - (-c[3]),
    "bounds": lambda c: min(max(c[0], c[1]), abs(c[2])),
    "functions": lambda c: math.sqrt(abs(c[0])) - np.floor(3.0 * c[1]),
    "sine": lambda c: sine(40.0 * c[0]) + 3.0 * versine(c[1]),
    "magnitude": lambda c: magnitude(c),
    "total": lambda c: total(c),
    "moment": lambda c: moment(c, 2),
    "bound": lambda c: bound_below(c),
    "length": lambda c: length_at(c, 1e-9, 0.5),
    "slope on a disc": lambda c: bound_of_slope(c, abs(c[4])),
    "value and mean on a disc": lambda c: bounds_on_disc(c, abs(c[4]))[0] + 8.0 * bounds_on_disc(c, abs(c[4]))[1],
}

WITH_MASS = ("cos", "exp", "expm1", "arcsinh", "product", "log1p")
"""Formulas of which the series of a contact with mass is tried, of the others that of one without."""


def aligned(rows: int) -> Block:
    """Rows of lanes, where the processor wants them."""
    return apart(rows, SIMD_WIDTH)


def series(seed: int) -> Block:
    """As many polynomials as there are lanes, one a column."""
    block = aligned(TERMS)
    block[:] = np.random.default_rng(seed).normal(size=block.shape) * 0.6 ** np.arange(TERMS)[:, None]
    return block


@pytest.mark.sampled(every=11)
@pytest.mark.parametrize("name", FUNCTIONS)
def test_functions_have_the_same_bits_in_lanes_and_floats(name: str) -> None:
    function = compiled(FUNCTIONS[name])

    @compiled
    def side_by_side(block: int, out: int) -> None:
        rows_of(out)[0] = function(rows_of(block))

    @compiled
    def alone(address: int) -> float:
        return function(floats(address))

    block, out = series(3), aligned(1)
    side_by_side(block.ctypes.data, out.ctypes.data)
    columns = [np.ascontiguousarray(block[:, n]) for n in range(SIMD_WIDTH)]
    assert out[0].tolist() == [alone(column.ctypes.data) for column in columns]
    assert len(set(out[0].tolist())) > 1


def test_multiplying_by_powers_has_the_same_bits_in_lanes() -> None:
    @compiled
    def side_by_side(block: int, powers: int, out: int) -> None:
        powers_of(rows_of(block)[0], rows_of(powers))
        multiply(rows_of(block), rows_of(powers), rows_of(out))

    @compiled
    def alone(address: int, powers: int, out: int) -> None:
        powers_of(floats(address)[0], floats(powers))
        multiply(floats(address), floats(powers), ahead(floats(out), 0))

    block, powers, out = series(4), aligned(TERMS), aligned(TERMS)
    side_by_side(block.ctypes.data, powers.ctypes.data, out.ctypes.data)
    for n in range(SIMD_WIDTH):
        column, own_powers, own = np.ascontiguousarray(block[:, n]), np.zeros(TERMS), np.zeros(TERMS)
        alone(column.ctypes.data, own_powers.ctypes.data, own.ctypes.data)
        assert out[:, n].tolist() == own.tolist()


def test_comparisons_choose_lane_by_lane() -> None:
    @compiled
    def side_by_side(block: int, out: int) -> int:
        a, b = rows_of(block)[0], rows_of(block)[1]
        rows_of(out)[0] = chosen((a > b) & ~(a >= 3.0), a, -b)
        rows_of(out)[1] = chosen(a == b, 1.0, b)
        return (a < b) | (a <= 0.0)

    numbers = np.array([[1.0, -1.0, 3.0, 2.0, np.nan, 0.0, 7.0, 2.5], [0.0, 2.0, 0.0, 2.0, 1.0, np.nan, 9.0, 2.0]])
    for first in range(0, 8, SIMD_WIDTH):
        block, out = aligned(2), aligned(2)
        block[:] = a, b = numbers[:, first : first + SIMD_WIDTH]
        bits = side_by_side(block.ctypes.data, out.ctypes.data)
        assert np.array_equal(out[0], np.where((a > b) & ~(a >= 3.0), a, -b), equal_nan=True)
        assert np.array_equal(out[1], np.where(a == b, 1.0, b), equal_nan=True)
        assert bits == sum(int(x) << n for n, x in enumerate((a < b) | (a <= 0.0)))


def test_rows_in_lanes_are_stored_across_as_columns() -> None:
    @compiled
    def store(block: int, targets: int) -> None:
        store_across(rows_of(block), integers(targets), 2)

    block, out = aligned(SIMD_WIDTH + 2), np.zeros((SIMD_WIDTH, SIMD_WIDTH + 3))
    block[:] = np.arange(block.size).reshape(block.shape)
    targets = np.array([row.ctypes.data for row in out])
    store(block.ctypes.data, targets.ctypes.data)
    assert np.array_equal(out[:, 2 : SIMD_WIDTH + 2], block[2:].T)
    assert not out[:, :2].any()
    assert not out[:, SIMD_WIDTH + 2 :].any()


@pytest.mark.sampled(every=6)
@pytest.mark.parametrize("name", FORMULAS)
def test_series_have_the_same_bits_in_lanes_and_floats(name: str) -> None:
    part = "motion_jet" if name in WITH_MASS else "rate_jet"
    functions, constants = functions_of(FORMULAS[name], 0.21)
    random = np.random.default_rng(8)
    c, k, load, side_by_side = aligned(len(constants)), aligned(12), series(5), aligned(2 * TERMS)
    c[:] = constants[:, None]
    k[:] = np.array([9.8, 100.0, 1.0, 0.05, 0.01, 0.0, 0.0, 3.0, 0.5, 0.1, 1.0, 0.0])[:, None]
    k[5], k[3] = random.uniform(0.0, 0.3, SIMD_WIDTH), random.uniform(0.02, 0.1, SIMD_WIDTH)
    load[0] += 60.0
    address = ctypes.CFUNCTYPE(None, *[ctypes.c_void_p] * 4)(functions.address(part + "s"))
    address(*(block.ctypes.data for block in (c, k, load, side_by_side)))
    for n in range(SIMD_WIDTH):
        own = [np.ascontiguousarray(block[:, n]) for block in (c, k, load, np.zeros_like(side_by_side))]
        JET(functions.address(part))(*(array.ctypes.data_as(ctypes.POINTER(ctypes.c_double)) for array in own))
        assert side_by_side[:, n].tolist() == own[3].tolist()
        assert np.isfinite(own[3]).all()
