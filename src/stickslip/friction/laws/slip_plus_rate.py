"""Define the sum of a slip law and a rate law."""

from dataclasses import dataclass
from typing import Any, ClassVar

from typing_extensions import override

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

    @override
    def critical_value(self, impedance: float, normal: float) -> tuple[str, float] | None:
        """Return the critical value of the rate law: the part that depends on slip does not change with the slip rate."""
        closed = self.rate.critical_value(impedance, normal)
        if closed is None or closed[0] == "normal_stress":
            return closed
        return f"rate.{closed[0]}", closed[1]
