"""Problems of every kind that the engine knows, random but reproducible."""

from __future__ import annotations

import math

import numpy as np

import stickslip as ss


def away_from_jumps(run: ss.Solution, times: np.ndarray) -> np.ndarray:
    """Return which times are not within a hair of a shock, where the two may stand on different sides."""
    shocks = run.shocks.time.to_numpy()
    if len(shocks) == 0:
        return np.ones(len(times), bool)
    return np.abs(times[:, None] - shocks).min(axis=1) > 1e-6 * run.duration


F = ss.friction


def slab(rng: np.random.Generator, **changes: float) -> ss.ElasticSlab:
    values = {
        "density": rng.uniform(2000, 3500),
        "wave_speed": rng.uniform(1500, 4500),
        "thickness": 10 ** rng.uniform(2.5, 4.5),
        "normal_stress": 10 ** rng.uniform(6.5, 8.5),
    }
    return ss.ElasticSlab(**(values | changes))


def block(rng: np.random.Generator) -> ss.SpringBlock:
    mass, stiffness = 10 ** rng.uniform(-1, 12), 10 ** rng.uniform(1, 13)
    damping = rng.choice([0.0, 0.3]) * math.sqrt(mass * stiffness)
    return ss.SpringBlock(mass, stiffness, 10 ** rng.uniform(1, 14), damping=damping)


def slip_scale(body: ss.ElasticSlab | ss.SpringBlock) -> float:
    """Slip that sheds a load as large as the normal one, m."""
    normal = body.normal_stress if isinstance(body, ss.ElasticSlab) else body.normal_force
    return normal / body.stiffness


def rate_scale(body: ss.ElasticSlab | ss.SpringBlock) -> float:
    """Slip rate at which the body resists as much as the normal load, m/s."""
    if isinstance(body, ss.ElasticSlab):
        return body.normal_stress / body.impedance
    return body.normal_force / math.sqrt(body.mass * body.stiffness)


def slip_law(rng: np.random.Generator, body: ss.ElasticSlab | ss.SpringBlock) -> ss.friction.FrictionLaw:
    scale = slip_scale(body)
    if rng.random() < 0.5:
        return F.SinusoidalSlip(rng.uniform(0.5, 1.0), rng.uniform(0.05, 0.4), rng.uniform(1, 30) / scale)
    return F.LinearSlipWeakening(rng.uniform(0.5, 0.9), rng.uniform(0.05, 0.45), rng.uniform(0.02, 1.0) * scale)


def rate_law(rng: np.random.Generator, body: ss.ElasticSlab | ss.SpringBlock) -> ss.friction.FrictionLaw:
    if rng.random() < 0.3:
        return F.Coulomb(rng.uniform(0.5, 0.9), rng.uniform(0.05, 0.45))
    return F.HyperbolicRate(rng.uniform(0.5, 0.9), rng.uniform(0.05, 0.45), 10 ** rng.uniform(-1, 2) / rate_scale(body))


def problem(rng: np.random.Generator, body: ss.ElasticSlab | ss.SpringBlock, law: ss.friction.FrictionLaw) -> ss.Problem:
    normal = body.normal_stress if isinstance(body, ss.ElasticSlab) else body.normal_force
    return ss.Problem(
        body,
        law,
        pull_rate=10 ** rng.uniform(-4, -1.5) * rate_scale(body),
        initial_slip=rng.uniform(0.0, 1.0) * slip_scale(body) if law.counts == "net" else 0.0,
        initial_excess=10 ** rng.uniform(-5, -1) * normal,
    )


def duration(body: ss.ElasticSlab | ss.SpringBlock, rounds: float) -> float:
    return rounds * (body.two_way_time if isinstance(body, ss.ElasticSlab) else body.period)


KINDS = {
    "slab, slip law": lambda rng: (body := slab(rng), slip_law(rng, body)),
    "slab, rate law": lambda rng: (body := slab(rng), rate_law(rng, body)),
    "lossy slab, slip law": lambda rng: (
        body := slab(rng, driver_impedance=float(10 ** rng.uniform(5, 8))),
        slip_law(rng, body),
    ),
    "dead load, rate law": lambda rng: (body := slab(rng, driver_impedance=0.0), rate_law(rng, body)),
    "slab with mass, slip law": lambda rng: (body := slab(rng, contact_mass=1e6), slip_law(rng, body)),
    "slab with mass, rate law": lambda rng: (body := slab(rng, contact_mass=1e6), rate_law(rng, body)),
    "block, slip law": lambda rng: (body := block(rng), slip_law(rng, body)),
    "block, rate law": lambda rng: (body := block(rng), rate_law(rng, body)),
}
"""Body and law drawn at random, of every kind that the method of steps can follow."""
