"""Export the friction laws of the contact.

To add a law, add one file to `laws` (docs/adding-a-law.md), and here its import, its place in `LAWS` and its name in `__all__`.
`FromExpression`, `FromFunction` and `FromTable` make laws from formulas, functions and measured points of users;
`smooth` and `fit` make laws from noisy points.
"""

from stickslip.friction.custom.fit import Fit, fit, fit_each
from stickslip.friction.custom.from_expression import FromExpression
from stickslip.friction.custom.from_function import FromFunction
from stickslip.friction.custom.measured import Points
from stickslip.friction.custom.smooth import Smooth, smooth
from stickslip.friction.custom.table import FromTable
from stickslip.friction.law import FrictionLaw
from stickslip.friction.laws.coulomb import Coulomb
from stickslip.friction.laws.dahl import Dahl
from stickslip.friction.laws.exponential_cohesive_zone import ExponentialCohesiveZone
from stickslip.friction.laws.exponential_slip_weakening import ExponentialSlipWeakening
from stickslip.friction.laws.exponential_stribeck import ExponentialStribeck
from stickslip.friction.laws.flash_heating import FlashHeating
from stickslip.friction.laws.hyperbolic_rate import HyperbolicRate
from stickslip.friction.laws.lagged import LaggedFriction
from stickslip.friction.laws.linear_slip_weakening import LinearSlipWeakening
from stickslip.friction.laws.lugre import LuGre
from stickslip.friction.laws.parabolic_slip_weakening import ParabolicSlipWeakening
from stickslip.friction.laws.piecewise_linear_rate import PiecewiseLinearRate
from stickslip.friction.laws.piecewise_linear_slip import PiecewiseLinearSlip
from stickslip.friction.laws.power_stribeck import PowerStribeck
from stickslip.friction.laws.rate_and_state import RateAndState
from stickslip.friction.laws.sinusoidal_slip import SinusoidalSlip
from stickslip.friction.laws.slip_plus_rate import SlipPlusRate
from stickslip.friction.laws.slip_times_rate import SlipTimesRate
from stickslip.friction.laws.two_state_rate_and_state import TwoStateRateAndState
from stickslip.friction.laws.velocity_strengthening import VelocityStrengthening

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
        TwoStateRateAndState,
        LaggedFriction,
        LuGre,
        Dahl,
        FlashHeating,
        SlipPlusRate,
        SlipTimesRate,
        FromExpression,
        FromTable,
    )
}
"""Every friction law by its name in scenario files."""

__all__ = ["LAWS", "FrictionLaw", "FromExpression", "FromFunction", "FromTable"]
__all__ += ["Fit", "Points", "Smooth", "fit", "fit_each", "smooth"]
__all__ += ["Coulomb", "Dahl", "FlashHeating", "LuGre"]
__all__ += ["HyperbolicRate", "LaggedFriction", "PiecewiseLinearRate", "RateAndState", "VelocityStrengthening"]
__all__ += ["ExponentialCohesiveZone", "ExponentialSlipWeakening", "LinearSlipWeakening", "ParabolicSlipWeakening"]
__all__ += ["ExponentialStribeck", "PiecewiseLinearSlip", "PowerStribeck", "SinusoidalSlip", "SlipPlusRate", "SlipTimesRate"]
