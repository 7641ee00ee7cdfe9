"""Export the friction laws of the contact.

To add a law, add a class to `laws` (docs/adding-a-law.md), and here its import, its place in `LAWS` and its name in `__all__`.
`FromExpression`, `FromFunction` and `FromTable` make laws from formulas, functions and measured points of users;
`smooth` and `fit`, of an extension, make laws from noisy points. `__init__.pyi` is the page of all names.
"""

from stickslip.foundation.lazy_names import other_names
from stickslip.friction.custom.from_expression import FromExpression
from stickslip.friction.custom.from_function import FromFunction
from stickslip.friction.custom.points import FromTable, Points
from stickslip.friction.law import FrictionLaw
from stickslip.friction.laws.bristles import Dahl, LuGre
from stickslip.friction.laws.combined import LaggedFriction, SlipPlusRate, SlipTimesRate
from stickslip.friction.laws.of_rate import (
    Coulomb,
    ExponentialStribeck,
    HyperbolicRate,
    PiecewiseLinearRate,
    PowerStribeck,
    VelocityStrengthening,
)
from stickslip.friction.laws.of_slip import (
    ExponentialCohesiveZone,
    ExponentialSlipWeakening,
    LinearSlipWeakening,
    ParabolicSlipWeakening,
    PiecewiseLinearSlip,
    PowerSlipWeakening,
    SinusoidalSlip,
)
from stickslip.friction.laws.rate_and_state import FlashHeating, RateAndState, TwoStateRateAndState

LAWS: dict[str, type[FrictionLaw]] = {
    law.kind: law
    for law in (
        SinusoidalSlip,
        HyperbolicRate,
        Coulomb,
        LinearSlipWeakening,
        ExponentialSlipWeakening,
        PowerSlipWeakening,
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
__all__ += ["Points"]
__all__ += ["Coulomb", "Dahl", "FlashHeating", "LuGre"]
__all__ += ["HyperbolicRate", "LaggedFriction", "PiecewiseLinearRate", "RateAndState", "VelocityStrengthening"]
__all__ += ["ExponentialCohesiveZone", "ExponentialSlipWeakening", "LinearSlipWeakening", "ParabolicSlipWeakening"]
__all__ += ["ExponentialStribeck", "PiecewiseLinearSlip", "PowerSlipWeakening", "PowerStribeck", "SinusoidalSlip"]
__all__ += ["SlipPlusRate", "SlipTimesRate"]

__getattr__ = other_names(__name__)
