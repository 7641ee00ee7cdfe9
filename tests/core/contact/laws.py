"""A friction law with as many folds as wanted, for the tests of this folder."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any, ClassVar

import numpy as np
from hypothesis import strategies as st

import stickslip as ss
from stickslip.foundation.quantities import quantity
from stickslip.friction.formula.functions import cos, exp

SLAB = ss.ElasticSlab(density=2800.0, wave_speed=3500.0, thickness=1e4, normal_stress=1e8)
"""The paper's slab."""
Z, S = 9.8e6, 1e8
ALPHA_C = 0.196


@dataclass(frozen=True)
class Wavy(ss.friction.FrictionLaw):
    """mu = mean + amplitude cos(beat v + turn u) exp(-v / fade) - amplitude cos(turn u): it rises and falls with the rate."""

    kind: ClassVar[str] = "wavy-test"
    source: ClassVar[str] = "made up"

    mean: float = quantity("1", "friction at rest")
    amplitude: float = quantity("1", "amplitude")
    beat: float = quantity("s/m", "wavenumber along the slip rate")
    fade: float = quantity("m/s", "slip rate at which the waves fade")
    turn: float = quantity("1/m", "phase along slip", default=0.0)
    step: float = quantity("1", "step from static to sliding friction", at_least=0, default=0.0)

    @staticmethod
    def formula(law: Any, u: Any, v: Any) -> Any:
        return law.mean + law.amplitude * cos(law.beat * v + law.turn * u) * exp(-v / law.fade) - law.amplitude * cos(law.turn * u)

    @property
    def static_excess(self) -> float:
        return self.step

    def range(self) -> tuple[float, float]:
        return self.mean - 2 * abs(self.amplitude), self.mean + 2 * abs(self.amplitude) + self.step


def hyperbolic(alpha: float, static: float = 0.8, dynamic: float = 0.3) -> ss.friction.HyperbolicRate:
    """The paper's rate law, eq. (15)."""
    return ss.friction.HyperbolicRate(static=static, dynamic=dynamic, alpha=alpha)


def slab_problem(law: ss.friction.FrictionLaw, selection: str = "perfect-delay", **body: float) -> ss.Problem:
    """The paper's slab under a law, at the edge of sliding."""
    changed = ss.ElasticSlab(2800.0, 3500.0, 1e4, 1e8, **body) if body else SLAB
    return ss.Problem(changed, law, pull_rate=1e-9, initial_excess=0.0, selection=selection)


def q_of(alpha: float) -> float:
    """The paper's q = sqrt(alpha / alpha_c)."""
    return math.sqrt(alpha / ALPHA_C)


wavy_laws = st.builds(
    Wavy,
    mean=st.just(0.7),
    amplitude=st.floats(0.02, 0.3),
    beat=st.floats(0.05, 3.0),
    fade=st.floats(0.5, 20.0),
    turn=st.just(0.4),
    step=st.sampled_from([0.0, 0.05]),
)
"""Draw laws that rise and fall with the rate."""


def closed_critical_value(law: ss.friction.FrictionLaw) -> tuple[str, float] | None:
    """The closed form of a critical value of a bundled law on SLAB: paper section 3, and the steepest fall of Stribeck's curves."""
    if isinstance(law, ss.friction.SlipPlusRate):
        name, value = closed_critical_value(law.rate) or ("", math.nan)
        return f"rate.{name}", value
    if isinstance(law, ss.friction.PiecewiseLinearRate):
        steepest = -float(np.min(law.polynomials()[:, 1]))
        return ("normal_stress", Z / steepest) if steepest > 0.0 else None
    fall = S * (law.static - law.dynamic) if hasattr(law, "dynamic") else 0.0
    if fall <= 0.0:
        return None
    if isinstance(law, ss.friction.Coulomb):
        return "static", law.dynamic
    if isinstance(law, ss.friction.HyperbolicRate):
        return "alpha", Z / fall
    n = law.exponent
    y = (n - 1.0) / (n if isinstance(law, ss.friction.ExponentialStribeck) else n + 1.0)
    if isinstance(law, ss.friction.ExponentialStribeck):
        steepness = n * y**y * math.exp(-y)
    else:
        steepness = n * y ** ((n - 1.0) / n) / (1.0 + y) ** 2
    return "rate", steepness * fall / (Z + S * law.viscosity)
