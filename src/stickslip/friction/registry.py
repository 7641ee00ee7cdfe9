"""Every friction law, by its name in scenario files. Adding a law is one file beside this one and one line here."""

from __future__ import annotations

from stickslip.friction.contract import FrictionLaw
from stickslip.friction.coulomb import Coulomb
from stickslip.friction.exponential_cohesive_zone import ExponentialCohesiveZone
from stickslip.friction.exponential_slip_weakening import ExponentialSlipWeakening
from stickslip.friction.exponential_stribeck import ExponentialStribeck
from stickslip.friction.from_expression import ExpressionLaw
from stickslip.friction.hyperbolic_rate import HyperbolicRate
from stickslip.friction.lagged import LaggedFriction
from stickslip.friction.linear_slip_weakening import LinearSlipWeakening
from stickslip.friction.parabolic_slip_weakening import ParabolicSlipWeakening
from stickslip.friction.piecewise_linear_rate import PiecewiseLinearRate
from stickslip.friction.piecewise_linear_slip import PiecewiseLinearSlip
from stickslip.friction.power_stribeck import PowerStribeck
from stickslip.friction.rate_and_state import RateAndState
from stickslip.friction.sinusoidal_slip import SinusoidalSlip
from stickslip.friction.slip_plus_rate import SlipPlusRate
from stickslip.friction.slip_times_rate import SlipTimesRate
from stickslip.friction.table import TableLaw
from stickslip.friction.velocity_strengthening import VelocityStrengthening

LAWS: dict[str, type[FrictionLaw]] = {
    law.kind: law
    for law in (
        SinusoidalSlip,
        HyperbolicRate,
        Coulomb,
        LinearSlipWeakening,
        ExponentialSlipWeakening,
        ParabolicSlipWeakening,
        ExponentialCohesiveZone,
        PiecewiseLinearSlip,
        ExponentialStribeck,
        PowerStribeck,
        PiecewiseLinearRate,
        VelocityStrengthening,
        RateAndState,
        LaggedFriction,
        SlipPlusRate,
        SlipTimesRate,
        ExpressionLaw,
        TableLaw,
    )
}
