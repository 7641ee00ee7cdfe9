"""Every friction law, by its name in scenario files. Adding a law is one file beside this one and one line here."""

from __future__ import annotations

from stickslip.friction.contract import FrictionLaw
from stickslip.friction.coulomb import Coulomb
from stickslip.friction.hyperbolic_rate import HyperbolicRate
from stickslip.friction.linear_slip_weakening import LinearSlipWeakening
from stickslip.friction.sinusoidal_slip import SinusoidalSlip

LAWS: dict[str, type[FrictionLaw]] = {
    law.kind: law
    for law in (
        SinusoidalSlip,
        HyperbolicRate,
        Coulomb,
        LinearSlipWeakening,
    )
}
