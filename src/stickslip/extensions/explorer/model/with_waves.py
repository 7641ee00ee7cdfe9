"""What the explorer shows of all bodies with waves."""

from __future__ import annotations

import math
import tomllib
from dataclasses import fields, replace
from typing import Any, ClassVar, cast

from stickslip.extensions.explorer.model.asked import ShownKind, slab_of_figure
from stickslip.foundation.names import TURNS
from stickslip.problem import block_for
from stickslip.problem.bodies import BodyOnCharacteristics, BodyWithWaves
from stickslip.problem.scenarios import Scenario, library, to_table

RIGID_DRIVER = {
    "driver_impedance": math.inf,
    "other_driver_impedance": math.inf,
    "driver_inertia": 0.0,
    "driver_integral_gain": 0.0,
}
"""Numbers of a driver that does not give way: the block equivalent to a body needs one."""


class ShownWaves(ShownKind):
    """The answers of bodies with waves, as far as they are alike."""

    has_the_mass: ClassVar[str] = "the contact"
    beside: ClassVar[str] = ""
    times: ClassVar[int] = 160

    def companion(self, scenario: Scenario) -> Scenario | None:
        """Return the equivalent block, for each m^2 of contact, so that its forces in N are the slab's stresses in Pa."""
        return replace(scenario, problem=block_for(scenario.problem), creep_rtol=None, shortest_event=None)

    def as_rigid(self, own: BodyOnCharacteristics) -> dict[str, Any]:
        """Return the block of the whole body, with all drivers rigid."""
        known = {one.name for one in fields(own)}
        whole = replace(own, **{field: value for field, value in RIGID_DRIVER.items() if field in known})
        return to_table(cast(BodyWithWaves, whole).equivalent_block())

    def in_place_of(self, own: BodyOnCharacteristics, kind: str, name: str) -> dict[str, Any]:
        """Return the body of the slab of the same figure, or of the scenario that new ones of this kind start from."""
        starter = kind if kind in library.STARTERS else "string" if own.load_unit == TURNS else "slab"  # of layers, or uniform
        slab_name = (slab_of_figure(name) if starter == "slab" else None) or library.STARTERS[starter].example
        return dict(tomllib.loads(library.text(slab_name))["body"])
