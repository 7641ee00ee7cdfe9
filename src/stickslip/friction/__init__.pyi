# The friction laws of the contact, and what makes laws from measured points.
from stickslip.extensions.inference.points.fit import Fit, fit, fit_each
from stickslip.extensions.inference.points.smooth import Smooth, smooth
from stickslip.friction.custom.from_expression import FromExpression
from stickslip.friction.custom.from_function import FromFunction
from stickslip.friction.custom.points import FromTable, Points
from stickslip.friction.law import FrictionLaw
from stickslip.friction.laws.both_ways import BothWays, SelfEnergising
from stickslip.friction.laws.bristles import Dahl, LuGre
from stickslip.friction.laws.combined import LaggedFriction, SlipPlusRate, SlipTimesRate
from stickslip.friction.laws.of_chains import CarlsonLanger
from stickslip.friction.laws.of_rate import (
    Coulomb,
    ExponentialStribeck,
    HyperbolicRate,
    PowerStribeck,
    VelocityStrengthening,
)
from stickslip.friction.laws.of_slip import (
    ExponentialCohesiveZone,
    ExponentialSlipWeakening,
    LinearSlipWeakening,
    ParabolicSlipWeakening,
    PowerSlipWeakening,
    SinusoidalSlip,
)
from stickslip.friction.laws.polylines import PiecewiseLinearRate, PiecewiseLinearSlip
from stickslip.friction.laws.rate_and_state import FlashHeating, RateAndState, TwoStateRateAndState
from stickslip.friction.register import LAWS

__all__ = [
    "LAWS",
    "BothWays",
    "CarlsonLanger",
    "Coulomb",
    "Dahl",
    "ExponentialCohesiveZone",
    "ExponentialSlipWeakening",
    "ExponentialStribeck",
    "Fit",
    "FlashHeating",
    "FrictionLaw",
    "FromExpression",
    "FromFunction",
    "FromTable",
    "HyperbolicRate",
    "LaggedFriction",
    "LinearSlipWeakening",
    "LuGre",
    "ParabolicSlipWeakening",
    "PiecewiseLinearRate",
    "PiecewiseLinearSlip",
    "Points",
    "PowerSlipWeakening",
    "PowerStribeck",
    "RateAndState",
    "SelfEnergising",
    "SinusoidalSlip",
    "SlipPlusRate",
    "SlipTimesRate",
    "Smooth",
    "TwoStateRateAndState",
    "VelocityStrengthening",
    "fit",
    "fit_each",
    "smooth",
]
