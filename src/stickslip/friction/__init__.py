"""Friction laws: what the contact resists with."""

from stickslip.friction.contract import FrictionLaw
from stickslip.friction.coulomb import Coulomb
from stickslip.friction.hyperbolic_rate import HyperbolicRate
from stickslip.friction.linear_slip_weakening import LinearSlipWeakening
from stickslip.friction.registry import LAWS
from stickslip.friction.sinusoidal_slip import SinusoidalSlip

__all__ = ["LAWS", "Coulomb", "FrictionLaw", "HyperbolicRate", "LinearSlipWeakening", "SinusoidalSlip"]
