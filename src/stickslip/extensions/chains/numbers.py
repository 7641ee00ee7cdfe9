"""A chain as the numbers that compiled code takes."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from stickslip.engine.series.polynomial import TERMS
from stickslip.extensions.chains.chain import Chain
from stickslip.extensions.chains.compiled import memory as at
from stickslip.extensions.chains.compiled.memory import Blocks, ChainNumbers, Laws, Room, Springs
from stickslip.foundation.errors import InputError
from stickslip.friction import FrictionLaw

SLOWEST = 1e-300
"""Lower bound of the bound of frequencies (1/s), for blocks that no spring holds."""
STRAIGHT = 1e-12
"""A piece of a law is a straight line if it is one at three points to this share (1) of its size."""


def numbers_of(chain: Chain) -> ChainNumbers:
    """Return the numbers of a chain. Raises InputError for a law that is not followed yet."""
    rows = chain.couplings
    mass, stiffness, normal, damping = (chain.values(name) for name in ("mass", "stiffness", "normal_force", "damping"))
    laws, which = chain.laws
    blocks = Blocks(mass, stiffness, normal, damping, which)
    tables = _laws(laws)
    sums = np.add.reduceat(rows.springs, rows.starts[:-1]) if len(rows.springs) else np.zeros(len(mass))
    sums[np.diff(rows.starts) == 0] = 0.0
    slopes = np.abs(tables.slopes).max(1)[which] * normal
    squares = (stiffness + rows.walls + 2.0 * sums + slopes) / mass
    fastest = max(math.sqrt(squares.max()), (damping / mass).max(), SLOWEST)
    forward = int(chain.direction == "forward")
    return ChainNumbers(Springs(*rows), blocks, tables, float(chain.pull_rate), forward, fastest, float(stiffness.sum()))


def _laws(laws: tuple[FrictionLaw, ...]) -> Laws:
    """Return the laws as straight lines between knots of slip."""
    most = max(len(law.pieces) for law in laws)
    knots = np.full((len(laws), most), np.inf)
    levels, slopes, excess = np.zeros((len(laws), most)), np.zeros((len(laws), most)), np.zeros(len(laws))
    rules = np.zeros((len(laws), 2), np.int64)
    for n, law in enumerate(laws):
        knots[n, 0] = -np.inf
        knots[n, 1 : len(law.pieces)] = law.knots
        excess[n] = law.static_excess
        rules[n] = law.counts == "net", law.memory == "since-arrest"
        for i in range(len(law.pieces)):
            levels[n, i], slopes[n, i] = _line(law, i)
    return Laws(knots, levels, slopes, excess, rules)


def _line(law: FrictionLaw, i: int) -> tuple[float, float]:
    """Return level and slope of a piece of a law that is a straight line of slip. Raises InputError if it is none."""
    from stickslip.friction.formula import RATE, SLIP, depends_on
    from stickslip.friction.formula.differences import value_and_slopes

    tree, numbers = law.trees()[i], law.numbers(i)
    places = np.array([0.0, 1.0, 2.0])
    values, slopes = value_and_slopes(tree, numbers, places, np.zeros(3))
    values, slope = np.broadcast_to(values, 3), np.broadcast_to(slopes[0], 3)
    size = np.abs(values).max() + np.abs(slope).max()
    if np.ptp(slope) > STRAIGHT * size or (depends_on(tree, RATE) and not _is_coulomb(law)):
        raise InputError(
            f"simulate: {type(law).__name__} is not a straight line of slip, which chains do not follow yet; "
            "allowed: Coulomb, LinearSlipWeakening, PiecewiseLinearSlip"
        )
    return float(values[0]), float(slope[0]) if depends_on(tree, SLIP) else 0.0


def _is_coulomb(law: FrictionLaw) -> bool:
    return not np.any(law.slopes(np.array([0.0, 1.0]), np.array([0.1, 1.0]))[1])


def room_of(count: int) -> Room:
    """Return room for the steps of so many blocks."""

    def whole() -> NDArray[np.int64]:
        return np.zeros(count, np.int64)

    lists = [whole() for _ in range(4)]
    return Room(
        np.empty((count, TERMS)), np.zeros(count), whole(), whole(), lists[0], lists[1], lists[2], lists[3],
        np.zeros(at.NUMBER_OF_COUNTS, np.int64),
    )
