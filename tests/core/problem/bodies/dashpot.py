"""Slabs whose contact has a dashpot: by its field, and by overriding the damping."""

from __future__ import annotations

import stickslip as ss

DROP = 0.3e8
"""Stress drop (Pa) of the Coulomb contact below."""


class SlabWithDashpot(ss.ElasticSlab):
    """A slab whose damping is not its impedance, though it was given no dashpot: a body of a user."""

    @property
    def damping(self) -> float:
        """Z + Z/2, Pa s/m."""
        return 1.5 * self.impedance


OWN = SlabWithDashpot(2800, 3500, 1e4, 1e8)
SLAB = ss.ElasticSlab(2800, 3500, 1e4, 1e8, contact_damping=4.9e6)
LAW = ss.friction.Coulomb(0.8, 0.5)
PROBLEM = ss.Problem(SLAB, LAW, initial_excess=1e6)
WEAKENING = ss.friction.LinearSlipWeakening(0.8, 0.5, 2.0)
