"""Define Dahl's friction: springs that bend and give way, at any slip rate alike."""

from dataclasses import dataclass
from typing import Any, ClassVar

import numpy as np
from numpy.typing import ArrayLike, NDArray
from typing_extensions import override

from stickslip.foundation.conversion import Number
from stickslip.foundation.quantities import quantity
from stickslip.friction.contract import Formula
from stickslip.friction.law import FrictionLaw
from stickslip.friction.laws.lugre import BENDING


@dataclass(frozen=True)
class Dahl(FrictionLaw):
    """mu = stiffness z, with dz/dt = v (1 - stiffness z / sliding) for slip rates v >= 0.

    The state z is the bending of bristles in the direction of slip: it changes its sign where motion reverses. Friction depends on
    the path alone, not on the speed. It has hysteresis but no drop, so no stick-slip arises. The contact never sticks.
    """

    kind = "dahl"
    source = (
        "Dahl 1968, Aerospace Corporation report TOR-0158(3107-18)-1; Astrom & Canudas de Wit 2008, IEEE Control Syst. Mag. 28, 101"
    )
    state = BENDING
    sticks = False
    start: ClassVar = {"coefficient": 0.0, "state": 0.0}
    example: ClassVar = {"sliding": 0.1, "stiffness": "1e4 1/m"}

    sliding: float = quantity("1", "friction coefficient of steady sliding", above=0)
    stiffness: Number = quantity("1/m", "stiffness of the bristles, over the normal load", above=0)

    @property
    @override
    def pieces(self) -> tuple[Formula, ...]:
        return (_friction,)

    @property
    @override
    def state_rate(self) -> Formula:
        return _bending

    @override
    def range(self) -> tuple[float, float]:
        return 0.0, self.sliding

    @override
    def steady_state(self, v: ArrayLike) -> NDArray[np.float64]:
        """Return the bending z (m) in steady forward sliding, at any slip rate v > 0 (m/s)."""
        return np.full(np.shape(v), self.sliding / self.stiffness)


def _friction(law: Any, u: Any, v: Any, z: Any) -> Any:
    return law.stiffness * z


def _bending(law: Any, u: Any, v: Any, z: Any) -> Any:
    """Return dz/dt (m/s)."""
    return v - v * law.stiffness * z / law.sliding
