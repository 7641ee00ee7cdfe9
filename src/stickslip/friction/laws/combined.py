"""Define friction that is the sum or the product of a law of slip and a law of slip rate."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, ClassVar

from typing_extensions import override

from stickslip.foundation.errors import InputError
from stickslip.friction.composite import CompositeLaw


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
