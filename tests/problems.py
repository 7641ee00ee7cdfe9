"""The slab and block of the paper, and histories that several test modules use."""

from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

import stickslip as ss
from stickslip.engine.state.layout import Store

Floats = NDArray[np.float64]

DENSITY, SPEED, THICKNESS, NORMAL = 2800.0, 3500.0, 1e4, 1e8
IMPEDANCE, MODULUS, ROUND = DENSITY * SPEED, DENSITY * SPEED**2, 2 * THICKNESS / SPEED
PULL = 0.05 / ss.YEAR
SLAB = ss.ElasticSlab(DENSITY, SPEED, THICKNESS, NORMAL)
RATE_LAW = ss.friction.HyperbolicRate(static=0.8, dynamic=0.3, alpha=1.0)
CRITICAL = IMPEDANCE / (NORMAL * 0.5)


def slip_law_slab(wavenumber: float, beyond: float, extra_load: float = 0.0, pull: float = PULL) -> ss.Problem:
    """Return the slab `beyond` the slip of largest friction, under the load that friction held there."""
    start = math.pi / (2 * wavenumber) + beyond
    return ss.Problem(
        SLAB,
        ss.friction.SinusoidalSlip(1.0, 0.5, wavenumber),
        pull_rate=pull,
        initial_slip=start,
        initial_load=1.5e8 + extra_load,
    )


def slip_law_block(wavenumber: float, stiffness: float) -> ss.Problem:
    """Return the block at the slip where S mu' + K = 0, its driver 1e-3 m too far."""
    start = (math.pi / 2 + math.asin(stiffness / (1e14 * 0.5 * wavenumber))) / wavenumber
    block = ss.SpringBlock(DENSITY * 1e9, stiffness, 1e14)
    law = ss.friction.SinusoidalSlip(1.0, 0.5, wavenumber)
    return ss.Problem(block, law, pull_rate=PULL, initial_slip=start, initial_excess=stiffness * 1e-3)


def rate_law_slab(alpha: float = 1.0, **changes: object) -> ss.Problem:
    """Return the slab at its static strength under the rate law."""
    problem = ss.Problem(SLAB, replace(RATE_LAW, alpha=alpha), pull_rate=PULL, initial_excess=0.0)
    return replace(problem, **changes)


def scaled_rate(store: Store, factor: float) -> Store:
    """Return a copy of a history whose slip rate is wrong by a factor: a test of what reads it must notice."""
    wrong = store._replace(pieces=store.pieces.copy())
    wrong.rate[:] *= factor
    return wrong


def measured(
    law: ss.friction.FrictionLaw, slip: Floats | None, rate: Floats | None, noise: float, seed: int = 0
) -> ss.friction.Points:
    """Return points of a law, at slips (m), slip rates (m/s) or both, with normal noise of this standard deviation."""
    friction = law.coefficient(0.0 if slip is None else slip, 0.0 if rate is None else rate)
    return ss.friction.Points(friction + noise * np.random.default_rng(seed).standard_normal(friction.shape), slip, rate)


def of_each_kind(names: Iterable[str]) -> list[str]:
    """Return the first of some bundled scenarios of one dimension for each kind of body, law, loading and start."""
    found = dict[tuple[object, ...], str]()
    for name in names:
        problem = ss.load_scenario(name).problem
        start = problem.initial_load is None, problem.initial_state is None, problem.initial_rate is None
        mass = getattr(problem.body, "contact_mass", 0.0) > 0.0
        kinds = (type(one) for one in (problem.body, problem.friction, problem.pull_rate, problem.far_stress))
        found.setdefault((*kinds, *start, mass), name)
    return list(found.values())
