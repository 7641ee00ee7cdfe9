"""Define the rigid bodies that a position loop holds: an axis that slides, and one that turns."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any, ClassVar

import numpy as np

from stickslip.foundation.arrays import anywhere
from stickslip.foundation.conversion import Number
from stickslip.foundation.errors import InputError
from stickslip.foundation.quantities import declare, quantity
from stickslip.foundation.show import Declared
from stickslip.problem.bodies.rigid.on_spring import OnSpring
from stickslip.problem.bodies.rigid.stops import RESTITUTION, STOP_AHEAD, STOP_BEHIND, check_with_stops

PERIODS_IN_TRIP = 1000.0
"""A rest winds up the integral, so that no two periods are alike and none is leapt over: a round trip has this many of them (1)."""


class InLoop(OnSpring):
    """What differs from a body on a spring: the proportional gain is the spring, the derivative gain a dashpot; a third winds up.

    The pull rate is the rate of the reference.
    """

    structure: ClassVar[str] = "loop"
    noun: ClassVar[str] = "axis"
    what_is_heavy: ClassVar[str] = "axis"
    proportional_gain: float
    integral_gain: float
    derivative_gain: float
    reference_step: float

    @property
    def stiffness(self) -> float:
        """The proportional gain (N/m), which acts as a spring."""
        return self.proportional_gain

    @property
    def driver_damping(self) -> float:  # type: ignore[override]
        """The derivative gain (N s/m), which acts as a dashpot beside this spring."""
        return self.derivative_gain

    @property
    def driver_kind(self) -> str:
        """The kind of driver: "position_loop", also where a gain is 0."""
        return "position_loop"

    @property
    def has_machine(self) -> bool:  # type: ignore[override]
        """True if there is an integral gain."""
        return bool(anywhere(self.integral_gain))

    @property
    def round_trip_time(self) -> float:
        """The length of a round trip of its history (s)."""
        found: float = super().round_trip_time  # type: ignore[misc] # a property of every body on a spring
        return found * (PERIODS_IN_TRIP if anywhere(self.integral_gain) else 1.0)

    @property
    def longest_way(self) -> float:
        """The period (s)."""
        return self.period

    @property
    def period(self) -> float:
        """The period of free oscillation without an integral, 2 pi sqrt(m / kp) (s)."""
        found: float = 2.0 * np.pi * np.sqrt(self.inertia / self.stiffness)  # type: ignore[attr-defined]
        return found

    def on_belt(self) -> Any:
        """Refuse: the reference of a loop is a way over ground at rest."""
        raise InputError(f"{type(self).__name__}: a loop is not followed on a belt: take the belt's velocity from the pull rate")


@dataclass(frozen=True)
class PositionLoop(Declared, InLoop):
    """A rigid axis that a controller holds at a reference: m dv/dt + damping v + tau = kp (r - u) + kd (r' - v) + q.

    q' = ki (r - u) is the integral, r' is the pull rate, and slip u is the position. Loads and tractions are forces, in N. Without
    an integral gain it is a `SpringBlock`. At the start the lag r - u is `reference_step`, and q the initial load less kd r' before
    the start, which is 0 for `Waypoints`, else that at the start.
    """

    kind: ClassVar[str] = "position-loop"
    source: ClassVar[str] = "Armstrong-Helouvry, Dupont & Canudas de Wit 1994, Automatica 30, section 4.2"
    load_unit: ClassVar[str] = "N"
    mass_field: ClassVar[str] = "mass"

    mass: Number = quantity("kg", "mass m that is moved", above=0)
    proportional_gain: Number = quantity("N/m", "proportional gain kp, force per lag behind the reference", above=0)
    normal_force: Number = quantity("N", "normal force S on the contact, compression positive", above=0)
    integral_gain: Number = quantity("N/m/s", "integral gain ki, growth of the force per lag", at_least=0, default=0.0)
    derivative_gain: Number = quantity("N s/m", "derivative gain kd, force per rate of the lag", at_least=0, default=0.0)
    damping: Number = quantity("N s/m", "viscous resistance to slip", at_least=0, default=0.0)
    reference_step: Number = quantity("m", "step of the reference at the start, which the load follows", default=0.0)
    stop_ahead: Number = quantity("m", STOP_AHEAD, at_least=0, infinite=True, word="none", default=math.inf)
    stop_behind: Number = quantity("m", STOP_BEHIND, at_least=0, infinite=True, word="none", default=math.inf)
    restitution: Number = declare(RESTITUTION, 0.0)

    def __post_init__(self) -> None:
        check_with_stops(self)

    @property
    def inertia(self) -> float:
        """The mass (kg)."""
        return self.mass


@dataclass(frozen=True)
class RotaryLoop(Declared, InLoop):
    """A rigid axis that turns, which a controller holds at a reference: I dv/dt + damping v + tau = kp (r - u) + kd (r' - v) + q.

    q' = ki (r - u) is the integral, r' is the pull rate, and slip u is the angle (rad). Loads and tractions are torques, in N m.
    Without an integral gain it is a `RotatingBlock`. At the start the lag is `reference_step`, and q the initial load less kd r'
    before the start, which is 0 for `Waypoints`, else that at the start.
    """

    kind: ClassVar[str] = "rotary-loop"
    source: ClassVar[str] = "Armstrong-Helouvry, Dupont & Canudas de Wit 1994, with angles for lengths and torques for forces"
    load_unit: ClassVar[str] = "N m"
    mass_field: ClassVar[str] = "inertia"

    inertia: Number = quantity("kg m^2", "moment of inertia I that is turned", above=0)
    proportional_gain: Number = quantity("N m/rad", "proportional gain kp, torque per lag behind the reference", above=0)
    normal_torque: Number = quantity("N m", "torque of friction if mu is 1", above=0)
    integral_gain: Number = quantity("N m/rad/s", "integral gain ki, growth of the torque per lag", at_least=0, default=0.0)
    derivative_gain: Number = quantity("N m s", "derivative gain kd, torque per rate of the lag", at_least=0, default=0.0)
    damping: Number = quantity("N m s", "viscous resistance to slip", at_least=0, default=0.0)
    reference_step: Number = quantity("rad", "step of the reference at the start, which the load follows", default=0.0)
    stop_ahead: Number = quantity("rad", STOP_AHEAD, at_least=0, infinite=True, word="none", default=math.inf)
    stop_behind: Number = quantity("rad", STOP_BEHIND, at_least=0, infinite=True, word="none", default=math.inf)
    restitution: Number = declare(RESTITUTION, 0.0)

    def __post_init__(self) -> None:
        check_with_stops(self)
