"""A chain as the numbers that compiled code takes."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from stickslip.engine.compiled_formula import CompiledFormula, compile_formula
from stickslip.engine.state.layout import TERMS
from stickslip.extensions.chains.chain import Chain
from stickslip.extensions.chains.compiled import memory as at
from stickslip.extensions.chains.compiled.memory import Blocks, ChainNumbers, Laws, Room, Springs
from stickslip.foundation.kernels.uncompiled import lend_memory
from stickslip.friction import FrictionLaw
from stickslip.friction.formula import RATE, SLIP, depends_on
from stickslip.friction.formula.differences import value_and_slopes

SLOWEST = 1e-300
"""Lower bound of the bound of frequencies (1/s), for blocks that no spring holds."""
ROUNDING = 1e-12
"""A piece of a law is a straight line of slip if its slopes at some points agree to this share (1) of its size."""


class Numbers(NamedTuple):
    """The numbers of a chain, and what must live as long as they do: formulas, and their constants."""

    chain: ChainNumbers
    owners: tuple[object, ...]


def numbers_of(chain: Chain) -> Numbers:
    """Return the numbers of a chain. Formulas of laws that are not straight in slip are compiled."""
    rows = chain.couplings
    mass, stiffness, normal, damping = (chain.values(name) for name in ("mass", "stiffness", "normal_force", "damping"))
    laws, which = chain.laws
    tables, owners = _laws(laws)
    sums = np.zeros(chain.count)
    np.add.at(sums, np.repeat(np.arange(chain.count), np.diff(rows.starts)), rows.springs)
    slopes = np.abs(tables.slopes).max(1)[which] * normal
    squares = (stiffness + rows.walls + 2.0 * sums + slopes) / mass
    fastest = max(math.sqrt(squares.max()), (damping / mass).max(), SLOWEST)
    forward, straight = int(chain.direction == "forward"), int(tables.rules[:, at.STRAIGHT].all())
    blocks = Blocks(mass, stiffness, normal, damping, which)
    total = float(stiffness.sum())
    return Numbers(ChainNumbers(Springs(*rows), blocks, tables, float(chain.pull_rate), forward, fastest, total, straight), owners)


def _laws(laws: tuple[FrictionLaw, ...]) -> tuple[Laws, tuple[object, ...]]:
    """Return the laws, and what must live as long as their numbers."""
    shape = len(laws), max(len(law.pieces) for law in laws)
    knots = np.full(shape, np.inf)
    levels, slopes, references, excess = np.zeros(shape), np.zeros(shape), np.zeros(shape), np.zeros(len(laws))
    rules = np.zeros((len(laws), 3), np.int64)
    values_at, jets_at, radii_at, constants_at = (np.zeros(shape, np.int64) for _ in range(4))
    owners: list[object] = []
    for n, law in enumerate(laws):
        count = len(law.pieces)
        knots[n, 0], knots[n, 1:count] = -np.inf, law.knots
        excess[n] = law.static_excess
        rules[n] = law.counts == "net", getattr(law, "memory", "all") == "since-arrest", all(is_line(law, i) for i in range(count))
        for i in range(count):
            references[n, i] = law.knots[max(i - 1, 0)] if law.knots else 0.0
            levels[n, i] = law.piece_coefficient(i, references[n, i], 0.0)
            if rules[n, at.STRAIGHT]:
                slopes[n, i] = _slope(law, i, references[n, i])
                continue
            formula, constants = _formula(law, i, references[n, i])
            owners += [formula, constants]
            values_at[n, i], jets_at[n, i] = formula.address("value"), formula.address("motion_jet")
            radii_at[n, i], constants_at[n, i] = formula.address("radii"), constants.ctypes.data
    return Laws(knots, levels, slopes, references, excess, rules, values_at, jets_at, radii_at, constants_at), tuple(owners)


def _formula(law: FrictionLaw, i: int, reference: float) -> tuple[CompiledFormula, NDArray[np.float64]]:
    """Return the compiled formula of a piece of a law, and its constants."""
    formula = compile_formula(law.trees()[i], law.parameters(), ())
    constants = np.zeros(formula.size)
    formula.fill(np.array(law.piece_values(i)), reference, constants)
    lend_memory(constants)
    return formula, constants


def is_line(law: FrictionLaw, i: int) -> bool:
    """Return True if a piece of a law is a straight line of slip."""
    tree, numbers = law.trees()[i], law.numbers(i)
    places, rates = np.array([0.0, 0.3, 1.7, 0.1, 0.9]), np.array([0.0, 0.1, 1.0, 10.0, 0.5])
    found = value_and_slopes(tree, numbers, places, rates)[1]
    by_slip, by_rate = (np.broadcast_to(found[k], places.shape) for k in range(2))
    size = abs(by_slip[0]) + abs(law.piece_coefficient(i, 0.0, 0.0))
    bends = depends_on(tree, RATE) and bool(by_rate.any())
    return not (bends or (depends_on(tree, SLIP) and float(np.ptp(by_slip)) > ROUNDING * size))


def _slope(law: FrictionLaw, i: int, reference: float) -> float:
    """Return the slope (1/m) of a piece of a law that is a straight line of slip."""
    found = value_and_slopes(law.trees()[i], law.numbers(i), np.array([reference]), np.zeros(1))[1]
    return float(np.broadcast_to(found[0], 1)[0])


def room_of(count: int) -> Room:
    """Return room for the steps of so many blocks."""

    def whole() -> NDArray[np.int64]:
        return np.zeros(count, np.int64)

    lists = whole(), whole(), whole(), whole()
    return Room(
        np.empty((count, TERMS)), np.zeros(count), whole(), whole(), *lists, np.zeros(at.NUMBER_OF_COUNTS, np.int64), np.zeros(2)
    )
