"""Folds and jumps of the hyperbolic rate law (15) on the massless contact of a slab: Campillo et al. 1996, section 3.

With q = sqrt(alpha / alpha_c), alpha_c = Z / (S (muS - muD)): g(v) = Z v + S mu(v) falls up to v1 = (q - 1) / alpha.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

from stickslip.foundation.errors import InputError
from stickslip.reference.bisection import bisect


@dataclass(frozen=True)
class HyperbolicFolds:
    """Impedance (Pa s/m), normal stress (Pa), coefficients at rest and at high rate, alpha (s/m) > alpha_c.

    Raises InputError where the contact is regular (alpha <= alpha_c): there are no folds.
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
        """S (muS - muD), in Pa."""
        return self.normal_stress * (self.static - self.dynamic)

    @property
    def critical_value(self) -> float:
        """alpha_c (s/m)."""
        return self.impedance / self.drop

    @property
    def q(self) -> float:
        """sqrt(alpha / alpha_c)."""
        return math.sqrt(self.alpha / self.critical_value)

    @property
    def fold_rate(self) -> float:
        """v1 (m/s), the lower end of the fast branch."""
        return (self.q - 1.0) / self.alpha

    @property
    def fold_load(self) -> float:
        """g(v1) = S mu1 = S muD + (Z / alpha) (2 q - 1), in Pa: down-jump under perfect delay."""
        return self.normal_stress * self.dynamic + self.impedance / self.alpha * (2.0 * self.q - 1.0)

    @property
    def jump_rate(self) -> float:
        """v_B (m/s): slip rate right after the jump at the static strength."""
        return (self.q**2 - 1.0) / self.alpha

    @property
    def maxwell_rate(self) -> float:
        """v_M (m/s), where equal areas end: x = alpha v solves x^2 / (2 q^2) + x / (1 + x) = ln(1 + x)."""
        return bisect(lambda x: _imbalance(x, self.q), 0.0, 4.0 * self.q**2) / self.alpha

    @property
    def maxwell_load(self) -> float:
        """beta_M (Pa), at which Maxwell's rule jumps both ways."""
        rate = self.maxwell_rate
        return self.normal_stress * self.dynamic + self.impedance * rate + self.drop / (1.0 + self.alpha * rate)


def _imbalance(x: float, q: float) -> float:
    """1 / (2 q^2) - [ln(1 + x) - x / (1 + x)] / x^2, which grows with x; by its series where it would lose digits."""
    if x < 0.1:
        return -sum((-x) ** k * (k + 1) / (k + 2) for k in range(1, 18)) - 0.5 * (q - 1.0) * (q + 1.0) / q**2
    return 0.5 / q**2 - (math.log1p(x) - x / (1.0 + x)) / x**2
