"""Bodies that carry waves: what follows from their numbers."""

from __future__ import annotations

from functools import cached_property
from typing import Any, ClassVar

import numpy as np

from stickslip.foundation.arrays import anywhere, everywhere
from stickslip.foundation.constants import RIGID
from stickslip.foundation.conversion import Number
from stickslip.foundation.quantities import Quantity
from stickslip.problem.bodies.contract import BodyWithWaves, WithOneDriver


def contact_damping(unit: str, load: str) -> Quantity:
    """Declare the dashpot of a contact: its unit, and what sentences call a load."""
    return Quantity(unit, f"viscous resistance of the contact beside friction: {load} for each unit of slip rate", at_least=0)


class WithWaves(WithOneDriver):
    """What follows from the numbers of a `BodyWithWaves`: a base for such bodies."""

    structure: ClassVar[str] = "uniform"
    driver_may_change: ClassVar[bool] = True
    turn: ClassVar[str] = "round trip"
    what_is_heavy: ClassVar[str] = "contact mass"
    has_waves: ClassVar[bool] = True
    is_uniform: ClassVar[bool] = True
    contact_damping: Number = 0.0  # type: ignore[assignment] # fields convert, this is no field
    """The dashpot of a body that does not declare one."""

    @property
    def damping(self: BodyWithWaves) -> float:
        """The load per slip rate (Pa s/m) that leaves with the waves, which is the impedance, or that a dashpot takes."""
        return self.impedance + self.contact_damping

    @property
    def dashpot(self: BodyWithWaves) -> float:
        """The load per slip rate (Pa s/m) that does not leave with the waves: `damping` less `impedance`."""
        return self.damping - self.impedance

    @property
    def total_damping(self: BodyWithWaves) -> float:
        """The damping (Pa s/m): no dashpot leads past the waves to the driver."""
        return self.damping

    @property
    def two_way_time(self: BodyWithWaves) -> float:
        """The two-way travel time R = 2 h / c (s)."""
        return 2.0 * self.distance / self.wave_speed

    @property
    def round_trip_time(self: BodyWithWaves) -> float:
        """The two-way travel time R (s), after which a wave that slip has sent out comes back as load."""
        return self.two_way_time

    @property
    def longest_way(self: BodyWithWaves) -> float:
        """The two-way travel time (s), through all of the body."""
        return self.two_way_time

    @property
    def time_to_driver(self: BodyWithWaves) -> float:
        """The travel time h / c (s)."""
        return self.distance / self.wave_speed

    @property
    def driver_kind(self: BodyWithWaves) -> str:
        """The kind of driver: "rigid", "machine", or "lossy" if it is neither."""
        if self.is_driven_rigidly:
            return "rigid"
        return "machine" if self.has_machine else "lossy"

    def grows_in_a_trip(self: BodyWithWaves, rate: Any) -> Any:
        """Return the growth of the load (Pa) at rest in one round trip, under a rigid driver at a rate (m/s): 2 Z V."""
        return 2.0 * self.impedance * rate

    def check_uniform(self, refusal: str) -> None:
        """Do nothing: it is a uniform body with waves."""

    @property
    def noun_with_driver(self: BodyWithWaves) -> str:
        """What sentences call the body."""
        return self.noun

    def turn_time(self: BodyWithWaves, longest: float) -> float:
        """Return the length of a round trip of a history (s): that of waves."""
        return self.round_trip_time

    def meets_driver_at_first(self: BodyWithWaves, excess: Any, rate: Any, shear: Any) -> Any:
        """Return the wave (Pa, minus the reference strength) that meets the driver at the start."""
        return self.impedance * shear - (excess - 2.0 * self.impedance * rate)

    @property
    def echo_impedance(self: BodyWithWaves) -> float:
        """The impedance (Pa s/m) with which slip comes back as load after a round trip: Z."""
        return self.impedance

    @property
    def inflow_delay(self: BodyWithWaves) -> float:
        """The travel time h / c (s) from the driver to the contact."""
        return self.distance / self.wave_speed

    @property
    def last_impedance(self: BodyWithWaves) -> float:
        """The impedance at the driver (Pa s/m), that of the contact in a uniform body."""
        return self.impedance

    @property
    def fastest_rate(self: BodyWithWaves) -> float:
        """The slip rate (m/s) at which the body would slide as fast as its waves run."""
        return self.wave_speed

    @property
    def has_inertia(self: BodyWithWaves) -> bool:
        """True if a mass slips with the contact, so that its slip rate cannot jump."""
        return self.inertia > 0.0

    @cached_property
    def reflection(self: BodyWithWaves) -> float:
        """The reflection coefficient of the driver, r = (Z - Zd) / (Z + Zd).

        It is -1 for a rigid driver, 0 for a matched half-space and +1 for a dead load. A driver with a mass or an integral gain
        sends back a wave that depends on how long the one that it meets lasts: r holds where neither is felt.
        """
        if everywhere(np.isinf(self.driver_impedance) | np.isinf(self.driver_inertia)):
            return RIGID
        return (self.impedance - self.driver_impedance) / (self.impedance + self.driver_impedance)

    @cached_property
    def is_driven_rigidly(self: BodyWithWaves) -> bool:
        """True if the driver reflects the whole wave with its sign reversed, r = -1."""
        return everywhere(self.reflection == RIGID)

    @property
    def front_reflection(self: BodyWithWaves) -> float:
        """The share of a sharp wave front that the driver sends back: a mass has no time to give way."""
        return RIGID if np.any(np.greater(self.driver_inertia, 0.0)) else self.reflection

    @cached_property
    def has_machine(self: BodyWithWaves) -> bool:
        """True if the driver has a motion of its own: a mass or an integral gain."""
        own = anywhere(self.driver_inertia > 0.0) or anywhere(self.driver_integral_gain > 0.0)
        return own and not self.is_driven_rigidly

    @property
    def stiffness(self: BodyWithWaves) -> float:
        """The modulus over the distance, G / h (Pa/m): the decrease of the load per metre of slow slip under a rigid driver."""
        return self.modulus / self.distance
