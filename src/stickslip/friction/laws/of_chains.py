"""Define friction that literature on chains of blocks uses."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, ClassVar

from typing_extensions import override

from stickslip.foundation.conversion import Number
from stickslip.foundation.errors import InputError
from stickslip.foundation.quantities import quantity
from stickslip.friction.law import FrictionLaw


@dataclass(frozen=True)
class CarlsonLanger(FrictionLaw):
    """mu(v) = static (1 - drop) / (1 + v / rate) in slip, and static at rest: the law of chains of blocks.

    The literature has forces in units of the static strength, sigma for `drop`, and (1 - sigma) / (2 alpha) for `rate`.
    """

    kind = "carlson-langer"
    source = (
        "Carlson & Langer 1989, Phys. Rev. A 40, 6470 (drop 0); Carlson, Langer & Shaw 1994, Rev. Mod. Phys. 66, 657 (drop sigma)"
    )
    many = True
    critical = "rate"
    example: ClassVar = {"static": 0.6, "drop": 0.01, "rate": "0.2 m/s"}

    static: float = quantity("1", "friction coefficient at rest", at_least=0)
    drop: float = quantity("1", "share of static friction that is lost at once as slip begins, at most 1", at_least=0)
    rate: Number = quantity("m/s", "slip rate where half of the rest is lost", above=0)

    @override
    def check(self) -> None:
        if not self.drop <= 1.0:
            raise InputError(f"CarlsonLanger: drop is a share of static friction, at most 1, got {self.drop:g}")

    @staticmethod
    @override
    def formula(law: Any, u: Any, v: Any) -> Any:
        return law.static * (1.0 - law.drop) / (1.0 + v / law.rate)

    @property
    @override
    def static_excess(self) -> float:
        return self.static * self.drop
