"""Define the product of a slip law and a rate law."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, ClassVar

from stickslip.foundation.errors import InputError
from stickslip.friction.composite import CompositeLaw


@dataclass(frozen=True)
class SlipTimesRate(CompositeLaw):
    """mu(u, v) = slip law * rate law: one is a friction coefficient, the other a factor; slip is what the slip law counts.

    Both parts must be continuous at rest: the height of a step there would change with slip.

    Parameters
    ----------
    slip
        A friction law, or a factor, that depends on slip only.
    rate
        A factor, or a friction law, that depends on slip rate only.

    Raises
    ------
    InputError
        If a part has a state, depends on the variable of the other or steps from static to sliding friction, or if both are
        piecewise.
    """

    kind: ClassVar[str] = "product"
    source: ClassVar[str] = "the sources of its parts"
    example: ClassVar[dict[str, Any]] = {
        "slip": {"kind": "linear-slip-weakening", "static": 0.7, "dynamic": 0.5, "distance": "0.4 m"},
        "rate": {"kind": "hyperbolic-rate", "static": 1.0, "dynamic": 0.5, "alpha": "1 s/m"},
    }

    def check(self) -> None:
        super().check()
        for part in self.parts:
            if part.static_excess:
                raise InputError(f"SlipTimesRate: {part.kind} steps from static to sliding friction; a factor must be continuous")

    @staticmethod
    def join(slip: Any, rate: Any) -> Any:
        return slip * rate

    def range(self) -> tuple[float, float]:
        (low, high), (least, most) = self.slip.range(), self.rate.range()
        return low * least, high * most if high * most == high * most else 0.0
