"""Linear growth of slip on a slab that weakens with slip, from rest.

A perturbation u = exp(lambda t) sinh(lambda (h - x) / c) of a slab under a rigid driver satisfies the friction law at x = 0 if

    lambda coth(lambda h / c) = c alpha_w,    alpha_w = -S mu'(u) / G

(Campillo et al. 1996, section 2, from eqs (7)-(13)): it grows if and only if alpha_w h > 1.
"""

from __future__ import annotations

import math

from stickslip.bodies import ElasticSlab


def growth_rate(slab: ElasticSlab, weakening: float) -> float:
    """Return the growth rate (1/s) of a perturbation of a slab that weakens with slip by -mu'(u) (1/m); 0 if the slab is stable.

    It solves lambda coth(lambda h / c) = c alpha_w with alpha_w = S weakening / G, for a slab under a rigid driver and without
    contact mass.

    Source: Campillo et al. 1996, section 2, from eqs (7)-(13).
    """
    from scipy.optimize import brentq  # here, because it takes a quarter of a second to import

    target = slab.normal_stress * weakening / slab.shear_modulus * slab.thickness
    if target <= 1.0:
        return 0.0
    x: float = brentq(lambda x: _excess(x) - (target - 1.0), 0.0, target + 1.0, xtol=1e-300)
    return x * slab.wave_speed / slab.thickness


def _excess(x: float) -> float:
    """Return x coth x - 1, from its series if the difference would lose digits."""
    if x < 0.05:
        return x**2 / 3 - x**4 / 45 + 2 * x**6 / 945 - x**8 / 4725
    return x / math.tanh(x) - 1.0
