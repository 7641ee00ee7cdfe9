"""Export the friction laws of the contact.

The laws of the registry are exported under the names of their classes. `FromExpression`, `FromFunction` and `FromTable` make
laws from formulas, functions and measured points of users.
"""

from stickslip.friction.custom.from_expression import ExpressionLaw, FromExpression
from stickslip.friction.custom.from_function import FromFunction
from stickslip.friction.custom.table import FromTable, TableLaw
from stickslip.friction.law import FrictionLaw
from stickslip.friction.laws.coulomb import Coulomb
from stickslip.friction.laws.exponential_cohesive_zone import ExponentialCohesiveZone
from stickslip.friction.laws.exponential_slip_weakening import ExponentialSlipWeakening
from stickslip.friction.laws.exponential_stribeck import ExponentialStribeck
from stickslip.friction.laws.hyperbolic_rate import HyperbolicRate
from stickslip.friction.laws.lagged import LaggedFriction
from stickslip.friction.laws.linear_slip_weakening import LinearSlipWeakening
from stickslip.friction.laws.parabolic_slip_weakening import ParabolicSlipWeakening
from stickslip.friction.laws.piecewise_linear_rate import PiecewiseLinearRate
from stickslip.friction.laws.piecewise_linear_slip import PiecewiseLinearSlip
from stickslip.friction.laws.power_stribeck import PowerStribeck
from stickslip.friction.laws.rate_and_state import RateAndState
from stickslip.friction.laws.sinusoidal_slip import SinusoidalSlip
from stickslip.friction.laws.slip_plus_rate import SlipPlusRate
from stickslip.friction.laws.slip_times_rate import SlipTimesRate
from stickslip.friction.laws.velocity_strengthening import VelocityStrengthening
from stickslip.friction.registry import LAWS

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
