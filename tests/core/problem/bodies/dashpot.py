"""A slab whose damping is not its impedance."""

from __future__ import annotations

import stickslip as ss

DROP = 0.3e8
"""Stress drop (Pa) of the Coulomb contact below."""


class SlabWithDashpot(ss.ElasticSlab):
    """A slab whose contact has a dashpot beside friction."""

    @property
    def damping(self) -> float:
        """Z + Z/2, Pa s/m."""
        return 1.5 * self.impedance


SLAB = SlabWithDashpot(2800, 3500, 1e4, 1e8)
LAW = ss.friction.Coulomb(0.8, 0.5)
PROBLEM = ss.Problem(SLAB, LAW, initial_excess=1e6)
WEAKENING = ss.friction.LinearSlipWeakening(0.8, 0.5, 2.0)
