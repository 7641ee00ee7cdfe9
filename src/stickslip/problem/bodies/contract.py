"""Define what is asked of every body, and the checks that bodies share."""

from __future__ import annotations

from dataclasses import Field
from typing import Any, ClassVar, Protocol, cast

import numpy as np

from stickslip.foundation.arrays import anywhere
from stickslip.foundation.errors import InputError
from stickslip.foundation.names import KINDS_OF_BODY, Name, si_unit
from stickslip.foundation.quantities import check_fields


class Body(Protocol):
    """What every body that slides on a contact has, whatever solves its motion.

    Its loads are stresses (Pa), forces (N) or torques (N m). Units below are for a slab; for a block read N for Pa, and kg for
    kg/m^2; for a body that turns N m for Pa, kg m^2 for kg/m^2, and rad for m where it is slip (`Problem.unit_of`).
    """

    __dataclass_fields__: ClassVar[dict[str, Field[Any]]]

    kind: ClassVar[str]
    """Name in scenario files."""
    load_unit: ClassVar[str]
    """SI unit of loads and tractions, which decides the other units: a row of `foundation.names.KINDS_OF_BODY`."""
    noun: ClassVar[str]
    """What sentences call the body: "slab", "block" or "string"."""

    @property
    def normal_field(self) -> str:
        """The name of the field that holds the normal load, or that is in proportion to it."""
        ...

    @property
    def normal_load(self) -> float:
        """The normal load S on the contact (Pa), compression positive."""
        ...

    @property
    def stiffness(self) -> float:
        """The decrease of the load per metre of slow slip (Pa/m)."""
        ...

    @property
    def impedance(self) -> float:
        """The load per slip rate that is characteristic of the body (Pa s/m): Z of a slab, sqrt(K m) of a block."""
        ...

    @property
    def damping(self) -> float:
        """The load per slip rate by which the body itself resists slip (Pa s/m): by radiation of waves, by viscosity, or both."""
        ...

    @property
    def total_damping(self) -> float:
        """The load per slip rate of all that resists slip (Pa s/m): `damping`, and a dashpot beside the spring of a block."""
        ...

    @property
    def inertia(self) -> float:
        """The mass that slips with the contact (kg/m^2): the contact mass of a slab, the whole mass of a block."""
        ...

    @property
    def has_inertia(self) -> bool:
        """True if a mass slips with the contact, so that its slip rate cannot jump."""
        ...


class BodyOnCharacteristics(Body, Protocol):
    """What the exact solver needs besides: how slip acts on the contact again, after a round trip, along characteristics.

    Units are those of `Body`.
    """

    structure: ClassVar[str]
    """The kind of body, by which the parts of the program answer what they are asked: "rigid", "uniform" or "layered"."""
    turn: ClassVar[str]
    """What sentences call the time after which slip acts on the contact again: "round trip" or "period"."""
    driver_may_change: ClassVar[bool]
    """True if the driver may be one that changes in time."""
    what_is_heavy: ClassVar[str]
    """What sentences call what has the mass that slips: "contact mass" or "block"."""
    has_waves: ClassVar[bool]
    """True if slip sends waves into the body, which come back as load one round trip later; False if the body is rigid."""
    is_uniform: ClassVar[bool]
    """False if the waves are reflected on their way, too, where layers meet."""
    mass_field: ClassVar[str]
    """Name of the field for the mass that slips with the contact."""

    @property
    def driver_impedance(self) -> float:
        """The impedance of the driver (Pa s/m), inf for a driver that prescribes its displacement."""
        ...

    @property
    def driver_kind(self) -> str:
        """The kind of driver (`stickslip.problem.drivers`).

        It is "spring" or "spring_and_dashpot" of a rigid body; of others "rigid", "lossy" or "machine". Of several drivers it is
        "rigid" only if all are.
        """
        ...

    @property
    def is_driven_rigidly(self) -> bool:
        """True if the driver does not give way, or by less than rounding."""
        ...

    @property
    def has_machine(self) -> bool:
        """True if the driver has a motion of its own: a mass, or a gain that integrates."""
        ...

    @property
    def is_damped(self) -> bool:
        """True if a damper at the free top takes energy of the waves, in a motion of its own."""
        ...

    @property
    def driver_inertia(self) -> float:
        """The mass of a machine (kg/m^2)."""
        ...

    @property
    def driver_integral_gain(self) -> float:
        """The integral gain ki of such a driver: stress for each metre that it lags behind what its pull rate asks for (Pa/m)."""
        ...

    @property
    def reflection(self) -> float:
        """The share of an outgoing wave that comes back from the driver, between -1 and 1; 0 without waves."""
        ...

    @property
    def round_trip_time(self) -> float:
        """The time (s) after which slip acts on the contact again: 2 h/c of a slab, the period of a block."""
        ...

    def equivalent_block(self) -> BodyOnCharacteristics:
        """Return the rigid body on a spring to which this one is equivalent in slow motion. Raises InputError if there is none."""
        ...

    @property
    def noun_with_driver(self) -> str:
        """What sentences call the body, or the like of it, whose driver may give way: "slab" or "string"."""
        ...

    def check_uniform(self, refusal: str) -> None:
        """Raise InputError unless the body is a uniform one with waves: see `as_waves`."""
        ...

    def turn_time(self, longest: float) -> float:
        """Return the length of a round trip of a history (s), which may be as long as that of a rigid body that never rests."""
        ...

    @property
    def longest_way(self) -> float:
        """The time (s) of a wave to the driver and back, through all layers; of a block its period."""
        ...

    @property
    def time_to_driver(self) -> float:
        """The time (s) of a wave from the contact to the (first) driver; 0 of a block."""
        ...

    def grows_in_a_trip(self, rate: Any) -> Any:
        """Return the growth of the load (Pa) of a contact at rest in one `round_trip_time` under a rigid driver at a rate (m/s)."""
        ...

    def added_at_contact(self, sent: tuple[Any, Any]) -> tuple[Any, Any]:
        """Return the load from the driver that the engine adds at the contact, and its growth: nothing if layers bring it."""
        ...

    def rates_at_start(self, rate: float, shear: float) -> list[tuple[float, float]]:
        """Return the velocities (m/s, towards forward slip) of the contact and of the driver on each side of it.

        The contact slips at `rate`, and the driver moves by `shear` faster than that.
        """
        ...

    def held_at_start(self, rate: float, shear: float) -> list[float]:
        """Return the stress (Pa) that drag then takes between the contact and the driver of each side."""
        ...

    def meets_driver_at_first(self, excess: Any, rate: Any, shear: Any) -> Any:
        """Return the wave (Pa, minus the reference strength) that meets the driver at the start.

        The load then has an excess over that strength (Pa), the contact slips at `rate`, and the driver is by `shear` faster (m/s).
        """
        ...

    @property
    def pulled_shares(self) -> list[float]:
        """The share (1) of each driver in an inflow that varies, which is that of the first one."""
        ...

    @property
    def dashpot(self) -> float:
        """The load per slip rate that the contact of a body with waves takes beside friction and its waves (Pa s/m); 0 of others.

        The `damping` of a rigid body stands for what waves would take.
        """
        ...

    @property
    def echo_impedance(self) -> float:
        """The impedance (Pa s/m) with which slip comes back as load after a round trip: Z, and 0 of a rigid body."""
        ...

    @property
    def first_share(self) -> float:
        """The share (1) of the load, and of the far stress, that the first side bears."""
        ...

    @property
    def drivers(self) -> int:
        """The number of drivers."""
        ...

    @property
    def has_ground(self) -> bool:
        """True if there is ground under the contact, which may move: not if two sides slip on each other."""
        ...

    def belt_as_ground(self, pull: Any, given: str) -> Any:
        """Return the `Ground` that a belt is, whose velocity is the pull rate; None without a belt, or if it runs steadily.

        `given` is the field with another motion of the ground, "" for none. Raises InputError where a belt cannot have that.
        """
        ...

    takes_force: ClassVar[bool]
    """True if a force may act on it, because it is rigid."""

    @property
    def is_free(self) -> bool:
        """True if no spring holds the body: its stiffness is 0."""
        ...

    @property
    def has_stops(self) -> bool:
        """True if a hard stop bars its way, ahead or behind."""
        ...

    @property
    def has_play(self) -> bool:
        """True if there is backlash between it and its spring."""
        ...

    @property
    def inflow_delay(self) -> float:
        """The time (s) that a loading takes from the driver to where the engine adds it: h/c of a slab, 0 of a block."""
        ...

    @property
    def last_impedance(self) -> float:
        """The impedance at the driver (Pa s/m)."""
        ...

    @property
    def fastest_rate(self) -> float:
        """The slip rate (m/s) at which the body would slide as fast as its (slowest) waves run; inf without waves."""
        ...


MACHINE = "a driver with a mass or an integral gain"
"""Words for a driver that is a machine (`BodyOnCharacteristics.has_machine`)."""


def check_body(body: BodyOnCharacteristics) -> None:
    """Check the fields of a body. Its normal load is one number, whereas a history belongs to the problem."""
    normal = KINDS_OF_BODY[body.load_unit].normal
    if hasattr(getattr(body, normal), "segments"):
        one = f"{type(body).__name__}: {normal} is one number, that at the start"
        raise InputError(f"{one}: a history is normal_load of the Problem, [loading.normal_load] in a scenario")
    check_fields(body)


class BodyWithWaves(BodyOnCharacteristics, Protocol):
    """A uniform body in which waves run along one line between the contact and the driver."""

    modulus_name: ClassVar[Name]
    """Name, symbol, unit and meaning of the modulus."""
    impedance_formula: ClassVar[str]
    """The impedance in symbols, for people."""

    @property
    def wave_speed(self) -> float:
        """The wave speed c (m/s)."""
        ...

    @property
    def modulus(self) -> float:
        """The load per strain: G of a slab (Pa); per angle of twist on each metre, G J of a string (N m^2)."""
        ...

    @property
    def distance(self) -> float:
        """The distance h between contact and driver (m)."""
        ...

    @property
    def two_way_time(self) -> float:
        """The two-way travel time R = 2 h / c (s)."""
        ...

    @property
    def contact_damping(self) -> float:
        """The load per slip rate that a dashpot at the contact takes, beside friction (Pa s/m)."""
        ...

    @property
    def front_reflection(self) -> float:
        """The share of a sharp wave front that the driver sends back."""
        ...


def as_waves(body: BodyOnCharacteristics, refusal: str = "needs a body with waves") -> BodyWithWaves:
    """Return a uniform body that must carry waves. Raises InputError, with the text `refusal` for a rigid one."""
    body.check_uniform(refusal)
    return cast(BodyWithWaves, body)


class WithNormalLoad:
    """The normal load of a body whose field for it has the usual name, and no belt under it: a base for bodies."""

    has_stops: bool = False
    has_play: bool = False

    takes_force: ClassVar[bool] = False
    is_free: bool = False

    @property
    def normal_field(self: Body) -> str:
        """The name of the field that holds the normal load."""
        return KINDS_OF_BODY[self.load_unit].normal

    @property
    def normal_load(self: Body) -> float:
        """The normal load S on the contact, compression positive (Pa, N or N m)."""
        found: float = getattr(self, self.normal_field)
        return found

    def belt_as_ground(self, pull: Any, given: str) -> Any:
        """Return None: there is no belt."""
        return None


class WithOneDriver(WithNormalLoad):
    """What bodies have in common that one driver ends, without layers before it: a base for bodies."""

    drivers: int = 1
    first_share: float = 1.0
    has_ground: bool = True
    is_damped: bool = False

    def added_at_contact(self, sent: tuple[Any, Any]) -> tuple[Any, Any]:
        """Return all load that the driver sends, and its growth."""
        return sent

    def rates_at_start(self, rate: float, shear: float) -> list[tuple[float, float]]:
        """Return the velocities (m/s) of the contact, which slips at `rate`, and of the driver, which is by `shear` faster."""
        return [(rate, rate + shear)]

    def held_at_start(self, rate: float, shear: float) -> list[float]:
        """Return the stress (Pa) that drag takes between contact and driver: none."""
        return [0.0]

    @property
    def pulled_shares(self) -> list[float]:
        """The share (1) of the driver in an inflow that varies: all."""
        return [1.0]


def check_driver(body: BodyOnCharacteristics) -> None:
    """Raise InputError if the mass and the gains of a driver do not go together."""
    owner = type(body).__name__
    rigid, gain = np.isinf(body.driver_impedance), body.driver_integral_gain > 0.0
    unmoved = np.isinf(body.driver_inertia)
    heavy = (body.driver_inertia > 0.0) & ~unmoved
    why = "a rigid driver holds its rate whatever its mass and gains"
    for name, given in (("driver_inertia", heavy), ("driver_integral_gain", gain)):
        if anywhere(given & rigid):
            raise InputError(f"{owner}: {name} needs a finite driver_impedance, the proportional gain: {why}")
    if anywhere(gain & unmoved):
        raise InputError(f"{owner}: driver_integral_gain needs a finite driver_inertia: {why}")
    if anywhere(gain & (body.driver_impedance == 0.0)):
        why = "nothing damps the driver, and its swings grow where friction falls with the slip rate"
        raise InputError(
            f"{owner}: driver_integral_gain needs a driver_impedance, the proportional gain, above 0: without it {why}"
        )


def check_equivalent(body: BodyOnCharacteristics, driver: str = "driver_impedance") -> None:
    """Raise InputError unless the drivers of a body are rigid: otherwise no spring is left in slow motion.

    `driver` is the field of one that gives way, if any does.
    """
    if not body.is_driven_rigidly:
        raise InputError(
            f"{type(body).__name__}: equivalent_block needs a rigid driver: behind one of finite impedance nothing holds the "
            f"{body.noun} in the slow limit, so there is no spring; got "
            f"{driver} = {getattr(body, driver):g} {si_unit('impedance', body.load_unit)}"
        )
