"""How strings are pressed onto their contact: by the weight on the bit, or by a torque."""

from __future__ import annotations

from stickslip.foundation.conversion import OptionalNumber
from stickslip.foundation.errors import InputError
from stickslip.foundation.quantities import Quantity

WEIGHT_ON_BIT = Quantity("N", "weight on the bit: a force, compression positive", above=0)
"""How the normal load of a body that turns on its bit may be given, and vary."""
BIT_RADIUS = Quantity("m", "effective radius of the bit: 2/3 of its own if the weight is spread evenly", above=0)
NORMAL_TORQUE = Quantity("N m", "torque of the bit if mu is 1, in place of weight and radius", above=0)
LOADED_BY = "give either normal_torque, or weight_on_bit and bit_radius"
"""How a string is pressed onto its contact."""


class OnBit:
    """How a string is pressed onto its contact, by a weight or by a torque: a base for strings, with the names of their fields."""

    weight_on_bit: OptionalNumber
    bit_radius: OptionalNumber
    normal_torque: OptionalNumber

    @property
    def normal_field(self) -> str:
        """The field that a heavier load changes: the weight on the bit, or the torque where that is given."""
        return "normal_torque" if self.normal_torque is not None else "weight_on_bit"

    @property
    def normal_load(self) -> float:
        """The torque of the bit if mu is 1 (N m)."""
        if self.normal_torque is not None:
            return self.normal_torque
        assert self.weight_on_bit is not None
        assert self.bit_radius is not None
        return self.weight_on_bit * self.bit_radius

    def check_bit(self) -> None:
        """Raise InputError unless the bit has either a weight and a radius, or a torque."""
        weight = (self.weight_on_bit is None, self.bit_radius is None)
        if weight[0] != weight[1] or weight[0] == (self.normal_torque is None):
            raise InputError(f"{type(self).__name__}: {LOADED_BY}")
