"""Define the sum of a slip law and a rate law."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, ClassVar

from stickslip.friction.composite import CompositeLaw


@dataclass(frozen=True)
class SlipPlusRate(CompositeLaw):
    """mu(u, v) = slip law + rate law, at rest too; slip is what the slip law counts.

    Parameters
    ----------
    slip
        A friction law that depends on slip only.
    rate
        A friction law that depends on slip rate only.

    Raises
    ------
    InputError
        If a part has a state, depends on the variable of the other, or if both are piecewise.
    """

    kind: ClassVar[str] = "sum"
    source: ClassVar[str] = "the sources of its parts"
    example: ClassVar[dict[str, Any]] = {
        "slip": {"kind": "linear-slip-weakening", "static": 0.4, "dynamic": 0.2, "distance": "0.4 m"},
        "rate": {"kind": "exponential-stribeck", "static": 0.3, "dynamic": 0.2, "rate": "0.1 m/s"},
    }

    @staticmethod
    def join(slip: Any, rate: Any) -> Any:
        return slip + rate

    @property
    def static_excess(self) -> float:
        return self.slip.static_excess + self.rate.static_excess

    def critical_value(self, impedance: float, normal: float) -> tuple[str, float] | None:
        """Return the critical value of the rate law: the part that depends on slip does not change with the slip rate."""
        closed = self.rate.critical_value(impedance, normal)
        if closed is None or closed[0] == "normal_stress":
            return closed
        return f"rate.{closed[0]}", closed[1]

    def range(self) -> tuple[float, float]:
        (low, high), (least, most) = self.slip.range(), self.rate.range()
        return low + least, high + most
