"""Define a rate law whose friction lags behind the slip rate, with an optional direct effect: a regularisation."""

import math
from dataclasses import dataclass
from typing import Any, ClassVar

import numpy as np
from numpy.typing import ArrayLike, NDArray
from typing_extensions import override

from stickslip.foundation.conversion import Number
from stickslip.foundation.errors import InputError
from stickslip.foundation.quantities import Part, declare, quantity
from stickslip.friction.composite import MAKES_LAWS, LawOfParts, PartNumbers
from stickslip.friction.contract import Formula, StateVariable
from stickslip.friction.formula.functions import arcsinh
from stickslip.friction.law import FrictionLaw


@dataclass(frozen=True)
class LaggedFriction(LawOfParts):
    """mu = law(w) + direct [arcsinh(v / (2 direct_rate)) - arcsinh(w / (2 direct_rate))], with time dw/dt = v - w.

    In steady sliding, w = v, friction is as under the law itself. On a slab without contact mass and without direct effect, Z time
    dw/dt = load - g(w): the lag acts on w as a contact mass Z time acts on the slip rate. The contact heals at rest, because w
    falls to 0 there.

    The law must depend on slip rate only, and have neither a state, nor kinks, nor a step at rest.
    """

    kind = "lagged"
    source = (
        "Campillo et al. 1996, section 3 (why a solution must be selected); Hess & Soom 1990, J. Tribol. 112, 147 (a time lag); "
        "Rice & Ben-Zion 1996, Proc. Natl. Acad. Sci. 93, 3811 (arcsinh)"
    )
    state = StateVariable("w", "m/s", "lagged slip rate")
    example: ClassVar = {"rate": {"kind": "hyperbolic-rate", "static": 0.8, "dynamic": 0.3, "alpha": "1 s/m"}, "time": "10 ms"}

    rate: FrictionLaw = declare(Part("a law of slip rate"))
    time: Number = quantity("s", "time in which friction catches up with the slip rate", above=0)
    direct: float = quantity("1", "immediate increase of friction per factor e of slip rate", at_least=0, default=0.0)
    direct_rate: Number = quantity("m/s", "slip rate below which the direct effect fades", above=0, default=1e-6)

    @override
    def check(self) -> None:
        if not isinstance(self.rate, FrictionLaw):
            raise InputError(f"LaggedFriction: rate must be a friction law, got {type(self.rate).__name__}; {MAKES_LAWS}")
        if self.rate.depends_on_slip or not self.rate.depends_on_rate or self.rate.states:
            raise InputError(f"LaggedFriction: rate must be a law of slip rate only, {self.rate.kind} is not")
        if self.rate.knots or self.rate.static_excess:
            raise InputError(f"LaggedFriction: rate must be a smooth law, {self.rate.kind} has kinks or a step at rest")

    @property
    @override
    def pieces(self) -> tuple[Formula, ...]:
        lagged = _with_lag(self.rate.pieces[0])
        return (_with_direct_effect(lagged) if self.direct > 0.0 else lagged,)

    @property
    @override
    def state_rate(self) -> Formula:
        return _catch_up

    @override
    def coefficient(self, u: ArrayLike, v: ArrayLike = 0.0, w: ArrayLike = 0.0) -> NDArray[np.float64]:
        """Return mu as in `FrictionLaw.coefficient`, with negative values of w replaced by 0.

        The polynomials of a run may fall below zero by their tolerance, where the formula need not hold.
        """
        return super().coefficient(u, v, np.maximum(np.asarray(w, float), 0.0))

    @property
    @override
    def can_be_negative(self) -> bool:
        """True with a direct effect, which lowers friction without bound when slip is slow, but was fast a moment ago."""
        return self.direct > 0.0 or super().can_be_negative

    @override
    def range(self) -> tuple[float, float]:
        low, high = self.rate.range()
        return low, math.inf if self.direct > 0.0 else high

    @property
    @override
    def variation(self) -> float:
        return self.rate.variation

    @property
    @override
    def rate_scales(self) -> tuple[float, ...]:
        return self.rate.rate_scales


def _with_lag(formula: Formula) -> Formula:
    def lagged(law: Any, u: Any, v: Any, w: Any) -> Any:
        return formula(PartNumbers(law, "rate"), u, w)

    return lagged


def _with_direct_effect(formula: Formula) -> Formula:
    def direct(law: Any, u: Any, v: Any, w: Any) -> Any:
        gained = arcsinh(v / (2.0 * law.direct_rate)) - arcsinh(w / (2.0 * law.direct_rate))
        return formula(law, u, v, w) + law.direct * gained

    return direct


def _catch_up(law: Any, u: Any, v: Any, w: Any) -> Any:
    return (v - w) / law.time
