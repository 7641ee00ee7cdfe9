"""Join two laws, one of slip and one of slip rate, into one."""

from __future__ import annotations

from abc import abstractmethod
from collections.abc import Callable
from dataclasses import dataclass
from types import SimpleNamespace
from typing import Any, Literal

from typing_extensions import override

from stickslip.foundation.errors import InputError
from stickslip.foundation.quantities import Part, declare
from stickslip.friction.contract import Formula
from stickslip.friction.law import FrictionLaw

PREFIXES = ("slip_", "rate_")
"""Prefixes of the parameters of the slip law and of the rate law, so that names of the two cannot collide."""


@dataclass(frozen=True)
class CompositeLaw(FrictionLaw):
    """A law whose friction coefficient combines the values of a slip law and a rate law.

    It counts and remembers slip as its slip law does. The slip law depends on slip only, the rate law on slip rate only; neither
    has a state, and at most one of them has knots.
    """

    slip: FrictionLaw = declare(Part("a law of slip"))  # noqa: RUF009 - makes a dataclass field
    rate: FrictionLaw = declare(Part("a law of slip rate"))  # noqa: RUF009

    @staticmethod
    @abstractmethod
    def join(slip: Any, rate: Any) -> Any:
        """Return the friction coefficient from the values of the two parts, which are numbers or expressions."""

    @property
    def parts(self) -> tuple[FrictionLaw, FrictionLaw]:
        """The slip law and the rate law."""
        return self.slip, self.rate

    @override
    def check(self) -> None:
        name = type(self).__name__
        for part, place in zip(self.parts, ("slip", "rate"), strict=True):
            if not isinstance(part, FrictionLaw):
                raise InputError(f"{name}: {place} must be a friction law, got {type(part).__name__}")
            if part.state is not None:
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

    @override
    def parameters(self) -> tuple[str, ...]:
        return tuple(prefix + name for prefix, part in zip(PREFIXES, self.parts, strict=True) for name in part.parameters())

    @override
    def piece_values(self, i: int) -> tuple[float, ...]:
        return sum((part.piece_values(i if part.knots else 0) for part in self.parts), ())

    @override
    def literals(self) -> dict[str, float]:
        laws = zip(PREFIXES, self.parts, strict=True)
        return {prefix + name: value for prefix, part in laws for name, value in part.literals().items()}

    @property
    @override
    def rate_scales(self) -> tuple[float, ...]:
        return self.rate.rate_scales


class Prefixed:
    """Give a part's formula access to its own parameters, which the whole law stores under prefixed names."""

    def __init__(self, law: SimpleNamespace, prefix: str) -> None:
        self._law, self._prefix = law, prefix

    def __getattr__(self, name: str) -> Any:
        return getattr(self._law, self._prefix + name)


def _joined(join: Callable[[Any, Any], Any], slip: Formula, rate: Formula) -> Formula:
    def formula(law: Any, u: Any, v: Any) -> Any:
        first, second = (Prefixed(law, prefix) for prefix in PREFIXES)
        return join(slip(first, u, v), rate(second, u, v))

    return formula
