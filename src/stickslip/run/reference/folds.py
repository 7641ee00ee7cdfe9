"""Folds and jumps of the hyperbolic rate law (15) on the massless contact of a slab, and the delay that a little inertia causes.

With q = sqrt(alpha / alpha_c) and alpha_c = Z / (S (muS - muD)), the resistance g(v) = Z v + S mu(v) falls up to the fold
v1 = (q - 1) / alpha. Source: Campillo et al. 1996, section 3.

With little inertia the slip rate obeys eps dv/dt = load - g(v), with a load that passes the fold at the rate b (Pa/s) and
g = g_fold + a (v - v_fold)^2 + ... near it (a = |g''| / 2, Pa s^2/m^2). With time in units of k = (eps^2 / (a b))^(1/3) s, the
scaled deviation from the fold obeys X' = -T - X^2. The solution that comes from the branch is X = -Ai'(-T) / Ai(-T), which diverges
at the first zero of the Airy function Ai, T = 2.338. Source: Haberman 1979, SIAM J. Appl. Math. 37, 69.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

from scipy.optimize import brentq

from stickslip.foundation.errors import InputError

AIRY_ZERO = 2.338107410459767
"""Magnitude of the first zero of the Airy function Ai."""


@dataclass(frozen=True)
class HyperbolicFolds:
    """Folds and jumps of the hyperbolic rate law on a slab, with Z (Pa s/m), S (Pa) and alpha (s/m) of eq. (15).

    Raises InputError if the contact is regular (alpha <= alpha_c), so that there are no folds.

    Source: Campillo et al. 1996, section 3 and Figs 3-4, from eqs (12) and (15).
    """

    impedance: float
    normal_stress: float
    static: float
    dynamic: float
    alpha: float

    def __post_init__(self) -> None:
        if self.drop <= 0.0 or self.alpha <= self.critical_value:
            raise InputError(f"HyperbolicFolds: alpha = {self.alpha:g} s/m is regular, there are no folds")

    @property
    def drop(self) -> float:
        """The strength drop S (muS - muD) (Pa)."""
        return self.normal_stress * (self.static - self.dynamic)

    @property
    def critical_value(self) -> float:
        """The critical value alpha_c = Z / (S (muS - muD)) (s/m)."""
        return self.impedance / self.drop

    @property
    def q(self) -> float:
        """The pure number sqrt(alpha / alpha_c)."""
        return math.sqrt(self.alpha / self.critical_value)

    @property
    def fold_rate(self) -> float:
        """The slip rate v1 of the fold (m/s), the lower end of the fast branch."""
        return (self.q - 1.0) / self.alpha

    @property
    def fold_load(self) -> float:
        """G(v1), called S mu1 in the paper, S muD + (Z / alpha) (2 q - 1) (Pa): perfect delay jumps down there."""
        return self.normal_stress * self.dynamic + self.impedance / self.alpha * (2.0 * self.q - 1.0)

    @property
    def jump_rate(self) -> float:
        """The slip rate v_B right after the jump at the static strength (m/s)."""
        return (self.q**2 - 1.0) / self.alpha

    @property
    def maxwell_rate(self) -> float:
        """The slip rate v_M of equal areas (m/s): x = alpha v_M solves x^2 / (2 q^2) + x / (1 + x) = ln(1 + x)."""
        return float(brentq(lambda x: _imbalance(x, self.q), 0.0, 4.0 * self.q**2, xtol=1e-300)) / self.alpha

    @property
    def maxwell_load(self) -> float:
        """The load beta_M at which Maxwell's rule jumps, both up and down (Pa)."""
        rate = self.maxwell_rate
        return self.normal_stress * self.dynamic + self.impedance * rate + self.drop / (1.0 + self.alpha * rate)


def _imbalance(x: float, q: float) -> float:
    """Return 1 / (2 q^2) - [ln(1 + x) - x / (1 + x)] / x^2, which grows with x, from its series if it would lose digits."""
    if x < 0.1:
        return -sum((-x) ** k * (k + 1) / (k + 2) for k in range(1, 18)) - 0.5 * (q - 1.0) * (q + 1.0) / q**2
    return 0.5 / q**2 - (math.log1p(x) - x / (1.0 + x)) / x**2


def fold_delay(inertia: float, curvature: float, load_rate: float) -> float:
    """Return the delay (s) of a jump after the load passes the fold, in the limit of small inertia.

    `inertia` is the contact mass eps (Pa s^2/m, which is kg/m^2), or for lagged friction Z times the time of the lag; `curvature`
    is |g''| at the fold (Pa s^2/m^2), and `load_rate` the magnitude of the rate of change of the load there (Pa/s).

    Source: Haberman 1979, SIAM J. Appl. Math. 37, 69.
    """
    return float(AIRY_ZERO * (inertia**2 / (0.5 * curvature * load_rate)) ** (1.0 / 3.0))
