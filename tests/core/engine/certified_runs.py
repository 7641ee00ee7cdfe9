"""Runs of every kind of step, and what they lack of the contact equation, worked out in double precision without compiled code."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

import stickslip as ss
from stickslip.engine.history.history import History, Positions
from stickslip.engine.state.layout import HistoryPiece

F = ss.friction
SLAB = ss.ElasticSlab(2800.0, 3500.0, 1e4, 1e8)
BLOCK = ss.SpringBlock(1.0, 20.0, 10.0)
Floats = NDArray[np.float64]
Mu = Callable[[Any, Any, Any], Any]

ROUNDING = 4e-14
"""Rounding of the terms of the contact equation in this test and in the engine (1), relative to the sum of their sizes."""
PLACES = np.linspace(0.0, 1.0, 41)


def shortfall(history: History, mu: Mu) -> tuple[Floats, Floats]:
    """What the contact equation lacks at PLACES of each piece of slip, less what rounding can do, and the bounds of the pieces."""
    problem, store = history.problem, history.store
    moving = np.flatnonzero(store.mode != 0)
    at = Positions.inside(np.repeat(moving, len(PLACES)), np.tile(PLACES, len(moving)))
    direction, rate = store.mode[at.piece], history.rate(at)
    load = history.excess(at) + problem.strength
    slip, state = history.law_slip(at), history.state(at)
    friction = direction * problem.normal * mu(slip, np.abs(rate), state)
    steeper = problem.normal * np.abs(mu(slip * (1.0 + 1e-9), np.abs(rate), state) - mu(slip, np.abs(rate), state)) * 1e9
    body: Any = problem.body
    lacks = body.damping * rate + friction - load
    inertia = 0.0
    if body.has_inertia:
        powers = np.arange(1, store.rate.shape[1])
        slopes = store.rate[at.piece, 1:] * powers * at.xi[:, None] ** (powers - 1)
        inertia = (body.mass if isinstance(body, ss.SpringBlock) else body.contact_mass) / store.speed[at.piece]
        lacks = lacks + inertia * slopes.sum(axis=1)
        inertia = inertia * np.abs(slopes).sum(axis=1)
    terms = np.abs(load) + np.abs(friction) + body.damping * np.abs(store.rate[at.piece]).sum(axis=1) + inertia + steeper
    real: Floats = np.maximum(np.abs(lacks) - ROUNDING * terms, 0.0).reshape(-1, len(PLACES)).max(axis=1)
    return real, HistoryPiece.of(store.pieces).residual[moving]


def smooth_law(seed: int, rate: bool, scale: float) -> str:
    """A random smooth law of slip, or of slip and slip rate, with features of a tenth of the scale (m and m/s) or more."""
    rng = np.random.default_rng(seed)
    terms = ["0.6"]
    for shape in rng.choice(
        ["sin({z})", "tanh({z})", "exp(-{z}**2)", "1/(1+{z}**2)", "sqrt(1+{z}**2)/9", "log(1+{z}**2)/5", "arcsinh({z})/3"], 3
    ):
        x = "v" if rate and rng.random() < 0.5 else "u"
        z = f"(({x}-{rng.uniform(0.0, 2.0) * scale!r})/{rng.uniform(0.1, 0.7) * scale!r})"
        terms.append(f"{float(rng.choice([-1.0, 1.0]) * rng.uniform(0.01, 0.04))!r}*" + shape.format(z=z))
    return "+".join(terms)


def slab(seed: int) -> ss.Problem:
    return ss.Problem(SLAB, F.FromExpression(smooth_law(seed, False, 1.0)), pull_rate=0.3, initial_excess=1.5e7)


def slab_of_rate(seed: int) -> ss.Problem:
    law = F.FromExpression(f"0.5+0.1/(1+v/0.7)+0.01*tanh((v-{1.0 + 0.1 * seed})/0.5)+0.02*log(1+v)")
    return ss.Problem(SLAB, law, pull_rate=3.0 + seed, initial_excess=1e7)


def slab_of_both(seed: int) -> ss.Problem:
    law = F.FromExpression(f"0.6+0.02*sin({2 + seed}*u)*exp(-v/3)+0.01*log(1+v)")
    return ss.Problem(SLAB, law, pull_rate=1.0, initial_excess=1.5e7)


def block(seed: int) -> ss.Problem:
    return ss.Problem(BLOCK, F.FromExpression(smooth_law(seed, True, 0.5)), pull_rate=0.1, initial_excess=4.0)


def damped_block(seed: int) -> ss.Problem:
    return replace(block(seed), body=replace(BLOCK, damping=2.0))


def contact_mass(seed: int) -> ss.Problem:
    """A contact that hardly is stiff: it takes explicit steps for the most part."""
    return replace(slab(seed), body=replace(SLAB, contact_mass=1e7))


def stiff(seed: int) -> ss.Problem:
    """A contact that takes implicit steps once it has settled."""
    return replace(slab(seed), body=replace(SLAB, contact_mass=1e3))


def barrier(seed: int) -> ss.Problem:
    """A massless contact that settles against friction that rises within a millimetre: implicit steps."""
    law = F.FromExpression(f"0.6+0.15*(1+tanh((u-{0.5 + 0.1 * seed})/1e-3))")
    return ss.Problem(SLAB, law, initial_excess=1.2e7)


def rate_and_state(seed: int) -> ss.Problem:
    law = F.RateAndState(0.6, 0.012, 0.01 + 0.002 * seed, 0.01, evolution=("ageing", "slip", "ageing")[seed % 3])
    return ss.Problem(SLAB, law, pull_rate=1.0, initial_load=6.3e7, initial_state=1e-2)


def lagged(seed: int) -> ss.Problem:
    return ss.Problem(SLAB, F.LaggedFriction(F.HyperbolicRate(0.8, 0.3, 0.05), 0.05 * (1 + seed)), initial_excess=1e7)


RUNS = (slab, slab_of_rate, slab_of_both, block, damped_block, contact_mass, stiff, barrier, rate_and_state, lagged)


def coefficient(problem: ss.Problem) -> Mu:
    """The law as its arrays give it, without compiled code; the state is that of its formulas."""
    law = problem.friction
    return lambda u, v, w: law.coefficient(u, v, w) if law.state is not None else law.coefficient(u, v)


def duration(problem: ss.Problem) -> float:
    """Up to the first echo of a slab, or some way through the swing of a block, s."""
    return 5.5 if isinstance(problem.body, ss.ElasticSlab) else 1.5
