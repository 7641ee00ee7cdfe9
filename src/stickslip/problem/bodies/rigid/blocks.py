"""Define the rigid bodies on a spring: a block that slides, and a disc that turns."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import ClassVar

from stickslip.foundation.conversion import Number
from stickslip.foundation.errors import InputError
from stickslip.foundation.quantities import declare, quantity
from stickslip.foundation.show import Declared
from stickslip.problem.bodies.contract import BodyOnCharacteristics
from stickslip.problem.bodies.rigid.on_spring import OnSpring
from stickslip.problem.bodies.rigid.play import BACKLASH, check_play
from stickslip.problem.bodies.rigid.stops import RESTITUTION, STOP_AHEAD, STOP_BEHIND, check_with_stops


@dataclass(frozen=True)
class SpringBlock(Declared, OnSpring):
    """A rigid block pulled through a spring: m dv/dt + damping v + tau = K (D0 + V t - u). Loads and tractions are forces, in N.

    A dashpot beside the spring adds driver_damping (V - v) on the right, and `force` of a `Problem` adds a force. With a stiffness
    of 0 there is no spring.
    """

    kind: ClassVar[str] = "spring-block"
    belted: ClassVar[str] = "block-on-belt"
    source: ClassVar[str] = "Campillo et al. 1996, eqs (4)-(6); damping and driver_damping are additions"
    load_unit: ClassVar[str] = "N"
    mass_field: ClassVar[str] = "mass"

    mass: Number = quantity("kg", "mass m", above=0)
    stiffness: Number = quantity("N/m", "stiffness K of the spring; 0: there is none", at_least=0)
    normal_force: Number = quantity("N", "normal force S on the contact, compression positive", above=0)
    damping: Number = quantity("N s/m", "viscous resistance to slip", at_least=0, default=0.0)
    driver_damping: Number = quantity(
        "N s/m", "damping of a dashpot beside the spring, between block and driver", at_least=0, default=0.0
    )
    stop_ahead: Number = quantity("m", STOP_AHEAD, at_least=0, infinite=True, word="none", default=math.inf)
    stop_behind: Number = quantity("m", STOP_BEHIND, at_least=0, infinite=True, word="none", default=math.inf)
    restitution: Number = declare(RESTITUTION, 0.0)
    backlash: Number = quantity("m", BACKLASH, at_least=0, default=0.0)

    def __post_init__(self) -> None:
        check_with_stops(self)
        check_play(self)

    @property
    def inertia(self) -> float:
        """The mass (kg)."""
        return self.mass


@dataclass(frozen=True)
class RotatingBlock(Declared, OnSpring):
    """A rigid body turned through a torsion spring: I dv/dt + damping v + tau = K (D0 + V t - u), with an angle u (rad).

    Loads and tractions are torques, in N m. The contact resists with the torque `normal_torque` mu: for a brake or a clutch that is
    its clamping force times its effective radius. A dashpot beside the spring adds driver_damping (V - v) on the right.
    """

    kind: ClassVar[str] = "rotating-block"
    belted: ClassVar[str] = "block-on-disc"
    source: ClassVar[str] = "Campillo et al. 1996, eqs (4)-(6), with angles for lengths and torques for forces"
    load_unit: ClassVar[str] = "N m"
    mass_field: ClassVar[str] = "inertia"

    inertia: Number = quantity("kg m^2", "moment of inertia I; for a spring without one a small one: check says how small", above=0)
    stiffness: Number = quantity("N m/rad", "stiffness K of the torsion spring; 0: there is none", at_least=0)
    normal_torque: Number = quantity("N m", "torque of friction if mu is 1: clamping force times effective radius", above=0)
    damping: Number = quantity("N m s", "viscous resistance to slip", at_least=0, default=0.0)
    driver_damping: Number = quantity(
        "N m s", "damping of a dashpot beside the spring, between body and driver", at_least=0, default=0.0
    )
    stop_ahead: Number = quantity("rad", STOP_AHEAD, at_least=0, infinite=True, word="none", default=math.inf)
    stop_behind: Number = quantity("rad", STOP_BEHIND, at_least=0, infinite=True, word="none", default=math.inf)
    restitution: Number = declare(RESTITUTION, 0.0)
    backlash: Number = quantity("rad", BACKLASH, at_least=0, default=0.0)

    def __post_init__(self) -> None:
        check_with_stops(self)
        check_play(self)


def as_block(body: BodyOnCharacteristics) -> SpringBlock:
    """Return a body that must be a block; raise InputError for any other body."""
    if not isinstance(body, SpringBlock):
        raise InputError("needs a spring-block")
    return body
