"""Friction laws: what the contact resists with.

The laws of the registry are exported by the names of their classes; `FromExpression`, `FromFunction` and `FromTable` make laws
of what users bring.
"""

from stickslip.friction.contract import FrictionLaw
from stickslip.friction.coulomb import Coulomb
from stickslip.friction.exponential_cohesive_zone import ExponentialCohesiveZone
from stickslip.friction.exponential_slip_weakening import ExponentialSlipWeakening
from stickslip.friction.exponential_stribeck import ExponentialStribeck
from stickslip.friction.from_expression import ExpressionLaw, FromExpression
from stickslip.friction.from_function import FromFunction
from stickslip.friction.hyperbolic_rate import HyperbolicRate
from stickslip.friction.lagged import LaggedFriction
from stickslip.friction.linear_slip_weakening import LinearSlipWeakening
from stickslip.friction.parabolic_slip_weakening import ParabolicSlipWeakening
from stickslip.friction.piecewise_linear_rate import PiecewiseLinearRate
from stickslip.friction.piecewise_linear_slip import PiecewiseLinearSlip
from stickslip.friction.power_stribeck import PowerStribeck
from stickslip.friction.rate_and_state import RateAndState
from stickslip.friction.registry import LAWS
from stickslip.friction.sinusoidal_slip import SinusoidalSlip
from stickslip.friction.slip_plus_rate import SlipPlusRate
from stickslip.friction.slip_times_rate import SlipTimesRate
from stickslip.friction.table import FromTable, TableLaw
from stickslip.friction.velocity_strengthening import VelocityStrengthening

__all__ = [
    "LAWS",
    "Coulomb",
    "ExponentialCohesiveZone",
    "ExponentialSlipWeakening",
    "ExponentialStribeck",
    "ExpressionLaw",
    "FrictionLaw",
    "FromExpression",
    "FromFunction",
    "FromTable",
    "HyperbolicRate",
    "LaggedFriction",
    "LinearSlipWeakening",
    "ParabolicSlipWeakening",
    "PiecewiseLinearRate",
    "PiecewiseLinearSlip",
    "PowerStribeck",
    "RateAndState",
    "SinusoidalSlip",
    "SlipPlusRate",
    "SlipTimesRate",
    "TableLaw",
    "VelocityStrengthening",
]
