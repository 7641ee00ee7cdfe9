"""Define friction of bristles: springs that bend before they slip, with hysteresis where motion reverses."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any, ClassVar

import numpy as np
from numpy.typing import ArrayLike, NDArray
from typing_extensions import override

from stickslip.foundation.conversion import Number
from stickslip.foundation.quantities import quantity
from stickslip.friction.contract import Formula, StateVariable
from stickslip.friction.formula.functions import exp
from stickslip.friction.law import FrictionLaw

BENDING = StateVariable("z", "m", "mean bending z of the bristles, positive in forward slip", reverses=True)


@dataclass(frozen=True)
class LuGre(FrictionLaw):
    """mu = stiffness z + damping dz/dt + viscosity v, with dz/dt = v - stiffness z v / g(v) for slip rates v >= 0.

    g(v) = dynamic + (static - dynamic) exp(-(v / rate)^2) is friction in steady sliding without the viscosity. The bristles bend
    with slip before they give way, within about static / stiffness, and spring back where motion reverses: z, in the direction of
    slip, then changes its sign, and friction drives slip for a moment. The contact never sticks.

    On a contact without mass the damping must not be so large that friction at a given bending falls with slip rate: such a run
    ends.
    """

    kind = "lugre"
    source = (
        "Canudas de Wit, Olsson, Astrom & Lischinsky 1995, IEEE Trans. Autom. Control 40, 419; Astrom & Canudas de Wit 2008, IEEE "
        "Control Syst. Mag. 28, 101"
    )
    state = BENDING
    sticks = False
    start: ClassVar = {"coefficient": 0.0, "state": 0.0}
    example: ClassVar = {
        **{"static": 0.15, "dynamic": 0.1, "rate": "1 mm/s"},
        **{"stiffness": "1e4 1/m", "damping": "3 s/m", "viscosity": "0.04 s/m"},
    }

    static: float = quantity("1", "friction coefficient of very slow sliding", above=0)
    dynamic: float = quantity("1", "friction coefficient of fast sliding, without the viscous term", above=0)
    rate: Number = quantity("m/s", "slip rate over which friction falls (Stribeck)", above=0)
    stiffness: Number = quantity("1/m", "stiffness of the bristles, over the normal load", above=0)
    damping: Number = quantity("s/m", "damping of the bristles, over the normal load", at_least=0, default=0.0)
    viscosity: Number = quantity("s/m", "increase of friction with slip rate", at_least=0, default=0.0)

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
        return 0.0, math.inf

    @property
    @override
    def variation(self) -> float:
        """The larger of static and dynamic friction: bristles that spring back change it from one sign to the other (no unit)."""
        return max(self.static, self.dynamic)

    @override
    def steady_state(self, v: ArrayLike) -> NDArray[np.float64]:
        """Return the bending z (m) in steady forward sliding at slip rates v > 0 (m/s): g(v) / stiffness."""
        return np.asarray(_steady(self, np.asarray(v, float)) / self.stiffness)


def _steady(law: Any, v: Any) -> Any:
    """Return g(v), the friction coefficient of steady sliding without viscosity."""
    return law.dynamic + (law.static - law.dynamic) * exp(-((v / law.rate) ** 2))


def _bending(law: Any, u: Any, v: Any, z: Any) -> Any:
    """Return dz/dt (m/s)."""
    return v - law.stiffness * v * z / _steady(law, v)


def _friction(law: Any, u: Any, v: Any, z: Any) -> Any:
    return law.stiffness * z + law.damping * _bending(law, u, v, z) + law.viscosity * v


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
        return (_dahl_friction,)

    @property
    @override
    def state_rate(self) -> Formula:
        return _dahl_bending

    @override
    def range(self) -> tuple[float, float]:
        return 0.0, self.sliding

    @override
    def steady_state(self, v: ArrayLike) -> NDArray[np.float64]:
        """Return the bending z (m) in steady forward sliding, at any slip rate v > 0 (m/s)."""
        return np.full(np.shape(v), self.sliding / self.stiffness)


def _dahl_friction(law: Any, u: Any, v: Any, z: Any) -> Any:
    return law.stiffness * z


def _dahl_bending(law: Any, u: Any, v: Any, z: Any) -> Any:
    """Return dz/dt (m/s)."""
    return v - v * law.stiffness * z / law.sliding
