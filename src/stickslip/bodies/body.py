"""Define what the rest of the package asks of a body, so that it need not ask which body it is."""

from __future__ import annotations

from dataclasses import Field
from typing import Any, ClassVar, Protocol

from stickslip.bodies.elastic_slab import ElasticSlab
from stickslip.bodies.spring_block import SpringBlock
from stickslip.foundation.errors import InputError


class Body(Protocol):
    """What every body that slides on a contact has, whatever solves its motion. Its loads are stresses (Pa) or forces (N).

    Units below are for a slab; for a block read N for Pa, and kg for kg/m^2.
    """

    __dataclass_fields__: ClassVar[dict[str, Field[Any]]]

    kind: ClassVar[str]
    """Name in scenario files."""
    load_unit: ClassVar[str]
    """Unit of loads and tractions."""
    energy_unit: ClassVar[str]
    """Unit of energies, in the form that files store."""

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
        """The load per slip rate by which the body resists slip (Pa s/m): by radiation of waves, or by viscosity."""
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

    has_waves: ClassVar[bool]
    """True if slip sends waves into the body, which come back as load one round trip later; False if the body is rigid."""

    @property
    def driver_impedance(self) -> float:
        """The impedance of the driver (Pa s/m), inf for a driver that prescribes its displacement."""
        ...

    @property
    def is_driven_rigidly(self) -> bool:
        """True if the driver does not give way, or by less than rounding."""
        ...

    @property
    def reflection(self) -> float:
        """The share of an outgoing wave that comes back from the driver, between -1 and 1; 0 without waves."""
        ...

    @property
    def round_trip_time(self) -> float:
        """The time (s) after which slip acts on the contact again: 2 h/c of a slab, the period of a block."""
        ...


def has_dashpot(body: BodyOnCharacteristics) -> bool:
    """Return True if the contact of a body with waves resists slip by another damping than its waves, whose damping is Z."""
    return body.has_waves and body.damping != body.impedance


def as_slab(body: BodyOnCharacteristics, refusal: str = "needs an elastic slab") -> ElasticSlab:
    """Return a body that must be a slab. Raises InputError with the text `refusal` for any other body."""
    if not isinstance(body, ElasticSlab):
        raise InputError(refusal)
    return body


def as_block(body: BodyOnCharacteristics) -> SpringBlock:
    """Return a body that must be a block; raise InputError for any other body."""
    if not isinstance(body, SpringBlock):
        raise InputError("needs a spring-block")
    return body
