"""A chain as the numbers that compiled code takes."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from stickslip.engine import TERMS, CompiledFormula, compile_formula
from stickslip.extensions.chains.chain import Chain
from stickslip.extensions.chains.compiled import memory as at
from stickslip.extensions.chains.compiled.memory import Blocks, ChainNumbers, Laws, Springs, StepRoom
from stickslip.foundation.kernels.uncompiled import lend_memory
from stickslip.friction import Coulomb, FrictionLaw, LinearSlipWeakening, PiecewiseLinearSlip

SLOWEST = 1e-300
"""Lower bound of the bound of frequencies (1/s), for blocks that no spring holds."""
STRAIGHT_LAWS = (Coulomb, LinearSlipWeakening, PiecewiseLinearSlip)
"""Laws that are straight in slip from knot to knot, so that moving blocks are a linear system."""


class PreparedChain(NamedTuple):
    """The numbers of a chain, and what must live as long as they do: formulas, and their constants."""

    chain: ChainNumbers
    owners: tuple[object, ...]


def numbers_of(chain: Chain) -> PreparedChain:
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
    return PreparedChain(
        ChainNumbers(Springs(*rows), blocks, tables, float(chain.pull_rate), forward, fastest, total, straight), owners
    )


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
        rules[n] = law.counts == "net", getattr(law, "memory", "all") == "since-arrest", is_straight(law)
        for i in range(count):
            references[n, i] = law.knots[max(i - 1, 0)] if law.knots else 0.0
            levels[n, i] = law.piece_coefficient(i, references[n, i], 0.0)
            if rules[n, at.STRAIGHT]:
                slopes[n, i] = _slope(law, i)
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


def is_straight(law: FrictionLaw) -> bool:
    """Return True for a law that is straight in slip from knot to knot."""
    return type(law) in STRAIGHT_LAWS


def _slope(law: FrictionLaw, i: int) -> float:
    """Return the slope (1/m) of a piece of a law that is straight in slip."""
    if not law.knots:
        return 0.0
    ends = (law.knots[0] - 1.0, *law.knots, law.knots[-1] + 1.0)
    return float(law.slopes(0.5 * (ends[i] + ends[i + 1]))[0])


def room_of(count: int) -> StepRoom:
    """Return room for the steps of so many blocks."""

    def whole() -> NDArray[np.int64]:
        return np.zeros(count, np.int64)

    lists = whole(), whole(), whole(), whole()
    return StepRoom(
        np.empty((count, TERMS)), np.zeros(count), whole(), whole(), *lists, np.zeros(at.NUMBER_OF_COUNTS, np.int64), np.zeros(2)
    )
