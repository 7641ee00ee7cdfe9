"""Slabs, and laws of slip and slip rate: the folds of their contact equation move with slip."""

from __future__ import annotations

from dataclasses import replace

import stickslip as ss

F = ss.friction
Z, S = 9.8e6, 1e8
SLAB = ss.ElasticSlab(density=2800.0, wave_speed=3500.0, thickness=1e3, normal_stress=S)
MATCHED = replace(SLAB, driver_impedance=Z)
"""Nothing comes back: the load is what the far side makes it."""
ROUND = SLAB.two_way_time

WEAKENING = F.SlipPlusRate(slip=F.LinearSlipWeakening(0.4, 0.3, 0.5), rate=F.HyperbolicRate(0.4, 0.2, 1.5))
WAVY = F.SlipPlusRate(slip=F.SinusoidalSlip(0.3, 0.05, 3.0), rate=F.HyperbolicRate(0.45, 0.1, 1.0))
PRODUCT = F.SlipTimesRate(slip=F.SinusoidalSlip(0.6, 0.1, 2.0), rate=F.HyperbolicRate(1.0, 0.4, 1.0))
FREE = F.FromExpression("0.35 + 0.1*cos(3*u) + 0.3*(1 + 0.2*sin(u))*exp(-(v/0.7)**2)")
KINKED = F.SlipPlusRate(
    slip=F.SinusoidalSlip(0.3, 0.05, 3.0), rate=F.PiecewiseLinearRate((0.0, 0.5, 1.5, 2.0), (0.4, 0.25, 0.32, 0.2))
)


def hardening(slope: float = 0.05) -> ss.friction.FrictionLaw:
    """mu = 0.3 + 0.5 / (1 + v) + slope u: the lower fold of the fast branch rises with slip until it takes the slip away."""
    return F.FromExpression("0.3 + 0.5/(1 + v) + k*u", {"k": slope}, counts="path")
