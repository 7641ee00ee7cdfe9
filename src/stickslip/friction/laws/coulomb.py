"""Define Coulomb friction with a static and a dynamic coefficient."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, ClassVar

from stickslip.foundation.errors import InputError
from stickslip.foundation.quantities import quantity
from stickslip.friction.law import FrictionLaw


@dataclass(frozen=True)
class Coulomb(FrictionLaw):
    """|tau| <= static S at rest, |tau| = dynamic S in slip: the limit alpha -> infinity of the hyperbolic rate law.

    Parameters
    ----------
    static
        Friction coefficient at rest (no unit), not less than `dynamic`.
    dynamic
        Friction coefficient in slip (no unit).

    Raises
    ------
    InputError
        If `static` is less than `dynamic`, or a coefficient is negative.

    Notes
    -----
    Source: Campillo et al. 1996, section 4, the limit of eq. (15).
    """

    kind: ClassVar[str] = "coulomb"
    source: ClassVar[str] = "Campillo et al. 1996, section 4 (limit of eq. 15)"
    many: ClassVar[bool] = True
    example: ClassVar[dict[str, Any]] = {"static": 0.6, "dynamic": 0.5}

    static: float = quantity("1", "friction coefficient at rest", at_least=0)
    dynamic: float = quantity("1", "friction coefficient in slip", at_least=0)

    def check(self) -> None:
        if self.static < self.dynamic:
            raise InputError(f"Coulomb: static must be at least dynamic, got static {self.static:g} < dynamic {self.dynamic:g}")

    @staticmethod
    def formula(law: Any, u: Any, v: Any) -> Any:
        return law.dynamic + 0.0 * v

    @property
    def static_excess(self) -> float:
        return self.static - self.dynamic

    def critical_value(self, impedance: float, normal: float) -> tuple[str, float] | None:
        """Return static_c = dynamic: any step down in friction gives several solutions, under every normal stress."""
        return "static", self.dynamic

    def range(self) -> tuple[float, float]:
        return self.dynamic, self.static

    @property
    def bends_one_way(self) -> bool:
        return True
