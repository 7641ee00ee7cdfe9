"""Define laws that are made of other laws."""

from __future__ import annotations

from abc import abstractmethod
from collections.abc import Callable
from dataclasses import dataclass
from types import SimpleNamespace
from typing import Any, Literal

from typing_extensions import override

from stickslip.foundation.errors import InputError
from stickslip.foundation.quantities import Part, declare, fields_of, quantities_of
from stickslip.friction.contract import Formula
from stickslip.friction.law import FrictionLaw

MAKES_LAWS = "FromFunction makes one of a function, FromExpression of a text"
"""End of a message about a part that is no law."""


@dataclass(frozen=True)
class LawOfParts(FrictionLaw):
    """A law with other laws as parts, at most one of which has knots.

    The formulas know a parameter of a part by the name of its field and its own name, such as "rate_alpha", so that names of two
    parts cannot collide.
    """

    @property
    def parts(self) -> dict[str, FrictionLaw]:
        """The parts by the name of their field."""
        return {name: getattr(self, name) for name, (declared, _) in fields_of(type(self)).items() if isinstance(declared, Part)}

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

    slip: FrictionLaw = declare(Part("a law of slip"))
    rate: FrictionLaw = declare(Part("a law of slip rate"))

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
