"""Define laws that are made of other laws: sums and products of a slip law and a rate law, and friction that lags behind."""

from __future__ import annotations

import math
from abc import abstractmethod
from collections.abc import Callable
from dataclasses import dataclass
from types import SimpleNamespace
from typing import Any, ClassVar, Literal

import numpy as np
from numpy.typing import ArrayLike, NDArray
from typing_extensions import override

from stickslip.foundation.conversion import Number
from stickslip.foundation.errors import InputError
from stickslip.foundation.quantities import LawField, declare, fields_of, quantities_of, quantity
from stickslip.friction.contract import Formula, StateVariable
from stickslip.friction.formula.functions import arcsinh
from stickslip.friction.law import FrictionLaw

MAKES_LAWS = "FromFunction makes one of a function, FromExpression of a text"
"""End of a message about a part that is no law."""


@dataclass(frozen=True)
class LawOfParts(FrictionLaw):
    """A law with other laws as parts; at most one of them has knots.

    The formulas know a parameter of a part by the name of its field and its own name, such as "rate_alpha", so that names of two
    parts cannot collide.
    """

    @property
    def parts(self) -> dict[str, FrictionLaw]:
        """The parts by the name of their field."""
        return {
            name: getattr(self, name) for name, (declared, _) in fields_of(type(self)).items() if isinstance(declared, LawField)
        }

    @override
    def check_start(self, slip: float) -> None:
        for part in self.parts.values():
            part.check_start(slip)

    @property
    @override
    def can_be_negative(self) -> bool:
        return any(part.can_be_negative for part in self.parts.values())

    @override
    def parameters(self) -> tuple[str, ...]:
        of_parts = (f"{place}_{name}" for place, part in self.parts.items() for name in part.parameters())
        return (*of_parts, *quantities_of(type(self)))

    @override
    def piece_values(self, i: int) -> tuple[float, ...]:
        of_parts = (value for part in self.parts.values() for value in part.piece_values(i if part.knots else 0))
        return (*of_parts, *(float(getattr(self, name)) for name in quantities_of(type(self))))

    @override
    def literals(self) -> dict[str, float]:
        return {f"{place}_{name}": value for place, part in self.parts.items() for name, value in part.literals().items()}


class PartNumbers:
    """Give the formula of a part access to its parameters, which the whole law knows under longer names."""

    def __init__(self, law: SimpleNamespace, place: str) -> None:
        self._law, self._place = law, place

    def __getattr__(self, name: str) -> Any:
        return getattr(self._law, f"{self._place}_{name}")


@dataclass(frozen=True)
class CompositeLaw(LawOfParts):
    """A law whose friction coefficient combines the values of a slip law and a rate law.

    It counts and remembers slip as its slip law does. The slip law depends on slip only, the rate law on slip rate only; neither
    has a state, and at most one of them has knots.
    """

    slip: FrictionLaw = declare(LawField("a law of slip"))
    rate: FrictionLaw = declare(LawField("a law of slip rate"))

    @staticmethod
    @abstractmethod
    def join(slip: Any, rate: Any) -> Any:
        """Return the friction coefficient from the values of the two parts, which are numbers or expressions."""

    @override
    def check(self) -> None:
        name = type(self).__name__
        for place, part in self.parts.items():
            if not isinstance(part, FrictionLaw):
                raise InputError(f"{name}: {place} must be a friction law, got {type(part).__name__}; {MAKES_LAWS}")
            if part.states:
                raise InputError(f"{name}: {place} must be a law without a state of its own, {part.kind} has one")
        for part, place, other in ((self.slip, "slip", "rate"), (self.rate, "rate", "slip")):
            if getattr(part, f"depends_on_{other}"):
                raise InputError(f"{name}: {place} must be a law of {place} only, but {part.kind} depends on {other}")
        if self.slip.knots and self.rate.knots:
            raise InputError(f"{name}: only one part may be piecewise, but {self.slip.kind} and {self.rate.kind} both are")

    @property
    @override
    def counts(self) -> Literal["net", "path"]:  # type: ignore[override] # follows the slip law
        return self.slip.counts

    @property
    @override
    def memory(self) -> Literal["all", "since-arrest"]:  # type: ignore[override] # follows the slip law
        return self.slip.memory

    @property
    @override
    def knot_variable(self) -> Literal["slip", "rate"]:  # type: ignore[override] # follows the part with knots
        return (self.rate if self.rate.knots else self.slip).knot_variable

    @property
    @override
    def knots(self) -> tuple[float, ...]:
        return self.slip.knots or self.rate.knots

    @property
    @override
    def pieces(self) -> tuple[Formula, ...]:
        pairs = [(a, b) for a in self.slip.pieces for b in self.rate.pieces]
        made = {pair: _joined(self.join, *pair) for pair in dict.fromkeys(pairs)}
        return tuple(made[pair] for pair in pairs)

    @property
    @override
    def rate_scales(self) -> tuple[float, ...]:
        return self.rate.rate_scales


def _joined(join: Callable[[Any, Any], Any], slip: Formula, rate: Formula) -> Formula:
    def formula(law: Any, u: Any, v: Any) -> Any:
        return join(slip(PartNumbers(law, "slip"), u, v), rate(PartNumbers(law, "rate"), u, v))

    return formula


@dataclass(frozen=True)
class SlipPlusRate(CompositeLaw):
    """mu(u, v) = slip law + rate law, at rest too; the slip law says which slip counts."""

    kind = "sum"
    source = "the sources of its parts"
    example: ClassVar = {
        "slip": {"kind": "linear-slip-weakening", "static": 0.4, "dynamic": 0.2, "distance": "0.4 m"},
        "rate": {"kind": "exponential-stribeck", "static": 0.3, "dynamic": 0.2, "rate": "0.1 m/s"},
    }

    @staticmethod
    @override
    def join(slip: Any, rate: Any) -> Any:
        return slip + rate

    @property
    @override
    def static_excess(self) -> float:
        return self.slip.static_excess + self.rate.static_excess

    @override
    def range(self) -> tuple[float, float]:
        (low, high), (least, most) = self.slip.range(), self.rate.range()
        return low + least, high + most

    @property
    def critical(self) -> str:  # type: ignore[override] # that of the rate law: the other part does not change with the slip rate
        """The name of the rate law's parameter that has a critical value."""
        return f"rate.{self.rate.critical}" if self.rate.critical else ""


@dataclass(frozen=True)
class SlipTimesRate(CompositeLaw):
    """mu(u, v) = slip law * rate law: one is a friction coefficient, the other a factor; the slip law says which slip counts.

    Both parts must be continuous at rest: the height of a step there would change with slip.
    """

    kind = "product"
    source = "the sources of its parts"
    example: ClassVar = {
        "slip": {"kind": "linear-slip-weakening", "static": 0.7, "dynamic": 0.5, "distance": "0.4 m"},
        "rate": {"kind": "hyperbolic-rate", "static": 1.0, "dynamic": 0.5, "alpha": "1 s/m"},
    }

    @override
    def check(self) -> None:
        super().check()
        for part in self.parts.values():
            if part.static_excess:
                raise InputError(f"SlipTimesRate: {part.kind} steps from static to sliding friction; a factor must be continuous")

    @staticmethod
    @override
    def join(slip: Any, rate: Any) -> Any:
        return slip * rate

    @override
    def range(self) -> tuple[float, float]:
        (low, high), (least, most) = self.slip.range(), self.rate.range()
        return low * least, high * most if high * most == high * most else 0.0


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

    rate: FrictionLaw = declare(LawField("a law of slip rate"))
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
