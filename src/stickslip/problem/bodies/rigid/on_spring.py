"""Rigid bodies on a spring, or on none (stiffness 0: `problem.free_turn`): what follows from their numbers."""

from __future__ import annotations

import math
from dataclasses import fields
from typing import Any, ClassVar, Protocol, cast

import numpy as np

from stickslip.foundation.arrays import anywhere
from stickslip.foundation.errors import InputError
from stickslip.problem.bodies.contract import BodyOnCharacteristics, WithOneDriver
from stickslip.problem.bodies.register import BODIES

LONGEST_ROUND_TRIP = 1e6
"""Largest number of periods (1) in a block's round trip."""
FREE_TURN = 1.0
"""Length (s) of the round trip of a body that is free: any does, as long as it is no longer than what happens in it."""


class BodyOnSpring(BodyOnCharacteristics, Protocol):
    """A rigid body on a spring."""

    belted: ClassVar[str]

    @property
    def driver_damping(self) -> float:
        """The damping of a dashpot between the body and the pulled end of its spring (N s/m)."""
        ...

    stop_ahead: float
    stop_behind: float
    restitution: float
    backlash: float
    integral_gain: float
    reference_step: float

    @property
    def period(self) -> float:
        """The period of free oscillation (s)."""
        ...


class OnSpring(WithOneDriver):
    """What follows from the numbers of a rigid body on a spring: a base for such bodies."""

    structure: ClassVar[str] = "rigid"
    noun: ClassVar[str] = "block"
    driver_may_change: ClassVar[bool] = False
    takes_force: ClassVar[bool] = True
    noun_with_driver: str = "slab"
    turn: ClassVar[str] = "period"
    what_is_heavy: ClassVar[str] = "block"
    belted: ClassVar[str]
    """The kind of this body on a belt."""
    driver_damping: float = 0.0
    """Of a body that has no dashpot beside its spring."""
    backlash: float = 0.0
    """Of a body without a play between it and its spring."""
    integral_gain: float = 0.0
    """Of a body that is in no position loop; and the step of its reference."""
    reference_step: float = 0.0
    echo_impedance: float = 0.0
    dashpot: float = 0.0
    has_waves: ClassVar[bool] = False
    is_uniform: ClassVar[bool] = True
    has_inertia: ClassVar[bool] = True
    driver_impedance: ClassVar[float] = math.inf
    """The end of the spring is displaced as prescribed, as the face of a slab is by a rigid driver."""
    is_driven_rigidly: ClassVar[bool] = True
    has_machine: ClassVar[bool] = False
    driver_inertia: ClassVar[float] = 0.0
    driver_integral_gain: ClassVar[float] = 0.0
    reflection: ClassVar[float] = 0.0
    inflow_delay: ClassVar[float] = 0.0
    time_to_driver: ClassVar[float] = 0.0
    fastest_rate: ClassVar[float] = math.inf

    @property
    def driver_kind(self: BodyOnSpring) -> str:
        """The kind of driver: "spring_and_dashpot" if there is a dashpot, "free" if there is nothing, else "spring"."""
        return "spring_and_dashpot" if anywhere(self.driver_damping) else "free" if self.is_free else "spring"

    @property
    def is_free(self: BodyOnSpring) -> bool:  # type: ignore[override] # a constant of all other bodies
        """True if the stiffness is 0: a dashpot may still pull the body."""
        return not anywhere(self.stiffness)

    @property
    def has_stops(self: BodyOnSpring) -> bool:  # type: ignore[override]
        """True if a hard stop bars its way."""
        return anywhere(self.stop_ahead < math.inf) or anywhere(self.stop_behind < math.inf)

    @property
    def has_play(self: BodyOnSpring) -> bool:  # type: ignore[override]
        """True if there is a play between it and its spring."""
        return anywhere(self.backlash)

    @property
    def total_damping(self: BodyOnSpring) -> float:
        """The viscous resistance to slip of the ground and of the driver (N s/m)."""
        return self.damping + self.driver_damping

    @property
    def last_impedance(self: BodyOnCharacteristics) -> float:
        """The `impedance`."""
        return self.impedance

    @property
    def round_trip_time(self: BodyOnCharacteristics) -> float:
        """The period of free undamped oscillation, 2 pi sqrt(m / K) (s): the spring has then brought the body's motion back."""
        found: float = 2.0 * math.pi * np.sqrt(self.inertia / _swung(self))
        return found

    @property
    def longest_way(self: BodyOnCharacteristics) -> float:
        """The period (s)."""
        return self.round_trip_time

    def grows_in_a_trip(self: BodyOnCharacteristics, rate: Any) -> Any:
        """Return the growth of the load (N) in one period while the spring is pulled at a rate (m/s) and the block rests."""
        return self.stiffness * rate * self.round_trip_time

    def check_uniform(self, refusal: str) -> None:
        """Refuse: a rigid body has no waves."""
        raise InputError(refusal)

    def on_belt(self) -> Any:
        """Return the body on a belt: what moves at the pull rate is then the ground, and the spring hangs on a wall.

        A `SpringBlock` is then a `BlockOnBelt`. A `RotatingBlock` is a `BlockOnDisc`: the belt is a disc that turns. The pull rate
        of the problem is the velocity of the belt, and slip is how far the belt has run ahead of the body.
        """
        numbers = {one.name: getattr(self, one.name) for one in fields(self)}  # type: ignore[arg-type] # every body is a dataclass
        return BODIES[self.belted](**numbers)

    def equivalent_block(self) -> BodyOnCharacteristics:
        """Refuse: a block stands for itself."""
        raise InputError("analogy: needs a slab or a string: a block has no other block that stands for it")

    def turn_time(self: BodyOnCharacteristics, longest: float) -> float:
        """Return the period (s), or as long a time as is asked for if it never rests, up to LONGEST_ROUND_TRIP periods."""
        period = self.round_trip_time
        return max(period, min(LONGEST_ROUND_TRIP * period, longest))

    def meets_driver_at_first(self, excess: Any, rate: Any, shear: Any) -> Any:
        """Return the load of the spring (N, minus the reference strength), which the far end bears."""
        return excess

    @property
    def period(self: BodyOnCharacteristics) -> float:
        """The period of free undamped oscillation (s)."""
        return self.round_trip_time

    @property
    def impedance(self: BodyOnCharacteristics) -> float:
        """Sqrt(K m) (N s/m), which takes the place of a slab's impedance; a scale, and not 0, of a body without a spring."""
        found: float = np.sqrt(_swung(self) * self.inertia)
        return found


def _swung(body: BodyOnCharacteristics) -> Any:
    """Return the stiffness (N/m), or that of a spring on which a body without one would swing in FREE_TURN."""
    stiffness, free = body.stiffness, body.inertia * (2.0 * math.pi / FREE_TURN) ** 2
    return np.where(stiffness > 0.0, stiffness, free) if isinstance(stiffness, np.ndarray) else stiffness or free


def as_on_spring(body: BodyOnCharacteristics) -> BodyOnSpring:
    """Return a body that must be a rigid one, as one on a spring, with the numbers that only such a body has."""
    return cast(BodyOnSpring, body)
