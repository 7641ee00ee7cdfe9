"""The register of friction laws, by their names in scenario files."""

from __future__ import annotations

from typing import TYPE_CHECKING

from stickslip.foundation.classes_by_kind import ClassesByKind

if TYPE_CHECKING:
    from stickslip.friction.law import FrictionLaw

LAWS: ClassesByKind[FrictionLaw] = ClassesByKind(
    "stickslip.friction",
    {
        "sinusoidal-slip": "laws.of_slip.SinusoidalSlip",
        "hyperbolic-rate": "laws.of_rate.HyperbolicRate",
        "coulomb": "laws.of_rate.Coulomb",
        "carlson-langer": "laws.of_chains.CarlsonLanger",
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
        "both-ways": "laws.both_ways.BothWays",
        "self-energising": "laws.both_ways.SelfEnergising",
        "expression": "custom.from_expression.FromExpression",
        "table": "custom.points.FromTable",
    },
)
"""The class of every friction law by its name in scenario files, in the order of tables."""
