"""Export the friction laws of the contact; each is imported when it is first used.

To add a law, add a class to `laws` (docs/adding-a-law.md), its place to `LAWS`, and its import and name to `__init__.pyi`, the page
of all names. `FromExpression`, `FromFunction` and `FromTable` make laws from formulas, functions and measured points of users;
`smooth` and `fit`, of an extension, make laws from noisy points.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from stickslip.foundation.classes_by_kind import ClassesByKind
from stickslip.foundation.lazy_names import lazy_names

if TYPE_CHECKING:
    from stickslip.friction.law import FrictionLaw

LAWS: ClassesByKind[FrictionLaw] = ClassesByKind(
    "stickslip.friction",
    {
        "sinusoidal-slip": "laws.of_slip.SinusoidalSlip",
        "hyperbolic-rate": "laws.of_rate.HyperbolicRate",
        "coulomb": "laws.of_rate.Coulomb",
        "linear-slip-weakening": "laws.of_slip.LinearSlipWeakening",
        "exponential-slip-weakening": "laws.of_slip.ExponentialSlipWeakening",
        "power-slip-weakening": "laws.of_slip.PowerSlipWeakening",
        "parabolic-slip-weakening": "laws.of_slip.ParabolicSlipWeakening",
        "exponential-cohesive-zone": "laws.of_slip.ExponentialCohesiveZone",
        "piecewise-linear-slip": "laws.polylines.PiecewiseLinearSlip",
        "exponential-stribeck": "laws.of_rate.ExponentialStribeck",
        "power-stribeck": "laws.of_rate.PowerStribeck",
        "piecewise-linear-rate": "laws.polylines.PiecewiseLinearRate",
        "velocity-strengthening": "laws.of_rate.VelocityStrengthening",
        "rate-and-state": "laws.rate_and_state.RateAndState",
        "two-state-rate-and-state": "laws.rate_and_state.TwoStateRateAndState",
        "lagged": "laws.combined.LaggedFriction",
        "lugre": "laws.bristles.LuGre",
        "dahl": "laws.bristles.Dahl",
        "flash-heating": "laws.rate_and_state.FlashHeating",
        "sum": "laws.combined.SlipPlusRate",
        "product": "laws.combined.SlipTimesRate",
        "expression": "custom.from_expression.FromExpression",
        "table": "custom.points.FromTable",
    },
)
"""The class of every friction law by its name in scenario files, in the order of tables."""

__getattr__, __dir__ = lazy_names(__name__, __file__)
