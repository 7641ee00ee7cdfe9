"""A slab and a block that figures are drawn of."""

from __future__ import annotations

import stickslip as ss

SLAB = ss.ElasticSlab(density=2800, wave_speed=3500, thickness=1e4, normal_stress=1e8)
BLOCK = ss.SpringBlock(mass=2.8e12, stiffness=3.43e13, normal_force=1e14)
LAW = ss.friction.HyperbolicRate(static=0.8, dynamic=0.3, alpha=1.0)
SLAB_PROBLEM = ss.Problem(SLAB, LAW, pull_rate=0.05 / ss.YEAR, initial_excess=0.0)
BLOCK_PROBLEM = ss.Problem(BLOCK, LAW, pull_rate=0.05 / ss.YEAR, initial_excess=0.0)
